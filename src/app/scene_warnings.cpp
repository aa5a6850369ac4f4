#include "app/scene_warnings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "app/combine_targets.h"
#include "app/ground_target.h"
#include "app/pierced_advice.h"
#include "app/triangle_runs.h"
#include "common/input.h"
#include "common/ledger.h"
#include "core/places.h"
#include "core/triangle_distance.h"

namespace vantage::internal::app {
namespace {

using Corners = std::array<Vec3, 3>;

Corners corners_of(const Mesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// "350 m", "14.2 km".
std::string distance_text(double metres) {
  if (metres < 1000) return shortest(std::round(metres)) + " m";
  return shortest(std::round(metres / 100) / 10) + " km";
}

Box target_box(const Target& target) {
  Box box;
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    const Vec3 offset =
        target.offset_m == 0 ? Vec3::Zero() : Vec3(target.offset_m * make_target_frame(target, i).normal);
    for (const Vec3& vertex : target.parts[i]) box.extend(vertex + offset);
  }
  return box;
}

/// Distance of the nearest triangle, or less than `enough` if one is as near as that.
double nearest(const LoadedScene& loaded, const Vec3& point, double enough) {
  double least = std::numeric_limits<double>::infinity();
  const auto may_be_nearer = [&](const Box& box) {
    return (box.min - point).cwiseMax(point - box.max).cwiseMax(0).squaredNorm() < least;
  };
  triangle_runs(loaded).visit(may_be_nearer, [&](std::size_t i) {
    const auto [a, b, c] = corners_of(loaded.scene.mesh, i);
    least = std::min(least, core::squared_distance_to_triangle(point, a, b, c));
    return least > enough * enough;
  });
  return std::sqrt(least);
}

/// That no triangle of the scene is so near that it could matter.
std::optional<Warning> far_off(const Mission& mission, const Target& of) {
  const Scene& scene = mission.scene();
  const Box target = target_box(of);
  const Vec3 middle = (target.min + target.max) / 2;
  const double enough = range_limit_m(mission.sensor) + (target.max - target.min).norm() / 2;
  const double distance = nearest(*mission.loaded, middle, enough);
  if (distance <= enough) return std::nullopt;
  return Warning{
      WarningCode::range_beyond_scene,
      "nothing of the scene is within max_range of the target, so nothing hides it: the nearest triangle is " +
          distance_text(distance) + " away; check the target's coordinates" +
          (scene.georeference ? "" : ", scene.up and scene.scale, and whether scene and target have the same origin")};
}

/// Of triangles whose normals are within 11 degrees of an axis: what share of all area.
Vec3 facing_axes(const Mesh& mesh) {
  constexpr double kAlong = 0.98;
  Vec3 facing = Vec3::Zero();
  double all = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners corners = corners_of(mesh, i);
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double area = normal.norm();
    all += area;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(normal[axis]) > kAlong * area) facing[axis] += area;
    }
  }
  return all > 0 ? Vec3(facing / all) : facing;
}

/// What share of all corners lies within 2 % of the size from the lowest one, along each axis.
Vec3 lowest_level(const Mesh& mesh, const Box& box) {
  const Vec3 level = box.min + 0.02 * (box.max - box.min);
  Vec3 count = Vec3::Zero();
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle)
      count += (mesh.vertices[vertex].array() <= level.array()).cast<double>().matrix();
  }
  return count / (3.0 * static_cast<double>(std::max<std::size_t>(1, mesh.triangles.size())));
}

/// glTF is y up, whatever the mission says.
std::string turning_advice(const Scene& scene) {
  const std::string extension = scene.source.extension().string();
  if (extension == ".gltf" || extension == ".glb") return "export it again with the axes of glTF, y up";
  return scene.up == UpAxis::y ? "give scene.up: z" : "give scene.up: y (on a command line --up y)";
}

