// Whether points lie in a closed mesh, without rounding.
#pragma once

#include <cstdint>
#include <vector>

#include "core/bvh.h"
#include "vantage/geometry.h"

namespace vantage::internal::solid {

/// Refers to the mesh, which must outlive it, be closed and oriented. Any number of threads may ask at once. Building:
/// O(n log n).
class ExactWinding {
 public:
  explicit ExactWinding(const Mesh& mesh);

  /// Whether the mesh winds round the point at least once, or the point is on a triangle. Decided by the coordinates as
  /// they are. The point must be finite. Cost: O(log n), and the triangles straight above the point.
  bool holds(const Vec3& point) const;

 private:
  const Mesh& mesh_;
  Box bounds_;
  Vec3 origin_ = Vec3::Zero();        ///< boxes are about it: they are single precision
  std::vector<std::uint32_t> order_;  ///< triangles, as the leaves hold them
  std::vector<Box> boxes_;            ///< of these
  core::Bvh bvh_;
};

}  // namespace vantage::internal::solid
