// The camera of a picture.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/picture.h"

namespace vantage::internal::picture {

/// Pixels that annotation takes from each side of a picture.
struct Insets {
  double left = 0, top = 0, right = 0, bottom = 0;
};

/// A camera. Image coordinates of a point: metres right and up of `eye` in a parallel projection, tangents of the angle
/// to the axis in a perspective one. Pixels: right and down from the upper left corner.
struct View {
  int width = 0, height = 0;
  bool perspective = false;
  Vec3 eye = Vec3::Zero();                           ///< parallel: a point on the axis, before everything
  Vec3 right = Vec3::UnitX(), up = Vec3::UnitY();    ///< right-handed with `back`
  Vec3 back = Vec3::UnitZ();                         ///< towards the viewer
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< image coordinates of the picture's middle
  double pixels = 1;                                 ///< per unit of image coordinates
  double near_m = 1, far_m = 2;                      ///< along -back; far: of a parallel projection only
  double focus_m = 1;                                ///< from the eye to what is looked at, along -back

  double depth(const Vec3& point) const { return -back.dot(point - eye); }
  Eigen::Vector2d pixel(const Vec3& point) const;
  /// Pixels that a metre across the line of sight takes at the focus.
  double pixels_per_metre() const { return perspective ? pixels / focus_m : pixels; }
  /// For points relative to `origin`: to clip coordinates with depth 1 (near) to 0 (far), moved by (x, y) pixels.
  Eigen::Matrix4f clip(const Vec3& origin, const Eigen::Vector2d& shift) const;
};

/// Where an oblique camera stands by default.
inline constexpr double kPreferredAzimuth = 235;

/// A view that shows all `points` within the insets, and whose depths hold `bounds`; `centre` is looked at. Throws
/// Error(input) for a camera that stands at the centre or is not finite.
View make_view(const PictureView& view, int width, int height, const Insets& insets, const std::vector<Vec3>& points,
               const Vec3& centre, const Box& bounds);

}  // namespace vantage::internal::picture
