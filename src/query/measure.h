// How large a plane polygon is, by each FractionMeasure.
#pragma once

#include <span>

#include "query/shadow.h"
#include "vantage/fraction.h"
#include "vantage/geometry.h"

namespace vantage::internal::query {

/// Measures convex polygons of one target (local, metres, counter-clockwise) for one eye. All terms of all sums are
/// positive: what is small comes out as precise as what is large.
class Measure {
 public:
  /// `eye`: local, z > 0; `target`: all corners.
  Measure(FractionMeasure measure, std::span<const Point2> target, const Vec3& eye);

  /// Square metres; steradians; or squares of the focal length.
  double of(std::span<const Point2> polygon) const;

 private:
  double of_triangle(const Point2& a, const Point2& b, const Point2& c) const;

  FractionMeasure measure_;
  Vec3 eye_, axis_;
};

/// The axis of the narrowest circular cone about directions (unit length, at least one, all less than 90 degrees off
/// some axis). Welzl 1991, on the sphere. Cost: O(n^3) at worst, n <= 64.
Vec3 narrowest_cone_axis(std::span<const Vec3> directions);

}  // namespace vantage::internal::query
