// The target as the check sees it: its own frame, made from the public Target alone and shared with nobody.
#pragma once

#include <vector>

#include "vantage/target.h"
#include "verify/box_index.h"

namespace vantage::internal::verify {

class TargetView {
 public:
  /// The view of a target of one part: the polygon in the plane through the mean of its vertices, normal by Newell's
  /// rule, front by the rule in vantage/target.h, offset applied. Vertices that rounding has put inside the others'
  /// outline, by a millionth of the extent at most, are left out. A point has one vertex and the plane through it.
  /// Throws Error(input) for a polygon that has no plane, is not planar or not convex.
  explicit TargetView(const Target& target);

  const Vec3& origin() const {
    return origin_;
  }  ///< of the check's local frame, in scene coordinates; axes as the scene's
  const Vec3& centre() const { return centre_; }                   ///< mean of the vertices, local
  const Vec3& normal() const { return normal_; }                   ///< unit, towards the front
  const std::vector<Vec3>& vertices() const { return vertices_; }  ///< local, counter-clockwise seen from the front

  bool is_point() const { return vertices_.size() == 1; }
  bool all_sides() const { return all_sides_; }  ///< a point without front: its plane hides nothing

  double height(const Vec3& point) const { return normal_.dot(point - centre_); }  ///< above the plane, metres
  double farthest(const Vec3& point) const;  ///< distance to the farthest point of the target, metres

  /// Whether the point, dropped along the normal, falls on the target grown by `margin` metres on every side.
  bool over(const Vec3& point, double margin) const;

  /// Whether what is seen from the point need lie on no side of the target's plane, or lies in front of it, farther
  /// than the margin.
  bool in_front(const Vec3& point, double margin = 0) const { return all_sides_ || height(point) > margin; }

  /// A point of the polygon; uniform when u and v are uniform in [0, 1), and continuous but for the polygon's fan.
  Vec3 interior(double u, double v) const;

 private:
  void set_point(const Target& target);
  void set_plane(const Target& target);
  void drop_reflex_vertices(const Target& target, double slack);
  void check_shape(const Target& target);

  Vec3 origin_, centre_, normal_;
  bool all_sides_ = false;
  std::vector<Vec3> vertices_;
  std::vector<HalfSpace> sides_;  ///< one an edge, unit normals pointing inwards
  std::vector<double> fan_area_;  ///< running sum over the triangles (0, i, i + 1), relative to the whole
};

}  // namespace vantage::internal::verify
