#include "solid/visible_share.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/causes.h"
#include "core/mend_welded.h"
#include "core/pieces.h"
#include "core/progress_reporter.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "solid/arranged.h"
#include "solid/cell_tree.h"
#include "solid/clean.h"
#include "solid/numerics.h"
#include "solid/regions.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {
namespace {

/// The volumes of cells are computed for a range that is longer by this part, and with facets that are off by half of
/// that: they matter nowhere within the range of the whole target, to which the result is cut. The fewer facets the
/// cells have the faster they are arranged.
constexpr double kLonger = 0.1;
constexpr double kLongestRange = 1e9;  // metres; as of sensors

/// What a cell costs is counted in this part of a cell of average size. One part alone has cells of one size.
constexpr std::uint64_t kUnitsPerCell = 8;

/// What the volumes of cells take of the whole.
constexpr double kPartOfCells = 0.5;

constexpr double kOneUlp = 0x1p-51;         // of a product with a decimal number that is no binary one
constexpr double kPlaneRounding = 0x1p-48;  // of coordinates, on the way from the target's frame and back to it
constexpr double kBehind = 0x1p-42;         // of a cell's range: farther than an arrangement at first moves the cell
constexpr double kAreaRounding = 0x1p-36;   // of the areas of cells, with what their strips have

double area_of(const TargetFrame& frame) {
  double twice = 0;
  const auto& p = frame.polygon;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const Eigen::Vector2d a = p[i] - p[0], b = p[i + 1] - p[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

/// How many cells each part becomes: as many as its area asks, and at least one.
std::vector<std::size_t> cell_counts(const std::vector<double>& areas, std::size_t cells) {
  const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::vector<std::size_t> counts;
  std::vector<std::pair<double, std::size_t>> rest;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const double wanted = areas[i] / all * static_cast<double>(cells);
    counts.push_back(std::max<std::size_t>(1, static_cast<std::size_t>(wanted)));
    rest.emplace_back(static_cast<double>(counts.back()) - wanted, i);  // the least was rounded down most
  }
  std::stable_sort(rest.begin(), rest.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const std::size_t given = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  for (std::size_t i = 0; given + i < cells && i < rest.size(); ++i) ++counts[rest[i].second];
  return counts;
}

/// What may be missed: cells that cost no more than `budget` together. Where all areas are at least what the costs say,
/// then what is seen is at least the share.
struct Plan {
  std::vector<std::size_t> counts;   ///< cells of each part
  std::vector<std::uint64_t> costs;  ///< of a cell of each part
  std::uint64_t budget = 0;
};

Plan plan_of(const PreparedTarget& target) {
  const VisibleShare& visible = *target.sensor().visible;
  std::vector<double> areas;
  for (std::size_t i = 0; i < target.part_count(); ++i) areas.push_back(area_of(target.frame(i)));
  Plan plan;
  plan.counts = cell_counts(areas, visible.cells);
  const std::uint64_t units = kUnitsPerCell * std::accumulate(plan.counts.begin(), plan.counts.end(), std::uint64_t{0});
  const double unit = std::accumulate(areas.begin(), areas.end(), 0.0) / static_cast<double>(units);
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const double cost = areas[i] / static_cast<double>(plan.counts[i]) / unit;
    plan.costs.push_back(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(cost * (1 - kAreaRounding)))));
  }
  plan.budget =
      units - static_cast<std::uint64_t>(std::ceil(visible.share * static_cast<double>(units) * (1 - kOneUlp)));
  std::uint64_t divisor = 0;
  for (const std::uint64_t cost : plan.costs) divisor = std::gcd(divisor, cost);
  for (std::uint64_t& cost : plan.costs) cost /= divisor;
  plan.budget /= divisor;
  return plan;
}

/// The frame of the first part, for solids: in it the plane of the target is exact.
class Local {
 public:
  explicit Local(const TargetFrame& frame) : frame_(frame) {}

  /// Corners of the target's plane that rounding has moved out of it are put back, or a little behind it: so that of
  /// several volumes only one has its facet there. Walls end in these corners, and move out by as much at most. Other
  /// parts have other planes.
  LabelledMesh labelled(const Volume& volume, double behind_m) {
    std::vector<std::uint32_t> merged;
    for (const Cause& cause : volume.causes) merged.push_back(causes_.add(cause));
    LabelledMesh labelled{volume.mesh, sources_.add(volume, merged)};
    for (Vec3& vertex : labelled.mesh.vertices) vertex = frame_.to_local(vertex);
    double largest = 0;
    for (const Vec3& vertex : volume.mesh.vertices) largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
    for (std::size_t t = 0; t < volume.cause_of.size(); ++t) {
      if (volume.causes[volume.cause_of[t]].kind != CauseKind::target_plane) continue;
      for (const std::uint32_t v : volume.mesh.triangles[t]) {
        double& height = labelled.mesh.vertices[v].z();
        if (std::abs(height) <= kPlaneRounding * largest) height = -behind_m;
      }
    }
    return labelled;
  }

  /// Makes the result's mesh of what booleans left.
  void finish(LabelledMesh labelled, double rounding, Volume& result) const {
    for (Vec3& vertex : labelled.mesh.vertices) vertex = frame_.to_scene(vertex);
    clean_inward(labelled, frame_.origin, {},
                 cleaning_limits(result.tolerance_m, rounding, bounding_box(labelled.mesh)));
    core::mend_for_doubles(labelled);
    set_mesh(std::move(labelled), sources_.sources(), causes_.causes(), result);
  }

