// From a request to a tour: regions, the order, ways clear of obstacles, when what is viewed; then all is checked
// again.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/format.h"
#include "core/progress_reporter.h"
#include "core/stopwatch.h"
#include "flight/tour/tour_breach.h"
#include "flight/tour/tour_course.h"
#include "flight/tour/tour_obstacles.h"
#include "flight/tour/tour_random.h"
#include "flight/tour/tour_region.h"
#include "flight/tour/tour_schedule.h"
#include "flight/tour/tour_search.h"
#include "flight/tour/tour_wing.h"
#include "vantage/error.h"
#include "vantage/tour.h"

namespace vantage {
namespace internal::flight::tour {
namespace {

constexpr double kOfTimeForOrder = 0.6;
constexpr std::size_t kMostTried = 3;  ///< courses that are flown round obstacles
constexpr int kMostRounds = 100;       ///< in which ways round obstacles are drawn anew
constexpr int kMostIdle = 5;           ///< such rounds without a gain, one after the other
constexpr double kLeastGain = 1e-5;    ///< relative to the length

void check_request(const TourRequest& request) {
  check_tour_settings(request.settings);
  if (request.targets.empty()) {
    throw Error(ErrorCode::nothing_given, "a tour has no targets", "tour", "give one target or more");
  }
  if (!(request.chord_error_m > 0) || !std::isfinite(request.chord_error_m)) {
    throw Error(ErrorCode::value_out_of_range, "the chord error of a tour is not positive", "tour",
                "give metres above 0");
  }
  if (!request.home) return;
  const Vec3& home = *request.home;
  if (!home.allFinite()) {
    throw Error(ErrorCode::coordinate_not_finite, "the home of the tour is not finite", "tour.home",
                "give three finite numbers");
  }
  const double deviation = request.settings.vehicle.kind == TourVehicle::Kind::fixed_wing ? request.chord_error_m : 0;
  if (!request.airspace || request.airspace->allows({home, home}, deviation)) return;
  throw Error(
      ErrorCode::value_out_of_range,
      core::format("the tour may not begin at its home: {}", request.airspace->obstacle({home, home}, deviation)),
      "tour.home", "move it to where the vehicle may fly, or change the limits");
}

Tour::End end_of(SearchEnd end) {
  return end == SearchEnd::done        ? Tour::End::done
         : end == SearchEnd::cancelled ? Tour::End::cancelled
                                       : Tour::End::time_limit;
}

/// Courses of different lengths: the same flight may serve its targets in several orders.
std::vector<Course> different(const std::vector<Course>& courses) {
  std::vector<Course> result;
  for (const Course& course : courses) {
    const bool is_new = result.empty() || course.length_m() > result.back().length_m() * (1 + 1e-6);
    if (is_new && result.size() < kMostTried) result.push_back(course);
  }
  return result;
}

/// A closed course without a home begins where it turns most: it would rest there anyway.
void begin_at_turn(Course& course) {
  if (!course.closed || course.first_free() == 1 || course.stops.size() < 2) return;
  std::size_t sharpest = 0;
  double least = 2;
  for (std::size_t i = 0; i < course.stops.size(); ++i) {
    const Vec3 in = course.stops[i].point - *course.before(i), out = *course.after(i) - course.stops[i].point;
    const double cosine = in.norm() > 0 && out.norm() > 0 ? in.dot(out) / (in.norm() * out.norm()) : 1;
    if (cosine >= least) continue;
    least = cosine;
    sharpest = i;
  }
  std::rotate(course.stops.begin(), course.stops.begin() + static_cast<std::ptrdiff_t>(sharpest), course.stops.end());
}

/// Stops that lie within 2 cm of the next point or the one before move there, where their region and the airspace allow
/// it: the vehicle hovers once then. The way gets no longer.
void join_stops(Course& course, const Regions& regions, const Airspace* airspace) {
  constexpr double kNear = 0.02;
  constexpr int kPasses = 2;  // the second one for stops on both sides of where the course begins
  const std::size_t count = course.stops.size();
  const auto allows = [&](const Vec3* from, const Vec3* to) {
    return !airspace || !from || !to || airspace->allows({*from, *to}, 0);
  };
  for (std::size_t k = 0; k < kPasses * count; ++k) {
    const std::size_t i = count - 1 - k % count;
    const Vec3 *next = course.after(i), *before = course.before(i);
    Stop& stop = course.stops[i];
    for (const Vec3* to : {next, before}) {
      if (stop.region < 0 || !to || (*to - stop.point).norm() > kNear) continue;
      if (*to == stop.point) break;
      if (!regions[static_cast<std::size_t>(stop.region)]->holds(*to)) continue;
      if (!allows(to == next ? before : to, to == next ? to : next)) continue;
      stop.point = *to;
      break;
    }
  }
}

bool is_better(const FlownCourse& a, const FlownCourse& b) {
  if (a.problems.size() != b.problems.size()) return a.problems.size() < b.problems.size();
  return a.course.length_m() < b.course.length_m();
}

class MultirotorPlan {
 public:
  MultirotorPlan(const TourRequest& request, const core::ProgressReporter& progress)
      : request_(request),
        progress_(progress),
        regions_(make_regions(request.targets, request.settings.margin_m, progress)) {}

