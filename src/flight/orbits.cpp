#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/format.h"
#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "flight/orbit_search.h"
#include "flight/solid_depth.h"
#include "flight/view_describer_data.h"
#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/solid.h"
#include "vantage/standpoints.h"

namespace vantage {
namespace {

using internal::core::ProgressReporter;
using internal::flight::ClosedCurve;
using internal::flight::CurveDepth;
using internal::flight::CurveRequest;
using internal::flight::Obstacles;
using internal::flight::OrbitSearch;
using internal::flight::SolidDepth;
using internal::flight::TargetView;

constexpr double kDegrees = 180 / std::numbers::pi;

void check_orbit_options(const OrbitOptions& options) {
  const auto check = [](bool is_good, const char* what, const char* where) {
    if (!is_good) throw Error(ErrorCode::value_out_of_range, what, where, "give metres");
  };
  check(options.least_radius_m > 0 && std::isfinite(options.least_radius_m),
        "the smallest radius is not positive and finite", "least_radius_m");
  check(options.most_radius_m >= options.least_radius_m, "the largest radius is smaller than the smallest one",
        "most_radius_m");
  check(std::isnan(options.margin_m) || (options.margin_m >= 0 && std::isfinite(options.margin_m)),
        "the margin is below 0 or not finite", "margin_m");
  check(std::isnan(options.tolerance_m) || (options.tolerance_m > 0 && std::isfinite(options.tolerance_m)),
        "the tolerance is not positive and finite", "tolerance_m");
}

/// All searches in one volume.
class OrbitFinder {
 public:
  OrbitFinder(const Mission& mission, const Volume& volume, const PreparedScene& scene, const ViewDescriber& describer,
              const OrbitOptions& options)
      : exact_(volume.mesh),  // first: it checks the mesh
        solid_(volume.mesh),
        depth_(solid_),
        query_(prepare_views(mission, scene), mission.navigation),
        describer_(describer),
        options_(options) {}

  Orbits find(const ProgressReporter& progress) {
    const Vec3 size = solid_.bounds().max - solid_.bounds().min;
    most_radius_m_ = std::min(options_.most_radius_m, size.head<2>().minCoeff() / 2);
    // A layer of air has orbits too.
    const double fine = std::min({1.0, solid_.size_m() / 100, size.minCoeff() / 8});
    tolerance_m_ = std::isnan(options_.tolerance_m) ? fine : options_.tolerance_m;
    if (most_radius_m_ < options_.least_radius_m) {
      result_.reason =
          fmt::format("a circle of radius {:.6g} m is wider than the volume, which is {:.1f} m by {:.1f} m",
                      options_.least_radius_m, size.x(), size.y());
      return std::move(result_);
    }
    result_.margin_m = std::isnan(options_.margin_m) ? tolerance_m_ / 2 : options_.margin_m;
    const OrbitSearch deepest = search(OrbitKind::deepest, result_.margin_m, std::nullopt, progress.part(0, 1.0 / 3));
    set_margin(deepest);
    if (!deepest.curve()) {
      result_.reason = why_none("circle", deepest);
      if (options_.racetracks) add_racetrack(progress.part(1.0 / 3, 1));
      return std::move(result_);
    }
    const OrbitSearch widest =
        search(OrbitKind::widest, result_.margin_m, deepest.curve(), progress.part(1.0 / 3, 2.0 / 3));
    add(OrbitKind::widest, widest);
    add(OrbitKind::deepest, deepest);
    if (target().has_pixels()) {
      add(OrbitKind::finest_pixel,
          search(OrbitKind::finest_pixel, result_.margin_m, deepest.curve(), progress.part(2.0 / 3, 1)));
    } else {
      result_.notes.emplace_back("finest_pixel: the mission has no camera whose pixels are known");
    }
    return std::move(result_);
  }

 private:
  const TargetView& target() const { return describer_.data().target; }
  Vec3 local_target() const { return target().centre() - solid_.origin(); }

