// A circle in space and the parts of it that half-spaces leave.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "core/portable_math.h"
#include "exact/blocker.h"
#include "exact/interval_set.h"

namespace vantage::internal::exact {

/// centre + radius (cos(angle) axis_1 + sin(angle) axis_2), metres.
struct SpaceCircle {
  Vec3 centre, axis_1, axis_2;
  double radius;

  Vec3 at(double angle) const {
    const portable::SineCosine turn = portable::sine_cosine(angle);
    return centre + radius * (turn.cosine * axis_1 + turn.sine * axis_2);
  }
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

  /// Takes away what lies inside a body of planes: all of them less than 1, and in a cone: e . x > 0 for each of
  /// `cone`.
  void subtract_body(std::span<const Plane> planes, std::span<const Vec3> cone = {});

  /// Takes the angles between `begin` and `end` away.
  void drop(double begin, double end) { parts_.subtract(begin, end); }

  bool empty() const { return parts_.empty(); }
  const std::vector<Interval>& parts() const { return parts_.parts(); }
  void drop_shorter_than(double angle) { parts_.drop_shorter_than(angle); }

 private:
  /// The circle is beyond a plane where a cos(angle) + b sin(angle) >= level. The left side is `amplitude` at most.
  struct Wave {
    double a, b, amplitude, level;
  };
  enum class Cut { all, none, some };  // of the circle is beyond
  Wave wave_of(const Vec3& normal, double height) const;
  static Cut cut(const Wave& wave, double margin);
  static void subtract_below(const Wave& wave, IntervalSet& parts);
  bool is_clear_of(std::span<const Plane> planes, double size) const;

  SpaceCircle circle_;
  IntervalSet parts_, hidden_;
};

}  // namespace vantage::internal::exact
