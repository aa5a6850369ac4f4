// What of the scene may lie between a leg and a target.
#pragma once

#include <span>
#include <vector>

#include "core/bvh.h"
#include "query/side.h"
#include "vantage/query.h"

namespace vantage::internal::query {

/// The convex hull of a leg and one side of a target: what hides any of the target from anywhere on the leg meets it.
/// Held by slabs: along the axes, and square to its facets. Positions are relative to the scene's origin.
class LegHull {
 public:
  /// Grown by `radius`, in front of the target's plane.
  LegHull(const Side& side, const Leg& leg, double radius);

  /// False only where the hull does not meet the box.
  bool may_meet(const core::Bounds& bounds) const;
  /// The same of a convex polygon.
  bool may_meet(std::span<const Vec3> corners) const;

 private:
  struct Slab {
    Vec3 normal, size;  ///< unit length; its absolute values
    double low, high;
  };
  void add(const Vec3& normal, double room);

  std::vector<Vec3> target_;
  Vec3 from_, to_;
  double radius_;
  std::vector<Slab> slabs_;
};

}  // namespace vantage::internal::query
