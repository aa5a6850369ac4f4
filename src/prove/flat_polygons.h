// Convex polygons of a scene's triangles that lie in one plane.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "prove/fine.h"
#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage::internal::prove {

/// The corners run counter-clockwise about the normal. The triangles meet along whole edges, so that they leave no
/// crack; all of their outline is within `slack_m` of the polygon's, and all of them within it of the plane.
struct FlatPolygon {
  std::vector<Vec3> corners;
  std::vector<Vec3> inward;  ///< per side, from its corner to the next: to the inside, in the plane; unit length
  Vec3 normal = Vec3::Zero();
  double slack_m = 0;
  bool is_exactly_flat = false;          ///< all of them lie in one plane, to the last bit
  double outline_slack_m = 0;            ///< of slack_m, what is within the plane
  std::vector<FineVec3> fine_corners;    ///< the corners with more digits
  double reach_m = 0;                    ///< of the corners from the origin, at most
  std::vector<std::uint32_t> triangles;  ///< of the scene; sorted
};

/// Grown about a triangle when it is asked for, from neighbours across edges; what comes out depends on that triangle
/// alone. Any thread may ask.
class FlatPolygons {
 public:
  /// Takes these triangles of the scene; numbers may repeat. Positions are taken about `origin`. Cost: linear.
  FlatPolygons(const Scene& scene, const Vec3& origin, std::vector<std::uint32_t> triangles);

  /// The polygon about one of the triangles. Null where it has no area.
  const FlatPolygon* around(std::uint32_t triangle) const;
  /// The triangle by itself. Null where it has no area.
  const FlatPolygon* only(std::uint32_t triangle) const;

 private:
  struct Slot {
    std::once_flag grown_once, single_once;
    std::unique_ptr<FlatPolygon> grown, single;
  };
  class Growth;

  std::uint32_t slot_of(std::uint32_t triangle) const;
  void weld(const Scene& scene);
  void link();
  template <typename Visit>
  void visit_run(std::uint32_t from, std::uint32_t to, const Visit& visit) const;

  Vec3 origin_;
  std::vector<std::uint32_t> numbers_;               ///< sorted; a slot is a place in it
  std::vector<Triangle> triangles_;                  ///< by slot; of positions_
  std::vector<Vec3> positions_, stored_;             ///< about the origin; as the scene has them
  std::vector<std::uint32_t> first_run_, next_run_;  ///< runs 3 slot + k, from corner k on, by their end points
  double planar_m_ = 0;                              ///< what is nearer to a plane is in it
  std::unique_ptr<Slot[]> slots_;
};

}  // namespace vantage::internal::prove
