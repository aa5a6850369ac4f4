// The pyramid between a viewpoint and the target, and where to aim a ray at what reaches into it. Target points drawn
// at random miss thin shadows; a ray aimed at the middle of the part of a scene triangle that lies in the pyramid does
// not.
#pragma once

#include <optional>
#include <vector>

#include "verify/box_index.h"
#include "verify/segment.h"
#include "verify/target_view.h"

namespace vantage::internal::verify {

class ViewPyramid {
 public:
  /// `apex` lies in front of the target's plane. The view is kept by reference.
  ViewPyramid(const Vec3& apex, const TargetView& view);

  const std::vector<HalfSpace>& sides() const { return sides_; }  ///< the target's plane and one side an edge

  /// The target point behind the middle of the triangle's part inside the pyramid, higher than `lowest` metres over the
  /// target's plane. Nothing when no part is.
  std::optional<Vec3> aim(const FlatTriangle& triangle, double lowest) const;

  /// Adds what the triangle's part inside the pyramid hides of the target: convex polygons on its plane. What is lower
  /// than `lowest` over it, and over the target or no farther beside it, hides nothing.
  void add_shadows(const FlatTriangle& triangle, double lowest, std::vector<std::vector<Vec3>>& shadows) const;

 private:
  std::optional<std::vector<Vec3>> thrown(const std::vector<Vec3>& polygon) const;

  const TargetView& view_;
  Vec3 apex_;
  double apex_height_;
  std::vector<HalfSpace> sides_;
};

}  // namespace vantage::internal::verify
