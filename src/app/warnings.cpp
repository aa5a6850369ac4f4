#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "app/combine_targets.h"
#include "app/ledger.h"
#include "app/scene_warnings.h"
#include "app/triangle_runs.h"
#include "common/known_data.h"
#include "core/format.h"
#include "core/progress_reporter.h"
#include "geo/local_frame.h"
#include "geo/longitudes.h"
#include "target/fresnel_zone.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

using internal::app::Reach;
using Vec2 = Eigen::Vector2d;

std::string metres(double length) { return std::to_string(std::lround(std::ceil(length))) + " m"; }

std::vector<Vec3> corners(const Target& target) {
  std::vector<Vec3> points;
  for (const std::vector<Vec3>& part : target.parts) points.insert(points.end(), part.begin(), part.end());
  return points;
}

/// Where boxes and meshes let the vehicle fly, in plan.
Box flying_area(const Navigation& navigation) {
  const double everywhere = std::numeric_limits<double>::infinity();
  Box area{Vec3::Constant(-everywhere), Vec3::Constant(everywhere)};
  const auto cut = [&](const Box& box) {
    area.min = area.min.cwiseMax(box.min);
    area.max = area.max.cwiseMin(box.max);
  };
  Box boxes;
  for (const Zone& zone : navigation.keep_in) {
    for (const Vec2& corner : zone.outer) boxes.extend(Vec3(corner.x(), corner.y(), 0));
  }
  if (!navigation.keep_in.empty()) cut(boxes);
  for (const KeepInMesh& mesh : navigation.meshes) cut(bounding_box(mesh.mesh));
  return area;
}

std::vector<Vec3> corners_of_all(const Mission& mission) {
  std::vector<Vec3> all;
  for (const std::vector<Target>& view : internal::app::views_of(mission)) {
    for (const Target& target : view) {
      const auto own = corners(target);
      all.insert(all.end(), own.begin(), own.end());
    }
  }
  return all;
}

/// Points in plan round all that can lie between the target and where it is looked at from.
std::vector<Vec2> reach(const Mission& mission) {
  constexpr int kDirections = 64;
  const Box area = flying_area(mission.navigation);
  std::vector<Vec2> points;
  for (const Vec3& corner : corners_of_all(mission)) {
    points.emplace_back(corner.head<2>());
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * std::numbers::pi * i / kDirections;
      const Vec2 far = corner.head<2>() + range_limit_m(mission.sensor) * Vec2(std::cos(angle), std::sin(angle));
      points.push_back(far.cwiseMax(area.min.head<2>()).cwiseMin(area.max.head<2>()));
    }
  }
  return points;
}

double beyond(const std::vector<Vec2>& points, const Vec2& centre, double radius) {
  double most = 0;
  for (const Vec2& p : points) most = std::max(most, (p - centre).norm() - radius);
  return most;
}

/// How far the points reach out of a rectangle of the earth (west, south, east, north), metres.
double beyond(const std::vector<Vec2>& points, const std::array<double, 4>& degrees,
              const internal::geo::LocalFrame& frame) {
  const auto [west, south, east, north] = degrees;
  if (internal::geo::LongitudeRange{west, east}.width_deg() > 180) {  // round a pole
    const bool is_south = south + north < 0;
    const internal::geo::LonLat pole{0, is_south ? -90.0 : 90.0};
    return beyond(points, frame.to_local(pole), internal::geo::geodesic_m(pole, {0, is_south ? north : south}));
  }
  const Vec2 sw = frame.to_local({west, south}), se = frame.to_local({east, south});
  const Vec2 ne = frame.to_local({east, north}), nw = frame.to_local({west, north});
  const Vec2 min(std::max(sw.x(), nw.x()), std::max(sw.y(), se.y()));
  const Vec2 max(std::min(se.x(), ne.x()), std::min(ne.y(), nw.y()));
  double most = 0;
  for (const Vec2& p : points) most = std::max({most, (min - p).maxCoeff(), (p - max).maxCoeff()});
  return most;
}

/// How far the range reaches beyond what is known, and what would mend it.
struct Shortfall {
  double metres = 0;
  std::string known;  ///< "the part of the map that is used"
  std::string fix;
};

