#include "app/georeferencing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "app/combine_targets.h"
#include "app/face_targets.h"
#include "app/ground_target.h"
#include "app/target_files.h"
#include "app/zone_places.h"
#include "common/input.h"
#include "core/format.h"
#include "core/places.h"
#include "core/progress_reporter.h"
#include "geo/local_frame.h"
#include "geo/on_globe.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage::internal::app {
namespace {

using Vec2 = Eigen::Vector2d;

geo::OnGlobe globe_of(const Mission& mission) {
  const Scene& scene = mission.scene();
  if (!scene.georeference) {
    throw Error(
        ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies",
        mission.as_written.file.string(),
        "give the target and the limits in the scene frame, or a scene with a place: a map (scene.osm), CityJSON with "
        "a reference system, a raster, or a mesh with 'crs' or written by 'vantage scene'");
  }
  return geo::OnGlobe(*scene.georeference);
}

/// Positions of the mission's CRS in the frame; heights are above the zero of the scene's, in the unit of the CRS where
/// it has one.
class CrsConverter {
 public:
  CrsConverter(const Mission& mission, const geo::OnGlobe& globe)
      : globe_(globe), system_(mission.as_written.crs, mission.as_written.file.string()) {}

  Vec3 operator()(const Vec3& position) const {
    return globe_.to_scene({system_.to_lonlat(position.head<2>()), metres(position.z())});
  }
  /// Of an outline, where it has no heights on the ground.
  void place(TargetOutline& outline, const SurfaceZ& ground) const {
    const auto to_degrees = [this](Zone::Ring& ring) {
      for (Vec2& corner : ring) {
        const geo::LonLat at = system_.to_lonlat(corner);
        corner = {at.longitude_deg, at.latitude_deg};
      }
    };
    to_degrees(outline.outer);
    for (Zone::Ring& hole : outline.holes) to_degrees(hole);
    for (double& z : outline.z_m) z = metres(z);
    place_corners(globe_, ground, outline);
  }
  /// From the origin, along the ellipsoid.
  double distance_m(const Vec2& position) const { return globe_.map().to_local(system_.to_lonlat(position)).norm(); }

  /// For coordinates that lead far away.
  const char* order_advice() const {
    return system_.is_geographic() ? "write the longitude before the latitude: [longitude, latitude, z]"
                                   : "check the coordinates, east before north, and the 'crs' that they are in";
  }
  /// What is said of such coordinates besides: whether all of them would lie near with both the other way round.
  const char* order_remark(std::span<const Vec2> given) const {
    const auto is_near = [this](const Vec2& p) { return distance_m({p.y(), p.x()}) <= geo::kFarthestM; };
    try {
      if (!std::all_of(given.begin(), given.end(), is_near)) return "";
    } catch (const Error&) {
      return "";  // no place of the system
    }
    return system_.is_geographic() ? "; longitude and latitude seem to be swapped"
                                   : "; east and north seem to be swapped";
  }

  /// A box lies askew in the frame by the angle between the norths, and its sides curve (a parallel of 2 km by a
  /// decimetre): what is kept in is cut down to the largest box of the frame within its sides, what is kept out grows
  /// to the smallest round it. Its sides may lean, as those of zones: see ZoneWalls.
  Box inside(const Box& box, const ZoneWalls& walls) const {
    const Heights heights = heights_of(box.min.z(), box.max.z());
    const auto [south, east, north, west] = sides(box, walls.middle_z_m(heights));
    const Extent extent = extent_of({south, east, north, west});
    const double lean = walls.lean_m(heights, extent.farthest_m);
    const Heights z = walls.z_of(heights, extent, ZoneUse::keep_in);
    Box result;
    result.min = {west.max.x() + lean, south.max.y() + lean, z.low_m};
    result.max = {east.min.x() - lean, north.min.y() - lean, z.high_m};
    return result;
  }
  Box around(const Box& box, const ZoneWalls& walls) const {
    const Heights heights = heights_of(box.min.z(), box.max.z());
    const std::array<Box, 4> all = sides(box, walls.middle_z_m(heights));
    const Extent extent = extent_of(all);
    const double lean = walls.lean_m(heights, extent.farthest_m);
    const Heights z = walls.z_of(heights, extent, ZoneUse::keep_out);
    Box result;
    for (const Box& side : all) result.extend(side);
    result.min = {result.min.x() - lean, result.min.y() - lean, z.low_m};
    result.max = {result.max.x() + lean, result.max.y() + lean, z.high_m};
    return result;
  }
  /// A zone's sides lie askew, too, and curve: see placed_zone.
  Zone placed(const Zone& zone, ZoneUse use, const ZoneWalls& walls) const {
    const Heights heights = heights_of(zone.min_z_m, zone.max_z_m);
    const double middle = walls.middle_z_m(heights);
    const auto position = [&](const Vec2& p) { return to_frame(p, middle); };
    const Extent extent = app::extent_of(zone.outer, position);
    Zone result = placed_near(zone, use, position, walls.lean_m(heights, extent.farthest_m));
    const Heights z = walls.z_of(heights, extent, use);
    result.min_z_m = z.low_m;
    result.max_z_m = z.high_m;
    return result;
  }

