#include "flight/tour/tour_wing.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/format.h"
#include "core/portable_math.h"
#include "core/stopwatch.h"
#include "flight/tour/tour_breach.h"
#include "flight/tour/tour_random.h"
#include "flight/tour/tour_schedule.h"
#include "flight/tour/tour_search.h"
#include "flight/tour/tour_wing_choice.h"
#include "flight/tour/tour_wing_views.h"
#include "vantage/error.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr std::size_t kViews = 20;  ///< drawn of each target
constexpr std::size_t kMostCourses = 3, kMostRefined = 2;
constexpr int kAttempts = 8;  ///< with other views each: tours of sharp turns end in one of many local minima

/// A course as chords, and where in them each view lies.
struct Layout {
  std::vector<Vec3> points;
  std::vector<std::pair<std::size_t, std::size_t>> views;  ///< first and last point; of circles once round each
};

Layout layout_of(const WingCourse& course, const WingSpace& space) {
  Layout layout;
  const auto add = [&](const std::vector<Vec3>& points) {
    // Each part begins where the last one ends.
    for (std::size_t i = layout.points.empty() ? 0 : 1; i < points.size(); ++i) layout.points.push_back(points[i]);
  };
  const double round = 2 * std::numbers::pi * space.limits().turn_radius_m;
  for (std::size_t i = 0; i < course.views.size(); ++i) {
    const View& view = course.views[i];
    const std::vector<Vec3> chords = space.chords(view);
    if (layout.points.empty()) layout.points.push_back(chords.front());
    const std::size_t first = layout.points.size() - 1;
    const double times = view.circles_m > 0 ? std::round(view.circles_m / round) : 1;
    for (int k = 0; k < static_cast<int>(times); ++k) add(chords);
    layout.views.emplace_back(first, layout.points.size() - 1);
    if (i < course.path_count()) {
      const View& next = course.views[course.next(i)];
      if (const auto path = space.path(view, next)) add(space.chords(*path, view, next));
    }
  }
  return layout;
}

/// Serves one region after the other, those that are passed as well.
class WingPlan {
 public:
  WingPlan(const TourRequest& request, const core::ProgressReporter& progress)
      : request_(request),
        progress_(progress),
        // A curve lies within the chord error of chords that are so much deeper.
        regions_(make_regions(request.targets, request.settings.margin_m + request.chord_error_m, progress)),
        space_(request, regions_),
        draw_(request.seed) {}

  Tour run() {
    progress_.begin("order of the tour");
    const TourSettings& settings = request_.settings;
    const SearchOptions options = {request_.seed, 0.3 * settings.time_limit_s, request_.rounds};
    const SearchResult found = search_order(regions_, {settings.closed, request_.home}, options, progress_);
    if (found.end == SearchEnd::cancelled) throw Error(ErrorCode::cancelled, "the tour was stopped", "tour", "");
    if (found.end == SearchEnd::time_limit) end_ = Tour::End::time_limit;
    progress_.begin("headings of the tour");
    const int attempts = request_.rounds > 0 ? 1 : kAttempts;
    Attempt shortest;
    for (int i = 0; i < attempts && end_ != Tour::End::cancelled && (i == 0 || !is_late()); ++i) {
      Attempt next = attempt(found.courses, shortest.best.has_value());
      if (!next.best) continue;
      if (!shortest.best || is_better(*next.best, *shortest.best)) shortest = std::move(next);
    }
    best_ = std::move(shortest.best);
    passed_ = std::move(shortest.passed);
    return sound_tour();
  }

 private:
  struct Candidate {
    WingCourse course;
    std::vector<TourProblem> problems;
    double length = 0;
  };

  struct Attempt {
    std::optional<Candidate> best;
    std::vector<int> passed;
  };

