// Planes in front of everything that the contents of a box can hide.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "exact/blocker.h"
#include "scene/bvh.h"

namespace vantage::exact {

/// For any normal m with m . t <= h for all target points t, m . o >= h for all points o of a box, and h > 0, whatever
/// the box holds hides only points with m . x >= h: for x = o + s (o - t), m . x = m . o + s (m . o - m . t) >= h. Any
/// set of such planes bounds the box's inverse depth from above; this one takes the box's own faces, the planes through
/// the target's edges that touch the box, and the target's normal.
class NodePlanes {
 public:
  NodePlanes(const LocalTarget& target, const TargetFrame& frame);

  /// Sets the planes of a box given in the scene's axes; `centre` is the target's centre in the same coordinates.
  /// False when the box reaches nowhere above the target's plane.
  bool set(const scene::Bounds& bounds, const Vec3& centre);

  std::span<const Plane> planes() const { return {planes_.data(), count_}; }

 private:
  void add(const Vec3& normal, double height);

  static constexpr std::size_t kMostEdges = 8;
  std::vector<LocalTarget::Edge> edges_;
  std::array<Vec3, 3> axes_;                        // the scene's axes in the target's frame
  std::array<double, 3> target_low_, target_high_;  // extent of the target along them
  std::array<Plane, kMostEdges + 4> planes_;
  std::size_t count_ = 0;
};

}  // namespace vantage::exact
