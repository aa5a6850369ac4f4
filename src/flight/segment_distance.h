// How far straight lines are from the triangles of a mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/bvh.h"
#include "vantage/geometry.h"

namespace vantage::internal::flight {

/// Square of the distance from the segment pq, which may be a point, to the closed triangle abc, which may have no
/// area; 0 where they meet. The distance is right to some 1e-15 of the coordinates, and to 1e-8 of the segment's length
/// where it runs along an edge.
double squared_segment_distance(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// Refers to the mesh, which must outlive it and should lie about the origin. Any number of threads may ask at once.
class SegmentDistance {
 public:
  /// Cost: O(n log n).
  explicit SegmentDistance(const Mesh& mesh);

  struct Nearest {
    double distance_m = 0;
    std::optional<std::uint32_t> triangle;  ///< nothing where none is nearer than `below`
  };
  /// From the segment pq to the mesh, which must not be empty; 0 where they meet. Only what is nearer than `below` is
  /// looked for: else that is the answer. The distance is right, or up to `slack` >= 0 too large: much is saved where
  /// thousands of facets are about as near, as in the middle of a dome.
  Nearest nearest(const Vec3& p, const Vec3& q, double below, double slack) const;

 private:
  const Mesh& mesh_;
  std::vector<std::uint32_t> order_;
  core::Bvh bvh_;
};

}  // namespace vantage::internal::flight
