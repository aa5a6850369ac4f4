#include "app/ground_target.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/ground_room.h"
#include "app/named_objects.h"
#include "app/pierced_advice.h"
#include "app/providers/maps.h"
#include "app/scene_lookups.h"
#include "app/scene_warnings.h"
#include "app/target_section.h"
#include "app/triangle_runs.h"
#include "common/input.h"
#include "io/mesh_builder.h"
#include "scene/triangulated_terrain.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

using core::Footprint;
using core::Ring;
using scene::Incline;
using scene::TriangulatedTerrain;
using Vec2 = Eigen::Vector2d;

const MapProvider& maps(const Mission& mission) {
  return map_provider("targets on the ground", mission.as_written.places.target);
}

Mesh ground_mesh(const Scene& scene, std::uint32_t ground) {
  Mesh mesh;
  std::vector<std::uint32_t> renamed(scene.mesh.vertices.size(), UINT32_MAX);
  for (std::size_t i = 0; i < scene.object_of.size(); ++i) {
    if (scene.object_of[i] != ground) continue;
    Triangle triangle = scene.mesh.triangles[i];
    for (std::uint32_t& vertex : triangle) {
      if (renamed[vertex] == UINT32_MAX) {
        renamed[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(scene.mesh.vertices[vertex]);
      }
      vertex = renamed[vertex];
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

const TriangulatedTerrain& ground_surface(const Mission& mission) {
  const Scene& scene = mission.scene();
  const auto ground = ground_object(scene);
  if (!ground) {
    throw Error(
        ErrorCode::ground_missing, "the scene has no object 'ground' to put the target on",
        mission.as_written.places.target,
        "give the target's vertices, or a scene that is made from a map; PLY and STL keep no objects, OBJ and GLB do");
  }
  return looked_up<TriangulatedTerrain>(
      *mission.loaded, [&] { return std::make_shared<const TriangulatedTerrain>(ground_mesh(scene, *ground)); });
}

/// The plane nearest to heights at some places, by least squares.
Incline nearest_plane(const std::vector<Vec2>& places, const std::vector<double>& heights_m) {
  Vec2 middle = Vec2::Zero();
  for (const Vec2& place : places) middle += place / static_cast<double>(places.size());
  Eigen::MatrixXd rows(places.size(), 3);
  Eigen::VectorXd heights(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) << places[i].x() - middle.x(), places[i].y() - middle.y(), 1;
    heights[static_cast<Eigen::Index>(i)] = heights_m[i];
  }
  const Eigen::Vector3d fit = rows.colPivHouseholderQr().solve(heights);
  return {fit.head<2>(), fit.z() - fit.head<2>().dot(middle)};
}

/// The plane nearest to the ground at a ring's corners and the middles of its sides, raised until no ground under the
/// ring lies above it.
Incline ground_plane(const TriangulatedTerrain& ground, const Ring& ring, const Mission& mission) {
  const char* const beyond = "the target reaches beyond the scene's ground";
  std::vector<Vec2> samples;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    samples.push_back(ring[i]);
    samples.push_back((ring[i] + ring[(i + 1) % ring.size()]) / 2);
  }
  std::vector<double> heights;
  for (const Vec2& sample : samples) {
    const auto height = ground.height(sample);
    if (!height) fail_off_ground(mission, beyond);
    heights.push_back(*height);
  }
  Incline plane = nearest_plane(samples, heights);
  const auto range = ground.range(ring, plane);
  if (!range) fail_off_ground(mission, beyond);
  plane.level_m += range->highest;
  return plane;
}

Ring rectangle(const Mission& mission, const GroundTarget& wanted, const geo::OnGlobe& globe) {
  const geo::LonLat place{(*wanted.center_deg)[1], (*wanted.center_deg)[0]};
  const Vec2 centre = globe.on_surface(place, above_ground(mission, wanted.above_ground_m));
  const double heading = wanted.heading_deg * std::numbers::pi / 180;
  const Vec2 along(std::sin(heading), std::cos(heading)), across(along.y(), -along.x());
  const Vec2 a = along * wanted.length_m / 2, b = across * wanted.width_m / 2;
  return {centre - a - b, centre - a + b, centre + a + b, centre + a - b};
}

/// The id of the area with that name; areas count before streets around them.
std::string id_of_area(const OutlineFinder& find, const std::string& name, const std::string& place, bool is_part) {
  std::vector<NamedId> areas, lines;
  for (NamedOutline& one : find.named()) {
    NamedId known{io::clean_name(one.name), std::move(one.id)};
    (one.is_line ? lines : areas).push_back(std::move(known));
  }
  const auto has_name = [&](const NamedId& one) { return is_same_name(one.name, name); };
  if (std::none_of(areas.begin(), areas.end(), has_name)) {
    std::move(lines.begin(), lines.end(), std::back_inserter(areas));
  }
  return id_of_name(areas, name, "area of the map", place, is_part);
}

struct NamedArea {
  std::string id;    ///< "way/123"
  std::string name;  ///< of the map; may be empty
  std::vector<Footprint> outlines;
};

/// An area of the map. What is in a hole, a building maybe, is not part of it and need not be seen. `asked`: its id or
/// its name.
NamedArea area_of_map(const Mission& mission, const std::string& asked, const geo::LocalFrame& frame,
                      const Progress& progress) {
  const SceneSource& source = mission.as_written.scene;
  const auto& find = looked_up<OutlineFinder>(*mission.loaded, [&] {
    return std::make_shared<const OutlineFinder>(
        maps(mission).find_outlines(source.file, source.city.region, progress));
  });
  const std::string& place = mission.as_written.places.target;
  const bool is_id = find.of(asked, frame).has_value();
  const bool is_part = uses_part_of_map(mission);
  const std::string name = is_id ? asked : id_of_area(find, asked, place, is_part);
  const auto found = find.of(name, frame);
  if (!found->is_area) {
    throw Error(ErrorCode::map_object_missing,
                (is_part ? "the scene's part of the map has no area " : "the map has no area ") + name, place,
                "name a tagged closed way or a multipolygon of " + source.file.filename().string() +
                    (is_part ? ", or choose a larger area of the map" : ""));
  }
  if (found->outlines.empty())
    throw Error(ErrorCode::map_object_missing, name + " has no area", place, "name another object");
  return {name, io::clean_name(found->name), found->outlines};
}

std::vector<Footprint> drawn(const std::vector<TargetOutline>& outlines) {
  std::vector<Footprint> areas;
  for (const TargetOutline& one : outlines) areas.push_back({one.outer, one.holes});
  return areas;
}

std::vector<Vec3> on_plane(const Ring& ring, const Incline& plane) {
  std::vector<Vec3> vertices;
  for (const Vec2& p : ring) vertices.emplace_back(p.x(), p.y(), plane.at(p));
  return vertices;
}

/// A convex polygon as parts with no more corners than a target may have.
std::vector<Ring> halved(const Ring& piece) {
  constexpr std::ptrdiff_t kMostCorners = 64;
  const auto corners = static_cast<std::ptrdiff_t>(piece.size());
  if (corners <= kMostCorners) return {piece};
  Ring first(piece.begin(), piece.begin() + corners / 2 + 1), second(piece.begin() + corners / 2, piece.end());
  second.push_back(piece.front());
  std::vector<Ring> parts = halved(first);
  for (Ring& part : halved(second)) parts.push_back(std::move(part));
  return parts;
}

/// The plane of an outline's own corners. Throws where they are not in one.
Incline plane_of_corners(const TargetOutline& outline, const std::string& place) {
  constexpr double kPlanarM = 1e-3;  // as of vertices: src/target/target_frame.cpp
  std::vector<Vec2> corners = outline.outer;
  for (const Zone::Ring& hole : outline.holes) corners.insert(corners.end(), hole.begin(), hole.end());
  const bool is_level =
      std::adjacent_find(outline.z_m.begin(), outline.z_m.end(), std::not_equal_to<>()) == outline.z_m.end();
  Incline plane =
      is_level ? Incline{Vec2::Zero(), outline.z_m.front()} : nearest_plane(corners, outline.z_m);  // level to the bit
  const double steepness = std::hypot(1, plane.slope.norm());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double off = std::abs(outline.z_m[i] - plane.at(corners[i])) / steepness;
    if (off <= kPlanarM) continue;
    throw Error(ErrorCode::target_not_planar,
                "the outline's corners are not in one plane: corner " + std::to_string(i) + " is off by " +
                    shortest(std::round(off * 1000) / 1000) + " m",
                place, "give heights of one plane, or none: then it lies on the ground");
  }
  return plane;
}

/// Convex parts on the ground, or as far above it as is asked for.
void put_on_plane_of_ground(Mission& mission, const std::vector<Footprint>& areas, Outlines state,
                            double above_ground_m) {
  const TriangulatedTerrain& ground = ground_surface(mission);
  for (const ConvexArea& area : maps(mission).convex_areas(areas, state)) {
    Incline plane = ground_plane(ground, area.outer, mission);
    plane.level_m += above_ground_m;
    for (const Ring& piece : area.pieces) {
      for (const Ring& small : halved(piece)) mission.target.parts.push_back(on_plane(small, plane));
    }
  }
}

/// The outline as the one part of a target, if it can be that: convex, with no more corners than a target may have.
std::optional<std::vector<Vec3>> as_one_part(const TargetOutline& outline) {
  if (!outline.holes.empty()) return std::nullopt;
  Target target;
  target.parts.resize(1);
  for (std::size_t i = 0; i < outline.outer.size(); ++i) {
    target.parts[0].emplace_back(outline.outer[i].x(), outline.outer[i].y(), outline.z_m[i]);
  }
  try {
    make_target_frame(target);
  } catch (const Error&) {  // it may be a target in several parts
    return std::nullopt;
  }
  return std::move(target.parts[0]);
}

/// Convex parts at the heights of the corners: a convex outline as it is given, to the bit. Others lie in the plane
/// nearest to their corners, which is no farther from these than plane_of_corners allows.
void put_at_heights(Mission& mission, const std::vector<TargetOutline>& outlines) {
  for (const TargetOutline& outline : outlines) {
    const Incline plane = plane_of_corners(outline, mission.as_written.places.target);
    if (auto part = as_one_part(outline)) {
      mission.target.parts.push_back(std::move(*part));
      continue;
    }
    // What is cut in plan is rounded there to 0.12 mm: along a steeper plane that is more than a millimetre.
    constexpr double kSteepest = 8;
    if (plane.slope.norm() > kSteepest) {
      throw Error(
          ErrorCode::target_not_planar,
          "the target's outline is not convex and nearly upright, steeper than " + shortest(kSteepest) + " to 1",
          mission.as_written.places.target, std::string("for a wall, ") + kUprightAdvice);
    }
    for (const ConvexArea& area : maps(mission).convex_areas(drawn({outline}), Outlines::rough)) {
      for (const Ring& piece : area.pieces) {
        for (const Ring& small : halved(piece)) mission.target.parts.push_back(on_plane(small, plane));
      }
    }
  }
}

/// Of a target all must be seen: an outline of which nothing is left, as convex_areas leaves narrow pieces out, is not
/// left out of it unsaid.
void check_area_of_each(const Mission& mission, const std::vector<TargetOutline>& outlines) {
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    if (!maps(mission).convex_areas(drawn({outlines[i]}), Outlines::rough).empty()) continue;
    const std::string which = outlines.size() == 1 ? "" : " " + std::to_string(i);
    const bool has_heights = !outlines[i].z_m.empty();
    throw Error(ErrorCode::target_without_area, "the target's outline" + which + " has hardly any area",
                mission.as_written.places.target,
                std::string("draw it wider than 1 cm and larger than 0.01 m2; without a 'crs' coordinates are metres") +
                    (has_heights ? std::string("; if it stands upright, ") + kUprightAdvice : ""));
  }
}