/// Whether some of the scene lies straight below a point, by more than `on`.
bool has_below(const LoadedScene& loaded, const Vec3& point, double on) {
  bool found = false;
  const auto is_in_plan = [&](const Box& box) {
    return (box.min - point).head<2>().maxCoeff() <= 0 && (point - box.max).head<2>().maxCoeff() <= 0;
  };
  triangle_runs(loaded).visit(is_in_plan, [&](std::size_t i) {
    const auto cross = [&](const Vec3& a, const Vec3& b) {
      return (a.x() - point.x()) * (b.y() - point.y()) - (a.y() - point.y()) * (b.x() - point.x());
    };
    const auto [a, b, c] = corners_of(loaded.scene.mesh, i);
    const double of_a = cross(b, c), of_b = cross(c, a), of_c = cross(a, b), sum = of_a + of_b + of_c;
    const bool is_inside = (of_a >= 0 && of_b >= 0 && of_c >= 0) || (of_a <= 0 && of_b <= 0 && of_c <= 0);
    if (!is_inside) return true;
    const double height =
        sum != 0 ? (of_a * a.z() + of_b * b.z() + of_c * c.z()) / sum : std::min({a.z(), b.z(), c.z()});
    found = height < point.z() - on;
    return !found;
  });
  return found;
}

/// That the target is looked at from below, where nothing is: not even ground.
std::optional<Warning> from_below(const Mission& mission) {
  constexpr double kDown = -0.5;  // of the normal: less than 60 degrees from straight down
  const TargetFrame frame = make_target_frame(mission.target);
  if (frame.all_sides || frame.normal.z() > kDown) return std::nullopt;
  const double on = std::min(2e-3, 0.01 * frame.enclosing_radius_m);  // the surface that it lies on is no nearer
  std::vector<Vec3> probes{frame.origin};
  for (const auto& corner : frame.polygon) probes.push_back(frame.to_scene({0.99 * corner.x(), 0.99 * corner.y(), 0}));
  const auto is_over = [&](const Vec3& probe) { return has_below(*mission.loaded, probe, on); };
  if (std::any_of(probes.begin(), probes.end(), is_over)) return std::nullopt;
  return Warning{
      WarningCode::target_from_below,
      "the target is looked at from below, and nothing of the scene lies below it: positions under the ground count "
      "as free; leave target.front out, or turn it round, to look from above"};
}

std::optional<Warning> below_all(const LoadedScene& loaded, const Volume* volume) {
  if (volume == nullptr || volume->mesh.empty()) return std::nullopt;
  // A target under the ground is told by the method itself.
  const auto is_told = [](const Warning& note) { return note.code == WarningCode::target_underground; };
  if (std::any_of(volume->notes.begin(), volume->notes.end(), is_told)) return std::nullopt;
  const Box box = bounding_box(volume->mesh), all = triangle_runs(loaded).bounds();
  constexpr double kTouch = 1e-3;  // of the volume's height
  if (box.max.z() > all.min.z() + kTouch * (box.max.z() - box.min.z())) return std::nullopt;
  return Warning{WarningCode::volume_below_scene,
                 "the whole volume lies below the scene, whose lowest point is at z = " +
                     std::to_string(std::lround(all.min.z())) +
                     " m: positions under the ground count as free; check the target's z, target.front and scene.up"};
}