 private:
  /// What a side of a box takes up in the frame; z is not used.
  Box side(const Vec2& from, const Vec2& to, double z_m) const {
    constexpr int kSteps = 32;
    std::vector<Vec2> points;
    for (int i = 0; i <= kSteps; ++i) points.push_back(to_frame(from + (to - from) * i / kSteps, z_m));
    // Between three of its points a curve leaves the chord by about an eighth of their second difference.
    double bulge = 0;
    for (int i = 1; i < kSteps; ++i) {
      const auto at = static_cast<std::size_t>(i);
      bulge = std::max(bulge, (points[at - 1] - 2 * points[at] + points[at + 1]).norm() / 4);
    }
    Box result;
    for (const Vec2& p : points) {
      result.extend(Vec3(p.x() - bulge, p.y() - bulge, 0));
      result.extend(Vec3(p.x() + bulge, p.y() + bulge, 0));
    }
    return result;
  }
  /// South, east, north, west.
  std::array<Box, 4> sides(const Box& box, double z_m) const {
    const Vec2 a = box.min.head<2>(), c = box.max.head<2>(), b(c.x(), a.y()), d(a.x(), c.y());
    return {side(a, b, z_m), side(b, c, z_m), side(c, d, z_m), side(d, a, z_m)};
  }
  static Extent extent_of(const std::array<Box, 4>& sides) {
    Box all;
    for (const Box& one : sides) all.extend(one);
    return app::extent_of(all);
  }

  Zone placed_near(const Zone& zone, ZoneUse use, const ToFrame& position, double lean_m) const {
    try {
      return placed_zone(zone, use, position, order_advice(), lean_m);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::too_far_away) throw;
      throw Error(error.code(), error.problem() + order_remark(zone.outer), error.where(), error.fix());
    }
  }

  Vec2 to_frame(const Vec2& position, double z_m) const { return globe_.at_z(system_.to_lonlat(position), z_m); }
  double metres(double height) const { return height * system_.vertical_unit_m().value_or(1); }
  Heights heights_of(double from, double to) const {
    const auto [low, high] = std::minmax({metres(from), metres(to)});
    return {low, high};
  }

  const geo::OnGlobe& globe_;
  geo::CoordinateSystem system_;
};

/// A box of which nothing is near the scene is most likely a slip, and would keep nothing out.
void check_near(const Box& box, const Box& given, const std::string& name, const CrsConverter& converter,
                const std::string& where) {
  const Vec2 nearest = Vec2::Zero().cwiseMax(box.min.head<2>()).cwiseMin(box.max.head<2>());
  if (nearest.norm() <= geo::kFarthestM) return;
  throw Error(ErrorCode::too_far_away,
              name + " lies " + std::to_string(std::lround(nearest.norm() / 1000)) + " km from the scene's origin" +
                  converter.order_remark(std::array{Vec2(given.min.head<2>()), Vec2(given.max.head<2>())}),
              where, converter.order_advice());
}

/// One to stay in is the largest inside, one to stay out of the smallest around.
Box placed_box(const Box& given, ZoneUse use, const std::string& name, const CrsConverter& converter,
               const ZoneWalls& walls) {
  Box around = converter.around(given, walls);
  check_near(around, given, name, converter, "");
  if (use == ZoneUse::keep_out) return around;
  Box inside = converter.inside(given, walls);
  if ((inside.min.array() < inside.max.array()).all()) return inside;
  throw Error(ErrorCode::limits_empty, name + " is too small or too askew to hold a box of the scene frame", "",
              "make it larger, or give it in the scene frame");
}

void convert_zones(std::vector<Zone>& zones, ZoneUse use, const CrsConverter& converter, const ZoneWalls& walls,
                   const std::vector<std::string>& places) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const std::string name = std::string(use == ZoneUse::keep_in ? "keep_in " : "keep_out ") + zone_name(zones, i);
    core::with_place(i < places.size() ? places[i] : "", [&] {
      try {
        Zone placed = zones[i].is_box ? Zone(placed_box(zones[i].box(), use, name, converter, walls))
                                      : converter.placed(zones[i], use, walls);
        placed.name = zones[i].name;
        zones[i] = std::move(placed);
      } catch (const Error& error) {
        throw error.with_where(error.where().empty() ? name : name + ", " + error.where());
      }
      return 0;
    });
  }
}

