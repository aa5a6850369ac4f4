#include "flight/tour/tour_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "flight/tour/tour_detour.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr double kGain = 1e-9;  ///< of the length: less is rounding

double distance(const Vec3* a, const Vec3& b) { return a ? (*a - b).norm() : 0; }

/// Stops `first` to `last` the other way round.
double gain_of_reversal(const Course& course, std::size_t first, std::size_t last) {
  const Vec3 *before = course.before(first), *after = course.after(last);
  const Vec3 &a = course.stops[first].point, &b = course.stops[last].point;
  return distance(before, a) + distance(after, b) - distance(before, b) - distance(after, a);
}

bool reverse_parts(Course& course) {
  bool changed = false;
  const std::size_t count = course.stops.size();
  const double least = kGain * course.length_m();
  for (std::size_t first = course.first_free(); first + 1 < count; ++first) {
    for (std::size_t last = first + 1; last < count; ++last) {
      if (course.closed && first == 0 && last + 1 == count) continue;
      if (gain_of_reversal(course, first, last) <= least) continue;
      std::reverse(course.stops.begin() + static_cast<std::ptrdiff_t>(first),
                   course.stops.begin() + static_cast<std::ptrdiff_t>(last) + 1);
      changed = true;
    }
  }
  return changed;
}

/// Takes `taken` stops from `first` on and puts them, either way round, where that shortens the way most.
bool move_part(Course& course, std::size_t first, std::size_t taken) {
  const std::size_t count = course.stops.size(), last = first + taken - 1;
  const Vec3 *before = course.before(first), *after = course.after(last);
  const Vec3 a = course.stops[first].point, b = course.stops[last].point;
  const double gain = distance(before, a) + distance(after, b) - (before && after ? (*before - *after).norm() : 0);
  double best = kGain * course.length_m();
  std::size_t target = count;
  bool turned = false;
  Course rest = course;
  rest.stops.erase(rest.stops.begin() + static_cast<std::ptrdiff_t>(first),
                   rest.stops.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  if (rest.stops.empty()) return false;
  const std::size_t left = rest.stops.size();
  for (std::size_t at = rest.first_free(); at <= left; ++at) {
    const Vec3* p = at > 0 ? &rest.stops[at - 1].point : rest.closed ? &rest.stops[left - 1].point : nullptr;
    const Vec3* q = at < left ? &rest.stops[at].point : rest.closed ? &rest.stops[0].point : nullptr;
    const double between = p && q ? (*p - *q).norm() : 0;
    const double straight = distance(p, a) + distance(q, b) - between, back = distance(p, b) + distance(q, a) - between;
    const double total = gain - std::min(straight, back);
    if (total <= best) continue;
    best = total;
    target = at;
    turned = back < straight;
  }
  if (target == count) return false;
  std::vector<Stop> part(course.stops.begin() + static_cast<std::ptrdiff_t>(first),
                         course.stops.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  if (turned) std::reverse(part.begin(), part.end());
  rest.stops.insert(rest.stops.begin() + static_cast<std::ptrdiff_t>(target), part.begin(), part.end());
  course = std::move(rest);
  return true;
}

bool move_parts(Course& course) {
  bool changed = false;
  for (std::size_t taken = 1; taken <= 3; ++taken) {
    for (std::size_t first = course.first_free(); first + taken <= course.stops.size(); ++first) {
      changed = move_part(course, first, taken) || changed;
    }
  }
  return changed;
}

}  // namespace

const Vec3* Course::before(std::size_t i) const {
  if (i > 0) return &stops[i - 1].point;
  return closed && stops.size() > 1 ? &stops.back().point : nullptr;
}

const Vec3* Course::after(std::size_t i) const {
  if (i + 1 < stops.size()) return &stops[i + 1].point;
  return closed && stops.size() > 1 ? &stops.front().point : nullptr;
}

double Course::length_m() const {
  double length = 0;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) length += (stops[i + 1].point - stops[i].point).norm();
  if (closed && stops.size() > 1) length += (stops.front().point - stops.back().point).norm();
  return length;
}

void settle_stop(Course& course, const Regions& regions, std::size_t i, double smoothing_m) {
  Stop& stop = course.stops[i];
  if (stop.region == Stop::kFixed) return;
  const Vec3 *a = course.before(i), *b = course.after(i);
  if (!a && !b) return;
  const TourRegion& region = *regions[static_cast<std::size_t>(stop.region)];
  stop.point = region.touch(a ? *a : *b, b ? *b : *a, smoothing_m, &stop.point);
}

double settle_once(Course& course, const Regions& regions, double smoothing_m) {
  for (std::size_t i = 0; i < course.stops.size(); ++i) settle_stop(course, regions, i, smoothing_m);
  return course.length_m();
}

Course settled(const Course& course, const Regions& regions) {
  Course best = course;
  double least = course.length_m();
  const double leg = least / static_cast<double>(std::max<std::size_t>(1, course.stops.size()));
  Course moving = course;
  constexpr int kMostSweeps = 40;
  for (const double share : {0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 0.0}) {
    double before = std::numeric_limits<double>::infinity();
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      const double length = settle_once(moving, regions, share * leg);
      if (length < least) {
        least = length;
        best = moving;
      }
      const double enough = std::max(1e-8, 1e-4 * share) * length;
      if (std::abs(before - length) <= enough) break;
      before = length;
    }
  }
  return best;
}

Place best_place(const Course& course, const TourRegion& region, std::size_t skip) {
  struct Candidate {
    double bound;
    std::size_t before;
  };
  const std::size_t count = course.stops.size();
  const auto ends = [&](std::size_t at) {
    const Vec3* a = at > 0 ? &course.stops[at - 1].point : course.closed ? &course.stops[count - 1].point : nullptr;
    const Vec3* b = at < count ? &course.stops[at].point : course.closed ? &course.stops[0].point : nullptr;
    return std::pair(a, b);
  };
  std::vector<Candidate> candidates;
  for (std::size_t at = course.first_free(); at <= count; ++at) {
    if (course.closed && at == 0) continue;  // the same as at the end
    const auto [a, b] = ends(at);
    const double bound =
        a && b ? region.touch_bound_m(*a, *b) - (*a - *b).norm() : region.touch_bound_m(a ? *a : *b, a ? *a : *b) / 2;
    candidates.push_back({bound, at});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.bound < b.bound; });
  Place best;
  best.detour_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = std::min(skip, candidates.size() - 1); i < candidates.size(); ++i) {
    if (candidates[i].bound >= best.detour_m || best.detour_m <= 0) break;
    const auto [a, b] = ends(candidates[i].before);
    const Vec3 &from = a ? *a : *b, &to = b ? *b : *a;
    const Vec3 point = region.touch(from, to);
    const double detour =
        a && b ? std::max(0.0, way_length(from, point, to, 0) - (from - to).norm()) : (from - point).norm();
    if (detour < best.detour_m) best = {candidates[i].before, point, detour};
  }
  return best;
}

void insert(Course& course, int region, const Place& place) {
  course.stops.insert(course.stops.begin() + static_cast<std::ptrdiff_t>(place.before), {region, place.point});
}

bool exchange(Course& course) {
  bool changed = false;
  constexpr int kMostRounds = 50;
  for (int round = 0; round < kMostRounds; ++round) {
    const bool reversed = reverse_parts(course), moved = move_parts(course);
    if (!reversed && !moved) break;
    changed = true;
  }
  return changed;
}

}  // namespace vantage::internal::flight::tour
