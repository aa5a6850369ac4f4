#include "exact/half_space_volume.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/causes.h"
#include "exact/collect.h"
#include "exact/triangulation.h"
#include "target/lengths.h"

namespace vantage::internal::exact {
namespace {

double area_of(const Mesh& mesh, const Triangle& t) {
  const auto& v = mesh.vertices;
  return 0.5 * (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).norm();
}

void add_causes(const PreparedScene& scene, const BlockerSet& blockers, const Boundary& boundary,
                HalfSpaceVolume& side) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> of_object(scene.objects().size(), kNone);
  std::uint32_t range = kNone, plane = kNone;
  const auto number = [&](std::uint32_t& slot, const auto& make_cause) {
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(side.causes.size());
      side.causes.push_back(make_cause());
    }
    return slot;
  };
  side.cause_of.reserve(boundary.blocker_of.size());
  side.polygon_of.reserve(boundary.blocker_of.size());
  for (std::size_t i = 0; i < boundary.blocker_of.size(); ++i) {
    const std::uint32_t blocker = boundary.blocker_of[i];
    std::uint32_t index, polygon = kNoPolygon;
    if (blocker == Boundary::kRange) {
      index = number(range, [] { return Cause{CauseKind::range, "max_range"}; });
    } else if (blocker == Boundary::kTargetPlane) {
      index = number(plane, [] { return Cause{CauseKind::target_plane, "target plane"}; });
    } else {
      polygon = blockers.polygon[blocker];
      const std::uint32_t object = scene.data().polygon_object[polygon];
      index = number(of_object[object], [&] { return cause_of_object(object, scene.objects()[object]); });
    }
    side.cause_of.push_back(index);
    side.polygon_of.push_back(polygon);
    side.causes[index].area_m2 += area_of(boundary.mesh, boundary.mesh.triangles[i]);
  }
}

}  // namespace

HalfSpaceVolume compute_half_space(const PreparedScene& scene, const TargetFrame& frame,
                                   const target::RangeRegion& range, const ExactOptions& options,
                                   const core::ProgressReporter& progress) {
  const target::Lengths lengths = target::lengths_of(scene.data(), frame, range.radius());
  const target::LocalTarget target = target::make_local_target(frame.polygon, lengths.slack, lengths.rounding);
  OctahedralGrid grid(range, options.tolerance_m);
  progress.begin("finding blockers");
  BlockerSet blockers;
  DirectionTree tree(blockers, range);
  collect_blockers(scene.data(), frame, target, range, blockers, tree, progress);
  progress.begin("tracing the envelope");
  // Seen from the centre a chord must also stay well within a cell of the grid: a region may be no wider than the
  // tolerance.
  const double widest = 0.1 * range.inner_radius() * std::numbers::pi / 2 / grid.size();
  const CurveSampling sampling{std::min(options.tolerance_m * 0.5, widest),
                               std::sqrt(8 * range.radius() * options.tolerance_m)};
  const Skeleton skeleton = trace_envelope(blockers, tree, range, sampling, grid, progress);
  progress.begin("triangulating");
  Boundary boundary = triangulate_boundary(skeleton, blockers, tree, range, grid, options.tolerance_m, progress);
  progress.finish();

  HalfSpaceVolume side;
  side.counts = {scene.data().polygon_count(), blockers.count(), skeleton.visible_blockers, skeleton.visible_facets,
                 boundary.constraint_edges};
  add_causes(scene, blockers, boundary, side);
  side.range_height = 1 / range.gauge(Vec3::UnitZ());
  side.mesh = std::move(boundary.mesh);
  for (const Vec3& v : side.mesh.vertices) side.height = std::max(side.height, v.z());
  return side;
}

std::string widest_scene_cause(const std::vector<Cause>& causes) {
  const auto widest = std::max_element(causes.begin(), causes.end(), [](const Cause& a, const Cause& b) {
    return (a.kind == CauseKind::scene ? a.area_m2 : 0) < (b.kind == CauseKind::scene ? b.area_m2 : 0);
  });
  return widest->name;
}

}  // namespace vantage::internal::exact