/// Whether a place is wound round by a facet seen from above. Of facets that share a side, one holds a place on it.
bool holds(const std::array<Vec3, 3>& facet, const Vec3& at) {
  bool inside = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = facet[i], &b = facet[(i + 1) % 3];
    if ((a.y() > at.y()) == (b.y() > at.y())) continue;
    if (at.x() < a.x() + (b.x() - a.x()) * (at.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

/// The middle of a target's part and its corners, on the side that is looked at: who sees all of it sees these.
std::vector<Vec3> places_of(const TargetFrame& frame) {
  constexpr double kClear = 1e-3;   // metres: it may lie on the object
  constexpr double kWithin = 0.99;  // of the way to a corner: objects beside it may touch the target there
  const Vec3 clear = frame.all_sides ? Vec3(Vec3::Zero()) : Vec3(kClear * frame.normal);
  std::vector<Vec3> places = {frame.origin + clear};
  for (const auto& corner : frame.polygon) {
    places.push_back(frame.to_scene({kWithin * corner.x(), kWithin * corner.y(), 0}) + clear);
  }
  return places;
}

/// That some of the target lies inside a closed object: what is seen of it from inside is computed, and seldom meant.
std::optional<Warning> inside_object(const LoadedScene& loaded, const Target& target) {
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    const std::vector<Vec3> places = places_of(make_target_frame(target, i));
    std::optional<std::uint32_t> object;
    std::size_t inside = 0, first = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto found = object_round(loaded, places[k]);
      if (!found || (object && *object != *found)) continue;
      if (!object) first = k;
      object = found;
      ++inside;
    }
    if (!object) continue;
    return Warning{
        WarningCode::target_inside,
        (inside == places.size() ? "the target lies inside " : "some of the target lies inside ") +
            in_quotes(display_name(loaded.scene.objects[*object])) +
            ", so no position outside that object sees all of it; " +
            how_to_leave_out_stand_in(loaded, *object).value_or(how_to_take_roof(loaded, *object, places[first]))};
  }
  return std::nullopt;
}

/// What on_its_side says.
struct Turned {
  std::optional<Warning> warning;
};

/// The facets of one object on a vertical line through a point, each counted by the side that it shows: a roof is 1
/// above, a floor is 1 below. So inside of a closed object both are more than 0.
struct Crossed {
  int above = 0, below = 0;
  double floor_z = -std::numeric_limits<double>::infinity();   ///< of the highest facet below that faces down
  double ground_z = -std::numeric_limits<double>::infinity();  ///< of the highest one that faces up
};

bool is_in_plan(const Box& box, const Vec3& at) {
  return (box.min - at).head<2>().maxCoeff() <= 0 && (at - box.max).head<2>().maxCoeff() <= 0;
}

std::map<std::uint32_t, Crossed> objects_on_the_vertical(const LoadedScene& loaded, const Vec3& at) {
  const Scene& scene = loaded.scene;
  std::map<std::uint32_t, Crossed> objects;
  if (scene.object_of.empty()) return objects;  // a scene may have no objects
  const auto may_be_crossed = [&](const Box& box) { return is_in_plan(box, at); };
  triangle_runs(loaded).visit(may_be_crossed, [&](std::size_t i) {
    std::array<Vec3, 3> facet;
    for (std::size_t k = 0; k < 3; ++k) facet[k] = scene.mesh.vertices[scene.mesh.triangles[i][k]];
    if (!holds(facet, at)) return true;
    const Vec3 normal = (facet[1] - facet[0]).cross(facet[2] - facet[0]);
    if (normal.z() == 0) return true;
    const double z = at.z() - normal.dot(at - facet[0]) / normal.z();
    const int up = normal.z() > 0 ? 1 : -1;
    Crossed& crossed = objects[scene.object_of[i]];
    if (z > at.z()) {
      crossed.above += up;
    } else {
      crossed.below -= up;
      double& nearest = up > 0 ? crossed.ground_z : crossed.floor_z;
      nearest = std::max(nearest, z);
    }
    return true;
  });
  return objects;
}

bool is_round(const Crossed& crossed) {
  constexpr double kOnGround = 1e-3;  // metres: so far apart may a floor and the ground below it be
  const bool has_floor = crossed.below > 0 || crossed.floor_z > crossed.ground_z - kOnGround;
  return crossed.above > 0 && has_floor;
}

/// What holds a place without being there as built: a stand-in round it, or what fills a void of a raster over it.
/// Voids are filled up to the highest posts of their rim, and the ground beneath is another object of that kind.
const LedgerEntry* stand_in_round(const LoadedScene& loaded, const Vec3& at) {
  const Scene& scene = loaded.scene;
  const std::map<std::uint32_t, Crossed> objects = objects_on_the_vertical(loaded, at);
  const auto is_held_by = [&](const LedgerEntry& entry) {
    const auto own = entry.stand_in ? objects.find(*entry.stand_in) : objects.end();
    if (own == objects.end()) return false;
    const ObjectKind kind = scene.objects[own->first].kind;
    if (kind == ObjectKind::stand_in) return is_round(own->second);
    if (kind != ObjectKind::ground && kind != ObjectKind::surface) return false;
    if (!entry.box || !is_in_plan(*entry.box, at) || own->second.above <= 0) return false;
    return std::any_of(objects.begin(), objects.end(), [&](const auto& one) {
      return one.first != own->first && scene.objects[one.first].kind == kind;
    });
  };
  const auto found = std::find_if(scene.ledger.begin(), scene.ledger.end(), is_held_by);
  return found == scene.ledger.end() ? nullptr : &*found;
}

}  // namespace

std::optional<std::uint32_t> object_round(const LoadedScene& loaded, const Vec3& at) {
  for (const auto& [object, crossed] : objects_on_the_vertical(loaded, at)) {
    if (is_round(crossed)) return object;
  }
  return std::nullopt;
}

