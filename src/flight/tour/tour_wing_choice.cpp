#include "flight/tour/tour_wing_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace vantage::internal::flight::tour {
namespace {

constexpr double kImpossible = std::numeric_limits<double>::infinity();
constexpr double kHalfCircle = std::numbers::pi;

/// Lengths from each view of a place to each of the next one, the latter's own length with them: bounds, until more is
/// asked.
class Lengths {
 public:
  Lengths(const std::vector<View>& from, const std::vector<View>& to, const WingSpace& space)
      : columns_(to.size()), values_(from.size() * to.size()), is_known_(values_.size(), false) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      for (std::size_t j = 0; j < columns_; ++j)
        values_[i * columns_ + j] = space.path_bound_m(from[i], to[j]) + own(to[j]);
    }
  }
  double at(std::size_t i, std::size_t j) const { return values_[i * columns_ + j]; }
  bool is_blocked() const {
    return std::all_of(values_.begin(), values_.end(), [](double v) { return v == kImpossible; });
  }
  /// Finds out the length, infinite where the path is not clear. Returns whether it was known before.
  bool know(std::size_t i, std::size_t j, const View& from, const View& to, const WingSpace& space) {
    const std::size_t index = i * columns_ + j;
    if (is_known_[index]) return true;
    is_known_[index] = true;
    values_[index] = space.is_clear(from, to) ? space.path_m(from, to) + own(to) : kImpossible;
    return false;
  }

 private:
  static double own(const View& view) { return view.straight_m + view.circles_m; }

  std::size_t columns_;
  std::vector<double> values_;
  std::vector<bool> is_known_;
};

struct Picked {
  double length = kImpossible;
  std::vector<std::size_t> views;
};

/// The shortest sequence that begins with one view of the first place; it ends in any of the last one, or closes.
Picked pick_from(std::size_t start, const Choices& choices, const std::vector<Lengths>& lengths, bool cyclic) {
  const std::size_t places = choices.size();
  std::vector<double> cost(choices[0].size(), kImpossible);
  cost[start] = 0;
  std::vector<std::vector<std::size_t>> came(places);
  for (std::size_t p = 1; p < places; ++p) {
    std::vector<double> next(choices[p].size(), kImpossible);
    came[p].assign(choices[p].size(), 0);
    for (std::size_t i = 0; i < cost.size(); ++i) {
      if (cost[i] == kImpossible) continue;
      for (std::size_t j = 0; j < next.size(); ++j) {
        const double sum = cost[i] + lengths[p - 1].at(i, j);
        if (sum >= next[j]) continue;
        next[j] = sum;
        came[p][j] = i;
      }
    }
    cost = std::move(next);
  }
  Picked best;
  std::size_t last = 0;
  for (std::size_t j = 0; j < cost.size(); ++j) {
    const double sum = cyclic ? cost[j] + lengths.back().at(j, start) : cost[j];
    if (sum >= best.length) continue;
    best.length = sum;
    last = j;
  }
  if (best.length == kImpossible) return best;
  best.views.assign(places, last);
  for (std::size_t p = places - 1; p > 0; --p) best.views[p - 1] = came[p][best.views[p]];
  return best;
}

Picked pick(const Choices& choices, const std::vector<Lengths>& lengths, bool cyclic) {
  Picked best;
  for (std::size_t start = 0; start < choices[0].size(); ++start) {
    Picked picked = pick_from(start, choices, lengths, cyclic);
    if (picked.length < best.length) best = std::move(picked);
  }
  return best;
}

/// One view, and how far it is moved and turned at a time.
struct Steps {
  Vec3 move;
  double turn, climb;
};

class Refinement {
 public:
  Refinement(WingCourse& course, const WingSpace& space, SplitMix64& draw, const core::ProgressReporter& progress,
             const std::function<bool(const WingCourse&)>& keeps, const IsOver& is_over)
      : course_(course), space_(space), draw_(draw), progress_(progress), keeps_(keeps), is_over_(is_over) {}

  void choose_again() {
    constexpr std::size_t kViewsTried = 12;
    for (const double spread : {0.3, 0.1, 0.03}) {
      progress_.check();
      Choices choices;
      for (const View& view : course_.views) {
        if (is_over_()) return;
        std::vector<View> some = {view};
        if (view.region == Stop::kFixed) {
          for (std::size_t i = 1; i < kViewsTried; ++i) {
            View turned = view;
            turned.enter.heading_rad += spread * kHalfCircle * draw_.uniform(-1, 1);
            some.push_back(turned);
          }
        } else if (view.circles_m <= 0) {
          const Vec3 middle = (view.enter.position + leave(view).position) / 2;
          const ViewHint hint = {middle, view.enter.heading_rad, spread};
          for (const View& other : space_.draw_views(view.region, hint, kViewsTried, draw_)) some.push_back(other);
        }
        choices.push_back(std::move(some));
      }
      const Choice choice = choose(choices, course_.cyclic, space_, progress_, is_over_, false);
      if (choice.is_stopped) return;
      if (!choice.course) continue;
      if (length_m(*choice.course, space_) < length_m(course_, space_) && keeps_(*choice.course)) {
        course_ = *choice.course;
      }
    }
  }

  void move_views() {
    const std::size_t count = course_.views.size();
    std::vector<double> paths(course_.path_count());
    for (std::size_t i = 0; i < paths.size(); ++i) paths[i] = path_m(i);
    std::vector<Steps> steps(count, {Vec3(30, 30, 15), 0.5, 0.1});
    constexpr std::size_t kForEach = 600, kForEachRound = 10;
    const auto rounds = static_cast<std::size_t>(space_.request().rounds);
    const std::size_t for_each = rounds > 0 ? std::min(kForEach, kForEachRound * rounds) : kForEach;
    for (std::size_t round = 0; round < for_each * count && !is_over_(); ++round) {
      progress_.check();
      const std::size_t i = draw_.below(count);
      const bool better = move_view(i, steps[i], paths);
      const double factor = better ? 1.4 : 0.985;
      steps[i].move *= factor;
      steps[i].turn = std::min(1.0, steps[i].turn * factor);
      steps[i].climb = std::min(0.2, steps[i].climb * factor);
    }
  }

