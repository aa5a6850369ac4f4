// The convex hull of points, asked through its points alone: lowest point in a direction, nearest point, half-spaces
// round it. No facets are needed, so that nothing can go wrong where the points lie in a plane or on a line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::flight::tour {

/// The points x with normal . x <= offset.
struct HalfSpace {
  Vec3 normal = Vec3::Zero();  ///< unit length, but for rounding
  double offset = 0;
  double thickness_m = 0;  ///< of the hull, along the normal
};

/// Where a hull is nearest to something, and how to keep apart from it.
struct NearestInHull {
  Vec3 point = Vec3::Zero();
  double distance_m = 0;  ///< 0: it is in the hull, but for rounding
};

class Hull {
 public:
  /// At least one point; finite, metres. Repeated points do not matter. `moved_m`: what is meant lies no farther from
  /// the hull of these points than that. Cost: O(n log n).
  explicit Hull(std::vector<Vec3> points, double moved_m = 0);

  /// A point p of the given ones at which direction . p is least, among equals any. What is computed of others may be
  /// less by 8 roundings of |direction|_1 reach_m(), not more.
  const Vec3& lowest(const Vec3& direction) const;

  /// To within `tolerance_m` where it is farther than that. Gilbert, Johnson and Keerthi 1988.
  NearestInHull nearest(const Vec3& point, double tolerance_m) const;
  /// To a segment, by projecting to and fro a few times: for choices, not for bounds.
  NearestInHull nearest_to_segment(const Vec3& from, const Vec3& to, double tolerance_m) const;

  bool is_point() const { return extent_m_ == 0; }
  const std::vector<Vec3>& points() const { return points_; }
  const Vec3& middle() const { return middle_; }  ///< of the box
  const Vec3& inside() const { return inside_; }  ///< mean of the lowest points in many directions: deep inside
  double extent_m() const { return extent_m_; }   ///< the box's diagonal
  double reach_m() const { return reach_m_; }     ///< the largest coordinate, as a size
  double moved_m() const { return moved_m_; }
  const Box& box() const { return box_; }
  /// That hold it, each touching it: 26, and those that were added.
  const std::vector<HalfSpace>& half_spaces() const { return half_spaces_; }
  /// That touches the hull.
  HalfSpace half_space(const Vec3& normal) const;
  /// Keeps one for programs to come; of many the last ones.
  void add(const HalfSpace& half_space);

 private:
  struct Node {
    Box box;
    std::uint32_t begin, end;  ///< of points_
    std::uint32_t right;       ///< the left child follows its parent; 0 for a leaf
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end);

  std::vector<Vec3> points_;
  std::vector<Node> nodes_;
  std::vector<HalfSpace> half_spaces_;
  std::size_t added_ = 0;
  Box box_;
  Vec3 middle_ = Vec3::Zero(), inside_ = Vec3::Zero();
  double extent_m_ = 0, reach_m_ = 0, moved_m_ = 0;
};

/// The point of a simplex of 1 to 4 corners that is nearest to the origin, and the corners that span it: the others are
/// removed from `corners`.
Vec3 nearest_of_simplex(std::vector<Vec3>& corners);

}  // namespace vantage::internal::flight::tour
