// How well a target is seen from a position, and from the best place near it.
#pragma once

#include <optional>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/target.h"

namespace vantage::internal::flight {

/// The corners of one part of a target, scene frame.
std::vector<Vec3> corners_of(const TargetFrame& part);

/// Measures of the target of one volume. With a `reach_m` of more than 0 they are bounds: no position that near to the
/// given one has less. Distances, and heights over a plane, change by no more than the position is moved.
class TargetView {
 public:
  explicit TargetView(const Mission& mission);

  const Vec3& centre() const { return centre_; }  ///< scene frame, metres
  double distance_m(const Vec3& position, double reach_m = 0) const;

  bool has_pixels() const { return focal_px_.has_value(); }
  /// The largest size of a pixel on the target; infinite where a part is seen from behind. Needs has_pixels().
  double pixel_m(const Vec3& position, double reach_m = 0) const;

  bool has_incidence() const;
  /// The largest angle between a part's normal and the line from a point of it to the position, degrees. Needs
  /// has_incidence().
  double incidence_deg(const Vec3& position, double reach_m = 0) const;

 private:
  struct Part {
    std::vector<Vec3> corners;  ///< scene frame
    Vec3 origin, normal;
    bool all_sides = false;
  };
  using Parts = std::vector<Part>;

  template <typename Measure>
  double worst(const Measure& of_part) const;

  std::vector<std::vector<Parts>> views_;  ///< all of the lists, and of each one target or more
  Vec3 centre_ = Vec3::Zero();
  std::optional<double> focal_px_;
  PixelLimit::Kind kind_ = PixelLimit::Kind::worst;
};

}  // namespace vantage::internal::flight
