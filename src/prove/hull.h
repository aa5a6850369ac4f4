// Convex hulls by their points, and planes that separate two of them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// The convex hull of points, relative to a common origin.
class PointHull {
 public:
  void add(const Vec3& point) {
    x_.push_back(point.x());
    y_.push_back(point.y());
    z_.push_back(point.z());
  }
  std::size_t size() const { return x_.size(); }

  /// The point that lies least far along a direction.
  Vec3 lowest(const Vec3& direction) const;

 private:
  std::vector<double> x_, y_, z_;
};

/// A box, or a convex polygon of three or four corners.
class Obstacle {
 public:
  explicit Obstacle(const Box& box) : points_{box.min, box.max}, is_box_(true) {}
  explicit Obstacle(std::span<const Vec3> polygon)
      : points_{polygon[0], polygon[1], polygon[2], polygon.back()}, is_triangle_(polygon.size() == 3) {}

  /// The point that lies farthest along a direction.
  Vec3 highest(const Vec3& direction) const {
    if (is_box_) {
      return {direction.x() > 0 ? points_[1].x() : points_[0].x(), direction.y() > 0 ? points_[1].y() : points_[0].y(),
              direction.z() > 0 ? points_[1].z() : points_[0].z()};
    }
    const double a = direction.dot(points_[0]), b = direction.dot(points_[1]), c = direction.dot(points_[2]);
    const Vec3& highest = a > b ? (a > c ? points_[0] : points_[2]) : (b > c ? points_[1] : points_[2]);
    return is_triangle_ || direction.dot(points_[3]) < direction.dot(highest) ? highest : points_[3];
  }
  Vec3 middle() const {
    if (is_box_) return (points_[0] + points_[1]) / 2;
    return (points_[0] + points_[1] + points_[2]) / 3;  // of a face, any point is good
  }

 private:
  std::array<Vec3, 4> points_{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  bool is_box_ = false, is_triangle_ = false;
};

/// A direction along which all of `hull` lies farther than all of `obstacle`, whatever was rounded; nothing where none
/// is found (Gilbert, Johnson and Keerthi 1988). `largest`: no coordinate is larger.
std::optional<Vec3> separate(const PointHull& hull, const Obstacle& obstacle, double largest);

/// What is rounded in the difference of two points along a direction: so much is not sure. In parts of 2^-53 of the sum
/// of the direction's coordinates times the largest one: three products and two sums for each of the two, twice, as
/// which point lies lowest or highest is found with the same sums (6 each), 2 for the difference, and the points
/// themselves: differences of stored coordinates, rounded once, where a triangle is cut up to four times more. That is
/// 31; and a few to spare.
inline double unsure_along(const Vec3& direction, double largest) {
  constexpr double kRoundings = 40, kUnit = 1.12e-16;
  return kRoundings * kUnit * direction.cwiseAbs().sum() * largest;
}

}  // namespace vantage::internal::prove