// All members are named: a limit that is added does not compile here before it is converted. An
// altitude is one of the scene frame, the ground is the scene's, and meshes say themselves where they lie.
void convert_limits(Navigation& navigation, const CrsConverter& converter, const ZoneWalls& walls,
                    const MissionFile& file) {
  auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = navigation;
  convert_zones(keep_in, ZoneUse::keep_in, converter, walls, file.places.keep_in_zones);
  convert_zones(keep_out, ZoneUse::keep_out, converter, walls, file.places.keep_out_zones);
}

/// A limit that is hardly a centimetre across keeps nothing out: its corners are most likely meant in degrees.
void check_not_in_degrees(const Eigen::AlignedBox2d& limit, const std::string& name, const std::string& place) {
  constexpr double kTinyM = 0.01, kLargestDegree = 180;
  const double across = limit.diagonal().norm();
  if (across >= kTinyM ||
      std::max(limit.min().cwiseAbs().maxCoeff(), limit.max().cwiseAbs().maxCoeff()) > kLargestDegree)
    return;
  throw Error(ErrorCode::value_out_of_range, core::format("{} is {:.2g} mm across", name, across * 1000), place,
              "if its corners are longitudes and latitudes, say so with 'crs: EPSG:4326'");
}

void check_limits_not_in_degrees(const Navigation& navigation, const MissionFile& file) {
  const auto check = [&](const std::vector<Zone>& zones, const std::vector<std::string>& places,
                         const std::string& list) {
    for (std::size_t i = 0; i < zones.size(); ++i) {
      Eigen::AlignedBox2d limit;
      for (const Vec2& corner : zones[i].outer) limit.extend(corner);
      check_not_in_degrees(limit, list + " " + zone_name(zones, i), i < places.size() ? places[i] : file.file.string());
    }
  };
  check(navigation.keep_in, file.places.keep_in_zones, "keep_in");
  check(navigation.keep_out, file.places.keep_out_zones, "keep_out");
}

void place_sun(Mission& mission) {
  const SunTime& time = *mission.as_written.sun_time;
  const std::string& place = mission.as_written.places.sensor;
  const auto& georeference = mission.scene().georeference;
  if (!georeference) {
    throw Error(ErrorCode::not_georeferenced,
                "the scene does not say where on the earth it lies, so the sun has no place", place,
                "give sun.azimuth and sun.elevation instead of the time, or scene.origin");
  }
  const Vec3 direction = sun_direction(georeference->latitude_deg, georeference->longitude_deg, time.unix_time_s);
  if (direction.z() < 0) {
    const double elevation = std::asin(direction.z()) * 180 / std::numbers::pi;
    throw Error(ErrorCode::value_out_of_range,
                "the sun is below the horizon at " + time.text + ", by " +
                    shortest(std::round(-elevation * 100) / 100) + " degrees",
                place, "check the time and its zone, or leave the limit out");
  }
  mission.sensor.sun->direction = direction;
}

/// Positions of the mission's target must lie near.
class GivenPositions {
 public:
  explicit GivenPositions(const CrsConverter& converter) : converter_(converter) {}

  void add(const Vec2& position) { given_.push_back(position); }

  void check_near(const std::string& where) const {
    for (const Vec2& position : given_) {
      const double distance = converter_.distance_m(position);
      if (distance <= geo::kFarthestM) continue;
      throw Error(ErrorCode::too_far_away,
                  "the target lies " + std::to_string(std::lround(distance / 1000)) + " km from the scene's origin" +
                      converter_.order_remark(given_),
                  where, converter_.order_advice());
    }
  }

 private:
  const CrsConverter& converter_;
  std::vector<Vec2> given_;
};

/// The positions that the mission gives in its own coordinate reference system.
void convert_positions(const Mission& mission, const CrsConverter& converter, MissionTarget& given) {
  GivenPositions vertices(converter), nearest(converter), corners(converter);
  auto* const ground = std::get_if<GroundTarget>(&given.source);
  auto* const faces = std::get_if<FaceTarget>(&given.source);
  const bool has_nearest = faces && faces->nearest;
  for (const std::vector<Vec3>& part : given.target.parts) {
    for (const Vec3& vertex : part) vertices.add(vertex.head<2>());
  }
  if (has_nearest) nearest.add(faces->nearest->head<2>());
  for (const TargetOutline& outline : ground ? ground->outlines : std::vector<TargetOutline>{}) {
    for (const Vec2& corner : outline.outer) corners.add(corner);
    for (const Zone::Ring& hole : outline.holes) {
      for (const Vec2& corner : hole) corners.add(corner);
    }
  }
  core::with_place(given.place, [&] {
    for (const GivenPositions* positions : {&vertices, &nearest, &corners}) positions->check_near("");
    for (std::vector<Vec3>& part : given.target.parts) {
      for (Vec3& vertex : part) vertex = converter(vertex);
    }
    if (has_nearest) faces->nearest = converter(*faces->nearest);
    if (!ground) return 0;
    const SurfaceZ surface = above_ground(mission, ground->above_ground_m);
    for (TargetOutline& outline : ground->outlines) converter.place(outline, surface);
    return 0;
  });
}

