// The point of an intersection of half-spaces that is nearest to a given one.
#pragma once

#include <optional>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::simplify {

struct HalfSpace {
  Vec3 normal = Vec3::UnitZ();  ///< of length 1, outward
  double offset = 0;            ///< points with normal . x <= offset are inside
};

/// Seidel's algorithm for linear programmes (1991), which also finds nearest points: where a new half-space leaves the
/// last answer out, the next one lies on its plane. Nothing where the half-spaces have no point in common, as far as
/// numbers tell. Right to roundings: whoever needs a point that is surely inside takes smaller offsets, and checks.
/// Cost: linear in the half-spaces if they come in a random order.
std::optional<Vec3> nearest_inner_point(const std::vector<HalfSpace>& half_spaces, const Vec3& wanted);

}  // namespace vantage::internal::simplify
