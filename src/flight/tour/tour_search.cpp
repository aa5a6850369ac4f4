#include "flight/tour/tour_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "flight/tour/tour_random.h"
#include "vantage/error.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr std::size_t kMostKept = 5;

class OrderSearch {
 public:
  OrderSearch(const Regions& regions, const CourseKind& kind, const SearchOptions& options,
              const core::ProgressReporter& progress)
      : regions_(regions), kind_(kind), options_(options), progress_(progress), draw_(options.seed) {}

  SearchResult run() {
    Course current = first_course();
    keep(current);
    const int rounds = options_.rounds > 0 ? options_.rounds : rounds_for(regions_.size());
    // A longer course is taken with the chance exp(-more / heat); heat falls from a share of a leg to nothing.
    const double leg = current.length_m() / static_cast<double>(current.stops.size());
    for (; result_.rounds < rounds && !is_over(result_.rounds, rounds); ++result_.rounds) {
      const double heat = 0.1 * leg * std::pow(1e-3, static_cast<double>(result_.rounds) / rounds);
      Course next = varied(current);
      const double longer = next.length_m() - current.length_m();
      if (longer < 0 || -heat * std::log(1 - draw_.unit()) > longer) {
        current = std::move(next);
        keep(current);
      }
    }
    finish();
    return std::move(result_);
  }

 private:
  static int rounds_for(std::size_t regions) {
    constexpr int kLeast = 500, kForEach = 60, kMost = 20'000;
    return std::min(kMost, kLeast + kForEach * static_cast<int>(regions));
  }

