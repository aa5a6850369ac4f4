// Where points lie, exactly, also where products of coordinates underflow. In space no coordinate is above 2^370.
#pragma once

#include <array>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// The sign of the determinant of (a - d, b - d, c - d), of the numbers as they are: 1 where a, b and c run clockwise
/// as seen from d's side, 0 where all four lie in one plane.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// In the plane, exactly: 1 where c lies left of the way from a to b, -1 right, 0 on the line.
int turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

/// Whether a segment passes through the inside of a triangle.
bool passes_through(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle);

/// Whether the three lie on one line, or in one place.
bool are_on_a_line(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace vantage::internal::prove