  /// Draws views and goes on from there. `may_fail`: there is a tour, so that what goes wrong is none of the caller's,
  /// and nothing comes of it where the time is over.
  Attempt attempt(const std::vector<Course>& courses, bool may_fail) {
    best_.reset();
    passed_.clear();
    no_place_.clear();
    try {
      if (!draw_choices(courses.front(), may_fail)) return {};
      improve(courses, may_fail);
    } catch (const Error& error) {
      const bool is_cancelled = error.code() == ErrorCode::cancelled;
      if (!best_ && !may_fail) throw;
      if (!is_cancelled && (best_ || error.code() != ErrorCode::limits_empty)) throw;
      if (is_cancelled) end_ = Tour::End::cancelled;
    }
    return {std::move(best_), std::move(passed_)};
  }

  bool is_late() {
    if (watch_.seconds() <= request_.settings.time_limit_s) return false;
    end_ = Tour::End::time_limit;
    return true;
  }

  /// About the stops of a course without turning; for each target once. False: `may_stop`, and the time is over.
  bool draw_choices(const Course& course, bool may_stop) {
    choices_.resize(regions_.size());
    TourRequest bare = request_;
    bare.airspace = nullptr;
    const WingSpace everywhere(bare, regions_);
    // In the order of the request: so the first target that is wrong is told.
    std::vector<std::size_t> stops(course.stops.size());
    std::iota(stops.begin(), stops.end(), std::size_t{0});
    std::sort(stops.begin(), stops.end(),
              [&](std::size_t a, std::size_t b) { return course.stops[a].region < course.stops[b].region; });
    for (const std::size_t i : stops) {
      const Stop& stop = course.stops[i];
      if (stop.region == Stop::kFixed) continue;
      progress_.check();
      if (may_stop && is_late()) return false;
      const Vec3 &before = course.before(i) ? *course.before(i) : stop.point,
                 &after = course.after(i) ? *course.after(i) : stop.point;
      const ViewHint hint = {stop.point, portable::atan2(after.y() - before.y(), after.x() - before.x()), 1};
      std::vector<View>& views = choices_[static_cast<std::size_t>(stop.region)];
      views = space_.draw_views(stop.region, hint, kViews, draw_);
      if (!views.empty()) continue;
      const TourTarget& target = request_.targets[static_cast<std::size_t>(stop.region)];
      if (request_.airspace && !everywhere.draw_views(stop.region, hint, 1, draw_).empty()) {
        const std::string obstacle = request_.airspace->obstacle({stop.point, stop.point}, request_.chord_error_m);
        no_place_.push_back({TourProblem::Kind::no_place, static_cast<std::size_t>(stop.region), {}, obstacle});
        continue;
      }
      if (turns_too_fast(stop.region, hint)) {
        throw Error(ErrorCode::limits_empty,
                    core::format("no stretch of {:.3g} m was found in the volume of a target on which the camera need "
                                 "not turn by more than {:g} degrees per second",
                                 space_.view_m(), request_.settings.gimbal_rate_deg_s),
                    target.name, "give a larger tour.gimbal.rate or a slower vehicle, or let it be seen from farther");
      }
      throw Error(
          ErrorCode::limits_empty,
          core::format("no stretch of {:.3g} m, and no circle of radius {:g} m, was found that fits in the volume "
                       "of a target",
                       space_.view_m(), space_.limits().turn_radius_m),
          target.name, "ask for a shorter dwell, a slower vehicle or a smaller margin");
    }
    return true;
  }

  /// Whether there are views of a region where the camera may turn as fast as it takes.
  bool turns_too_fast(int region, const ViewHint& hint) {
    TourRequest any_rate = request_;
    any_rate.airspace = nullptr;
    any_rate.settings.gimbal_rate_deg_s = std::numeric_limits<double>::infinity();
    return !WingSpace(any_rate, regions_).draw_views(region, hint, 1, draw_).empty();
  }

  std::vector<View> home_views() const {
    std::vector<View> views;
    constexpr int kHeadings = 16;
    for (int i = 0; i < kHeadings; ++i) {
      View view;
      view.enter = {*request_.home, 2 * std::numbers::pi * i / kHeadings, 0};
      views.push_back(view);
    }
    return views;
  }