void refuse_in_stand_ins(const LoadedScene& loaded, const Target& target) {
  if (loaded.scene.ledger.empty()) return;
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    if (target.parts[i].empty()) continue;
    for (const Vec3& place : places_of(make_target_frame(target, i))) {
      const LedgerEntry* const entry = stand_in_round(loaded, place);
      if (entry == nullptr) continue;
      throw Error(
          ErrorCode::target_inside_solid, "the target lies in a stand-in", "",
          how_to_leave_out_stand_in(loaded, *entry->stand_in)
              .value_or(
                  "a void is filled there: " + ledger_text(*entry) +
                  "; raise the target above that, or fill voids from their neighbours with scene: {missing: warn}"),
          *entry->stand_in);
    }
  }
}

void refuse_in_stand_ins(const Mission& mission) {
  core::with_place(mission.as_written.places.target, [&] {
    for (const std::vector<Target>& view : views_of(mission)) {
      for (const Target& target : view) refuse_in_stand_ins(*mission.loaded, target);
    }
    return 0;
  });
}

namespace {

// Of cities the heights are the smallest of the three sizes, and either most of what there is faces up or down, or most
// corners stand on one level: those of houses alone, without ground, whose walls are more than their roofs. A single
// facade is like that too, on its side: but not so high, or not so deep.
std::optional<Warning> found_on_its_side(const LoadedScene& loaded) {
  constexpr double kShare = 0.45, kMore = 3.5;             // real cities: 0.5 to 0.77, and 4 to 30 times the other two
  constexpr double kTooHigh = 100, kHigh = 20, kDeep = 3;  // metres
  constexpr double kLevel = 0.3, kNoLevel = 0.1;  // of the corners. Boxes on flat ground: 0.5, and 2 / their number
  const Scene& scene = loaded.scene;
  if (loaded.city || loaded.raster || loaded.tileset || scene.georeference || scene.states_axes) return std::nullopt;
  const Box box = triangle_runs(loaded).bounds();
  const Vec3 size = box.max - box.min;
  if (size.z() < kHigh || 2 * size.y() > std::min(size.x(), size.z())) return std::nullopt;
  const std::string sizes = "the scene seems to lie on its side: it is " + distance_text(size.z()) + " high and " +
                            distance_text(size.y()) + " deep, and ";
  const Vec3 facing = facing_axes(scene.mesh);
  if (size.z() >= kTooHigh && facing.y() >= kShare && facing.y() >= kMore * std::max(facing.x(), facing.z())) {
    return Warning{WarningCode::scene_on_its_side, sizes + std::to_string(std::lround(100 * facing.y())) +
                                                       " % of its area is upright and faces along y; if so, " +
                                                       turning_advice(scene)};
  }
  const Vec3 level = lowest_level(scene.mesh, box);
  if (size.y() < kDeep || level.y() < kLevel || level.z() > kNoLevel) return std::nullopt;
  return Warning{WarningCode::scene_on_its_side, sizes + std::to_string(std::lround(100 * level.y())) +
                                                     " % of its corners have the lowest y, as if they stood there; if "
                                                     "so, " +
                                                     turning_advice(scene)};
}

}  // namespace

std::optional<Warning> on_its_side(const LoadedScene& loaded) {
  return looked_up<Turned>(loaded, [&] { return std::make_shared<Turned>(Turned{found_on_its_side(loaded)}); }).warning;
}

std::vector<Warning> scene_warnings(const Mission& mission, const Volume* volume) {
  const LoadedScene& loaded = *mission.loaded;
  std::vector<Warning> warnings;
  if (loaded.scene.mesh.empty()) return warnings;
  std::optional<Warning> away;
  bool has_corners = false;
  for (const std::vector<Target>& view : views_of(mission)) {
    for (const Target& target : view) {
      if (target.parts.at(0).empty()) continue;
      has_corners = true;
      if (!away) away = far_off(mission, target);
    }
  }
  if (!has_corners) return warnings;
  const std::optional<Warning> side = on_its_side(loaded);
  if (side) warnings.push_back(*side);
  // A target on the ground was looked at before; where the scene lies on its side, nothing else is worth saying.
  if (!side && !only_ground_target(mission.as_written) && !mission.target.parts.at(0).empty()) {
    if (auto inside = inside_object(loaded, mission.target)) warnings.push_back(std::move(*inside));
  }
  if (away) {
    warnings.push_back(*away);
  } else if (const auto below = mission.target.parts.at(0).empty() ? std::nullopt : from_below(mission)) {
    warnings.push_back(*below);
  } else if (const auto under = below_all(loaded, volume)) {
    warnings.push_back(*under);
  }
  return warnings;
}

}  // namespace vantage::internal::app
