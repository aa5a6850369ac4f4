#include "flight/standpoint_search.h"

#include <algorithm>

namespace vantage::internal::flight {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

Vec3 point_at(const std::array<double, 3>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

}  // namespace

SearchEnd PointSearch::run(const core::ProgressReporter& progress) {
  SearchBox<3> root;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    root.middle[a] = (solid_.bounds().min[axis] + solid_.bounds().max[axis]) / 2;
    root.half[a] = (solid_.bounds().max[axis] - solid_.bounds().min[axis]) / 2;
  }
  return search_box(*this, root, request_.limits, progress);
}

/// Minus infinity where the point does not count.
double PointSearch::allowed_value(const Vec3& point) const {
  const double value = request_.value(point, 0);
  if (!(value > best_) || solid_.at_most_m(point) < request_.margin_m) return kNone;
  if (solid_.depth_m(point) < request_.margin_m || !request_.is_inside(point)) return kNone;
  return value;
}

double PointSearch::bound_of(const SearchBox<3>& box) {
  const Vec3 middle = point_at(box.middle);
  const double reach = point_at(box.half).norm();
  const double needed = request_.margin_m + request_.slack_m - reach;
  if (solid_.at_most_m(middle) < needed) return kNone;
  const double bound = request_.value(middle, reach);
  if (!(bound > best_ + request_.limits.tolerance)) return bound;
  const double depth = solid_.depth_m(middle);
  if (depth < needed) return kNone;
  if (depth < request_.margin_m) return bound;
  const double value = allowed_value(middle);
  if (!(value > best_)) return bound;
  const bool is_much_better = value > best_ + request_.limits.tolerance;
  best_ = value;
  point_ = middle;
  if (!is_much_better) return bound;
  std::array<double, 3> place = box.middle, steps{};
  steps.fill(reach);
  best_ = climb(place, value, steps, std::min(1.0, request_.least_step_m / reach), [&](const auto& next) {
    return allowed_value(point_at(next));
  });
  point_ = point_at(place);
  return bound;
}

}  // namespace vantage::internal::flight