  Tour run() {
    progress_.begin("order of the tour");
    const CourseKind kind = {request_.settings.closed, request_.home};
    const SearchOptions options = {request_.seed, kOfTimeForOrder * request_.settings.time_limit_s, request_.rounds};
    const SearchResult found = search_order(regions_, kind, options, progress_);
    end_ = end_of(found.end);
    FlownCourse flown = fly(different(found.courses));
    for (;;) {
      join_stops(flown.course, regions_, request_.airspace.get());
      begin_at_turn(flown.course);
      const auto [tour, breaches] = judged(flown);
      if (breaches.empty()) return tour;
      check_has_visits(tour);
      flown = without(problem_of(tour, breaches.front(), request_, 0), flown);
    }
  }

 private:
  /// After a call to stop, what was found is still made safe.
  bool is_over() const { return end_ == Tour::End::cancelled || watch_.seconds() > request_.settings.time_limit_s; }

  FlownCourse fly(const std::vector<Course>& courses) {
    std::optional<FlownCourse> best;
    for (const Course& course : courses) {
      if (best && is_over()) break;
      const std::optional<FlownCourse> flown = clear_of_obstacles(course, !best);
      if (flown && (!best || is_better(*flown, *best))) best = flown;
    }
    return *best;
  }

  /// Nothing where it was told to stop, unless it `must` find one.
  std::optional<FlownCourse> clear_of_obstacles(const Course& course, bool must) {
    const CourseLimits limits = {regions_, request_.airspace.get()};
    std::optional<FlownCourse> flown;
    try {
      SplitMix64 draw(request_.seed);
      const auto is_late = [this] { return is_over(); };
      flown = fly_clear(course, limits, draw, is_over() ? core::ProgressReporter() : progress_, is_late);
      draw_ways(flown->course, draw);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::cancelled) throw;
      end_ = Tour::End::cancelled;
    }
    if (flown || !must) return flown;
    SplitMix64 draw(request_.seed);
    return fly_clear(course, limits, draw, {}, [] { return true; });
  }

  void draw_ways(Course& course, SplitMix64& draw) const {
    if (!request_.airspace) return;
    const CourseLimits limits = {regions_, request_.airspace.get()};
    int idle = 0;
    for (int round = 0; round < kMostRounds && idle < kMostIdle && !is_over(); ++round) {
      const double before = course.length_m();
      draw_ways_anew(course, limits, draw, progress_, [this] { return is_over(); });
      idle = course.length_m() < before * (1 - kLeastGain) ? 0 : idle + 1;
    }
    join_bends(course, limits);
    shorten(course, limits);
  }

  struct Judged {
    Tour tour;
    std::vector<Breach> breaches;
  };

  /// A way that is cut where views begin and end differs from it by a rounding: where that breaks a limit, the vehicle
  /// hovers for the target, and the way stays as it was found.
  Judged judged(const FlownCourse& flown) const {
    std::vector<bool> hovers(regions_.size(), false);
    for (;;) {
      Tour tour = tour_of(flown, hovers);
      std::vector<Breach> breaches = breaches_of(tour);
      bool is_changed = false;
      for (const TourVisit& visit : tour.visits) {
        const bool is_broken = std::any_of(breaches.begin(), breaches.end(), [&](const Breach& breach) {
          if (!breach.leg) return tour.visits[breach.visit].target == visit.target;
          return visit.first_point <= *breach.leg + 1 && visit.last_point >= *breach.leg;
        });
        if (!is_broken || visit.first_point == visit.last_point) continue;
        hovers[visit.target] = is_changed = true;
      }
      if (!is_changed) return {std::move(tour), std::move(breaches)};
    }
  }

