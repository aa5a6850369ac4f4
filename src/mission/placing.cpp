#include "mission/placing.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "city/footprint.h"
#include "city/region.h"
#include "geo/local_frame.h"
#include "mission/numbers.h"
#include "mission/run_mission.h"
#include "osm/extract.h"
#include "terrain/surface.h"
#include "vantage/error.h"

namespace vantage::mission_io {
namespace {

using city::Vec2;

[[noreturn]] void fail(const std::string& problem, const std::string& where, const std::string& fix) {
  throw Error(ErrorKind::input, problem, where, fix);
}

geo::LocalFrame frame_of(const Mission& mission, const Scene& scene) {
  if (!scene.georeference) {
    fail("the scene does not say where on the earth it lies", mission.file.string(),
         "give the target and the limits in the scene frame, or a scene with a place: a map (scene.osm), CityJSON with "
         "a "
         "reference system, a raster, or a mesh with 'crs' or written by 'vantage scene'");
  }
  return geo::LocalFrame({scene.georeference->longitude_deg, scene.georeference->latitude_deg});
}

/// Positions of the mission's CRS in the frame; heights are z already.
class Placer {
 public:
  Placer(const Mission& mission, const geo::LocalFrame& frame)
      : frame_(frame), system_(mission.crs, mission.file.string()) {}

  Vec3 operator()(const Vec3& position) const {
    const Vec2 local = frame_.to_local(system_.to_lonlat(position.head<2>()));
    return {local.x(), local.y(), position.z()};
  }

  /// The corners of a box's lower side, in order round.
  std::array<Vec2, 4> corners(const Box& box) const {
    const Placer& at = *this;
    return {at(box.min).head<2>(), at({box.max.x(), box.min.y(), 0}).head<2>(), at(box.max).head<2>(),
            at({box.min.x(), box.max.y(), 0}).head<2>()};
  }

  /// A box lies askew in the frame by the angle between the norths, and its sides curve: what is kept in is cut down to
  /// the largest box of the frame within its sides, what is kept out grows to the smallest round it.
  Box inside(const Box& box) const {
    const auto c = corners(box);
    Box result;
    result.min = {std::max(c[0].x(), c[3].x()), std::max(c[0].y(), c[1].y()), box.min.z()};
    result.max = {std::min(c[1].x(), c[2].x()), std::min(c[2].y(), c[3].y()), box.max.z()};
    return result;
  }
  Box around(const Box& box) const {
    Box result;
    for (const Vec2& corner : corners(box)) {
      result.extend(Vec3(corner.x(), corner.y(), box.min.z()));
      result.extend(Vec3(corner.x(), corner.y(), box.max.z()));
    }
    return result;
  }

 private:
  const geo::LocalFrame& frame_;
  geo::CoordinateSystem system_;
};

/// Sides of a box that follow parallels curve by up to this over a kilometre and more; 1 cm covers boxes of 2 km below
/// 80 degrees of latitude.
void place_boxes(Navigation& navigation, const Placer& placer, const std::string& where) {
  for (Box& box : navigation.boxes) {
    box = placer.inside(box);
    if ((box.min.array() >= box.max.array()).any()) {
      fail("a box of navigation.boxes is too small or too askew to hold a box of the scene frame", where,
           "make it larger, or give it in the scene frame");
    }
  }
  for (Box& box : navigation.keep_out) box = placer.around(box);
}

// ---- targets on the ground ------------------------------------------------------------------------------------------

/// The triangles of the object "ground", which scenes from maps have, or "surface", which is all of a raster's.
terrain::Surface ground_of(const Mission& mission, const Scene& scene) {
  const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                  [](const std::string& name) { return name == "ground" || name == "surface"; });
  if (found == scene.objects.end()) {
    fail("the scene has no object 'ground' to put the target on", mission.target_place,
         "give the target's vertices, or a scene that is made from a map");
  }
  const auto ground = static_cast<std::uint32_t>(found - scene.objects.begin());
  Mesh mesh;
  std::vector<std::uint32_t> renamed(scene.mesh.vertices.size(), UINT32_MAX);
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
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
  return terrain::Surface(std::move(mesh));
}

/// z = slope . (x, y) + level.
struct Plane {
  Vec2 slope = Vec2::Zero();
  double level = 0;

  double at(const Vec2& p) const { return slope.dot(p) + level; }
};

/// The plane nearest to the ground at a ring's corners and the middles of its sides, raised until no ground under the
/// ring lies above it.
Plane ground_plane(const terrain::Surface& ground, const city::Ring& ring, const std::string& where) {
  std::vector<Vec2> samples;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    samples.push_back(ring[i]);
    samples.push_back((ring[i] + ring[(i + 1) % ring.size()]) / 2);
  }
  Vec2 middle = Vec2::Zero();
  for (const Vec2& sample : samples) middle += sample / double(samples.size());
  Eigen::MatrixXd rows(samples.size(), 3);
  Eigen::VectorXd heights(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto height = ground.height(samples[i]);
    if (!height) fail("the target reaches beyond the scene's ground", where, "choose a larger area of the map");
    rows.row(static_cast<Eigen::Index>(i)) << samples[i].x() - middle.x(), samples[i].y() - middle.y(), 1;
    heights[static_cast<Eigen::Index>(i)] = *height;
  }
  const Eigen::Vector3d fit = rows.colPivHouseholderQr().solve(heights);
  Plane plane{fit.head<2>(), fit.z() - fit.head<2>().dot(middle)};
  Mesh tilted = ground.mesh();
  for (Vec3& vertex : tilted.vertices) vertex.z() -= plane.at(vertex.head<2>());
  const auto range = terrain::Surface(std::move(tilted)).range(ring);
  if (!range) fail("the target reaches beyond the scene's ground", where, "choose a larger area of the map");
  plane.level += range->highest;
  return plane;
}

