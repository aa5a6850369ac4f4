#include "prove/witness.h"

#include <Eigen/Geometry>
#include <array>

#include "prove/orientation.h"
#include "prove/rounded_surface.h"

namespace vantage::internal::prove {
namespace {

/// Where a segment passes the plane of a triangle.
Vec3 passage_of(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& corners) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double at_from = normal.dot(from - corners[0]), at_to = normal.dot(to - corners[0]);
  return from + at_from / (at_from - at_to) * (to - from);
}

/// Whether it is so as it is told, in the scene frame, where sums are rounded once more; and whether what hides counts.
bool is_hidden(const Blocked& blocked, const View& view, const std::array<Vec3, 3>& corners) {
  const Vec3 from = view.origin + blocked.viewpoint, to = view.origin + blocked.target_point;
  if (!passes_through(from, to, corners)) return false;
  return view.all_sides || view.normal.dot(passage_of(from, to, corners) - view.origin) > view.margin_m;
}

}  // namespace

std::optional<HiddenView> deepest_witness(const Scene& scene, const View& view, const SceneTree& obstacles,
                                          const OpenVolume& volume, std::optional<HiddenView> known,
                                          const core::ProgressReporter& progress) {
  if (volume.open.empty()) return known;
  constexpr std::size_t kMostFacets = 2000;  // looked at: evenly among those that are open
  const std::size_t step = 1 + volume.open.size() / kMostFacets;
  const double of_numbers_m = rounding_of_numbers_m(view.origin.cwiseAbs().maxCoeff());
  const RoundedSurface surface(volume.whole, volume.rounding_m + of_numbers_m);
  for (std::size_t i = 0; i < volume.open.size(); i += step) {
    progress.report(i, volume.open.size());
    const OpenFacet& open = volume.open[i];
    const Piece& obstacle = obstacles.pieces[open.piece];
    std::array<Vec3, 3> facet, corners;
    for (std::size_t k = 0; k < 3; ++k) {
      facet[k] = volume.vertices[volume.facets[open.facet][k]];
      corners[k] = scene.mesh.vertices[scene.mesh.triangles[obstacle.of][k]];
    }
    // At a corner the volume may lie beside the line to the target. Behind or before a place inside of the facet it
    // does not, unless the facet bounds nothing.
    const Vec3 middle = (facet[0] + facet[1] + facet[2]) / 3;
    for (const double inward : {0.0, 0.1}) {
      for (Vec3& corner : facet) corner += inward * (middle - corner);
      auto blocked = find_blocked(facet, view, obstacle);
      if (!blocked || (known && blocked->depth_m <= known->depth_m)) break;
      if (!is_hidden(*blocked, view, corners)) continue;
      const std::optional<double> nearer_m = surface.surely_held(blocked->viewpoint, blocked->depth_m);
      if (!nearer_m) continue;
      if (*nearer_m > 0) {  // the facet bounds nothing here: the volume is in front of it
        blocked->viewpoint *= 1 - *nearer_m / blocked->viewpoint.norm();
        blocked->depth_m -= *nearer_m;
        if ((known && blocked->depth_m <= known->depth_m) || !is_hidden(*blocked, view, corners)) continue;
      }
      const std::uint32_t object = scene.object_of.empty() ? 0 : scene.object_of[obstacle.of];
      known = HiddenView{.viewpoint = view.origin + blocked->viewpoint,
                         .target_point = view.origin + blocked->target_point,
                         .triangle = obstacle.of,
                         .object = object < scene.objects.size() ? display_name(scene.objects[object]) : "",
                         .facet = volume.numbers[open.facet],
                         .depth_m = blocked->depth_m};
      break;
    }
  }
  return known;
}

}  // namespace vantage::internal::prove
