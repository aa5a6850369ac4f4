#include "solid/cell_volumes.h"

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
#include "solid/range_of_parts.h"
#include "solid/regions.h"
#include "solid/share_plan.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {
namespace {

/// The volumes of cells are computed for a range that is longer by this part, and with facets that are off by half of
/// that: they matter nowhere within the range of the whole target, to which the result is cut. The fewer facets the
/// cells have the faster they are arranged.
constexpr double kLonger = 0.1;
constexpr double kLongestRange = 1e9;  // metres; as of sensors

/// An arrangement counts what meets, too, and facets again in each round: so many times what booleans count that join
/// two parts at a time.
constexpr double kArrangedWork = 3;

/// What the volumes of cells take of the whole.
constexpr double kPartOfCells = 0.5;

constexpr double kPlaneRounding = 0x1p-48;  // of coordinates, on the way from the target's frame and back to it
constexpr double kBehind = 0x1p-42;         // of a cell's range: farther than an arrangement at first moves the cell

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

/// `meshes`: the region, and the volumes of the cells. The positions in the region that miss cells of no more than
/// `budget`. `fallbacks` counts trees of booleans.
Arranged seen_in(const std::vector<LabelledMesh>& meshes, const std::vector<std::uint64_t>& costs, std::uint64_t budget,
                 std::size_t& fallbacks, const core::ProgressReporter& progress) {
  const std::uint64_t all = std::accumulate(costs.begin(), costs.end(), std::uint64_t{0});
  std::vector<Weighted> operands{{&meshes[0], all + 1}};
  for (std::size_t i = 0; i < costs.size(); ++i) operands.push_back({&meshes[i + 1], costs[i]});
  if (auto arranged = weighing_at_least(operands, all + 1 + all - budget, progress)) return *arranged;
  ++fallbacks;
  const auto volume_of = [&](std::size_t i) {
    return meshes[i + 1].mesh.empty() ? Solid() : Solid(meshes[i + 1], "the volume of a cell");
  };
  const Solid whole(meshes[0], "the range"), seen = seen_within(costs, budget, volume_of, progress);
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
  if (has_share(target)) {
    result.reason = "no position sees " + core::number_text(target.sensor().visible->share) +
                    " of the target's area, so far as its cells tell";
    result.hint = "ask for a smaller share, or cut the target into more cells";
  } else {
    result.reason = "no position sees all " + std::to_string(target.part_count()) + " parts of the target";
    result.hint = "choose a part of the target, or make a volume for each part";
  }
  result.mesh = {};
  result.cause_of.clear();
  result.polygon_of.clear();
  result.causes.clear();
}

/// The cells of a target, and what each of them counts.
struct Cells {
  std::vector<PreparedTarget> targets;
  std::vector<std::uint64_t> costs;
};

Cells cells_of(const PreparedTarget& target, const SharePlan& plan, double range_m) {
  Cells cells;
  for (std::size_t part = 0; part < target.part_count(); ++part) {
    for (PreparedTarget& cell : target.cells(part, plan.counts[part], range_m)) {
      cells.targets.push_back(std::move(cell));
    }
    cells.costs.resize(cells.targets.size(), plan.costs[part]);
  }
  return cells;
}

/// `result`: the volume without the scene, which is cut to what misses cells of no more than the plan's budget. False
/// where a cell has no volume that must be seen.
bool cut_to_cells(const PreparedTarget& target, const SharePlan& plan, const ExactOptions& options,
                  const core::ProgressReporter& progress, Volume& result) {
  const double range = range_limit_m(target.sensor()), longer = std::min((1 + kLonger) * range, kLongestRange);
  ExactOptions coarse;
  coarse.tolerance_m = std::max(options.tolerance_m, 0.5 * (longer - range));
  const Cells cells = cells_of(target, plan, longer);
  Local local(target.frame());
  std::vector<LabelledMesh> meshes{local.labelled(result, 0)};
  const core::ProgressReporter making = progress.part(0, kPartOfCells);
  const Progress ask = [&](std::string_view, double) {
    making.check();
    return true;
  };
  for (std::size_t i = 0; i < cells.targets.size(); ++i) {
    const Volume volume = compute_visibility(cells.targets[i], coarse, making.is_followed() ? ask : Progress());
    add_counts(volume.counts, result.counts);
    const bool has_volume = volume.outcome == Outcome::computed;
    if (!has_volume && plan.budget == 0) return false;
    meshes.push_back(has_volume ? local.labelled(volume, kBehind * longer) : LabelledMesh());
    making.report(i + 1, cells.targets.size());
  }
  const core::ProgressReporter joining = progress.part(kPartOfCells, 1);
  std::size_t& fallbacks = result.counts.boolean_fallbacks;
  const Arranged seen = plan.budget == 0 ? intersection_of(std::move(meshes), fallbacks, joining)
                                         : seen_in(meshes, cells.costs, plan.budget, fallbacks, joining);
  LabelledMesh labelled = seen.solid.to_mesh();
  core::drop_slivers(labelled, numerics::kSliverEpsilons * seen.epsilon_m);
  if (labelled.mesh.empty()) {
    make_empty(target, result);
  } else {
    local.finish(std::move(labelled), seen.epsilon_m, result);
  }
  return true;
}

}  // namespace

Volume share_volume(const PreparedTarget& target, const ExactOptions& options, const Progress& callback) {
  const core::Stopwatch stopwatch;
  const core::ProgressReporter progress = core::ProgressReporter(callback).limited(
      options.work_limit, "ask for fewer cells ('sensor.cells'), or for a shorter range");
  progress.begin("cells");
  Volume result = volume_without_scene(target, options);
  result.counts.scene_polygons = target.scene().statistics().polygons;
  if (result.outcome != Outcome::computed) return result;
  cut_to_cells(target, share_plan(target), options, progress, result);
  progress.finish();
  result.seconds.engine = result.seconds.total = stopwatch.seconds();
  return result;
}

std::optional<Volume> volume_of_parts(const PreparedTarget& target, const ExactOptions& options,
                                      const Progress& callback) {
  const core::Stopwatch stopwatch;
  const core::ProgressReporter progress = core::ProgressReporter(callback).limited(
      options.work_limit, "ask for fewer parts, for an outline of fewer corners, or for a shorter range",
      kArrangedWork);
  progress.begin("parts");
  std::optional<Volume> range = range_of_parts(target, options);
  if (!range) return std::nullopt;
  Volume result = *std::move(range);
  result.counts.scene_polygons = target.scene().statistics().polygons;
  const SharePlan plan{std::vector<std::size_t>(target.part_count(), 1),
                       std::vector<std::uint64_t>(target.part_count(), 1), 0};
  if (!cut_to_cells(target, plan, options, progress, result)) return std::nullopt;
  progress.finish();
  result.seconds.engine = result.seconds.total = stopwatch.seconds();
  return result;
}

}  // namespace vantage::internal::solid
