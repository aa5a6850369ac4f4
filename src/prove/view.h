// One part of the target, and the scene in front of it.
#pragma once

#include <vector>

#include "prove/corner_planes.h"
#include "prove/scene_tree.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage::internal::prove {

/// Positions are relative to `origin`, c in docs/proof.md.
struct View {
  Vec3 origin = Vec3::Zero();  ///< of the part, raised; scene frame
  Vec3 normal = Vec3::Zero();  ///< to the front; unit length
  bool all_sides = false;
  std::vector<Vec3> whole;    ///< the part's corners
  std::vector<Vec3> corners;  ///< less the strip along its outline
  std::vector<Vec3> inner;    ///< less a strip of inner_margin_m: numbers tell it from planes that touch `corners`
  std::vector<Vec3> surely;   ///< less so much only that what is left is in the target, whatever was rounded
  double margin_m = 0;        ///< the strip's width, and the height under which obstacles do not count

  double inner_margin_m() const { return 4 * margin_m; }
  /// What a position in front may lie behind the plane by, as far as numbers can tell.
  double unsure_at(const Vec3& position) const;
};

View make_view(const Target& target, std::size_t part, double lift_m);

/// What of the scene's triangles lies in front of the target by more than the margin, in a tree: of those that reach
/// into `near`, or of all, also where nothing is left of a triangle.
SceneTree obstacles_in_front(const Scene& scene, const View& view, const Box& near);
SceneTree all_obstacles_in_front(const Scene& scene, const View& view);
/// The same of one triangle, with more digits.
std::vector<FineVec3> fine_corners_in_front(const Scene& scene, std::uint32_t triangle, const View& view);

}  // namespace vantage::internal::prove
