#include "flight/tour/tour_obstacles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "flight/tour/tour_detour.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr double kFarthest = std::numeric_limits<double>::infinity();

double length_of(const std::vector<Vec3>& points) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) length += (points[i + 1] - points[i]).norm();
  return length;
}

Vec3 nearest_on_leg(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 along = b - a;
  const double square = along.squaredNorm();
  return square > 0 ? Vec3(a + std::clamp(along.dot(point - a) / square, 0.0, 1.0) * along) : a;
}

/// Shortens a way between fixed ends: leaves out bends, cuts corners, pulls bends towards the straight line.
void pull_tight(std::vector<Vec3>& points, const Airspace& airspace, SplitMix64& draw) {
  const auto allows = [&](const Vec3& a, const Vec3& b) { return airspace.allows({a, b}, 0); };
  const auto leave_out = [&] {
    for (std::size_t i = 1; i + 1 < points.size();) {
      if (allows(points[i - 1], points[i + 1])) {
        points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
  };
  leave_out();
  constexpr int kCorners = 60, kPulls = 12, kHalvings = 8;
  for (int i = 0; i < kCorners && points.size() > 2; ++i) {
    // From a place before a bend to one after it.
    const std::size_t bend = 1 + draw.below(points.size() - 2);
    const Vec3 a = points[bend] + draw.unit() * (points[bend - 1] - points[bend]);
    const Vec3 b = points[bend] + draw.unit() * (points[bend + 1] - points[bend]);
    if (!allows(points[bend - 1], a) || !allows(a, b) || !allows(b, points[bend + 1])) continue;
    points[bend] = a;
    points.insert(points.begin() + static_cast<std::ptrdiff_t>(bend) + 1, b);
    leave_out();
  }
  for (int i = 0; i < kPulls; ++i) {
    const double before = length_of(points);
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
      const Vec3 to = nearest_on_leg(points[k - 1], points[k + 1], points[k]);
      double share = 1;
      for (int h = 0; h < kHalvings; ++h, share /= 2) {
        const Vec3 moved = points[k] + share * (to - points[k]);
        if (!allows(points[k - 1], moved) || !allows(moved, points[k + 1])) continue;
        points[k] = moved;
        break;
      }
    }
    leave_out();
    if (before - length_of(points) <= 1e-4 * before) break;
  }
}

class LazyRoadmap {
 public:
  LazyRoadmap(const Airspace& airspace, std::vector<Vec3> nodes) : airspace_(airspace), nodes_(std::move(nodes)) {
    const std::size_t count = nodes_.size();
    edges_.resize(count);
    constexpr std::size_t kNeighbours = 14;
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<std::pair<double, std::size_t>> others;
      for (std::size_t j = 0; j < count; ++j) {
        if (j != i) others.emplace_back((nodes_[i] - nodes_[j]).norm(), j);
      }
      const auto end = others.begin() + static_cast<std::ptrdiff_t>(std::min(kNeighbours, others.size()));
      std::partial_sort(others.begin(), end, others.end());
      for (auto it = others.begin(); it != end; ++it) {
        edges_[i].push_back({it->second, it->first, Edge::State::unknown});
        edges_[it->second].push_back({i, it->first, Edge::State::unknown});
      }
    }
  }

  /// From node 0 to node 1.
  std::optional<std::vector<Vec3>> way(const core::ProgressReporter& progress) {
    for (;;) {
      progress.check();
      const std::vector<std::size_t> found = shortest();
      if (found.empty()) return std::nullopt;
      bool is_free = true;
      for (std::size_t i = 0; i + 1 < found.size() && is_free; ++i) is_free = check(found[i], found[i + 1]);
      if (!is_free) continue;
      std::vector<Vec3> points;
      for (const std::size_t node : found) points.push_back(nodes_[node]);
      return points;
    }
  }

 private:
  struct Edge {
    enum class State { unknown, free, blocked };
    std::size_t to;
    double length;
    State state;
  };

  /// As it is flown: the other way round, rounding may decide otherwise.
  bool check(std::size_t from, std::size_t to) {
    Edge::State state = Edge::State::unknown;
    for (const Edge& edge : edges_[from]) {
      if (edge.to == to && edge.state != Edge::State::unknown) state = edge.state;
    }
    if (state == Edge::State::unknown) {
      state = airspace_.allows({nodes_[from], nodes_[to]}, 0) ? Edge::State::free : Edge::State::blocked;
    }
    for (Edge& edge : edges_[from]) {
      if (edge.to == to) edge.state = state;
    }
    return state == Edge::State::free;
  }

  std::vector<std::size_t> shortest() const {
    std::vector<double> cost(nodes_.size(), kFarthest);
    std::vector<std::size_t> from(nodes_.size(), 0);
    using Waiting = std::pair<double, std::size_t>;
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> open;
    cost[0] = 0;
    open.emplace((nodes_[0] - nodes_[1]).norm(), 0);
    std::vector<bool> done(nodes_.size(), false);
    while (!open.empty()) {
      const std::size_t node = open.top().second;
      open.pop();
      if (done[node]) continue;
      done[node] = true;
      if (node == 1) break;
      for (const Edge& edge : edges_[node]) {
        if (edge.state == Edge::State::blocked || cost[node] + edge.length >= cost[edge.to]) continue;
        cost[edge.to] = cost[node] + edge.length;
        from[edge.to] = node;
        open.emplace(cost[edge.to] + (nodes_[edge.to] - nodes_[1]).norm(), edge.to);
      }
    }
    if (cost[1] == kFarthest) return {};
    std::vector<std::size_t> path = {1};
    while (path.back() != 0) path.push_back(from[path.back()]);
    std::reverse(path.begin(), path.end());
    return path;
  }

  const Airspace& airspace_;
  std::vector<Vec3> nodes_;
  std::vector<std::vector<Edge>> edges_;
};