city::Ring rectangle(const GroundTarget& wanted, const geo::LocalFrame& frame) {
  const Vec2 centre = frame.to_local({(*wanted.center_deg)[1], (*wanted.center_deg)[0]});
  const double heading = wanted.heading_deg * M_PI / 180;
  const Vec2 along(std::sin(heading), std::cos(heading)), across(along.y(), -along.x());
  const Vec2 a = along * wanted.length_m / 2, b = across * wanted.width_m / 2;
  return {centre - a - b, centre - a + b, centre + a + b, centre + a - b};
}

bool is_closed(const osm::Line& line) {
  const geo::LonLat &first = line.points.front(), &last = line.points.back();
  return line.points.size() > 3 && first.longitude_deg == last.longitude_deg && first.latitude_deg == last.latitude_deg;
}

/// The rings of an object of the map: an area, or any closed way.
std::vector<osm::Ring> rings_of(const osm::Extract& extract, osm::ObjectId id) {
  std::vector<osm::Ring> rings;
  for (const osm::Area& area : extract.areas) {
    if (area.id != id) continue;
    for (const osm::Polygon& polygon : area.polygons) rings.push_back(polygon.outer);
  }
  for (const osm::Line& line : extract.lines) {
    if (line.id == id && is_closed(line)) rings.emplace_back(line.points.begin(), line.points.end() - 1);
  }
  return rings;
}

/// The outlines of an object of the map, without holes: what lies in a hole (a fountain) is to be seen as well.
std::vector<city::Ring> outlines(const Mission& mission, const std::string& name, const geo::LocalFrame& frame,
                                 const Progress& progress) {
  const auto id = osm::parse_object_id(name);
  if (!id) fail(in_quotes(name) + " is no object of a map", mission.target_place, "write 'osm: way/123'");
  osm::ReadOptions options;
  options.region = city::checked_region(mission.scene.city.region);
  std::vector<city::Footprint> rough;
  for (const osm::Ring& ring : rings_of(osm::read_extract(mission.scene.file, options, progress), *id)) {
    city::Footprint footprint;
    for (const geo::LonLat& position : ring) footprint.outer.push_back(frame.to_local(position));
    rough.push_back(std::move(footprint));
  }
  if (rough.empty()) {
    fail("the scene's part of the map has no area " + name, mission.target_place,
         "name a tagged closed way or a multipolygon of " + mission.scene.file.filename().string() +
             ", or choose a larger area of the map");
  }
  std::vector<city::Ring> rings;
  city::Repairs repairs;
  for (city::Footprint& footprint : city::clean(rough, repairs)) rings.push_back(std::move(footprint.outer));
  if (rings.empty()) fail(name + " has no area", mission.target_place, "name another object");
  return rings;
}

std::vector<Vec3> on_plane(const city::Ring& ring, const Plane& plane) {
  std::vector<Vec3> vertices;
  for (const Vec2& p : ring) vertices.emplace_back(p.x(), p.y(), plane.at(p));
  return vertices;
}

/// A convex polygon as parts with no more corners than a target may have.
std::vector<city::Ring> halved(const city::Ring& piece) {
  constexpr std::ptrdiff_t kMostCorners = 64;
  const auto corners = static_cast<std::ptrdiff_t>(piece.size());
  if (corners <= kMostCorners) return {piece};
  city::Ring first(piece.begin(), piece.begin() + corners / 2 + 1), second(piece.begin() + corners / 2, piece.end());
  second.push_back(piece.front());
  std::vector<city::Ring> parts = halved(first);
  for (city::Ring& part : halved(second)) parts.push_back(std::move(part));
  return parts;
}

void put_on_ground(Mission& mission, const Scene& scene, const geo::LocalFrame& frame, const Progress& progress) {
  const GroundTarget wanted = *mission.ground_target;
  const terrain::Surface ground = ground_of(mission, scene);
  const std::vector<city::Ring> rings = wanted.osm.empty() ? std::vector<city::Ring>{rectangle(wanted, frame)}
                                                           : outlines(mission, wanted.osm, frame, progress);
  std::vector<Target> parts;
  for (const city::Ring& ring : rings) {
    const Plane plane = ground_plane(ground, ring, mission.target_place);
    for (const city::Ring& piece : city::convex_pieces({ring, {}})) {
      for (const city::Ring& small : halved(piece)) {
        Target part = mission.target;
        part.vertices = on_plane(small, plane);
        parts.push_back(std::move(part));
      }
    }
  }
  if (parts.size() > 1) {
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].name.append(" ").append(std::to_string(i + 1));
  }
  mission.target = parts.front();
  mission.other_parts.assign(parts.begin() + 1, parts.end());
}

}  // namespace

void place_mission(Mission& mission, const Scene& scene, const Progress& progress) {
  if (mission.crs.empty() && !mission.ground_target) return;
  const geo::LocalFrame frame = frame_of(mission, scene);
  if (!mission.crs.empty()) {
    const Placer placer(mission, frame);
    with_place(mission.target_place, [&] {
      for (Vec3& vertex : mission.target.vertices) vertex = placer(vertex);
      return 0;
    });
    place_boxes(mission.navigation, placer, mission.file.string());
    mission.crs.clear();
  }
  if (mission.ground_target) put_on_ground(mission, scene, frame, progress);
  mission.ground_target.reset();
  with_place(mission.target_place, [&] {
    make_target_frame(mission.target);
    for (const Target& part : mission.other_parts) make_target_frame(part);
    return 0;
  });
}

}  // namespace vantage::mission_io
