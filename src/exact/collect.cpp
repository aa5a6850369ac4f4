#include "exact/collect.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/bounds_distance.h"
#include "core/walk_bvh.h"
#include "exact/segment_cover.h"
#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

// A polygon that reaches this far over a plane, in metres, does so whatever rounding does.
constexpr double kNear = 1e-7;

/// Finds the planes of a blocker whose facets its polygon's neighbours hide. Where only the polygon's own plane is
/// left, its facet is the polygon, and the blocker is confined to that. A facet is swept from the corners that its
/// plane touches, away from the target; a neighbour that has those corners hides every point of it, unless the plane
/// bounds what the neighbour hides as well. So of a closed surface only the silhouette casts shadows: docs/theory.md,
/// "Only what is seen can hide".
class Neighbours {
 public:
  Neighbours(const PreparedScene::Data& scene, const TargetFrame& frame, const target::LocalTarget& target,
             double reach)
      : scene_(scene), frame_(frame), target_(target), centre_(frame.origin - scene.origin), reach_(reach) {}

  /// For the last blocker of the set; `corners` are those of its polygon, not clipped.
  void mark_hidden(std::uint32_t polygon, std::span<const Vec3> corners, BlockerSet& blockers) {
    const auto clipped = blockers.corners_of(blockers.count() - 1);
    if (clipped.empty()) return;  // its facets are not all swept from corners of the polygon
    // Where the target's plane cuts the polygon, its planes touch it at corners that no neighbour knows.
    if (std::any_of(corners.begin(), corners.end(), [&](const Vec3& c) { return c.z() < -target_.slack; })) return;
    const auto vertices = scene_.corners_of(polygon);
    std::size_t visible_others = 0, own_planes = 0;
    for (std::uint32_t k = blockers.first[blockers.count() - 1]; k < blockers.planes.size(); ++k) {
      const double margin = touch_margin(blockers.planes[k], reach_);
      touched_.clear();
      for (std::size_t i = 0; i < corners.size(); ++i)
        if (std::abs(blockers.planes[k].dot(clipped[i]) - 1) <= margin) touched_.push_back(vertices[i]);
      if (touched_.size() == corners.size()) {
        own_planes += is_clear_of(blockers.planes[k]) ? 1 : 2;
        continue;
      }
      const auto hidden = [&](std::uint32_t other) {
        return other != polygon && hides(other, blockers.planes[k], 1 - kNear * blockers.planes[k].norm());
      };
      const auto candidates = touched_.empty() ? std::span<const std::uint32_t>() : scene_.polygons_at(touched_[0]);
      blockers.visible[k] = std::none_of(candidates.begin(), candidates.end(), hidden);
      visible_others += blockers.visible[k];
    }
    blockers.confined.back() = own_planes == 1 && visible_others == 0;
  }

 private:
  // Whether the plane of a polygon does not touch the target: then what lies on it is hidden only by the polygon.
  bool is_clear_of(const Plane& plane) const {
    return std::all_of(target_.vertices.begin(), target_.vertices.end(),
                       [&](const auto& t) { return plane.head<2>().dot(t) < 1 - kNear * plane.norm(); });
  }

  // Whether a polygon has all the touched corners and also reaches to the near side of the plane.
  bool hides(std::uint32_t other, const Plane& plane, double near) const {
    const auto vertices = scene_.corners_of(other);
    for (std::uint32_t v : touched_)
      if (std::find(vertices.begin(), vertices.end(), v) == vertices.end()) return false;
    bool stands = false, reaches = false;  // above the target's plane, to the near side
    for (std::uint32_t v : vertices) {
      const Vec3 d = scene_.vertices[v] - centre_;
      const Vec3 local(frame_.axis_u.dot(d), frame_.axis_v.dot(d), frame_.normal.dot(d));
      stands = stands || local.z() > target_.slack;
      reaches = reaches || (local.z() >= 0 && plane.dot(local) < near);
    }
    return stands && reaches;
  }

  const PreparedScene::Data& scene_;
  const TargetFrame& frame_;
  const target::LocalTarget& target_;
  Vec3 centre_;
  double reach_;
  std::vector<std::uint32_t> touched_;
};

}  // namespace

void collect_blockers(const PreparedScene::Data& scene, const TargetFrame& frame, const target::LocalTarget& target,
                      const target::RangeRegion& range, BlockerSet& blockers, DirectionTree& tree,
                      const core::ProgressReporter& progress) {
  const Vec3 centre = frame.origin - scene.origin;
  const double reach = std::max(range.radius(), target.radius);  // a segment from the region to the target stays within
  // The scene's axes in the target's frame.
  std::array<Vec3, 3> axes;
  for (int a = 0; a < 3; ++a) axes[a] = {frame.axis_u[a], frame.axis_v[a], frame.normal[a]};
  BlockerBuilder builder(target);
  Neighbours neighbours(scene, frame, target, range.radius());
  std::vector<Vec3> corners;
  std::size_t steps = 0;
  const auto may_show = [&](const core::BvhNode& node) {
    if (++steps % 1024 == 0) progress.check();
    if (scene.bvh.is_above_groups(node)) return true;
    Vec3 middle = Vec3::Zero();
    std::array<Vec3, 3> half;
    double above = 0;
    for (int a = 0; a < 3; ++a) {
      const double low = node.bounds.min[a] - centre[a], high = node.bounds.max[a] - centre[a];
      middle += axes[a] * (0.5 * (low + high));
      half[a] = axes[a] * (0.5 * (high - low));
      above += std::abs(half[a].z());
    }
    const bool is_behind_target = middle.z() + above <= target.slack;
    return !is_behind_target && !tree.hides_box(middle, half);
  };
  const auto add = [&](std::uint32_t polygon) {
    target::local_polygon(scene, frame, polygon, corners);
    if (tree.hides_hull(corners)) return;
    const std::size_t planes = blockers.planes.size();
    if (!builder.build(corners, blockers.planes, blockers.corners)) return;
    if (blockers.planes.size() == planes)  // it hides everything
      blockers.planes.emplace_back(0, 0, 1 / (numerics::kGrazing * target.clearance));
    blockers.close(polygon);
    neighbours.mark_hidden(polygon, corners, blockers);
    if (!tree.insert(static_cast<std::uint32_t>(blockers.count() - 1))) blockers.drop_last();
  };
  const auto distance = [&](const core::Bounds& bounds) { return core::distance_to(bounds, centre); };
  core::walk_nearest_first(scene.bvh, distance, reach, may_show, add);
}

}  // namespace vantage::internal::exact