/// Up, across, and down again: the lowest such way.
std::optional<std::vector<Vec3>> way_over(const Airspace& airspace, const Leg& leg) {
  const double base = std::max(leg.from.z(), leg.to.z()), length = (leg.to - leg.from).norm();
  const double top = std::min(airspace.bounds().max.z(), base + std::max(500.0, length));
  for (double rise = std::max(0.5, length / 100); base + rise <= top; rise *= 1.3) {
    Vec3 a = leg.from, b = leg.to;
    a.z() = b.z() = base + rise;
    // Slanted first: it is shorter.
    for (const double lean : {0.4, 0.2, 0.0}) {
      const Vec3 over_a = a + lean * (b - a), over_b = b + lean * (a - b);
      if (airspace.allows({over_a, over_b}, 0) && airspace.allows({leg.from, over_a}, 0) &&
          airspace.allows({over_b, leg.to}, 0)) {
        return std::vector<Vec3>{leg.from, over_a, over_b, leg.to};
      }
    }
  }
  return std::nullopt;
}

/// A place in the spheroid with its foci at the ends of the leg, inside the bounds.
Vec3 draw_about(const Leg& leg, double reach, const Box& bounds, SplitMix64& draw) {
  Vec3 middle = (leg.from + leg.to) / 2;
  for (int i = 0; i < 64; ++i) {
    const Vec3 offset(draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1));
    Vec3 point = (middle + reach / 2 * offset).cwiseMax(bounds.min).cwiseMin(bounds.max);
    if ((point - leg.from).norm() + (point - leg.to).norm() <= reach) return point;
  }
  return middle;
}

class ClearFlight {
 public:
  ClearFlight(const Course& course, const CourseLimits& limits, SplitMix64& draw,
              const core::ProgressReporter& progress, const std::function<bool()>& is_late)
      : course_(course), limits_(limits), draw_(draw), progress_(progress), is_late_(is_late) {}

  FlownCourse run() {
    if (!limits_.airspace) return {course_, {}};
    for (std::size_t i = 0; i < course_.stops.size();) {
      progress_.check();
      if (make_allowed(i)) {
        ++i;
      } else {
        leave_out(i, TourProblem::Kind::no_place, std::nullopt, obstacle_at(i));
      }
    }
    while (!put_bends_in()) {
    }
    shorten(course_, limits_);
    return {course_, problems_};
  }

