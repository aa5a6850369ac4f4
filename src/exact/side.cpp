#include "exact/side.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/edges.h"
#include "exact/collect.h"
#include "exact/triangulation.h"
#include "solid/csg.h"
#include "target/lengths.h"

namespace vantage::exact {
namespace {

double area_of(const Mesh& mesh, const Triangle& t) {
  const auto& v = mesh.vertices;
  return 0.5 * (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).norm();
}

void add_causes(const PreparedScene& scene, const BlockerSet& blockers, const Boundary& boundary, Side& side) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> of_object(scene.objects().size(), kNone);
  std::uint32_t range = kNone, plane = kNone;
  const auto cause = [&](std::uint32_t& slot, CauseKind kind, const std::string& name) {
    if (slot == kNone) slot = std::uint32_t(side.causes.size()), side.causes.push_back({kind, name, 0});
    return slot;
  };
  side.cause_of.reserve(boundary.blocker_of.size());
  for (std::size_t i = 0; i < boundary.blocker_of.size(); ++i) {
    const std::uint32_t blocker = boundary.blocker_of[i];
    std::uint32_t index;
    if (blocker == Boundary::kRange) {
      index = cause(range, CauseKind::range, "max_range");
    } else if (blocker == Boundary::kTargetPlane) {
      index = cause(plane, CauseKind::target_plane, "target plane");
    } else {
      const std::uint32_t object = scene.data().polygon_object[blockers.polygon[blocker]];
      index = cause(of_object[object], CauseKind::scene, scene.objects()[object]);
    }
    side.cause_of.push_back(index);
    side.causes[index].area_m2 += area_of(boundary.mesh, boundary.mesh.triangles[i]);
  }
}

/// Gives the causes of `other` numbers in `causes`, which grows by those that are new.
std::vector<std::uint32_t> merge_causes(const std::vector<Cause>& other, std::vector<Cause>& causes) {
  std::vector<std::uint32_t> number;
  for (const Cause& cause : other) {
    const auto same = std::find_if(causes.begin(), causes.end(), [&](const Cause& known) {
      return known.kind == cause.kind && known.name == cause.name;
    });
    number.push_back(static_cast<std::uint32_t>(same - causes.begin()));
    if (same == causes.end()) causes.push_back(cause);
  }
  return number;
}

/// Areas anew, and without causes that no triangle has.
void tidy_causes(Side& side) {
  std::vector<double> area(side.causes.size(), 0);
  std::vector<bool> used(side.causes.size(), false);
  for (std::size_t t = 0; t < side.cause_of.size(); ++t) {
    area[side.cause_of[t]] += area_of(side.mesh, side.mesh.triangles[t]);
    used[side.cause_of[t]] = true;
  }
  std::vector<std::uint32_t> number(side.causes.size(), 0);
  std::vector<Cause> kept;
  for (std::size_t c = 0; c < used.size(); ++c) {
    number[c] = static_cast<std::uint32_t>(kept.size());
    if (used[c]) kept.push_back({side.causes[c].kind, side.causes[c].name, area[c]});
  }
  for (std::uint32_t& cause : side.cause_of) cause = number[cause];
  side.causes = std::move(kept);
}

/// Gives what is left of the wall the causes of its neighbours, from the rim inwards.
void dissolve_wall(Side& side) {
  const auto is_wall = [&](std::uint32_t t) { return side.causes[side.cause_of[t]].kind == CauseKind::target_plane; };
  std::vector<std::vector<std::uint32_t>> neighbours(side.mesh.triangles.size());
  std::vector<std::uint32_t> front;
  const auto uses = core::edge_uses(side.mesh.triangles, side.mesh.vertices.size());
  core::for_each_edge(uses, [&](std::span<const core::EdgeUse> edge) {
    for (const core::EdgeUse& from : edge) {
      for (const core::EdgeUse& to : edge) {
        if (!is_wall(to.triangle) || from.triangle == to.triangle) continue;
        neighbours[from.triangle].push_back(to.triangle);
        if (!is_wall(from.triangle)) front.push_back(from.triangle);
      }
    }
  });
  for (std::size_t next = 0; next < front.size(); ++next) {
    for (const std::uint32_t t : neighbours[front[next]]) {
      if (!is_wall(t)) continue;
      side.cause_of[t] = side.cause_of[front[next]];
      front.push_back(t);
    }
  }
}

solid::Solid solid_of(const Side& side, double turn, const std::vector<std::uint32_t>& label) {
  solid::LabelledMesh labelled{side.mesh, {}};
  for (Vec3& v : labelled.mesh.vertices) v.tail<2>() *= turn;
  labelled.labels.reserve(side.cause_of.size());
  for (const std::uint32_t cause : side.cause_of) labelled.labels.push_back(label[cause]);
  return solid::Solid(labelled, "a side of the point");
}

StageCounts operator+(StageCounts a, const StageCounts& b) {
  a.candidate_blockers += b.candidate_blockers;
  a.visible_blockers += b.visible_blockers;
  a.visible_facets += b.visible_facets;
  a.constraint_edges += b.constraint_edges;
  return a;
}

}  // namespace

