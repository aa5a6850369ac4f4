// How far a point is above the ground, for the check.
#pragma once

#include <optional>
#include <vector>

#include "vantage/navigation.h"
#include "verify/box_index.h"

namespace vantage::internal::verify {

class GroundProbe {
 public:
  explicit GroundProbe(const AboveGround& limit);

  /// "agl min", "agl max" or "ground edge" where the point (scene frame) breaks it; nothing where it does not, or by
  /// less than rounding.
  std::optional<const char*> broken_by(const Vec3& point) const;

  /// Whether the point is below the lower height above all of the ground there, or above the upper one above all of it,
  /// or passes it by less than rounding. Where there is no ground it is not.
  bool is_outside_band(const Vec3& point) const;

 private:
  struct Heights {
    double lowest, highest;
  };
  std::optional<Heights> heights(const Vec3& point) const;
  double allowance_at(double height_m) const;

  double min_m_, max_m_;
  Ground ground_;
  double allowance_m_ = 0;  ///< for rounding of the ground
  Box bounds_;              ///< of the triangles
  std::optional<BoxIndex> index_;
};

}  // namespace vantage::internal::verify
