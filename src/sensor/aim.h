// A camera's orientation, and the planes of its picture's edges.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

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

inline PictureEdges picture_edges(const Pinhole& camera, const Aim& aim, double roll) {
  const double cy = std::cos(aim.yaw), sy = std::sin(aim.yaw), cp = std::cos(aim.pitch), sp = std::sin(aim.pitch);
  const Vec3 axis(cp * sy, cp * cy, sp), level(cy, -sy, 0), above = level.cross(axis);
  const Vec3 right = level * std::cos(roll) - above * std::sin(roll);
  const Vec3 up = above * std::cos(roll) + level * std::sin(roll);
  return {camera.half_width * axis + right, camera.half_width * axis - right, camera.half_height * axis + up,
          camera.half_height * axis - up};
}

/// The aim along a direction. Straight up and down the yaw is 0.
inline Aim aim_along(const Vec3& direction) {
  return {std::atan2(direction.x(), direction.y()), std::atan2(direction.z(), direction.head<2>().norm())};
}

}  // namespace vantage::internal::sensor