 private:
  std::string obstacle_at(std::size_t i) const {
    const Vec3& point = course_.stops[i].point;
    return limits_.airspace->obstacle({point, point}, 0);
  }

  /// An allowed place of the region, near where the way is shortest.
  bool make_allowed(std::size_t i) {
    Stop& stop = course_.stops[i];
    if (limits_.allows(stop.point, stop.point)) return true;
    if (stop.region == Stop::kFixed) return false;
    const TourRegion& region = *limits_.regions[static_cast<std::size_t>(stop.region)];
    const Vec3 wanted = stop.point;
    std::optional<Vec3> best;
    const auto offer = [&](const Vec3& point) {
      if (best && (point - wanted).squaredNorm() >= (*best - wanted).squaredNorm()) return;
      if (limits_.allows(point, point) && region.holds(point)) best = point;
    };
    for (const Vec3& anchor : region.anchors()) offer(anchor);
    constexpr int kDraws = 400;
    const Box box = region.box();
    for (int k = 0; k < kDraws; ++k) {
      // Near the wanted place first, then anywhere.
      const double share = std::min(1.0, (k + 1.0) / (kDraws / 2.0));
      const Vec3 low = wanted + share * (box.min - wanted), high = wanted + share * (box.max - wanted);
      offer({draw_.uniform(low.x(), high.x()), draw_.uniform(low.y(), high.y()), draw_.uniform(low.z(), high.z())});
    }
    if (!best) return false;
    stop.point = *best;
    return true;
  }

  std::optional<std::size_t> neighbour_of(std::size_t stop) const {
    const int region = course_.stops[stop].region;
    return region >= 0 ? std::optional<std::size_t>(static_cast<std::size_t>(region)) : std::nullopt;
  }

  void leave_out(std::size_t i, TourProblem::Kind kind, std::optional<std::size_t> neighbour, std::string obstacle) {
    problems_.push_back({kind, static_cast<std::size_t>(course_.stops[i].region), neighbour, std::move(obstacle)});
    course_.stops.erase(course_.stops.begin() + static_cast<std::ptrdiff_t>(i));
  }

  /// False where a stop had to go: the legs are then to be looked at again.
  bool put_bends_in() {
    std::erase_if(course_.stops, [](const Stop& stop) { return stop.region == kBend; });
    const std::size_t count = course_.stops.size();
    if (count < 2) return true;
    std::vector<Stop> stops;
    for (std::size_t i = 0; i < count; ++i) {
      progress_.check();
      stops.push_back(course_.stops[i]);
      if (i + 1 == count && !course_.closed) break;
      const std::size_t next = (i + 1) % count;
      const Vec3 from = course_.stops[i].point, to = course_.stops[next].point;
      if (limits_.allows(from, to)) continue;
      if (const auto& way = way_between(i, next)) {
        for (const Vec3& point : *way) stops.push_back({kBend, point});
        continue;
      }
      // Home stays; else the one that comes later goes.
      const std::size_t gone = course_.stops[next].region == Stop::kFixed || next == 0 ? i : next;
      const std::size_t other = gone == i ? next : i;
      leave_out(gone, TourProblem::Kind::no_way, neighbour_of(other), limits_.airspace->obstacle({from, to}, 0));
      return false;
    }
    course_.stops = std::move(stops);
    return true;
  }

  /// Each is looked for once, however often legs are looked at again.
  const std::optional<std::vector<Vec3>>& way_between(std::size_t i, std::size_t next) {
    const Vec3 &from = course_.stops[i].point, &to = course_.stops[next].point;
    const auto [known, is_new] = ways_.try_emplace({from.x(), from.y(), from.z(), to.x(), to.y(), to.z()});
    if (is_new) {
      const Effort effort = is_late_() ? Effort::little : Effort::full;
      known->second = find_way(*limits_.airspace, {from, to}, draw_, progress_, effort);
    }
    return known->second;
  }

