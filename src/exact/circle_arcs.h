// A circle in space and the parts of it that half-spaces leave.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "exact/blocker.h"
#include "exact/interval_set.h"

namespace vantage::internal::exact {

/// centre + radius (cos(angle) axis_1 + sin(angle) axis_2), metres.
struct SpaceCircle {
  Vec3 centre, axis_1, axis_2;
  double radius;

  Vec3 at(double angle) const { return centre + radius * (std::cos(angle) * axis_1 + std::sin(angle) * axis_2); }
};

/// A circle's part, cut by half-spaces m . x >= h. Angles run from 0 to 2 pi; parts that pass 0 are split there.
class CircleArcs {
 public:
  explicit CircleArcs(const SpaceCircle& circle) : circle_(circle) { parts_.assign(0, 2 * std::numbers::pi); }

  /// Keeps what has normal . x >= height.
  void keep(const Vec3& normal, double height);

  /// Takes away what a blocker hides: all of `planes` greater than 1. Where one of the planes holds the whole circle (a
  /// tie), the blocker hides it only if `owns_ties`.
  void subtract_blocker(std::span<const Plane> planes, bool owns_ties);

  bool empty() const { return parts_.empty(); }
  const std::vector<Interval>& parts() const { return parts_.parts(); }
  void drop_shorter_than(double angle) { parts_.drop_shorter_than(angle); }

 private:
  /// Where amplitude cos(angle - phase) >= level: the middle of the arc and its half width.
  struct Arc {
    double middle, half_width;
  };
  enum class Cut { all, none, some };
  Cut cut(const Vec3& normal, double height, double margin, Arc& arc) const;

  SpaceCircle circle_;
  IntervalSet parts_;
  std::vector<Arc> arcs_;
};

}  // namespace vantage::internal::exact
