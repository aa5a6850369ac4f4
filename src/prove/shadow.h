// What a convex polygon hides, B(O) in docs/proof.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "prove/flat_polygons.h"
#include "prove/scene_tree.h"
#include "prove/view.h"

namespace vantage::internal::prove {

/// What is looked at, for shadows: convex faces, points of which a witness names.
struct ShadowTarget {
  std::vector<std::vector<Vec3>> faces;  ///< about View::origin: the target, or of a point three squares about it
  Vec3 normal = Vec3::Zero();
  double floor_m = 0;   ///< what hides lies higher over the target's plane; minus infinity from all sides
  double radius_m = 0;  ///< of all corners from the origin, at most
  bool is_flat = false;
};

/// `point_radius_m`: of the ball that stands for a point.
ShadowTarget shadow_target(const View& view, double point_radius_m);

/// The segment from a position to `target_point` passes through a polygon.
struct Hit {
  Vec3 target_point = Vec3::Zero();
  double depth_m = 0;     ///< of the place where it passes, from the polygon's outline
  double before_m = 0;    ///< of the target's point from the polygon's plane
  double behind_m = 0;    ///< of the position from it, on the other side
  bool is_front = false;  ///< the position lies on the side that the normal points to
};

/// A place well inside of what is hidden of the target, if anything is.
std::optional<Hit> find_hit(const Vec3& position, const FlatPolygon& polygon, const ShadowTarget& target);

/// Whether the polygon hides something of the target from all of the hull of some positions, whatever was rounded.
/// `farthest_m`: of the positions from the origin, at most. `largest`: no coordinate is larger.
bool hides(const FlatPolygon& polygon, const ShadowTarget& target, const std::array<Hit, 3>& hits, double farthest_m,
           double largest);

/// The same with more digits, of an exactly flat polygon and the positions that were hit from: where the target is seen
/// at so flat an angle that roundings hide whether it is.
bool hides_finely(const FlatPolygon& polygon, const ShadowTarget& target, const std::array<Vec3, 3>& positions,
                  const std::array<Hit, 3>& hits, double farthest_m, double largest);

/// The triangles of the tree that may hide something of the target from a position, as numbers of the scene's
/// triangles, each once.
void collect_hiding(const Vec3& position, const ShadowTarget& target, const SceneTree& obstacles,
                    std::vector<std::uint32_t>& triangles);

}  // namespace vantage::internal::prove