Shortfall of_map(const Mission& mission, const std::vector<Vec2>& points) {
  const LoadedScene& loaded = *mission.loaded;
  const CityRegion& region = mission.as_written.scene.city.region;
  const Georeference& place = *loaded.scene.georeference;
  const internal::geo::LocalFrame frame({place.longitude_deg, place.latitude_deg});
  const std::string part = "the part of the map that is used";
  if (region.center_deg) {
    const Vec2 centre = frame.to_local({(*region.center_deg)[1], (*region.center_deg)[0]});
    const double missing = beyond(points, centre, region.radius_m);
    if (missing > 0) return {missing, part, "give scene.radius " + metres(region.radius_m + missing) + " or more"};
  }
  if (region.bbox_deg) {
    const double missing = beyond(points, *region.bbox_deg, frame);
    if (missing > 0) return {missing, part, "give a larger scene.bbox"};
  }
  return {beyond(points, loaded.city->bounds_deg, frame), "the map", "take an extract that reaches farther"};
}

/// Of a raster, or of a map's scene that was written to a file: it ends where its surface does.
Shortfall of_surface(const LoadedScene& loaded, const std::vector<Vec2>& points) {
  const Box box = internal::app::triangle_runs(loaded).bounds();
  double most = 0;
  for (const Vec2& p : points) {
    most = std::max({most, (box.min.head<2>() - p).maxCoeff(), (p - box.max.head<2>()).maxCoeff()});
  }
  if (loaded.raster) return {most, "the raster", "take more of it, or one that reaches farther"};
  return {most, "the scene's ground", "make the scene of a larger area"};
}

/// Nothing is known of other meshes: they may be all that there is.
Shortfall of(const Mission& mission, const std::vector<Vec2>& points) {
  const LoadedScene& loaded = *mission.loaded;
  const Scene& scene = loaded.scene;
  if (!scene.georeference) return {};
  const bool has_ground = std::any_of(scene.objects.begin(), scene.objects.end(),
                                      [](const SceneObject& object) { return object.kind == ObjectKind::ground; });
  if (loaded.city) return of_map(mission, points);
  if (loaded.tileset && mission.as_written.scene.tileset.radius_m) {
    const double radius = *mission.as_written.scene.tileset.radius_m;
    const double missing = beyond(points, Vec2::Zero(), radius);
    return {missing, "the part of the tileset that is used",
            "give scene.radius " + metres(radius + missing) + " or more"};
  }
  return loaded.raster || has_ground ? of_surface(loaded, points) : Shortfall{};
}

/// Round each leg of a flight, and its end.
std::vector<Box> leg_boxes(const std::vector<Vec3>& positions) {
  std::vector<Box> legs;
  for (const Vec3& position : positions) {
    if (!legs.empty()) legs.back().extend(position);
    legs.push_back({position, position});
  }
  return legs;
}

/// How far from a flight what stands counts: it may hide, or it must be kept away from. Targets that are volumes may
/// have no range; what else they ask for still counts.
double kept_m(const Mission& mission, double clearance_m) {
  const double range = range_limit_m(mission.sensor);
  if (std::isfinite(range)) clearance_m = std::max(clearance_m, range);
  const auto& clearance = mission.navigation.clearance;
  return clearance ? std::max(clearance_m, clearance->distance_m) : clearance_m;
}

/// The boxes round a link's point and each leg hold all of its lines; the zone of a radio link is an ellipsoid round
/// them.
Reach reach_of(const FlightLink& link, std::vector<Box> legs, double tube_radius_m) {
  double farthest = 0;
  for (Box& leg : legs) {
    leg.extend(link.point);
    farthest = std::max(farthest, (leg.max - leg.min).norm());
  }
  if (!link.radio) return {std::move(legs), tube_radius_m};
  const double excess = internal::target::zone_excess_m(*link.radio) + 2 * tube_radius_m;  // as LegViews judges a tube
  return {std::move(legs), std::sqrt(excess * (2 * farthest + excess)) / 2};
}

constexpr double kTolerance = 1;  // metre: rounding of degrees, and corners of extracts

/// Little more than nothing where the range allows very much: a target that can hardly be seen whole.
std::optional<Warning> small_volume(const Mission& mission, const Volume& volume) {
  constexpr double kSmall = 1, kOfBall = 1e-3;  // cubic metres; of a ball as large as the range
  if (volume.outcome != Outcome::computed) return std::nullopt;
  const double found = enclosed_volume(volume.mesh), range = range_limit_m(mission.sensor);
  if (!(found < kSmall) || !(found < kOfBall * 4.0 / 3.0 * std::numbers::pi * range * range * range)) {
    return std::nullopt;
  }
  return Warning{WarningCode::volume_small,
                 internal::core::format("the volume has only {:.2g} cubic metres: from nearly nowhere is all of the "
                                        "target seen within the limits; choose less of it, or relax a limit",
                                        found)};
}