  /// The best views of an order; what blocks it is left out. Nothing: `may_stop`, and the time is over.
  std::optional<Candidate> of_order(std::vector<int> order, bool may_stop) {
    Candidate candidate;
    candidate.problems = no_place_;
    std::erase_if(order, [&](int region) { return choices_[static_cast<std::size_t>(region)].empty(); });
    const bool has_home = request_.home.has_value(), closed = request_.settings.closed;
    while (!order.empty()) {
      Choices choices;
      if (has_home) choices.push_back(home_views());
      for (const int region : order) choices.push_back(choices_[static_cast<std::size_t>(region)]);
      if (has_home && closed) choices.push_back(home_views());
      const Choice choice = choose(
          choices, closed && !has_home, space_, progress_, [this] { return is_late(); }, !may_stop);
      if (choice.is_stopped) return std::nullopt;
      if (choice.course) {
        candidate.course = *choice.course;
        candidate.length = length_m(candidate.course, space_);
        break;
      }
      leave_out(order, choice.blocked, candidate);
    }
    return candidate;
  }

  /// Leaves out one of two places between which there is no way: the later one that is not home.
  void leave_out(std::vector<int>& order, std::size_t blocked, Candidate& candidate) const {
    const std::size_t first = request_.home ? 1 : 0;
    const auto region_at = [&](std::size_t place) -> std::optional<std::size_t> {
      if (place < first) return std::nullopt;
      const std::size_t at = place - first;
      if (at < order.size()) return static_cast<std::size_t>(order[at]);
      return request_.home ? std::nullopt : std::optional<std::size_t>(static_cast<std::size_t>(order[0]));
    };
    const std::optional<std::size_t> one = region_at(blocked), other = region_at(blocked + 1);
    const std::size_t gone = other.value_or(one.value_or(static_cast<std::size_t>(order[0])));
    const std::optional<std::size_t> neighbour = other ? one : std::nullopt;
    std::string obstacle;
    if (request_.airspace) {
      const auto place = [&](std::optional<std::size_t> region) {
        return region ? choices_[*region].front().enter.position : *request_.home;
      };
      obstacle = request_.airspace->obstacle({place(neighbour       ? neighbour
                                                    : request_.home ? neighbour
                                                                    : gone),
                                              place(gone)},
                                             request_.chord_error_m);
    }
    candidate.problems.push_back({TourProblem::Kind::no_way, gone, neighbour, obstacle});
    std::erase(order, static_cast<int>(gone));
  }

  /// `has_tour`: of another attempt.
  void improve(const std::vector<Course>& courses, bool has_tour) {
    std::vector<Candidate> candidates;
    const auto add = [&](const std::vector<int>& order) {
      std::optional<Candidate> next = of_order(order, has_tour || best_);
      if (!next) return;
      if (!best_) best_ = *next;
      candidates.push_back(std::move(*next));
    };
    double last = 0;
    std::size_t tried = 0;
    for (const Course& course : courses) {
      if (tried == kMostCourses || (tried > 0 && is_late())) break;
      if (tried > 0 && course.length_m() <= last * (1 + 1e-6)) continue;
      ++tried;
      last = course.length_m();
      std::vector<int> order;
      for (const Stop& stop : course.stops) {
        if (stop.region >= 0) order.push_back(stop.region);
      }
      add(order);
      if (request_.home && !request_.settings.closed) continue;
      std::reverse(order.begin(), order.end());
      add(order);
    }
    if (candidates.empty()) return;
    std::stable_sort(candidates.begin(), candidates.end(), is_better);
    best_ = candidates.front();
    const auto always = [](const WingCourse&) { return true; };
    for (std::size_t i = 0; i < candidates.size() && i < kMostRefined && !is_late(); ++i) {
      Candidate& candidate = candidates[i];
      if (candidate.course.views.empty()) continue;
      refine_candidate(candidate, always);
      if (is_better(candidate, *best_)) best_ = candidate;
    }
    if (best_->course.views.empty() || is_late()) return;
    for (int round = 0; round < 3 && put_elsewhere() && !is_late(); ++round) refine_candidate(*best_, always);
    pass_some();
  }

