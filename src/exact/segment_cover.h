// Which part of a segment a blocker hides.
#pragma once

#include <span>

#include "exact/blocker.h"
#include "exact/interval_set.h"
#include "target/numerics.h"

namespace vantage::internal::exact {

/// How far g . x may differ from 1 for points x within `reach` metres before a plane counts as apart from them: the tie
/// width, plus the rounding of the product for planes that pass close to the centre. `sum`: |x| + |y| + |z| of g.
inline double tie_margin(double sum, double reach) { return numerics::kTie + 1e-15 * reach * sum; }
inline double tie_margin(const Plane& plane, double reach) { return tie_margin(plane.cwiseAbs().sum(), reach); }

/// Two planes of one blocker whose inverse depths differ by less than this everywhere on a facet bound it together.
inline constexpr double kSiblingMargin = 1e-12;

/// How far g . o may differ from 1 for corners o of a polygon that the plane may touch: merged polygons are
/// planar to a nanometre only. Generous, because a plane taken for one that touches fewer corners may be taken for
/// hidden.
inline double touch_margin(const Plane& plane, double reach) {
  return tie_margin(plane, reach) + numerics::kTouch * plane.norm();
}

/// The part of from -> to (parameters 0 to 1) on which every plane exceeds 1: what the blocker hides of it. A surface
/// that only touches or holds the segment does not hide it: several blockers may share an edge, and none may count on
/// another to report it. Empty intervals have begin >= end.
inline Interval hidden_part(const Vec3& from, const Vec3& to, double reach, std::span<const Plane> planes) {
  constexpr Interval kNone{1, 0};
  Interval hidden{0, 1};
  for (const Plane& plane : planes) {
    const double margin = tie_margin(plane, reach);
    const double a = plane.dot(from) - 1, b = plane.dot(to) - 1;
    if (a <= margin && b <= margin) return kNone;
    if (a >= -margin && b >= -margin) continue;
    const double crossing = a / (a - b);
    if (a < b) {
      hidden.begin = std::max(hidden.begin, crossing);
    } else {
      hidden.end = std::min(hidden.end, crossing);
    }
    if (hidden.begin >= hidden.end) return kNone;
  }
  return hidden;
}

}  // namespace vantage::internal::exact