/// That metres were hardly meant: cameras see centimetres from hundreds of metres.
std::optional<Warning> large_pixel(const Sensor& sensor) {
  constexpr double kLarge = 0.3, kFar = 1000;  // metres
  const double range = range_limit_m(sensor);
  if (!sensor.pixel || sensor.pixel->size_m < kLarge || range < kFar) return std::nullopt;
  return Warning{
      WarningCode::pixel_in_metres,
      internal::core::format("sensor.pixel.size is {:.4g} m, so the range is {:.1f} km: if {:.4g} cm are meant, "
                             "write {:.4g}",
                             sensor.pixel->size_m, range / 1000, sensor.pixel->size_m, sensor.pixel->size_m / 100)};
}

}  // namespace

std::optional<Warning> incomplete_warning(const Mission& mission, const Volume* volume) {
  std::vector<Box> targets;
  for (const Vec3& corner : corners_of_all(mission)) targets.push_back({corner, corner});
  if (targets.empty()) return std::nullopt;  // volumes to fly through, which may have no range
  Box lines = volume != nullptr ? bounding_box(volume->mesh) : Box{};
  for (const Box& corner : targets) lines.extend(corner);
  const auto& clearance = mission.navigation.clearance;
  const double within_m = range_limit_m(mission.sensor) + (clearance ? clearance->distance_m : 0);
  return internal::app::incomplete_warning(mission.scene(), {{std::move(targets), within_m}}, {lines},
                                           "the sight lines");
}

std::vector<Warning> beyond_data_warnings(const Mission& mission, const FlownPlaces& flown, const Progress& progress) {
  std::vector<Vec2> points;
  for (const Vec3& position : flown.positions) points.emplace_back(position.head<2>());
  for (const Vec3& place : flown.seen) points.emplace_back(place.head<2>());
  for (const FlightLink& link : flown.links) points.emplace_back(link.point.head<2>());
  std::vector<Warning> warnings;
  const Shortfall shortfall = of(mission, points);
  if (shortfall.metres > kTolerance) {
    warnings.push_back({WarningCode::range_beyond_data,
                        "the flight, or what it must see, reaches " + metres(shortfall.metres) + " beyond " +
                            shortfall.known + ": what stands out there hides nothing, and nothing keeps clear of it; " +
                            shortfall.fix});
  }
  const std::vector<Box> legs = leg_boxes(flown.positions);
  std::vector<Reach> reaches = {{legs, flown.tube_radius_m + kept_m(mission, flown.clearance_m)}};
  for (const FlightLink& link : flown.links) reaches.push_back(reach_of(link, legs, flown.tube_radius_m));
  auto missing = internal::app::incomplete_warning(mission.scene(), std::move(reaches), legs, "the flight",
                                                   internal::core::ProgressReporter(progress));
  if (missing) warnings.push_back(std::move(*missing));
  return warnings;
}

std::vector<Warning> mission_warnings(const Mission& mission, const Volume* volume) {
  constexpr double kTiny = 0.01;  // metre: a target of street size in degrees is 1e-4 across
  constexpr double kLargestDegree = 180;
  std::vector<Warning> warnings = mission.notes;
  const Shortfall shortfall = of(mission, reach(mission));
  if (shortfall.metres > kTolerance) {
    warnings.push_back({WarningCode::range_beyond_data,
                        "the range reaches " + metres(shortfall.metres) + " beyond " + shortfall.known +
                            ": what stands out there hides nothing, and the volume may claim too much; " +
                            shortfall.fix});
  }
  if (auto missing = incomplete_warning(mission, volume)) warnings.push_back(std::move(*missing));
  Box box;
  for (const Vec3& corner : mission.target.parts.at(0)) box.extend(corner);
  const double across = (box.max - box.min).norm();
  if (mission.scene().georeference && !mission.target.is_point() && across < kTiny &&
      box.min.cwiseAbs().maxCoeff() <= kLargestDegree) {
    warnings.push_back({WarningCode::target_in_degrees,
                        internal::core::format("the target is {:.2g} mm across: if its vertices are longitudes and "
                                               "latitudes, say so with 'crs: EPSG:4326'",
                                               across * 1000)});
  }
  if (auto pixel = large_pixel(mission.sensor)) warnings.push_back(std::move(*pixel));
  for (Warning& warning : internal::app::scene_warnings(mission, volume)) warnings.push_back(std::move(warning));
  if (volume) {
    if (std::optional<Warning> small = small_volume(mission, *volume)) warnings.push_back(std::move(*small));
  }
  return warnings;
}

}  // namespace vantage
