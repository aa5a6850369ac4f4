#include "flight/tour/mission_limits.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/output.h"
#include "core/format.h"
#include "flight/tour/tour_certificate.h"
#include "flight/tour/tour_region.h"
#include "scene/viewpoint_check.h"
#include "vantage/error.h"
#include "vantage/ground.h"
#include "vantage/query.h"

namespace vantage::internal::flight::tour {
namespace {

using PlanPoints = std::vector<Eigen::Vector2d>;

constexpr double kHighestClimbM = 20;  ///< as DjiAircraft has it

constexpr double kAnyWidth = std::numeric_limits<double>::infinity();

double turn_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Counter-clockwise. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.
PlanPoints hull_in_plan(PlanPoints points) {
  const auto less = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(points.begin(), points.end(), less);
  PlanPoints hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= first + 2 && turn_of(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
      hull.push_back(point);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// The narrowest strip round a polygon lies along one of its sides.
double width_in_plan(const PlanPoints& points) {
  const PlanPoints hull = hull_in_plan(points);
  if (hull.size() < 3) return 0;
  double least = kAnyWidth;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d &a = hull[i], &b = hull[(i + 1) % hull.size()];
    double widest = 0;
    for (const Eigen::Vector2d& c : hull) widest = std::max(widest, turn_of(a, b, c));
    least = std::min(least, widest / (b - a).norm());
  }
  return least;
}

bool is_finite(const PlanPoints& points) {
  return std::all_of(points.begin(), points.end(), [](const Eigen::Vector2d& p) { return p.allFinite(); });
}

/// z of the lowest piece of ground at a place. Nothing where there is none, or the scene does not say what is ground.
std::optional<double> ground_z_m(const Mission& mission, const Vec3& place) {
  try {
    const std::optional<GroundLevels::Range> range = GroundLevels(ground_of(mission)).at(place.x(), place.y());
    return range ? std::optional(range->lowest_m) : std::nullopt;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::ground_missing) throw;
    return std::nullopt;
  }
}

/// The home, or the ground above it, where it was measured a little too low.
Vec3 on_ground(const Vec3& home, const Mission& mission) {
  constexpr double kTooLow = 2;  // metres: what heights of maps and of receivers may differ by
  const std::optional<double> ground = ground_z_m(mission, home);
  if (!ground || home.z() >= *ground) return home;
  if (home.z() < *ground - kTooLow) {
    throw Error(ErrorCode::viewpoint_inside_solid,
                core::format("tour.home lies {:.1f} m under the ground", *ground - home.z()),
                mission.as_written.places.tour, core::format("give it a z of {:.2f} or more", *ground));
  }
  return {home.x(), home.y(), *ground};
}

}  // namespace

double least_width_m(const Navigation& navigation) {
  double width = kAnyWidth;
  const auto take = [&](const PlanPoints& points) {
    if (!points.empty() && is_finite(points)) width = std::min(width, width_in_plan(points));
  };
  PlanPoints allowed;  // one of the zones is enough
  for (const Zone& zone : navigation.keep_in) allowed.insert(allowed.end(), zone.outer.begin(), zone.outer.end());
  take(allowed);
  for (const KeepInMesh& mesh : navigation.meshes) {
    PlanPoints points;
    for (const Vec3& vertex : mesh.mesh.vertices) points.emplace_back(vertex.x(), vertex.y());
    take(points);
  }
  return width;
}

// Let a smooth curve come back to its beginning, and look at how far it goes to one side, y. Somewhere it turns from
// forward to backward. From where it last ran level to where it next does, its heading turns by half a circle, or
// leaves a level and comes back to it from a right angle: either way y changes by two radii. Without such a stretch it
// would have to turn back at its beginning or its end alone, and the way back takes as much. So it is two radii wide.
void check_room_to_turn(const Mission& mission, const TourSettings& settings) {
  if (settings.vehicle.kind != TourVehicle::Kind::fixed_wing || !settings.closed) return;
  const double width = least_width_m(mission.navigation), turn = 2 * settings.vehicle.turn_radius_m;
  if (width >= turn) return;
  throw Error(
      ErrorCode::limits_empty,
      core::format("a closed flight with a turn radius of {:g} m is at least {:g} m wide, and the zones to stay "
                   "in leave {:.1f} m",
                   settings.vehicle.turn_radius_m, turn, width),
      mission.as_written.places.tour,
      "give a smaller tour.vehicle.turn_radius, a wider zone in 'navigation', or 'closed: false'");
}

std::optional<std::string> note_of_narrow_zones(const Mission& mission, const TourSettings& settings,
                                                const Tour& tour) {
  if (settings.vehicle.kind != TourVehicle::Kind::fixed_wing || tour.problems.empty()) return std::nullopt;
  // What stands there is told of the others.
  const auto has_no_way = [](const TourProblem& problem) { return problem.kind == TourProblem::Kind::no_way; };
  if (!std::all_of(tour.problems.begin(), tour.problems.end(), has_no_way)) return std::nullopt;
  const double width = least_width_m(mission.navigation), turn = 2 * settings.vehicle.turn_radius_m;
  if (width >= turn) return std::nullopt;
  std::string why =
      core::format("to turn round with a turn radius of {:g} m takes {:g} m, and the zones to stay in leave {:.1f} m",
                   settings.vehicle.turn_radius_m, turn, width);
  if (!tour.order.empty()) return "targets are left out, maybe because of this: " + why;
  throw Error(ErrorCode::limits_empty, "no flight was found that visits any target; " + why,
              mission.as_written.places.tour,
              "give a smaller tour.vehicle.turn_radius, or a wider zone in 'navigation'");
}

namespace {

/// The lowest height above `home` at which flying is allowed, of those in steps of 0.5 m; where none of them is
/// allowed, of 200 between the bounds of the airspace. Metres; nothing where there is none.
std::optional<double> lowest_allowed_m(const Vec3& home, const Airspace& airspace, double deviation_m) {
  constexpr double kStep = 0.5, kHighest = 1000, kSteps = 200;
  const auto lowest = [&](double low, double high, double step) -> std::optional<double> {
    for (double height = low; step > 0 && height <= high; height += step) {
      const Vec3 at = home + Vec3(0, 0, height);
      if (airspace.allows({at, at}, deviation_m)) return height;
    }
    return std::nullopt;
  };
  if (const auto height = lowest(0, kHighest, kStep)) return height;
  const Box bounds = airspace.bounds();
  const double low = std::max(0.0, bounds.min.z() - home.z() + deviation_m);
  const double high = std::min(bounds.max.z() - home.z(), low + kHighest);
  return lowest(low, high, (high - low) / kSteps);
}

/// What there is to stay out of on a leg; nothing where the way is free.
std::string kept_out_on(const Leg& leg, const Navigation& navigation) {
  Navigation zones;
  zones.keep_out = navigation.keep_out;
  const std::vector<LegBreak> broken = zones.empty() ? std::vector<LegBreak>() : LegLimits(zones).broken(leg, 0);
  return broken.empty() ? std::string() : broken.front().limit;
}

}  // namespace

Vec3 start_above(const Vec3& given, const Mission& mission, const PreparedScene& scene, const Airspace& airspace,
                 double deviation_m) {
  const Vec3 home = on_ground(given, mission);
  const Vec3 off_ground = home + Vec3(0, 0, 0.008);
  const std::string& where = mission.as_written.places.tour;
  const scene::ViewpointCheck solids(mission.scene());
  if (const auto solid = solids.solid_around(off_ground)) {
    throw Error(ErrorCode::viewpoint_inside_solid, "tour.home lies inside a solid",
                where + (where.empty() ? "" : ", ") + "object '" + solids.name_of(*solid) + "'",
                "move it into the open", *solid);
  }
  const auto height = lowest_allowed_m(home, airspace, deviation_m);
  if (!height) {
    constexpr double kAbove = 1000;
    const double off_ground_m = 0.5 + mission.as_written.tour.value_or(TourSettings()).tube_m;
    throw Error(ErrorCode::limits_empty, "above tour.home there is no height at which flying is allowed", where,
                "move it into the zones of 'navigation', widen these, or give a smaller tour.tube; nearest above it: " +
                    airspace.obstacle({home + Vec3(0, 0, off_ground_m), home + Vec3(0, 0, kAbove)}, 0));
  }
  Vec3 at = home + Vec3(0, 0, *height);
  LegDistanceOptions options;
  options.without_ground = true;
  const LegDistance nearest = LegDistances(scene, options).nearest({off_ground, at});
  if (!(nearest.distance_m > 0)) {
    throw Error(ErrorCode::viewpoint_inside_solid,
                "tour.home lies inside or under " + (nearest.name.empty() ? "the scene" : nearest.name), where,
                "move it to where the way up is free");
  }
  if (const std::string zone = kept_out_on({off_ground, at}, mission.navigation); !zone.empty()) {
    throw Error(ErrorCode::limits_empty, "tour.home lies inside or under " + zone + ", to stay out of", where,
                "move it to where the way up is free");
  }
  return at;
}

double room_above_m(const Vec3& home, const Vec3& start, const Airspace& airspace) {
  const auto allows = [&](double height_m) {
    return airspace.allows({start, {home.x(), home.y(), home.z() + height_m}}, kPlanRoundingM);
  };
  double low_m = start.z() - home.z(), high_m = kHighestClimbM;
  if (low_m >= high_m || allows(high_m)) return high_m;
  constexpr double kCentimetre = 0.01;
  while (high_m - low_m > kCentimetre / 2) {
    const double middle_m = (low_m + high_m) / 2;
    (allows(middle_m) ? low_m : high_m) = middle_m;
  }
  return std::floor(low_m / kCentimetre) * kCentimetre;
}

void check_tour_certificate_files(const Mission& mission, const std::filesystem::path& certificate) {
  const std::vector<std::filesystem::path> inputs = input_files(mission.as_written);
  check_not_an_input(certificate, inputs);
  check_certificate_output(certificate);
  for (std::size_t i = 0; i < volume_count(mission); ++i) {
    const std::filesystem::path mesh = region_file(certificate, i);
    check_not_an_input(mesh, inputs);
    check_certificate_output(mesh);
  }
}

}  // namespace vantage::internal::flight::tour