Side compute_side(const PreparedScene& scene, const TargetFrame& frame, const target::RangeRegion& range,
                  const ExactOptions& options, const core::ProgressReporter& progress) {
  const target::Lengths lengths = target::lengths_of(scene.data(), frame, range.radius());
  const target::LocalTarget target = target::make_local_target(frame.polygon, lengths.slack, lengths.rounding);
  ChartGrid grid(range, options.tolerance_m);
  progress.begin("finding blockers");
  BlockerSet blockers;
  DirectionTree tree(blockers, range);
  collect_blockers(scene.data(), frame, target, range, blockers, tree, progress);
  progress.begin("tracing the envelope");
  // Seen from the centre a chord must also stay well within a cell of the grid: a region may be no wider than the
  // tolerance.
  const double widest = 0.1 * range.inner_radius() * M_PI / 2 / grid.size();
  const CurveSampling sampling{std::min(options.tolerance_m * 0.5, widest),
                               std::sqrt(8 * range.radius() * options.tolerance_m)};
  const Skeleton skeleton = trace_envelope(blockers, tree, range, sampling, progress);
  progress.begin("triangulating");
  Boundary boundary = triangulate_boundary(skeleton, blockers, tree, range, grid, options.tolerance_m, progress);
  progress.finish();

  Side side;
  side.counts = {scene.data().polygon_count(), blockers.count(), skeleton.visible_blockers, skeleton.visible_facets,
                 boundary.constraint_edges};
  add_causes(scene, blockers, boundary, side);
  side.range_height = 1 / range.gauge(Vec3::UnitZ());
  side.mesh = std::move(boundary.mesh);
  for (const Vec3& v : side.mesh.vertices) side.height = std::max(side.height, v.z());
  return side;
}

Side join_sides(const Side& front, const Side& back, const core::ProgressReporter& progress) {
  Side joined;
  const std::vector<std::uint32_t> of_front = merge_causes(front.causes, joined.causes);
  const std::vector<std::uint32_t> of_back = merge_causes(back.causes, joined.causes);
  progress.begin("joining both sides");
  solid::LabelledMesh both = unite(solid_of(front, 1, of_front), solid_of(back, -1, of_back), progress).to_mesh();
  joined.mesh = std::move(both.mesh);
  joined.cause_of = std::move(both.labels);
  dissolve_wall(joined);
  tidy_causes(joined);
  joined.counts = front.counts + back.counts;
  joined.height = std::max(front.height, back.height);
  joined.range_height = std::max(front.range_height, back.range_height);
  return joined;
}

std::string widest_scene_cause(const std::vector<Cause>& causes) {
  const auto widest = std::max_element(causes.begin(), causes.end(), [](const Cause& a, const Cause& b) {
    return (a.kind == CauseKind::scene ? a.area_m2 : 0) < (b.kind == CauseKind::scene ? b.area_m2 : 0);
  });
  return widest->name;
}

}  // namespace vantage::exact
