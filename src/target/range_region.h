// The range region: the intersection of the balls of radius max_range about the target's vertices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/plane.h"
#include "vantage/export.h"
#include "vantage/target.h"

namespace vantage::internal::target {

class RangeRegion {
 public:
  /// A ball about each vertex. The origin must be inside all of them.
  RangeRegion(const std::vector<Eigen::Vector2d>& polygon, double max_range);

  double radius() const { return radius_; }
  std::size_t ball_count() const { return centres_.size(); }
  double inner_radius() const;  ///< the region holds all in front of the target that is within this of the origin
  const Eigen::Vector2d& centre(std::size_t ball) const { return centres_[ball]; }

  /// The balls that bound, beside it, the part of the region's boundary that lies on a ball's sphere; ascending, and
  /// perhaps some that do so nowhere. All centres lie in the target's plane, so these parts are the cells of a plane
  /// diagram, in which a point belongs to the centre that is farthest from it: hardly more than two balls each.
  std::span<const std::uint32_t> neighbours(std::size_t ball) const { return neighbours_[ball]; }

  /// What is farther from one centre than from another one: x . normal >= height. So on the sphere about `from` the
  /// points inside the ball about `to`.
  struct FartherSide {
    Vec3 normal;
    double height;
  };
  FartherSide farther_from(std::size_t from, std::size_t to) const {
    const Eigen::Vector2d &own = centres_[from], &other = centres_[to], across = other - own;
    return {{across.x(), across.y(), 0}, 0.5 * across.dot(other + own)};
  }

  /// Inverse depth along `direction` (any length: the gauge is homogeneous) of one ball's sphere.
  double gauge(std::size_t ball, const Vec3& direction) const {
    const double b = direction.x() * centres_[ball].x() + direction.y() * centres_[ball].y();
    const double root = std::sqrt(b * b + direction.squaredNorm() * power_[ball]);
    return b > 0 ? direction.squaredNorm() / (b + root) : (root - b) / power_[ball];
  }

  /// The gauge of the region: the greatest of the balls' gauges. Convex in `direction`.
  double gauge(const Vec3& direction) const;

  /// The same, trying `ball` first and leaving there the one that is met first: neighbouring directions mostly share
  /// it, and whether a point of one sphere is inside the other balls is told without a square root.
  double gauge(const Vec3& direction, std::size_t& ball) const;

  /// The ball whose sphere is met first along `direction`.
  std::size_t nearest_ball(const Vec3& direction) const;

  /// A plane that touches the region where `direction` leaves it: g . d <= gauge(d) for every d, with equality there.
  core::Plane supporting_plane(const Vec3& direction) const;

  /// Whether a point of a triangle may lie farther inside the region's boundary than `depth`.
  bool is_deeper_than(double depth, const std::array<Vec3, 3>& corners) const;

  /// Whether a point is within max_range of all vertices.
  bool contains(const Vec3& point) const;

 private:
  void find_neighbours();
  void find_opposite();
  std::size_t sector_of(const Vec3& direction) const;
  std::size_t first_met(const Vec3& direction, double gauge, std::size_t ball) const;

  std::vector<Eigen::Vector2d> centres_;
  std::vector<double> power_;  // radius^2 - |centre|^2
  double radius_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
  std::array<std::uint32_t, 64> opposite_{};  // per sector of directions in the target's plane
};

/// Moves the frame's origin inside every ball. The centre of the smallest enclosing circle always is, but may lie on
/// the target's outline, so the origin keeps as far from it as the range allows. The range exceeds the circle's radius.
VANTAGE_INTERNAL_API void move_into_range(TargetFrame& frame, double max_range);

}  // namespace vantage::internal::target