 private:
  double path_m(std::size_t i) const { return space_.path_m(course_.views[i], course_.views[course_.next(i)]); }

  View moved(const View& view, const Steps& steps) {
    View next = view;
    const auto bell = [&] { return draw_.unit() + draw_.unit() + draw_.unit() - 1.5; };
    const std::size_t kind = draw_.below(3);
    const bool is_free = view.region != Stop::kFixed;
    if (is_free && kind != 1) next.enter.position += steps.move.cwiseProduct(Vec3(bell(), bell(), bell()));
    if (!is_free || kind != 0) next.enter.heading_rad += steps.turn * bell();
    const bool may_climb = is_free && view.straight_m <= 0 && view.circles_m <= 0;
    if (may_climb && kind != 0) {
      next.enter.climb_rad = std::clamp(next.enter.climb_rad + steps.climb * bell(), space_.limits().lowest_climb_rad,
                                        space_.limits().highest_climb_rad);
    }
    if (may_climb) {
      const TourRegion& region = *space_.regions()[static_cast<std::size_t>(view.region)];
      if (!region.holds(next.enter.position)) {
        next.enter.position = region.touch(next.enter.position, next.enter.position);
      }
    }
    return next;
  }

  bool move_view(std::size_t i, const Steps& steps, std::vector<double>& paths) {
    const std::size_t count = course_.views.size();
    const bool has_before = i > 0 || course_.cyclic, has_after = i + 1 < count || course_.cyclic;
    const std::size_t before = (i + count - 1) % count;
    const View old = course_.views[i], next = moved(old, steps);
    if (count < 2 && course_.cyclic) return false;
    const double least = (has_before ? paths[before] : 0) + (has_after ? paths[i] : 0);
    const double bound = (has_before ? space_.path_bound_m(course_.views[before], next) : 0) +
                         (has_after ? space_.path_bound_m(next, course_.views[course_.next(i)]) : 0);
    if (bound >= least) return false;
    const double in = has_before ? space_.path_m(course_.views[before], next) : 0;
    if (in >= least) return false;
    const double out = has_after ? space_.path_m(next, course_.views[course_.next(i)]) : 0;
    if (in + out >= least - 1e-6 || !space_.is_valid(next)) return false;
    if (has_before && !space_.is_clear(course_.views[before], next)) return false;
    if (has_after && !space_.is_clear(next, course_.views[course_.next(i)])) return false;
    course_.views[i] = next;
    if (!keeps_(course_)) {
      course_.views[i] = old;
      return false;
    }
    if (has_before) paths[before] = in;
    if (has_after) paths[i] = out;
    return true;
  }

  WingCourse& course_;
  const WingSpace& space_;
  SplitMix64& draw_;
  const core::ProgressReporter& progress_;
  const std::function<bool(const WingCourse&)>& keeps_;
  const IsOver& is_over_;
};

}  // namespace

double length_m(const WingCourse& course, const WingSpace& space) {
  double length = 0;
  for (const View& view : course.views) length += view.straight_m + view.circles_m;
  for (std::size_t i = 0; i < course.path_count(); ++i) {
    length += space.path_m(course.views[i], course.views[course.next(i)]);
  }
  return length;
}

Choice choose(const Choices& choices, bool cyclic, const WingSpace& space, const core::ProgressReporter& progress,
              const IsOver& is_over, bool must_find) {
  const std::size_t places = choices.size();
  std::vector<Lengths> lengths;
  for (std::size_t p = 0; p + 1 < places; ++p) {
    progress.check();
    lengths.emplace_back(choices[p], choices[p + 1], space);
  }
  if (cyclic) lengths.emplace_back(choices.back(), choices.front(), space);
  const auto next = [&](std::size_t p) { return (p + 1) % places; };
  for (;;) {
    progress.check();
    const Picked picked = pick(choices, lengths, cyclic);
    if (picked.views.empty()) break;
    bool is_known = true, is_clear = true;
    for (std::size_t p = 0; p < lengths.size(); ++p) {
      if (!must_find && is_over()) return {std::nullopt, 0, true};
      const std::size_t i = picked.views[p], j = picked.views[next(p)];
      if (!lengths[p].know(i, j, choices[p][i], choices[next(p)][j], space)) is_known = false;
      is_clear = is_clear && lengths[p].at(i, j) < kImpossible;
    }
    // Later on it may turn out that another one is shorter.
    if (!is_known && !(is_clear && is_over())) continue;
    WingCourse course;
    course.cyclic = cyclic;
    for (std::size_t p = 0; p < places; ++p) course.views.push_back(choices[p][picked.views[p]]);
    return {course, 0, false};
  }
  std::size_t blocked = 0;
  for (std::size_t p = lengths.size(); p > 0; --p) {
    if (lengths[p - 1].is_blocked()) blocked = p - 1;
  }
  return {std::nullopt, blocked, false};
}

void refine(WingCourse& course, const WingSpace& space, SplitMix64& draw, const core::ProgressReporter& progress,
            const std::function<bool(const WingCourse&)>& keeps, const IsOver& is_over) {
  Refinement refinement(course, space, draw, progress, keeps, is_over);
  refinement.choose_again();
  refinement.move_views();
}

}  // namespace vantage::internal::flight::tour
