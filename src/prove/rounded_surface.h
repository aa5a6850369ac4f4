// Whether a volume holds what lies below its surface, once its vertices were rounded.
#pragma once

#include <optional>

#include "prove/scene_tree.h"
#include "vantage/geometry.h"

namespace vantage::internal::prove {

class RoundedSurface {
 public:
  /// `volume`: closed, about the origin of its view. `rounding_m`: how far a file's numbers moved the surface, if at
  /// all.
  RoundedSurface(const Mesh& volume, double rounding_m);

  /// Whether the volume held a position, before it was rounded, from which the same is hidden as from a point on its
  /// surface: one up to `depth_m` nearer to the origin, or any behind. It did where it winds round one that no facet is
  /// as near to as it can have been moved, or as numbers can tell. Facets that lie on each other, as the two sides of a
  /// flap, bound nothing. Not all positions are tried.
  ///
  /// The result: how much nearer to the origin it is, if no place next to the surface is held, on either side; 0 where
  /// one is.
  std::optional<double> surely_held(const Vec3& on_surface, double depth_m) const;

  /// How often it winds round a position, exactly. Nothing where rays meet edges.
  std::optional<int> turns_round(const Vec3& position) const;
  const SceneTree& facets() const { return tree_; }

 private:
  bool surely_holds(const Vec3& position) const;
  bool is_clear(const Vec3& position) const;

  double rounding_m_;
  Box box_;
  SceneTree tree_;
};

}  // namespace vantage::internal::prove