  static bool is_better(const Candidate& a, const Candidate& b) {
    if (a.problems.size() != b.problems.size()) return a.problems.size() < b.problems.size();
    return a.length < b.length;
  }

  void refine_candidate(Candidate& candidate, const std::function<bool(const WingCourse&)>& keeps) {
    refine(candidate.course, space_, draw_, progress_, keeps, [this] { return is_late(); });
    candidate.length = length_m(candidate.course, space_);
  }

  /// Moves the view of one target to another place of the order, where that shortens the course.
  bool put_elsewhere() {
    bool changed = false;
    for (std::size_t i = 0; i < best_->course.views.size() && !is_late(); ++i) {
      const View view = best_->course.views[i];
      if (view.region == Stop::kFixed || best_->course.views.size() < 4) continue;
      WingCourse rest = best_->course;
      rest.views.erase(rest.views.begin() + static_cast<std::ptrdiff_t>(i));
      if (std::optional<WingCourse> better = inserted(rest, view, best_->length - 1e-3, gap_that_is_blocked(rest, i))) {
        best_->course = std::move(*better);
        best_->length = length_m(best_->course, space_);
        changed = true;
      }
    }
    return changed;
  }

  /// The path of a course past a view that was taken out before view `i`, if it is not clear.
  std::optional<std::size_t> gap_that_is_blocked(const WingCourse& course, std::size_t i) const {
    const std::size_t count = course.views.size(), path = (i + count - 1) % count;
    const bool has_path = path < course.path_count();
    if (!has_path || space_.is_clear(course.views[path], course.views[course.next(path)])) return std::nullopt;
    return path;
  }

  /// With one more view, where it costs least, if the whole is shorter than `most`. `only`: in this path, as it is not
  /// clear itself; all others are.
  std::optional<WingCourse> inserted(const WingCourse& course, const View& view, double most,
                                     std::optional<std::size_t> only) {
    progress_.check();
    const double base = length_m(course, space_);
    std::vector<View> views = choices_[static_cast<std::size_t>(view.region)];
    views.push_back(view);
    struct Try {
      double length;
      std::size_t path, view;
      bool operator<(const Try& other) const { return length < other.length; }
    };
    std::vector<Try> tries;
    for (std::size_t p = 0; p < course.path_count(); ++p) {
      if (only && p != *only) continue;
      const View &a = course.views[p], &b = course.views[course.next(p)];
      const double between = space_.path_m(a, b);
      if (is_late()) return std::nullopt;
      for (std::size_t v = 0; v < views.size(); ++v) {
        const double own = views[v].straight_m + views[v].circles_m;
        const double bound = space_.path_bound_m(a, views[v]) + space_.path_bound_m(views[v], b);
        if (base - between + bound + own >= most) continue;
        const double length = base - between + space_.path_m(a, views[v]) + own + space_.path_m(views[v], b);
        if (length < most) tries.push_back({length, p, v});
      }
    }
    std::sort(tries.begin(), tries.end());
    for (const Try& t : tries) {
      if (is_late()) return std::nullopt;
      if (!space_.is_clear(course.views[t.path], views[t.view])) continue;
      if (!space_.is_clear(views[t.view], course.views[course.next(t.path)])) continue;
      WingCourse result = course;
      result.views.insert(result.views.begin() + static_cast<std::ptrdiff_t>(t.path) + 1, views[t.view]);
      return result;
    }
    return std::nullopt;
  }