  void set_margin(const OrbitSearch& deepest) {
    constexpr double kShare = 4;
    if (!deepest.curve()) return;
    if (std::isnan(options_.margin_m)) result_.margin_m = std::min(1.0, deepest.best() / kShare);
    if (std::isnan(options_.tolerance_m) && result_.margin_m > 0) {
      tolerance_m_ = std::min(tolerance_m_, result_.margin_m / 2);
    }
  }

  OrbitSearch search(OrbitKind kind, double margin_m, const std::optional<ClosedCurve>& known,
                     const ProgressReporter& progress, double most_half_straight_m = 0) {
    constexpr double kPixelShare = 0.02;
    CurveRequest request;
    request.kind = kind;
    request.centre = options_.centre;
    request.target = local_target();
    request.least_radius_m = options_.least_radius_m;
    request.most_radius_m = most_radius_m_;
    request.most_half_straight_m = most_half_straight_m;
    request.margin_m = margin_m + last_error_m();  // so that the last look finds the margin too
    request.slack_m = tolerance_m_;
    request.error_m = tolerance_m_ / 4;
    if (kind == OrbitKind::deepest) request.slack_m = request.error_m;
    request.limits = {kind == OrbitKind::finest_pixel ? kPixelShare : tolerance_m_, options_.most_boxes};
    request.pixel_m = [this](const Vec3& p, double reach) { return target().pixel_m(solid_.origin() + p, reach); };
    request.is_inside = [this](const ClosedCurve& curve) {
      constexpr std::size_t kPlaces = 24;
      return sees_all(curve, kPlaces);
    };
    OrbitSearch found(depth_, std::move(request));
    found.run(known, progress);
    if (found.end().is_cut) {
      result_.notes.push_back(fmt::format("{}: the search was cut short after {} boxes; its bound is loose",
                                          most_half_straight_m > 0 ? "racetrack" : name_of(kind), found.end().boxes));
    }
    return found;
  }

  static double told(OrbitKind kind, double value) {
    return kind == OrbitKind::finest_pixel ? std::exp(-value) : value;
  }

  std::vector<Vec3> scene_points(const ClosedCurve& curve, std::size_t count) const {
    std::vector<Vec3> points = curve.points(count);
    for (Vec3& point : points) point += solid_.origin();
    return points;
  }

  bool sees_all(const ClosedCurve& curve, std::size_t count) {
    const std::vector<PointAnswer> answers = query_.answer(scene_points(curve, count));
    return std::all_of(answers.begin(), answers.end(), [](const PointAnswer& answer) { return answer.inside; });
  }

  std::string why_none(const char* what, const OrbitSearch& search) const {
    const char* const where = options_.centre == OrbitCentre::around_target ? " around the target"
                              : options_.centre == OrbitCentre::over_target ? " over the target's centre"
                                                                            : "";
    const std::string asked = fmt::format("{} of radius {:.6g} m or more{}", what, options_.least_radius_m, where);
    const std::string inside = fmt::format("lies {:.3g} m inside the volume", result_.margin_m);
    if (!search.end().is_cut) return "no " + asked + " " + inside;
    return fmt::format(
        "no {} was found that {}; it is not proved that there is none, but none lies more than {:.3g} m "
        "inside",
        asked, inside, search.end().bound);
  }

  void add_racetrack(const ProgressReporter& progress) {
    const OrbitSearch found = search(OrbitKind::deepest, result_.margin_m, std::nullopt, progress, solid_.size_m() / 2);
    if (found.curve()) {
      set_margin(found);
      add(OrbitKind::deepest, found);
    } else {
      result_.reason += "; " + why_none("racetrack", found);
    }
  }

