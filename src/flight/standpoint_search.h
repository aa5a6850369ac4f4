// The best position of a volume by one measure: branch and bound over boxes, see box_search.h.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "flight/box_search.h"
#include "flight/solid_depth.h"
#include "vantage/geometry.h"

namespace vantage::internal::flight {

/// A value to be made as large as possible, of a point about SolidDepth::origin. With a `reach_m` of more than 0 an
/// upper bound of the values of all points that near.
using PointValue = std::function<double(const Vec3& point, double reach_m)>;

struct PointRequest {
  PointValue value;                            ///< empty: the depth
  double margin_m = 0;                         ///< points count at this depth and deeper
  double slack_m = 0;                          ///< the bound is of points that are so much deeper than that
  SearchLimits limits;                         ///< the tolerance is of the value
  double least_step_m = 0;                     ///< > 0: no point is moved by less to make it better
  std::function<bool(const Vec3&)> is_inside;  ///< asked of each point before it counts
};

class PointSearch {
 public:
  PointSearch(const SolidDepth& solid, PointRequest request) : solid_(solid), request_(std::move(request)) {}

  SearchEnd run(const core::ProgressReporter& progress);

  std::optional<Vec3> point() const { return point_; }
  double best() const { return best_; }
  double bound_of(const SearchBox<3>& box);

 private:
  double allowed_value(const Vec3& point) const;
  void take(const SearchBox<3>& box, double value);

  const SolidDepth& solid_;
  PointRequest request_;
  std::optional<Vec3> point_;
  double best_ = -std::numeric_limits<double>::infinity();
};

}  // namespace vantage::internal::flight