  /// Leaves out views of targets that the rest of the course passes for long enough.
  void pass_some() {
    bool changed = false;
    for (std::size_t i = 0; i < best_->course.views.size() && !is_late();) {
      progress_.check();
      const int region = best_->course.views[i].region;
      WingCourse rest = best_->course;
      rest.views.erase(rest.views.begin() + static_cast<std::ptrdiff_t>(i));
      const bool may_go = region != Stop::kFixed && rest.views.size() >= 2 &&
                          space_.is_clear(rest.views[(i + rest.views.size() - 1) % rest.views.size()],
                                          rest.views[i % rest.views.size()]);
      passed_.push_back(region);
      if (may_go && length_m(rest, space_) < best_->length && views_of(rest)) {
        best_->course = std::move(rest);
        best_->length = length_m(best_->course, space_);
        changed = true;
      } else {
        passed_.pop_back();
        ++i;
      }
    }
    if (changed && !is_late()) {
      refine_candidate(*best_, [&](const WingCourse& course) { return views_of(course).has_value(); });
    }
  }

  /// All views along a course, of the targets that it passes too; nothing where one of these is not viewed for long
  /// enough.
  std::optional<std::vector<TourVisit>> views_of(const WingCourse& course) const {
    const Layout layout = layout_of(course, space_);
    const Polyline way(layout.points);
    std::vector<TourVisit> visits;
    std::vector<Stretch> taken;
    const double dwell = request_.settings.dwell_s;
    for (std::size_t i = 0; i < course.views.size(); ++i) {
      if (course.views[i].region == Stop::kFixed) continue;
      const auto [first, last] = layout.views[i];
      visits.push_back({static_cast<std::size_t>(course.views[i].region), first, last, way.station(first),
                        way.station(last), dwell});
      if (!request_.settings.simultaneous) taken.push_back({way.station(first), way.station(last)});
    }
    for (const int region : passed_) {
      const std::optional<TourVisit> visit = passing(region, way, taken);
      if (!visit) return std::nullopt;
      visits.push_back(*visit);
      if (!request_.settings.simultaneous) taken.push_back({visit->begin_m, visit->end_m});
    }
    std::stable_sort(visits.begin(), visits.end(),
                     [](const TourVisit& a, const TourVisit& b) { return a.begin_m < b.begin_m; });
    return visits;
  }

  static bool overlaps(double begin, double end, const std::vector<Stretch>& taken) {
    return std::any_of(taken.begin(), taken.end(),
                       [&](const Stretch& other) { return begin < other.end_m && end > other.begin_m; });
  }

  /// Whole chords in the region, as long as the dwell, while no other target is viewed.
  std::optional<TourVisit> passing(int region, const Polyline& way, const std::vector<Stretch>& taken) const {
    const auto target = static_cast<std::size_t>(region);
    for (const Stretch& stretch : stretches_in(*regions_[target], way)) {
      constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
      std::size_t first = kNowhere;  // of the points that follow each other in the stretch
      for (std::size_t i = 0; i < way.points().size(); ++i) {
        const double station = way.station(i);
        if (station < stretch.begin_m || station > stretch.end_m) {
          first = kNowhere;
          continue;
        }
        if (first != kNowhere && !space_.can_follow(region, {way.points()[i - 1], way.points()[i]}, Vec3::Zero()))
          first = i;
        if (first == kNowhere || overlaps(way.station(first), station, taken)) first = i;
        // Chords are shorter than the curve: on the safe side.
        if (station - way.station(first) < space_.view_m()) continue;
        if (overlaps(way.station(first), station, taken)) continue;
        if (first == i && i + 1 < way.points().size()) {
          const Vec3 along = (way.points()[i + 1] - way.points()[i]).normalized();
          if (!space_.can_follow(region, {way.points()[i]}, along)) continue;
        }
        return TourVisit{target, first, i, way.station(first), station, request_.settings.dwell_s};
      }
    }
    return std::nullopt;
  }