  /// Flown again without the target of a problem.
  FlownCourse without(const TourProblem& problem, const FlownCourse& flown) {
    Course course = flown.course;
    std::erase_if(course.stops, [&](const Stop& stop) {
      return stop.region == kBend || stop.region == static_cast<int>(problem.target);
    });
    FlownCourse rest = fly({course});
    std::vector<TourProblem> problems = flown.problems;
    problems.push_back(problem);
    rest.problems.insert(rest.problems.begin(), problems.begin(), problems.end());
    return rest;
  }

  /// `hovers`: for which targets, whether or not the vehicle passes them for long enough.
  Tour tour_of(const FlownCourse& flown, const std::vector<bool>& hovers) const {
    Tour tour;
    tour.problems = flown.problems;
    tour.end = end_;
    const std::vector<Stop>& stops = flown.course.stops;
    std::vector<Vec3> points;
    for (const Stop& stop : stops) {
      points.push_back(stop.point);
      if (stop.region >= 0) tour.order.push_back(static_cast<std::size_t>(stop.region));
    }
    if (tour.order.empty()) return tour;
    if (flown.course.closed && points.size() > 1) points.push_back(points.front());
    const Polyline way(points);
    std::vector<Viewing> viewings;
    for (std::size_t i = 0; i < stops.size(); ++i) {
      if (stops[i].region < 0) continue;
      const auto target = static_cast<std::size_t>(stops[i].region);
      viewings.push_back({target, way.station(i), {}});
      if (!hovers[target]) {
        viewings.back().stretches =
            stretches_followed(stretches_in(*regions_[target], way), way, request_.targets[target], request_);
      }
    }
    Scheduling scheduling = flight_of(way, schedule(viewings, request_.settings), request_);
    tour.flight = std::move(scheduling.flight);
    tour.visits = std::move(scheduling.visits);
    tour.length_m = length_m(tour.flight);
    tour.time_s = multirotor_seconds(tour.flight, request_.settings);
    return tour;
  }

  /// All legs and all visits, as they are in the flight.
  std::vector<Breach> breaches_of(const Tour& tour) const {
    std::vector<Breach> breaches = breaches_of_legs(tour, request_, 0);
    for (std::size_t i = 0; i < tour.visits.size(); ++i) {
      if (!is_kept(tour.visits[i], tour.flight)) breaches.push_back({std::nullopt, i});
    }
    return breaches;
  }

  bool is_kept(const TourVisit& visit, const Flight& flight) const {
    const TourRegion& region = *regions_[visit.target];
    double seconds = 0;
    for (std::size_t i = visit.first_point; i <= visit.last_point; ++i) seconds += flight.points[i].hold_s;
    for (std::size_t i = visit.first_point; i < visit.last_point; ++i) {
      if (!region.holds_leg(flight.leg(i))) return false;
      seconds += length_of(flight.leg(i)) / request_.settings.vehicle.speed_m_s;
    }
    return region.holds(flight.points[visit.first_point].position) && seconds >= visit.dwell_s;
  }

  static double length_of(const Leg& leg) { return (leg.to - leg.from).norm(); }

  const TourRequest& request_;
  const core::ProgressReporter& progress_;
  core::Stopwatch watch_;
  Regions regions_;
  Tour::End end_ = Tour::End::done;
};

}  // namespace
}  // namespace internal::flight::tour

Airspace::~Airspace() = default;

Tour plan_tour(const TourRequest& request, const Progress& progress) {
  namespace tour = internal::flight::tour;
  tour::check_request(request);
  const internal::core::ProgressReporter reporter(progress, "tour");
  if (request.settings.vehicle.kind == TourVehicle::Kind::fixed_wing) return tour::plan_wing_tour(request, reporter);
  return tour::MultirotorPlan(request, reporter).run();
}

}  // namespace vantage
