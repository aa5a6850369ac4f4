// A computed volume as a set of points.
#pragma once

#include <algorithm>
#include <memory>

#include "support/internals.h"
#include "support/random.h"
#include "vantage/volume.h"
#include "verify/closed_mesh.h"

namespace vantage::testing {

class MeshProbe {
 public:
  explicit MeshProbe(const Volume& volume)
      : origin_(volume.frame.origin),
        bounds_(bounding_box(volume.mesh)),
        mesh_(std::make_unique<verify::ClosedMesh>(volume.mesh, origin_, "volume")) {}

  /// Metres from the surface: positive inside, negative outside. Scene frame.
  double depth(const Vec3& point) const {
    const double distance = mesh_->distance_to_surface(point - origin_);
    return mesh_->contains(point - origin_).value_or(true) ? distance : -distance;
  }

  /// Whether the point is surely inside: beside facets that are narrower than rounding it may stay open.
  bool holds(const Vec3& point) const { return mesh_->contains(point - origin_) == true; }

  /// A uniform point of the inside.
  Vec3 draw(Random& random) const {
    for (;;) {
      Vec3 p = random.in_box(bounds_);
      if (mesh_->contains(p - origin_) == true) return p;
    }
  }

  const Box& bounds() const { return bounds_; }

 private:
  Vec3 origin_;
  Box bounds_;
  std::unique_ptr<verify::ClosedMesh> mesh_;
};

/// Distance from a point to the farthest vertex of the target as used.
inline double farthest_vertex(const TargetFrame& frame, const Vec3& point) {
  double farthest = 0;
  for (const Eigen::Vector2d& t : frame.polygon)
    farthest = std::max(farthest, (point - frame.to_scene({t.x(), t.y(), 0})).norm());
  return farthest;
}

}  // namespace vantage::testing