  /// The best tour. Where it breaks a limit, views are chosen anew, then what breaks a limit is left out.
  Tour sound_tour() {
    for (bool is_best = true;; is_best = false) {
      Tour tour = flown();
      const std::vector<Breach> breaches = breaches_of(tour);
      if (breaches.empty()) return tour;
      check_has_visits(tour);
      std::vector<TourProblem> problems = best_->problems;
      std::vector<int> order;
      for (const std::size_t target : tour.order) order.push_back(static_cast<int>(target));
      if (!is_best) {
        problems.push_back(problem_of(tour, breaches.front(), request_, request_.chord_error_m));
        std::erase(order, static_cast<int>(problems.back().target));
      }
      Candidate next = *of_order(order, false);
      const auto add = [&](const TourProblem& problem) {
        const bool is_told = std::any_of(problems.begin(), problems.end(),
                                         [&](const TourProblem& other) { return other.target == problem.target; });
        const bool is_asked = std::find(order.begin(), order.end(), static_cast<int>(problem.target)) != order.end();
        if (is_asked && !is_told) problems.push_back(problem);
      };
      std::for_each(next.problems.begin(), next.problems.end(), add);
      // For these no view was drawn in the last attempt, or its time was over before it told why.
      for (const int region : order) {
        const auto target = static_cast<std::size_t>(region);
        if (choices_[target].empty()) add({TourProblem::Kind::no_place, target, std::nullopt, ""});
      }
      next.problems = std::move(problems);
      best_ = std::move(next);
      passed_.clear();
    }
  }

  Tour flown() const {
    Tour tour;
    tour.end = end_;
    tour.problems = best_->problems;
    const WingCourse& course = best_->course;
    if (course.views.empty()) return tour;
    const Layout layout = layout_of(course, space_);
    tour.flight.chord_error_m = request_.chord_error_m;
    for (const Vec3& position : layout.points) {
      FlightPoint point;
      point.position = position;
      if (!tour.flight.points.empty()) point.speed_m_s = request_.settings.vehicle.speed_m_s;
      tour.flight.points.push_back(point);
    }
    const std::optional<std::vector<TourVisit>> visits = views_of(course);
    if (!visits) throw Error(ErrorCode::internal_defect, "a tour does not pass what it is to pass", "", "");
    tour.visits = *visits;
    for (const TourVisit& visit : tour.visits) tour.order.push_back(visit.target);
    tour.length_m = length_m(course, space_);
    tour.time_s = tour.length_m / request_.settings.vehicle.speed_m_s;
    return tour;
  }

  /// All legs and all visits, as they are in the flight.
  std::vector<Breach> breaches_of(const Tour& tour) const {
    std::vector<Breach> breaches = breaches_of_legs(tour, request_, request_.chord_error_m);
    for (std::size_t i = 0; i < tour.visits.size(); ++i) {
      if (!is_kept(tour.visits[i], tour.flight)) breaches.push_back({std::nullopt, i});
    }
    return breaches;
  }

  bool is_kept(const TourVisit& visit, const Flight& flight) const {
    const TourRegion& region = *regions_[visit.target];
    for (std::size_t i = visit.first_point; i < visit.last_point; ++i) {
      const Leg leg = flight.leg(i);
      if (!region.holds_leg(leg)) return false;
      if (!space_.can_follow(static_cast<int>(visit.target), {leg.from, leg.to}, Vec3::Zero())) return false;
    }
    return region.holds(flight.points[visit.first_point].position);
  }

  const TourRequest& request_;
  const core::ProgressReporter& progress_;
  core::Stopwatch watch_;
  Regions regions_;
  WingSpace space_;
  SplitMix64 draw_;
  std::vector<std::vector<View>> choices_;  ///< of each target
  std::vector<TourProblem> no_place_;
  std::optional<Candidate> best_;
  std::vector<int> passed_;  ///< targets that are viewed in passing
  Tour::End end_ = Tour::End::done;
};

}  // namespace

Tour plan_wing_tour(const TourRequest& request, const core::ProgressReporter& progress) {
  return WingPlan(request, progress).run();
}

}  // namespace vantage::internal::flight::tour