  void add(OrbitKind kind, const OrbitSearch& found) {
    if (!found.curve()) return;
    constexpr std::size_t kPlaces = 360;
    const ClosedCurve curve = kind == OrbitKind::widest ? widened(*found.curve()) : *found.curve();
    const std::vector<Vec3> points = scene_points(curve, kPlaces);
    const std::vector<std::uint8_t> held = exact_.contains(points);
    const bool is_held = std::all_of(held.begin(), held.end(), [](std::uint8_t one) { return one != 0; });
    if (!is_held || !sees_all(curve, kPlaces)) {
      result_.notes.push_back(std::string(name_of(kind)) + ": the exact query refused the orbit that was found");
      return;
    }
    Orbit& orbit = result_.found.emplace_back();
    orbit.kind = kind;
    orbit.clockwise = options_.clockwise;
    orbit.centre = solid_.origin() + curve.centre;
    orbit.radius_m = curve.radius_m;
    orbit.straight_m = 2 * curve.half_straight_m;
    if (curve.half_straight_m > 0) {
      const double heading = std::fmod(90 - curve.angle * kDegrees + 360, 180);
      orbit.heading_deg = heading < 180 ? heading : 0;
    }
    orbit.length_m = curve.length_m();
    orbit.margin_m = std::max(0.0, depth_.depth_m(curve, last_error_m(), solid_.rounding_m()));
    orbit.value = told(kind, found.best());
    orbit.bound = told(kind, found.end().bound);
    if (kind == OrbitKind::deepest) orbit.value = orbit.margin_m;
    if (kind == OrbitKind::widest) orbit.value = orbit.radius_m;
    if (kind != OrbitKind::finest_pixel) orbit.bound = std::max(orbit.bound, orbit.value);
    measure(orbit, curve);
  }

  /// The search looks less closely: as much wider as there is room.
  ClosedCurve widened(ClosedCurve curve) const {
    const double needed = result_.margin_m + last_error_m();
    const double room = depth_.depth_m(curve, last_error_m(), needed) - needed;
    if (room > 0) curve.radius_m = std::min(most_radius_m_, curve.radius_m + room);
    return curve;
  }

  /// How much too small the margin may be that is told. A smaller one takes more chords.
  double last_error_m() const {
    constexpr double kMillimetre = 1e-3, kShare = 100, kOfSize = 1e-7;
    const double least = std::max(10 * solid_.rounding_m(), kOfSize * solid_.size_m());
    return std::max(least, std::min(kMillimetre, result_.margin_m / kShare));
  }

  /// What is seen from all round.
  void measure(Orbit& orbit, const ClosedCurve& curve) const {
    orbit.place = describer_.describe(orbit.centre);
    constexpr double kApart = 0.1;  // metres between places, at most, but no more places than:
    constexpr double kMost = 20000, kFewest = 360;
    const auto count = static_cast<std::size_t>(std::clamp(std::ceil(orbit.length_m / kApart), kFewest, kMost));
    const double half_apart = orbit.length_m / static_cast<double>(count) / 2;
    orbit.min_pitch_deg = orbit.min_distance_m = std::numeric_limits<double>::infinity();
    orbit.max_pitch_deg = -std::numeric_limits<double>::infinity();
    double pixel = 0, incidence = 0, nearest = std::numeric_limits<double>::infinity();
    Vec3 nearest_point = orbit.centre;
    const Obstacles& obstacles = describer_.data().around->obstacles;
    for (const Vec3& point : scene_points(curve, count)) {
      const Vec3 line = target().centre() - point;
      const double pitch = std::atan2(line.z(), line.head<2>().norm()) * kDegrees;
      orbit.min_pitch_deg = std::min(orbit.min_pitch_deg, pitch);
      orbit.max_pitch_deg = std::max(orbit.max_pitch_deg, pitch);
      orbit.min_distance_m = std::min(orbit.min_distance_m, line.norm());
      orbit.max_distance_m = std::max(orbit.max_distance_m, line.norm());
      if (target().has_pixels()) pixel = std::max(pixel, target().pixel_m(point));
      if (target().has_incidence()) incidence = std::max(incidence, target().incidence_deg(point));
      if (obstacles.empty()) continue;
      const double distance = obstacles.distance_m(point);
      if (distance >= nearest) continue;
      nearest = distance;
      nearest_point = point;
    }
    if (target().has_pixels() && std::isfinite(pixel)) orbit.pixel_m = pixel;
    if (target().has_incidence()) orbit.incidence_deg = incidence;
    if (obstacles.empty()) return;
    orbit.obstacle_distance_m = std::max(0.0, nearest - half_apart);
    orbit.obstacle = obstacles.nearest(nearest_point).name;
  }