  bool is_over(int round, int rounds) {
    if (result_.end != SearchEnd::done) return true;
    try {
      progress_.report(static_cast<std::size_t>(round), static_cast<std::size_t>(rounds));
      progress_.check();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::cancelled) throw;
      result_.end = SearchEnd::cancelled;
      return true;
    }
    if (watch_.seconds() > options_.time_limit_s) result_.end = SearchEnd::time_limit;
    return result_.end != SearchEnd::done;
  }

  /// Farthest insertion: the region that is farthest from the course comes next, where it costs least.
  Course first_course() {
    Course course;
    course.closed = kind_.closed;
    std::vector<int> open(regions_.size());
    std::iota(open.begin(), open.end(), 0);
    if (kind_.home) {
      course.stops.push_back({Stop::kFixed, *kind_.home});
    } else {
      course.stops.push_back({0, regions_[0]->anchors().front()});
      open.erase(open.begin());
    }
    std::vector<double> near(regions_.size(), std::numeric_limits<double>::infinity());
    Vec3 added = course.stops[0].point;
    while (!open.empty()) {
      for (const int r : open) {
        const Vec3& anchor = regions_[static_cast<std::size_t>(r)]->anchors().front();
        near[static_cast<std::size_t>(r)] = std::min(near[static_cast<std::size_t>(r)], (anchor - added).norm());
      }
      const auto far = std::max_element(open.begin(), open.end(), [&](int a, int b) {
        return near[static_cast<std::size_t>(a)] < near[static_cast<std::size_t>(b)];
      });
      const int region = *far;
      open.erase(far);
      const Place place = best_place(course, *regions_[static_cast<std::size_t>(region)]);
      insert(course, region, place);
      added = place.point;
    }
    settle(course, 3);
    exchange(course);
    settle(course, 3);
    return course;
  }

  double smoothing(const Course& course) const {
    return 0.02 * course.length_m() / static_cast<double>(course.stops.size());
  }

  void settle(Course& course, int sweeps) {
    const double smooth = smoothing(course);
    for (int i = 0; i < sweeps; ++i) settle_once(course, regions_, i + 1 < sweeps ? smooth : 0);
  }

  /// Another part of one region, and what follows from it for its neighbours: a region of several pieces may have to
  /// change together with them.
  Course moved_elsewhere(const Course& course) {
    Course next = course;
    const std::size_t count = next.stops.size(), free = count - next.first_free();
    const std::size_t i = next.first_free() + draw_.below(free);
    const std::vector<Vec3>& anchors = regions_[static_cast<std::size_t>(next.stops[i].region)]->anchors();
    next.stops[i].point = anchors[draw_.below(anchors.size())];
    const double smooth = smoothing(course);
    const std::size_t reach = std::min<std::size_t>(4, (count - 1) / 2);
    for (std::size_t k = 1; k <= reach; ++k) {
      settle_stop(next, regions_, (i + k) % count, smooth);
      settle_stop(next, regions_, (i + count - k) % count, smooth);
    }
    for (const double s : {smooth, 0.0}) {
      for (std::size_t k = 0; k <= 2 * reach; ++k) settle_stop(next, regions_, (i + count + k - reach) % count, s);
    }
    return next;
  }

  /// Takes out some regions and puts them back.
  Course varied(const Course& course) {
    if (draw_.unit() < 0.4) return moved_elsewhere(course);
    Course next = course;
    std::vector<int> out = take_out(next);
    draw_.shuffle(out);
    std::vector<std::size_t> touched;
    for (const int region : out) {
      // Now and then the best place is passed over: it may not be there.
      const std::size_t skip = draw_.unit() < 0.05 ? 1 : 0;
      insert(next, region, best_place(next, *regions_[static_cast<std::size_t>(region)], skip));
    }
    if (next.stops.size() <= kAllSettle) {
      settle(next, 2);
    } else {
      settle_near(next, out);
    }
    if (exchange(next)) {
      if (next.stops.size() <= kAllSettle) settle(next, 2);
    }
    return next;
  }

  /// The stops of these regions and their neighbours, twice.
  void settle_near(Course& course, const std::vector<int>& served) {
    const std::size_t count = course.stops.size();
    std::vector<bool> is_near(count, false);
    for (std::size_t i = 0; i < count; ++i) {
      if (std::find(served.begin(), served.end(), course.stops[i].region) == served.end()) continue;
      for (std::size_t k = 0; k < 3; ++k) is_near[(i + count + k - 1) % count] = true;
    }
    const double smooth = smoothing(course);
    for (const double s : {smooth, 0.0}) {
      for (std::size_t i = 0; i < count; ++i) {
        if (is_near[i]) settle_stop(course, regions_, i, s);
      }
    }
  }

  /// Those whose points are nearest to that of one that is drawn, or those that follow it.
  std::vector<int> take_out(Course& course) {
    const std::size_t free = course.stops.size() - course.first_free();
    // One stop stays where there is no home.
    const std::size_t most = std::min<std::size_t>(10, course.first_free() == 1 ? free : free - 1);
    std::vector<int> out;
    if (most == 0) return out;
    const std::size_t count = 1 + draw_.below(most), seed = course.first_free() + draw_.below(free);
    if (draw_.unit() < 0.3) {
      for (std::size_t k = 0; k < count; ++k) {
        out.push_back(course.stops[course.first_free() + (seed - course.first_free() + k) % free].region);
      }
    } else {
      std::vector<std::pair<double, int>> by_distance;
      for (std::size_t i = course.first_free(); i < course.stops.size(); ++i) {
        const double away = (course.stops[i].point - course.stops[seed].point).norm();
        by_distance.emplace_back(away * draw_.uniform(0.7, 1.3), course.stops[i].region);
      }
      std::sort(by_distance.begin(), by_distance.end());
      for (std::size_t k = 0; k < count; ++k) out.push_back(by_distance[k].second);
    }
    std::erase_if(course.stops, [&](const Stop& stop) {
      return stop.region != Stop::kFixed && std::find(out.begin(), out.end(), stop.region) != out.end();
    });
    return out;
  }

  /// The same for a course and its reverse, wherever it begins.
  static std::vector<int> signature(const Course& course) {
    std::vector<int> order;
    for (const Stop& stop : course.stops) order.push_back(stop.region);
    if (!course.closed) return order;
    std::rotate(order.begin(), std::min_element(order.begin(), order.end()), order.end());
    if (order.size() > 2 && order[1] > order.back()) std::reverse(order.begin() + 1, order.end());
    return order;
  }

  void keep(const Course& course) {
    std::vector<Course>& kept = result_.courses;
    const double length = course.length_m();
    if (kept.size() == kMostKept && length >= kept.back().length_m()) return;
    const std::vector<int> order = signature(course);
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const Course& c) { return signature(c) == order; });
    if (same != kept.end()) {
      if (length >= same->length_m()) return;
      *same = course;
    } else {
      kept.push_back(course);
    }
    sort_kept();
    if (kept.size() > kMostKept) kept.pop_back();
  }

  void sort_kept() {
    std::stable_sort(result_.courses.begin(), result_.courses.end(),
                     [](const Course& a, const Course& b) { return a.length_m() < b.length_m(); });
  }

  /// Whoever asked to stop does not wait; when time is up, the best one is settled.
  void finish() {
    std::vector<Course>& kept = result_.courses;
    if (result_.end == SearchEnd::cancelled) return;
    if (result_.end == SearchEnd::time_limit) kept.resize(1);
    parallel::for_ranges(kept.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) kept[i] = settled(kept[i], regions_);
    });
    sort_kept();
  }

  static constexpr std::size_t kAllSettle = 25;

  const Regions& regions_;
  const CourseKind& kind_;
  const SearchOptions& options_;
  const core::ProgressReporter& progress_;
  SplitMix64 draw_;
  core::Stopwatch watch_;
  SearchResult result_;
};

}  // namespace

SearchResult search_order(const Regions& regions, const CourseKind& kind, const SearchOptions& options,
                          const core::ProgressReporter& progress) {
  return OrderSearch(regions, kind, options, progress).run();
}

}  // namespace vantage::internal::flight::tour
