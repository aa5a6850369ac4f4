// What must be seen, whole: one or more convex polygons, or a single point. Or, for flights alone, a volume to fly
// through.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage {

/// A region to fly through: a target of tours and of checked flights, of which nothing is there to be seen.
struct TargetVolume {
  Mesh mesh;              ///< closed, outward oriented, does not pass through itself; scene frame, metres
  double rounding_m = 0;  ///< how far the numbers of its file may have moved its surface, as the file says
  /// Its file says that vantage computed it: it lies inside of where its target is seen, and may be smaller.
  bool is_computed = false;
};

/// As the user states it, in the scene frame, metres. See docs/theory.md for what "seen" means.
struct VANTAGE_API Target {
  std::string name = "target";
  /// Convex planar polygons of 3 to 64 vertices, in order round the polygon, either turn; all of them must be seen. One
  /// part of a single vertex is a point. Default: one part, which has no vertices yet.
  std::vector<std::vector<Vec3>> parts = std::vector<std::vector<Vec3>>(1);
  double offset_m = 0.0;      ///< each part is moved this far along its normal, towards the front, before anything else
  std::optional<Vec3> front;  ///< a vector on the side that is looked at (any length, not in the polygon's plane).
                              ///< Default: the side that faces up; for a vertical polygon (normal within 1e-6 of
                              ///< horizontal) the side from which the vertices run counter-clockwise.
                              ///< A point is seen from the half-space on this side only; without `front` from all
                              ///< sides, and its normal is up

  bool front_by_order = false;  ///< without `front`: each part is seen from the side from which its vertices run
                                ///< counter-clockwise, also one that faces down. Not for a point

  /// Instead of parts, of which there is one without vertices then: null for all that is to be seen.
  std::shared_ptr<const TargetVolume> volume = nullptr;

  static Target polygon(std::vector<Vec3> vertices);
  static Target point(const Vec3& place);

  bool is_volume() const { return volume != nullptr; }
  bool is_point() const { return parts.size() == 1 && parts[0].size() == 1; }

  /// A target of that part alone; the second goes by the name of "NAME, part 2".
  Target part(std::size_t index) const;
};

/// A checked target with its frame. Viewpoints have local z > 0, but for a point that is seen from all sides.
struct TargetFrame {
  Vec3 origin;                  ///< strictly inside the polygon, near its smallest enclosing circle's centre; the point
  Vec3 axis_u, axis_v, normal;  ///< right-handed orthonormal; `normal` points to the front
  std::vector<Eigen::Vector2d> polygon;  ///< corners in (u, v) about `origin`, metres, counter-clockwise seen from the
                                         ///< front; of a point: (0, 0) alone
  double enclosing_radius_m = 0.0;       ///< of the smallest enclosing circle; 0 for a point
  bool all_sides = false;                ///< a point without `front`: viewpoints may have any local z

  Vec3 to_local(const Vec3& point) const {
    const Vec3 d = point - origin;
    return {axis_u.dot(d), axis_v.dot(d), normal.dot(d)};
  }
  Vec3 to_scene(const Vec3& local) const {
    return origin + axis_u * local.x() + axis_v * local.y() + normal * local.z();
  }
};

/// Checks a part of a target and makes its frame, `offset_m` applied. The scene plays no role here.
///
/// The polygon of the frame is the convex hull of the vertices, in the plane of their mean. It never loses a corner:
/// every vertex lies in it, but for 2^-50 of the extent, which is the rounding of its coordinates. A vertex is left out
/// where it lies inside the line between the corners beside it, by at most 1e-9 of the extent (and 2^-50 of the largest
/// coordinate); so much larger the polygon may be than what its vertices bound.
///
/// Throws Error(not_applicable) for a target that is a volume, and Error(input) for: no such part, no vertices, 2 or
/// more than 64, one vertex beside other parts, a coordinate that is not finite, repeated vertices (which; those nearer
/// to each other than 1e-9 of the extent), zero area, not planar (by how much; allowed: 1e-6 of the extent, at least 1
/// mm), not convex by more than said above (which vertex), a `front` that is zero or lies in the plane.
VANTAGE_API TargetFrame make_target_frame(const Target& target, std::size_t part = 0);

}  // namespace vantage