  Course course_;
  const CourseLimits& limits_;
  SplitMix64& draw_;
  const core::ProgressReporter& progress_;
  const std::function<bool()>& is_late_;
  std::map<std::array<double, 6>, std::optional<std::vector<Vec3>>> ways_;  ///< by their ends
  std::vector<TourProblem> problems_;
};

struct JoinedBend {
  Vec3 point;
  double longer_m;  ///< than before
};

/// Where the lines of two legs come nearest to each other: from[0] to from[1], and to[0] to to[1]; both go on.
std::optional<Vec3> crossing(const std::array<Vec3, 2>& from, const std::array<Vec3, 2>& to) {
  const Vec3 u = from[1] - from[0], v = to[1] - to[0], w = to[0] - from[0];
  const double square = u.cross(v).squaredNorm();
  if (!(square > 0)) return std::nullopt;
  const Vec3 normal = u.cross(v);
  const double s = w.cross(v).dot(normal) / square, t = w.cross(u).dot(normal) / square;
  return Vec3((from[0] + s * u + to[0] + t * v) / 2);
}

/// One bend in the place of the two in the middle of a way, where the way is shortest.
std::optional<JoinedBend> joined_bend(const std::array<Vec3, 4>& way, const CourseLimits& limits) {
  const Vec3 &from = way[0], &a = way[1], &b = way[2], &to = way[3];
  std::optional<JoinedBend> best;
  const auto offer = [&](const Vec3& point) {
    const double longer = way_length(from, point, to, 0) - (a - from).norm() - (b - a).norm() - (to - b).norm();
    if (best && longer >= best->longer_m) return;
    if (limits.allows(from, point) && limits.allows(point, to)) best = {point, longer};
  };
  if (const auto point = crossing({from, a}, {to, b})) offer(*point);
  for (const Vec3& point : {Vec3((a + b) / 2), a, b}) offer(point);
  return best;
}

/// Moves one stop or bend, if that shortens the way past it.
bool improve_stop(Course& course, const CourseLimits& limits, std::size_t i) {
  Stop& stop = course.stops[i];
  if (stop.region == Stop::kFixed) return false;
  const Vec3 *before = course.before(i), *after = course.after(i);
  if (!before && !after) return false;
  const Vec3 a = before ? *before : *after, b = after ? *after : *before;
  const TourRegion* region = stop.region >= 0 ? limits.regions[static_cast<std::size_t>(stop.region)].get() : nullptr;
  const Vec3 wanted = region ? region->touch(a, b, 0, &stop.point) : nearest_on_leg(a, b, stop.point);
  const double least = way_length(a, stop.point, b, 0);
  double share = 1;
  constexpr int kHalvings = 8;
  for (int h = 0; h < kHalvings; ++h, share /= 2) {
    const Vec3 moved = stop.point + share * (wanted - stop.point);
    if (way_length(a, moved, b, 0) >= least * (1 - 1e-9)) continue;
    if (region && !region->holds(moved)) continue;
    if ((before && !limits.allows(a, moved)) || (after && !limits.allows(moved, b))) continue;
    stop.point = moved;
    return true;
  }
  return false;
}

}  // namespace

std::optional<std::vector<Vec3>> find_way(const Airspace& airspace, const Leg& leg, SplitMix64& draw,
                                          const core::ProgressReporter& progress, Effort effort) {
  std::optional<std::vector<Vec3>> best = way_over(airspace, leg);
  if (best) pull_tight(*best, airspace, draw);
  const double direct = (leg.to - leg.from).norm();
  const Box bounds = airspace.bounds();
  std::vector<Vec3> nodes = {leg.from, leg.to};
  double reach = 1.15 * direct + 10;
  const int growths = effort == Effort::full ? 6 : 1;
  constexpr std::size_t kEach = 120;
  for (int growth = 0; growth < growths; ++growth, reach *= 1.7) {
    if (best && length_of(*best) <= 1.02 * direct) break;
    for (std::size_t i = 0; i < kEach; ++i) {
      progress.check();
      const Vec3 point = draw_about(leg, reach, bounds, draw);
      if (airspace.allows({point, point}, 0)) nodes.push_back(point);
    }
    std::optional<std::vector<Vec3>> way = LazyRoadmap(airspace, nodes).way(progress);
    if (!way) {
      if (best && growth >= 2) break;
      continue;
    }
    pull_tight(*way, airspace, draw);
    if (!best || length_of(*way) < length_of(*best)) best = way;
    break;
  }
  if (!best) return std::nullopt;
  return std::vector<Vec3>(best->begin() + 1, best->end() - 1);
}