/// A rectangle that is on the ground only with latitude and longitude the other way round.
void check_order(const Mission& mission, const GroundTarget& wanted, const TriangulatedTerrain& ground,
                 const geo::LocalFrame& map) {
  const auto [latitude, longitude] = *wanted.center_deg;
  const Vec2 centre = map.to_local({longitude, latitude});
  if (ground.height(centre) || std::abs(longitude) > 90 || !ground.height(map.to_local({latitude, longitude}))) return;
  throw Error(ErrorCode::target_off_ground,
              "the target's centre lies " + std::to_string(std::lround(centre.norm())) +
                  " m from the scene's origin, off its ground",
              mission.as_written.places.target,
              "latitude and longitude are the wrong way round: write center: [latitude, longitude]");
}

PlanBox plan_box(const std::vector<Footprint>& areas) {
  PlanBox box{areas.front().outer.front(), areas.front().outer.front()};
  for (const Footprint& area : areas) {
    for (const Vec2& corner : area.outer) {
      box.min = box.min.cwiseMin(corner);
      box.max = box.max.cwiseMax(corner);
    }
  }
  return box;
}

/// From inside a building its walls are all that is seen, and a volume all the same.
void check_outdoors(const Mission& mission) {
  constexpr double kClear = 1e-3;  // metres: the target may lie on the floor of a building
  const Scene& scene = mission.scene();
  for (std::size_t i = 0; i < mission.target.parts.size(); ++i) {
    const TargetFrame frame = make_target_frame(mission.target, i);
    const Vec3 at = frame.origin + kClear * frame.normal;
    const auto solid = object_round(*mission.loaded, at);
    if (!solid) continue;
    throw Error(ErrorCode::target_inside_solid,
                "the target lies inside " + in_quotes(display_name(scene.objects[*solid])),
                mission.as_written.places.target,
                how_to_leave_out(*mission.loaded, *solid, only_ground_target(mission.as_written)->osm)
                    .value_or("name a place outdoors; " + how_to_take_roof(*mission.loaded, *solid, at)),
                *solid);
  }
}

}  // namespace

