// A camera's orientation, and the planes of its picture's edges.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/portable_math.h"
#include "vantage/geometry.h"
#include "vantage/sensor.h"

namespace vantage::internal::sensor {

/// Radians. Yaw clockwise from +y, pitch up from level, roll to the right.
struct Aim {
  double yaw = 0, pitch = 0;
};

/// Inward normals of the planes through the camera and the picture's edges: left, right, bottom, top. A direction is in
/// the picture where its product with each is >= 0. Their lengths are sqrt(1 + tangent^2).
using PictureEdges = std::array<Vec3, 4>;

/// The axes of a picture, of unit length: along the camera's axis, to the right and up.
struct PictureAxes {
  Vec3 ahead, right, up;
};

/// An angle with its sine and cosine.
struct Angle {
  explicit Angle(double value = 0) : Angle(portable::sine_cosine(value)) {}

  double sine, cosine;

 private:
  explicit Angle(const portable::SineCosine& both) : sine(both.sine), cosine(both.cosine) {}
};

inline PictureAxes picture_axes(const Angle& yaw, const Angle& pitch, const Angle& roll) {
  const Vec3 ahead(pitch.cosine * yaw.sine, pitch.cosine * yaw.cosine, pitch.sine), level(yaw.cosine, -yaw.sine, 0);
  const Vec3 above = level.cross(ahead);
  return {ahead, level * roll.cosine - above * roll.sine, above * roll.cosine + level * roll.sine};
}

inline PictureEdges picture_edges(const Pinhole& camera, const Angle& yaw, const Angle& pitch, const Angle& roll) {
  const auto [ahead, right, up] = picture_axes(yaw, pitch, roll);
  return {camera.half_width * ahead + right, camera.half_width * ahead - right, camera.half_height * ahead + up,
          camera.half_height * ahead - up};
}

inline PictureEdges picture_edges(const Pinhole& camera, const Aim& aim, const Angle& roll) {
  return picture_edges(camera, Angle(aim.yaw), Angle(aim.pitch), roll);
}

/// The aim along a direction. Straight up and down the yaw is 0.
inline Aim aim_along(const Vec3& direction) {
  return {portable::atan2(direction.x(), direction.y()), portable::atan2(direction.z(), direction.head<2>().norm())};
}

}  // namespace vantage::internal::sensor