 private:
  TargetFrame frame_;
  core::CauseList causes_;
  FacetSourceList sources_;
};

/// The positions in the region that miss cells of no more than `budget`. `fallbacks` counts trees of booleans.
Arranged seen_in(const LabelledMesh& region, const std::vector<LabelledMesh>& volumes,
                 const std::vector<std::uint64_t>& costs, std::uint64_t budget, std::size_t& fallbacks,
                 const core::ProgressReporter& progress) {
  const std::uint64_t all = std::accumulate(costs.begin(), costs.end(), std::uint64_t{0});
  std::vector<Weighted> operands{{&region, all + 1}};
  for (std::size_t i = 0; i < volumes.size(); ++i) operands.push_back({&volumes[i], costs[i]});
  if (auto arranged = weighing_at_least(operands, all + 1 + all - budget, progress)) return *arranged;
  ++fallbacks;
  const auto volume_of = [&](std::size_t i) {
    return volumes[i].mesh.empty() ? Solid() : Solid(volumes[i], "the volume of a cell");
  };
  const Solid whole(region, "the range"), seen = seen_within(costs, budget, volume_of, progress);
  const Solid common = intersect(whole, seen, progress.part(1, 1));
  return {common, std::max(whole.epsilon(), common.epsilon())};
}

/// Where the whole target is in range and each part is looked at from its front, whatever the scene.
Volume volume_without_scene(const PreparedTarget& target, const ExactOptions& options) {
  const PreparedTarget alone = target.alone();
  std::vector<Volume> volumes;
  for (std::size_t i = 0; i < alone.part_count(); ++i) volumes.push_back(compute_visibility(alone.part(i), options));
  return volumes.size() == 1 ? std::move(volumes[0]) : intersect_volumes(volumes);
}

void add_counts(const StageCounts& cell, StageCounts& all) {
  all.candidate_blockers += cell.candidate_blockers;
  all.visible_blockers += cell.visible_blockers;
  all.visible_facets += cell.visible_facets;
  all.constraint_edges += cell.constraint_edges;
  all.boolean_fallbacks += cell.boolean_fallbacks;
}

void make_empty(const PreparedTarget& target, Volume& result) {
  result.outcome = Outcome::no_common_view;
  result.reason = "no position sees " + core::number_text(target.sensor().visible->share) +
                  " of the target's area, so far as its cells tell";
  result.hint = "ask for a smaller share, or cut the target into more cells";
  result.mesh = {};
  result.cause_of.clear();
  result.polygon_of.clear();
  result.causes.clear();
}

}  // namespace

bool has_share(const PreparedTarget& target) {
  if (!target.sensor().visible || target.sensor().visible->share >= 1 || target.target().is_point()) return false;
  const Plan plan = plan_of(target);
  return std::any_of(plan.costs.begin(), plan.costs.end(), [&](std::uint64_t cost) { return cost <= plan.budget; });
}

Volume share_volume(const PreparedTarget& target, const ExactOptions& options, const Progress& callback) {
  const core::Stopwatch stopwatch;
  const core::ProgressReporter progress = core::ProgressReporter(callback).limited(
      options.work_limit, "ask for fewer cells ('sensor.cells'), or for a shorter range");
  progress.begin("cells");
  Volume result = volume_without_scene(target, options);
  result.counts.scene_polygons = target.scene().statistics().polygons;
  if (result.outcome != Outcome::computed) return result;

  const double range = range_limit_m(target.sensor()), longer = std::min((1 + kLonger) * range, kLongestRange);
  ExactOptions coarse;
  coarse.tolerance_m = std::max(options.tolerance_m, 0.5 * (longer - range));
  const Plan plan = plan_of(target);
  std::vector<PreparedTarget> cells;
  std::vector<std::uint64_t> costs;
  for (std::size_t part = 0; part < target.part_count(); ++part) {
    for (PreparedTarget& cell : target.cells(part, plan.counts[part], longer)) cells.push_back(std::move(cell));
    costs.resize(cells.size(), plan.costs[part]);
  }
  Local local(target.frame());
  const LabelledMesh region = local.labelled(result, 0);
  const core::ProgressReporter making = progress.part(0, kPartOfCells);
  const Progress ask = [&](std::string_view, double) {
    making.check();
    return true;
  };
  std::vector<LabelledMesh> volumes;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Volume volume = compute_visibility(cells[i], coarse, callback ? ask : Progress());
    add_counts(volume.counts, result.counts);
    volumes.push_back(volume.outcome == Outcome::computed ? local.labelled(volume, kBehind * longer) : LabelledMesh());
    making.report(i + 1, cells.size());
  }
  const Arranged seen =
      seen_in(region, volumes, costs, plan.budget, result.counts.boolean_fallbacks, progress.part(kPartOfCells, 1));
  LabelledMesh labelled = seen.solid.to_mesh();
  core::drop_slivers(labelled, numerics::kSliverEpsilons * seen.epsilon_m);
  if (labelled.mesh.empty()) {
    make_empty(target, result);
  } else {
    local.finish(std::move(labelled), seen.epsilon_m, result);
  }
  progress.finish();
  result.seconds.engine = result.seconds.total = stopwatch.seconds();
  return result;
}

}  // namespace vantage::internal::solid