void shorten(Course& course, const CourseLimits& limits) {
  constexpr int kMostSweeps = 30;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    const double before = course.length_m();
    for (std::size_t i = 0; i < course.stops.size(); ++i) improve_stop(course, limits, i);
    for (std::size_t i = 0; i < course.stops.size();) {
      const Vec3 *a = course.before(i), *b = course.after(i);
      const bool may_go = course.stops[i].region == kBend && (!a || !b || limits.allows(*a, *b));
      if (may_go) {
        course.stops.erase(course.stops.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    if (before - course.length_m() <= 1e-6 * before) break;
  }
}

void draw_ways_anew(Course& course, const CourseLimits& limits, SplitMix64& draw,
                    const core::ProgressReporter& progress, const std::function<bool()>& is_over) {
  std::vector<Stop>& stops = course.stops;
  for (std::size_t i = 0; i < stops.size() && !is_over(); ++i) {
    std::size_t next = i + 1;
    while (next < stops.size() && stops[next].region == kBend) ++next;
    if (stops[i].region == kBend || next == i + 1) continue;
    std::vector<Vec3> points;
    for (std::size_t k = i; k <= next; ++k) points.push_back(stops[k % stops.size()].point);
    const auto way = find_way(*limits.airspace, {points.front(), points.back()}, draw, progress);
    if (!way) continue;
    std::vector<Vec3> drawn = {points.front()};
    drawn.insert(drawn.end(), way->begin(), way->end());
    drawn.push_back(points.back());
    if (length_of(drawn) >= length_of(points)) continue;
    const auto first = stops.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    stops.erase(first, stops.begin() + static_cast<std::ptrdiff_t>(next));
    std::vector<Stop> bends;
    for (const Vec3& point : *way) bends.push_back({kBend, point});
    stops.insert(stops.begin() + static_cast<std::ptrdiff_t>(i) + 1, bends.begin(), bends.end());
  }
  shorten(course, limits);
}

void join_bends(Course& course, const CourseLimits& limits) {
  constexpr double kMostLonger = 1e-3;
  constexpr int kSweeps = 6;
  std::vector<Stop>& stops = course.stops;
  const double most = course.length_m() * (1 + kMostLonger);
  double length = course.length_m();
  // What costs least goes first.
  for (int sweep = 1; sweep <= kSweeps; ++sweep) {
    const double most_each = std::ldexp(most * kMostLonger, 2 * (sweep - kSweeps));
    for (std::size_t i = 1; i + 1 < stops.size();) {
      const Vec3 *from = course.before(i), *to = course.after(i + 1);
      const bool are_bends = stops[i].region == kBend && stops[i + 1].region == kBend && from && to;
      const auto joined = are_bends ? joined_bend({*from, stops[i].point, stops[i + 1].point, *to}, limits)
                                    : std::optional<JoinedBend>();
      if (!joined || joined->longer_m > std::min(most_each, most - length)) {
        ++i;
        continue;
      }
      length += joined->longer_m;
      stops[i].point = joined->point;
      stops.erase(stops.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    }
  }
}

FlownCourse fly_clear(const Course& course, const CourseLimits& limits, SplitMix64& draw,
                      const core::ProgressReporter& progress, const std::function<bool()>& is_late) {
  return ClearFlight(course, limits, draw, progress, is_late).run();
}

}  // namespace vantage::internal::flight::tour