SurfaceZ above_ground(const Mission& mission, double above_m) {
  return [&mission, above_m](const Vec2& at) -> std::optional<double> {
    if (!ground_object(mission.scene())) return std::nullopt;  // what needs it says so
    const auto height = ground_surface(mission).height(at);
    return height ? std::optional(*height + above_m) : std::nullopt;
  };
}

void place_corners(const geo::OnGlobe& globe, const SurfaceZ& ground, TargetOutline& outline) {
  std::size_t number = 0;
  const auto place = [&](Zone::Ring& ring) {
    for (Vec2& corner : ring) {
      const geo::LonLat at{corner.x(), corner.y()};
      if (number < outline.z_m.size()) {
        const Vec3 placed = globe.to_scene({at, outline.z_m[number]});
        corner = placed.head<2>();
        outline.z_m[number] = placed.z();
      } else {
        corner = globe.on_surface(at, ground);
      }
      ++number;
    }
  };
  place(outline.outer);
  for (Zone::Ring& hole : outline.holes) place(hole);
}

void put_on_ground(Mission& mission, const geo::OnGlobe* globe, const Progress& progress) {
  maps(mission);
  auto& wanted = std::get<GroundTarget>(mission.as_written.targets.front().source);
  if (wanted.center_deg) check_order(mission, wanted, ground_surface(mission), globe->map());
  const bool is_drawn = !wanted.outlines.empty();
  check_area_of_each(mission, wanted.outlines);
  mission.target.parts.clear();
  if (is_drawn && !wanted.outlines.front().z_m.empty()) {
    put_at_heights(mission, wanted.outlines);
  } else {
    std::vector<Footprint> areas;
    if (is_drawn) {
      areas = drawn(wanted.outlines);
    } else if (wanted.osm.empty()) {
      areas = {{rectangle(mission, wanted, *globe), {}}};
    } else {
      NamedArea area = area_of_map(mission, wanted.osm, globe->map(), progress);
      if (mission.target.name == wanted.osm && !area.name.empty()) {
        mission.target.name = area.name + " (" + area.id + ")";
      }
      wanted.osm = std::move(area.id);  // for this target alone: see georeference()
      areas = std::move(area.outlines);
    }
    if (auto note = make_room(mission, plan_box(areas))) mission.notes.push_back(std::move(*note));
    put_on_plane_of_ground(mission, areas, is_drawn ? Outlines::rough : Outlines::clean, wanted.above_ground_m);
  }
  if (mission.target.parts.empty()) {
    throw Error(ErrorCode::target_without_area, "the target's outline has hardly any area",
                mission.as_written.places.target, "draw it wider than 1 cm and larger than 0.01 m2");
  }
  check_outdoors(mission);
}

}  // namespace vantage::internal::app
