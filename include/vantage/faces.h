// Roofs and outer walls of the objects of a scene, as targets.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage {

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

}  // namespace vantage
