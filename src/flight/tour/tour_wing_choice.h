// Which view of each target: a dynamic program over drawn views, then small moves.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/progress_reporter.h"
#include "flight/tour/tour_wing_views.h"

namespace vantage::internal::flight::tour {

/// Views one after the other. With a home it comes first, and last again where the tour is closed.
struct WingCourse {
  bool cyclic = false;  ///< from the last view on to the first one
  std::vector<View> views;

  std::size_t path_count() const { return cyclic ? views.size() : views.size() - 1; }
  std::size_t next(std::size_t i) const { return (i + 1) % views.size(); }
};

/// The length of the paths and the views.
double length_m(const WingCourse& course, const WingSpace& space);

/// Views to choose from, for each place of the order.
using Choices = std::vector<std::vector<View>>;

struct Choice {
  std::optional<WingCourse> course;  ///< nothing: there is no way through, or the time was over
  std::size_t blocked = 0;           ///< then: no view of this place has a clear path to one of the next place
  bool is_stopped = false;           ///< the time was over: nothing is known of ways
};

/// Whether the time is over. Asked before each path that is looked at: one may take some 10 ms where it climbs far.
using IsOver = std::function<bool()>;

/// The shortest course that takes one view of each place, all paths clear. How long a path is, and whether it is clear,
/// is asked only when the shortest course by bounds takes it. Cost: k^2 bounds for k views in neighbouring places, and
/// k^3 sums for each of some tens of courses. When the time is over it stops or, if it must find one, goes on to the
/// first course whose paths are clear.
Choice choose(const Choices& choices, bool cyclic, const WingSpace& space, const core::ProgressReporter& progress,
              const IsOver& is_over, bool must_find);

/// Draws views near those of the course and chooses again, nearer each time; then moves and turns single views while
/// that shortens the course, all paths staying clear, until the time is over. `keeps` is asked of each shorter course.
void refine(WingCourse& course, const WingSpace& space, SplitMix64& draw, const core::ProgressReporter& progress,
            const std::function<bool(const WingCourse&)>& keeps, const IsOver& is_over);

}  // namespace vantage::internal::flight::tour
