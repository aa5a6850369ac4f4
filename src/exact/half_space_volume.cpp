#include "exact/half_space_volume.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/causes.h"
#include "core/portable_math.h"
#include "exact/collect.h"
#include "exact/gauge.h"
#include "exact/triangulation.h"
#include "target/lengths.h"

namespace vantage::internal::exact {
namespace {

double area_of(const Mesh& mesh, const Triangle& t) {
  const auto& v = mesh.vertices;
  return 0.5 * (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).norm();
}

/// Added to a limit's label: the polygon of a blocker that is one.
constexpr std::uint32_t kCeiling = 1u << 31;

class Causes {
 public:
  Causes(const PreparedScene& scene, const BlockerSet& blockers, const LimitsOfView* limits, const Floor* floor,
         HalfSpaceVolume& side)
      : scene_(scene),
        blockers_(blockers),
        limits_(limits),
        floor_(floor),
        side_(side),
        of_object_(scene.objects().size(), kNone),
        of_limit_(limits ? limits->causes.size() : 0, kNone) {}

  void add(const Boundary& boundary) {
    const std::size_t facets = boundary.blocker_of.size();
    side_.cause_of.resize(facets);
    side_.polygon_of.resize(facets);
    std::uint32_t cause = kNone, polygon = kNoPolygon;
    for (std::size_t i = 0; i < facets; ++i) {
      // Most facets have the blocker of the one before.
      if (i == 0 || boundary.blocker_of[i] != boundary.blocker_of[i - 1]) {
        polygon = kNoPolygon;
        cause = cause_of(boundary.blocker_of[i], polygon);
      }
      side_.cause_of[i] = cause;
      side_.polygon_of[i] = polygon;
      side_.causes[cause].area_m2 += area_of(boundary.mesh, boundary.mesh.triangles[i]);
    }
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;

  template <typename MakeCause>
  std::uint32_t number(std::uint32_t& slot, const MakeCause& make_cause) {
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(side_.causes.size());
      side_.causes.push_back(make_cause());
    }
    return slot;
  }
  std::uint32_t of_limit(std::uint32_t label) {
    return number(of_limit_[label], [&] { return limits_->causes[label]; });
  }
  std::uint32_t cause_of(std::uint32_t blocker, std::uint32_t& polygon) {
    if (blocker == Boundary::kRange) return number(range_, [] { return Cause{CauseKind::range, "max_range"}; });
    if (blocker == Boundary::kTargetPlane) {
      return number(plane_, [] { return Cause{CauseKind::target_plane, "target plane"}; });
    }
    if (blocker >= Boundary::kFloor) return of_limit(floor_->label(blocker - Boundary::kFloor));
    const std::uint32_t of_blocker = blockers_.polygon[blocker];
    if (of_blocker >= kCeiling) return of_limit(of_blocker - kCeiling);
    polygon = of_blocker;
    const std::uint32_t object = scene_.data().polygon_object[polygon];
    return number(of_object_[object], [&] { return cause_of_object(object, scene_.objects()[object]); });
  }

