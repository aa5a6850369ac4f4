// How much of a polygon is left when convex shadows are taken from it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vantage/geometry.h"
#include "verify/target_view.h"

namespace vantage::internal::verify {

using FlatPolygon = std::vector<Eigen::Vector2d>;

/// Square metres; positive where the corners run counter-clockwise.
double area_of(const FlatPolygon& polygon);

/// Places on the target's plane as two numbers, metres about the target's centre; counter-clockwise as from its front.
class PlaneAxes {
 public:
  explicit PlaneAxes(const TargetView& view);

  FlatPolygon flat(std::span<const Vec3> corners) const;
  Vec3 place(const Eigen::Vector2d& point) const { return centre_ + point.x() * u_ + point.y() * v_; }

 private:
  Vec3 centre_, u_, v_;
};

/// The area of what no shadow covers. All polygons are convex, shadows in either turn. Pieces are cut along the edges
/// of one shadow after another, the largest first; each cut loses no more than its rounding. Cost: the shadows times
/// the pieces that they leave.
double area_left(const FlatPolygon& polygon, std::vector<FlatPolygon> shadows);

}  // namespace vantage::internal::verify
