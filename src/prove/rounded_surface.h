// What the surface of a volume leaves open once its vertices were rounded.
#pragma once

#include <array>
#include <vector>

#include "prove/scene_tree.h"
#include "vantage/geometry.h"

namespace vantage::internal::prove {

class RoundedSurface {
 public:
  /// `volume`: closed, about the origin of its view. `rounding_m`: how far a file's numbers moved the surface.
  RoundedSurface(const Mesh& volume, double rounding_m);

  /// Whether the volume held one of these positions before it was rounded: those from a point on its surface up to
  /// `depth_m` towards the origin. It did where it holds one that no facet is as near to as it can have been moved.
  bool was_below_for_sure(const Vec3& on_surface, double depth_m) const;

 private:
  bool is_clear(const Vec3& position) const;

  double rounding_m_;
  std::vector<std::array<Vec3, 3>> facets_;
  SceneTree tree_;
};

}  // namespace vantage::internal::prove