  const PreparedScene& scene_;
  const BlockerSet& blockers_;
  const LimitsOfView* limits_;
  const Floor* floor_;
  HalfSpaceVolume& side_;
  std::uint32_t range_ = kNone, plane_ = kNone;
  std::vector<std::uint32_t> of_object_, of_limit_;
};

// What lies beyond a plane hides only what lies beyond it, too, where the target does not.
bool holds_target(const std::vector<ChartLimits::Side>& ceilings, const TargetFrame& frame) {
  return std::ranges::all_of(ceilings, [&](const ChartLimits::Side& side) {
    return std::ranges::all_of(
        frame.polygon, [&](const Eigen::Vector2d& corner) { return side.normal.head<2>().dot(corner) <= side.at; });
  });
}

// They hide what is beyond them, as blockers do.
void add_ceilings(const LimitsOfView& limits, BlockerSet& blockers, DirectionTree& tree) {
  for (const ChartLimits::Side& side : limits.ceilings) {
    blockers.planes.emplace_back(side.normal / side.at);
    blockers.close(kCeiling + side.label);
    if (!tree.insert(static_cast<std::uint32_t>(blockers.count() - 1))) blockers.drop_last();
  }
}

/// Convex polygons that all hold the centre; what is to be seen is all that they cover.
using Cover = std::span<const std::vector<Eigen::Vector2d>>;

// What is hidden behind what hides one polygon of the target may still hide another one: each has its own search. Of
// what these find, the tree keeps what may be seen.
void collect_for_all(const PreparedScene::Data& scene, const TargetFrame& frame, Cover cover,
                     const target::RangeRegion& range, BlockerSet& blockers, DirectionTree& tree,
                     const core::ProgressReporter& progress) {
  const target::Lengths lengths = target::lengths_of(scene, frame, range.radius());
  for (std::uint32_t k = 0; k < cover.size(); ++k) {
    const target::LocalTarget target = target::make_local_target(cover[k], lengths.slack, lengths.rounding);
    if (cover.size() == 1) return collect_blockers(scene, frame, target, range, blockers, tree, progress);
    BlockerSet own;
    DirectionTree own_tree(own, range);
    collect_blockers(scene, frame, target, range, own, own_tree, progress);
    for (std::size_t i = 0; i < own.count(); ++i) {
      blockers.append(own, i, k);
      if (!tree.insert(static_cast<std::uint32_t>(blockers.count() - 1))) blockers.drop_last();
    }
  }
}

/// How far the view reaches before the limits on how near it begins.
std::optional<Floor> with_stars(const LimitsOfView& limits, const BlockerSet& blockers, const DirectionTree& tree,
                                const target::RangeRegion& range) {
  const auto reach_at = [&](const Vec3& direction) {
    const Vec3 up(direction.x(), direction.y(), std::max(direction.z(), 0.0));
    const OctahedralPoint at = to_octahedral(up);
    return to_direction(at).norm() / evaluate_gauge(blockers, tree, range, at).value;
  };
  const auto reach = [&](const Vec3& direction, double angle) {
    constexpr double kWide = 0.03;
    constexpr int kRound = 6;
    double farthest = reach_at(direction);
    if (angle < kWide) return farthest;
    const portable::SineCosine off = portable::sine_cosine(angle);
    const Vec3 aside = off.sine / off.cosine * direction.unitOrthogonal(), across = direction.cross(aside);
    for (int i = 0; i < kRound; ++i) {
      const portable::SineCosine turn = portable::sine_cosine(2 * std::numbers::pi * i / kRound);
      farthest = std::max(farthest, reach_at((direction + turn.cosine * aside + turn.sine * across).normalized()));
    }
    return farthest;
  };
  std::vector<ChartLimits::Star> stars;
  for (const ChartLimits::StarMaker& make : limits.stars) stars.push_back(make(reach));
  return limits.floor.with(stars);
}

/// `limits`: null where there are none.
std::optional<HalfSpaceVolume> compute(const PreparedScene& scene, const TargetFrame& frame, Cover cover,
                                       const target::RangeRegion& range, const LimitsOfView* limits,
                                       const ExactOptions& options, const core::ProgressReporter& progress) {
  OctahedralGrid grid(range, options.tolerance_m);
  progress.begin("finding blockers");
  BlockerSet blockers;
  DirectionTree tree(blockers, range);
  if (limits) add_ceilings(*limits, blockers, tree);
  collect_for_all(scene.data(), frame, cover, range, blockers, tree, progress);
  std::optional<Floor> all_limits;
  if (limits) all_limits = with_stars(*limits, blockers, tree, range);
  if (limits && !all_limits) return std::nullopt;
  const Floor* const floor = all_limits && !all_limits->empty() ? &*all_limits : nullptr;
  progress.begin("tracing the envelope");
  // Seen from the centre a chord must also stay well within a cell of the grid: a region may be no wider than the
  // tolerance.
  const double widest = 0.1 * range.inner_radius() * std::numbers::pi / 2 / grid.size();
  const CurveSampling sampling{std::min(options.tolerance_m * 0.5, widest),
                               std::sqrt(8 * range.radius() * options.tolerance_m)};
  Skeleton skeleton = trace_envelope(blockers, tree, range, sampling, grid, progress);
  FloorSkeleton floor_skeleton;
  if (floor) {
    floor_skeleton = trace_floor(*floor, blockers, tree, range, sampling, progress);
    add_rim_ends(floor_skeleton, range.radius(), sampling, skeleton);
  }
  progress.begin("triangulating");
  std::optional<Boundary> boundary =
      triangulate_boundary({skeleton, floor ? &floor_skeleton : nullptr},
                           {blockers, tree, range, floor, options.tolerance_m, progress}, grid);
  if (!boundary) return std::nullopt;
  progress.finish();

  HalfSpaceVolume side;
  side.counts = {scene.data().polygon_count(), blockers.count(), skeleton.visible_blockers, skeleton.visible_facets,
                 boundary->constraint_edges};
  Causes(scene, blockers, limits, floor, side).add(*boundary);
  side.range_height = 1 / range.gauge(Vec3::UnitZ());
  side.mesh = std::move(boundary->mesh);
  for (const Vec3& v : side.mesh.vertices) side.height = std::max(side.height, v.z());
  return side;
}

}  // namespace

HalfSpaceVolume compute_half_space(const PreparedScene& scene, const TargetFrame& frame,
                                   const target::RangeRegion& range, const ExactOptions& options,
                                   const core::ProgressReporter& progress) {
  return *compute(scene, frame, {&frame.polygon, 1}, range, nullptr, options, progress);
}

HalfSpaceVolume compute_half_space(const PreparedScene& scene, const TargetFrame& frame,
                                   std::span<const std::vector<Eigen::Vector2d>> cover,
                                   const target::RangeRegion& range, const ExactOptions& options,
                                   const core::ProgressReporter& progress) {
  return *compute(scene, frame, cover, range, nullptr, options, progress);
}

std::optional<LimitsOfView> limits_of_view(const ChartLimits& limits, std::vector<Cause> causes,
                                           const TargetFrame& frame, const target::RangeRegion& range) {
  LimitsOfView all{{}, {}, limits.stars, std::move(causes)};
  std::optional<Floor> floor = Floor::of(limits, range.radius(), all.ceilings);
  if (!floor || !holds_target(all.ceilings, frame)) return std::nullopt;
  all.floor = std::move(*floor);
  return all;
}

std::optional<HalfSpaceVolume> compute_half_space_within(const PreparedScene& scene, const TargetFrame& frame,
                                                         std::span<const std::vector<Eigen::Vector2d>> cover,
                                                         const target::RangeRegion& range, const LimitsOfView& limits,
                                                         const ExactOptions& options,
                                                         const core::ProgressReporter& progress) {
  return compute(scene, frame, cover, range, &limits, options, progress);
}

const Cause& widest_cause(const std::vector<Cause>& causes) {
  const auto area = [](const Cause& cause) { return cause.kind == CauseKind::target_plane ? 0 : cause.area_m2; };
  return *std::max_element(causes.begin(), causes.end(),
                           [&](const Cause& a, const Cause& b) { return area(a) < area(b); });
}

}  // namespace vantage::internal::exact
