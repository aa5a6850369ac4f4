// What must be seen, whole: one or more convex polygons, or a single point. Or, for flights alone, a volume to fly
// through.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/navigation.h"
#include "vantage/scene.h"

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

  bool operator==(const Target&) const = default;
};

/// A checked target with its frame. Viewpoints have local z > 0, but for a point that is seen from all sides.
struct TargetFrame {
  Vec3 origin = Vec3::Zero();  ///< strictly inside the polygon, near its smallest enclosing circle's centre; the point
  Vec3 axis_u = Vec3::UnitX(), axis_v = Vec3::UnitY(), normal = Vec3::UnitZ();  ///< right-handed orthonormal; `normal`
                                                                                ///< points to the front
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

// ---- Roofs and outer walls of the objects of a scene, as targets

enum class FaceKind : std::uint8_t {
  roof,    ///< faces upward: by more than 15 degrees out of the vertical
  facade,  ///< a wall: its normal is within 15 degrees of horizontal
};

/// "roof", "facade".
VANTAGE_API const char* name_of(FaceKind kind);

/// A connected piece of an object's surface in one plane, without what lies on it.
struct Face {
  std::uint32_t object = 0;              ///< index into Scene::objects
  Vec3 normal = Vec3::UnitZ();           ///< unit, out of the object
  double area_m2 = 0;                    ///< of all parts
  std::vector<std::vector<Vec3>> parts;  ///< convex polygons that cover it and overlap only along their sides, in one
                                         ///< plane, counter-clockwise seen from outside
};

/// Finds the faces of objects of one scene, which must outlive this.
///
/// Triangles of an object belong to one face where they share edges (vertices at exactly the same position count as
/// one) and all of their corners are within 0.5 mm of the plane of the largest of them. A face whose corners are off
/// that plane by more than rounding is laid into the parallel plane through the outermost corner: at most 1 mm out of
/// the object, never into it, and seen along its normal of the same outline.
///
/// Outside is found by rays, steeply upward and nearly level, and by how often they cross the object. So a building
/// needs no floor, and its triangles may be turned at random. Where both sides are outside, as of a sheet, it is the
/// one from which the triangles run counter-clockwise; what has the object on both sides is no face.
///
/// Not part of a face is where anything of the scene is less than 3 mm in front of it, where the wall of a solid lies
/// against it (within 1 mm of its plane), what is in another solid, and of a facade what is under ground
/// (ObjectKind::ground). What is left in connected pieces of 1 m2 or less is left out.
class VANTAGE_API FaceFinder {
 public:
  /// Throws Error(input) for a scene whose arrays do not fit together. Cost: O(n log n) in the scene's triangles.
  explicit FaceFinder(const Scene& scene);
  ~FaceFinder();
  FaceFinder(FaceFinder&&) noexcept;
  FaceFinder& operator=(FaceFinder&&) noexcept;

  /// The faces of these objects (indices into Scene::objects), in the order of the objects and of their triangles.
  /// Throws Error(input) for an index out of range. Uses the threads of the caller's arena. Cost: in proportion to the
  /// objects' triangles and to what is near them.
  std::vector<Face> faces(std::span<const std::uint32_t> objects, FaceKind kind) const;

  /// The one that is nearest to a point (the first one of several); nothing where there is no face of that kind.
  /// Throws as faces(), and for a point that is not finite. Cost: less than that of faces(), as few of them are made.
  std::optional<Face> nearest(std::span<const std::uint32_t> objects, FaceKind kind, const Vec3& point) const;

  struct Data;

 private:
  std::unique_ptr<const Data> data_;
};

/// Those whose normal, seen from above, is within 45 degrees of a direction, clockwise from north (y). Level faces
/// point nowhere.
VANTAGE_API std::vector<Face> facing(const std::vector<Face>& faces, double heading_deg);

/// One target of all the parts of some faces: all of them must be seen. `front` or `front_by_order` is set as the faces
/// need it. At least one face.
VANTAGE_API Target target_of(std::span<const Face> faces, std::string name);

// ---- A target that is ready to be seen: checked against its scene, once, for every method

/// A target in a scene, with the range it is looked at from. Immutable and cheap to copy (a shared handle); any number
/// of threads may use it at once. Holds on to the scene.
class VANTAGE_API PreparedTarget {
 public:
  /// Checks the target and finds how far each part must be raised to clear the surface that it lies on: rounding of
  /// the input, less than 2.01 mm; where max_range is less than 20 m, in proportion. Throws Error(input) for a bad
  /// target (see make_target_frame), a pierced one (object, place, smallest offset that clears it) and a max_range that
  /// is not positive and finite, or beyond 1e9 m. Cost: in proportion to the scene's polygons near the target.
  PreparedTarget(const PreparedScene& scene, const Target& target, const Sensor& sensor);

  const PreparedScene& scene() const;
  const Target& target() const;  ///< as given
  const Sensor& sensor() const;
  std::size_t part_count() const;

  /// Of a part as it is used, lift included.
  const TargetFrame& frame(std::size_t part = 0) const;
  double lift_m(std::size_t part) const;      ///< how far it was raised
  double lift_m() const;                      ///< the largest
  const std::vector<Warning>& notes() const;  ///< what to know before relying on results: the target seems to be
                                              ///< under the ground

  /// The same of one part alone.
  PreparedTarget part(std::size_t index) const;

  /// One part cut into `count` convex cells of the same area, which together hold all of it: in its plane, raised as it
  /// is, and seen from its side. Their sensor has this range, more than the radius of the part's enclosing circle, and
  /// nothing else. Twice as many cells are halves of these where `count` is a power of two. Cells overlap by rounding,
  /// in parts of the target's extent by 1e-12 and where the cut passes a corner by at most 1e-6. Throws Error(input)
  /// for a point.
  std::vector<PreparedTarget> cells(std::size_t part, std::size_t count, double max_range_m) const;

  /// The same target where it is, in a scene without anything.
  PreparedTarget alone() const;

  struct Data;
  const Data& data() const { return *data_; }  ///< for the methods

 private:
  explicit PreparedTarget(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace vantage