  SolidIndex exact_;
  SolidDepth solid_;
  CurveDepth depth_;
  ViewsQuery query_;
  const ViewDescriber& describer_;
  const OrbitOptions& options_;
  double most_radius_m_ = 0, tolerance_m_ = 0;
  Orbits result_;
};

}  // namespace

const char* name_of(OrbitKind kind) {
  switch (kind) {
    case OrbitKind::widest:
      return "widest";
    case OrbitKind::deepest:
      return "deepest";
    case OrbitKind::finest_pixel:
      return "finest_pixel";
  }
  return "unknown";
}

const char* name_of(OrbitCentre centre) {
  switch (centre) {
    case OrbitCentre::around_target:
      return "around_target";
    case OrbitCentre::over_target:
      return "over_target";
    case OrbitCentre::anywhere:
      return "anywhere";
  }
  return "unknown";
}

Orbits find_orbits(const Mission& mission, const Volume& volume, const PreparedScene& scene,
                   const ViewDescriber& describer, const OrbitOptions& options, const Progress& progress) {
  check_orbit_options(options);
  Orbits result;
  if (volume.empty()) {
    result.reason = volume.reason.empty() ? "the volume is empty" : volume.reason;
    return result;
  }
  const ProgressReporter reporter(progress, "orbits");
  reporter.begin("orbits");
  internal::parallel::with_threads(
      options.threads, [&] { result = OrbitFinder(mission, volume, scene, describer, options).find(reporter); });
  reporter.finish();
  internal::flight::AskedPitches asked;
  const Mount& mount = mission.sensor.mount;
  for (const Orbit& orbit : result.found) {
    for (const double pitch_deg : {orbit.min_pitch_deg, orbit.max_pitch_deg}) {
      asked.add(mission.sensor.camera ? std::clamp(pitch_deg, mount.min_pitch_deg, mount.max_pitch_deg) : pitch_deg);
    }
  }
  if (const auto note = asked.note(mission)) result.notes.push_back(*note);
  return result;
}

Flight flight_of(const Orbit& orbit, double chord_error_m) {
  const bool is_finite = orbit.centre.allFinite() && std::isfinite(orbit.radius_m) && std::isfinite(orbit.straight_m) &&
                         std::isfinite(orbit.heading_deg);
  if (!is_finite || !(orbit.radius_m > 0) || !(orbit.straight_m >= 0)) {
    throw Error(ErrorCode::value_out_of_range, "the orbit has no radius, or a number that is not finite", "orbit",
                "pass what find_orbits found");
  }
  if (!(chord_error_m > 0)) {
    throw Error(ErrorCode::value_out_of_range, "the error of chords is not positive", "chord_error_m", "give metres");
  }
  // A circle begins in the north: half a turn on from the right of this direction.
  const double angle = orbit.straight_m > 0 ? (90 - orbit.heading_deg) / kDegrees : std::numbers::pi;
  const ClosedCurve curve{orbit.centre, orbit.radius_m, orbit.straight_m / 2, angle};
  Flight flight;
  flight.chord_error_m = orbit.margin_m > 0 ? std::min(chord_error_m, orbit.margin_m) : chord_error_m;
  std::vector<Vec3> corners = curve.corners(flight.chord_error_m);
  corners.push_back(corners.front());
  if (orbit.clockwise) std::reverse(corners.begin(), corners.end());
  for (const Vec3& corner : corners) flight.points.push_back({.position = corner});
  return flight;
}

}  // namespace vantage