/// As the mission of that target alone, for functions of one target.
class OneTarget {
 public:
  OneTarget(Mission& mission, const MissionTarget& given)
      : mission_(mission), all_(std::exchange(mission.as_written.targets, {given})) {
    mission_.target = given.target;
    mission_.as_written.places.target = given.place;
  }
  ~OneTarget() {
    mission_.as_written.targets = std::move(all_);
    mission_.as_written.places.target = place_;
  }
  OneTarget(const OneTarget&) = delete;
  OneTarget& operator=(const OneTarget&) = delete;

 private:
  Mission& mission_;
  std::vector<MissionTarget> all_;
  std::string place_ = mission_.as_written.places.target;
};

/// The targets in the scene frame, those of the same list of MissionTargets in the same list.
std::vector<std::vector<Target>> placed(Mission& mission, const std::vector<MissionTarget>& given,
                                        const geo::OnGlobe* globe, const Progress& progress) {
  std::vector<std::vector<Target>> targets(given.size());
  // The ground may be extended: after that the scene stays as it is.
  for (std::size_t i = 0; i < given.size(); ++i) {
    targets[i] = {given[i].target};
    if (!std::holds_alternative<GroundTarget>(given[i].source)) continue;
    const OneTarget one(mission, given[i]);
    put_on_ground(mission, globe, progress);
    targets[i] = {mission.target};
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto* const wanted = std::get_if<FaceTarget>(&given[i].source);
    if (!wanted) continue;
    const OneTarget one(mission, given[i]);
    const bool together = mission.as_written.combine == Combine::all && !given[i].both_sides;
    core::ProgressReporter(progress).begin("finding faces");
    FaceTargets faces = face_targets(mission, *wanted, given[i].target, globe, together);
    targets[i] = std::move(faces.targets);
    if (faces.note) mission.notes.push_back(std::move(*faces.note));
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    core::with_place(given[i].place, [&] {
      for (const Target& target : targets[i]) {
        if (target.is_volume()) continue;
        for (std::size_t part = 0; part < target.parts.size(); ++part) make_target_frame(target, part);
      }
      return 0;
    });
  }
  return targets;
}

}  // namespace

void georeference(Mission& mission, const Progress& progress) {
  const MissionFile& file = mission.as_written;
  if (file.sun_time) place_sun(mission);
  std::vector<MissionTarget> given = file.targets;
  const bool needs_frame =
      !file.crs.empty() || std::any_of(given.begin(), given.end(), [](const MissionTarget& target) {
        const auto* const ground = std::get_if<GroundTarget>(&target.source);
        const auto* const from = std::get_if<TargetFile>(&target.source);
        const auto* const faces = std::get_if<FaceTarget>(&target.source);
        return (ground && ground->outlines.empty()) || (from && !from->is_volume) || (faces && faces->at_deg);
      });
  std::optional<geo::OnGlobe> globe;
  if (needs_frame) globe = globe_of(mission);
  std::optional<CrsConverter> converter;
  if (!file.crs.empty()) {
    converter.emplace(mission, *globe);
    for (MissionTarget& target : given) convert_positions(mission, *converter, target);
  } else if (mission.scene().georeference) {
    check_limits_not_in_degrees(mission.navigation, file);
  }
  const core::ProgressReporter reporter(progress);
  for (MissionTarget& target : given) {
    const auto* const from = std::get_if<TargetFile>(&target.source);
    if (!from) continue;
    core::with_place(target.place, [&] {
      if (from->is_volume) {
        read_target_volume(mission, progress, target);
      } else {
        read_target_file(mission, *globe, reporter, target);
      }
      return 0;
    });
  }
  std::vector<std::vector<Target>> targets = placed(mission, given, globe ? &*globe : nullptr, progress);
  if (file.vlos) {
    for (std::vector<Target>& pilot : targets) pilot[0].parts[0][0].z() += file.vlos->eye_height_m;
  }
  combine_targets(given, std::move(targets), mission);
}

void georeference_limits(Mission& mission) {
  if (mission.as_written.crs.empty()) return;
  const geo::OnGlobe globe = globe_of(mission);
  convert_limits(mission.navigation, CrsConverter(mission, globe), ZoneWalls(globe, mission), mission.as_written);
}

}  // namespace vantage::internal::app
