#include "flight/standpoint_search.h"

#include <algorithm>

namespace vantage::internal::flight {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

Vec3 point_at(const std::array<double, 3>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

}  // namespace

SearchEnd PointSearch::run(const core::ProgressReporter& progress) {
  SearchBox<3> root;
  const double longest = (solid_.bounds().max - solid_.bounds().min).maxCoeff() / 2;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    root.middle[a] = (solid_.bounds().min[axis] + solid_.bounds().max[axis]) / 2;
    root.half[a] = (solid_.bounds().max[axis] - solid_.bounds().min[axis]) / 2;
    if (!request_.value) root.weight[a] = flatness(root.half[a], longest);
  }
  return search_box(*this, root, request_.limits, progress);
}

/// Minus infinity where the point does not count, or is no better than the best.
double PointSearch::allowed_value(const Vec3& point) const {
  if (solid_.at_most_m(point) < request_.margin_m) return kNone;
  if (request_.value && !(request_.value(point, 0) > best_)) return kNone;
  const double depth = solid_.depth_m(point);
  const double value = request_.value ? request_.value(point, 0) : depth;
  return depth >= request_.margin_m && value > best_ && request_.is_inside(point) ? value : kNone;
}

/// A better value, of the middle of a box.
void PointSearch::take(const SearchBox<3>& box, double value) {
  const bool is_much_better = value > best_ + request_.limits.tolerance;
  best_ = value;
  std::array<double, 3> place = box.middle, steps{};
  if (is_much_better) {
    const double reach = point_at(box.half).norm();
    steps.fill(reach);
    best_ = climb(place, value, steps, std::min(1.0, request_.least_step_m / reach),
                  [&](const auto& next) { return allowed_value(point_at(next)); });
  }
  point_ = point_at(place);
}

double PointSearch::bound_of(const SearchBox<3>& box) {
  const Vec3 middle = point_at(box.middle), half = point_at(box.half);
  const double needed = request_.margin_m + request_.slack_m, interesting = best_ + request_.limits.tolerance;
  const double at_most = solid_.box_at_most_m(middle, half);
  if (at_most < needed) return kNone;
  double bound = request_.value ? request_.value(middle, half.norm()) : at_most;
  if (!(bound > interesting)) return bound;
  const SolidDepth::Bounded depth = solid_.bounded_m(middle, half);
  if (depth.bound_m < needed) return kNone;
  if (!request_.value) bound = depth.bound_m;
  if (depth.depth_m < request_.margin_m) return bound;
  const double at_least = request_.value ? request_.value(middle, 0) : depth.depth_m;
  if (!(at_least > best_)) return bound;
  const double value = allowed_value(middle);
  if (value > best_) take(box, value);
  return bound;
}

}  // namespace vantage::internal::flight
