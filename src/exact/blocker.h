// What one convex scene polygon hides: docs/theory.md, "What one polygon blocks is convex".
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/plane.h"
#include "target/local_target.h"

namespace vantage::internal::exact {

/// A plane of a blocker: g . x = 1 bounds what it hides. Hidden points have g . x > 1 for all of its planes.
using core::Plane;

/// The part of a polygon (local frame, metres) that is above the target's plane; heights within `slack` of it are set
/// to zero. Nothing where the polygon reaches nowhere above it.
void clip_to_front(std::span<const Vec3> polygon, double slack, std::vector<Vec3>& clipped);

/// Planes of B(O) for the convex polygon O (local frame, metres, at least 3 corners, planar to rounding), clipped to
/// z >= 0. Appends to `planes` and the clipped corners to `corners`; returns false and appends nothing when O reaches
/// nowhere above the target's plane. Every plane holds all of B(O) on its far side (to target::LocalTarget::slack), so
/// leaving one out, or easing it, only hides more. That is done to planes within numerics::kGrazing of the target's;
/// then no corners are appended, for facets need not begin at them, and there may be no planes at all. Cost: O(N M) for
/// N target vertices and M corners.
class BlockerBuilder {
 public:
  explicit BlockerBuilder(const target::LocalTarget& target) : target_(target) {}
  bool build(std::span<const Vec3> polygon, std::vector<Plane>& planes, std::vector<Vec3>& corners);

 private:
  void add_own_plane(const Vec3& normal);
  void add_target_edge_planes();
  void add_polygon_edge_planes(const Vec3& polygon_normal);
  void add_edge_plane(const Vec3& normal, double height);
  void add(const Vec3& normal, double height);
  bool same(const Plane& kept, const Plane& plane) const;

  const target::LocalTarget& target_;
  std::vector<Vec3> polygon_;             // clipped
  std::vector<std::uint8_t> on_polygon_;  // per target vertex: 1 where the polygon's plane, if kept, touches it
  std::vector<Plane>* planes_ = nullptr;
  std::size_t first_ = 0;
  bool grown_ = false;  // hides more than the polygon does
};

}  // namespace vantage::internal::exact
