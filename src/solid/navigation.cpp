// Cutting a volume to where the vehicle may fly. Boxes, zones and the like are small solids beside a volume of perhaps
// a hundred thousand facets, so they are combined first. What limits of the sensor and the clearance have in common
// costs more than to cut the volume to one after the other.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/causes.h"
#include "core/mend_welded.h"
#include "core/navigation_check.h"
#include "core/pieces.h"
#include "core/progress_reporter.h"
#include "core/stopwatch.h"
#include "core/volume_check.h"
#include "solid/clean.h"
#include "solid/local_cut.h"
#include "solid/numerics.h"
#include "solid/outside_limits.h"
#include "solid/regions.h"
#include "solid/sensor_region_builder.h"
#include "vantage/each_limit.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {
namespace {

std::vector<Solid> to_combine(const std::vector<Region>& regions) {
  std::vector<Solid> solids;
  for (const Region& region : regions) {
    if (!region.is_cut_alone) solids.push_back(region.solid);
  }
  return solids;
}

/// The volume, cut by one solid after another.
class Cutting {
 public:
  /// `count`: solids, and what else takes as long.
  Cutting(const LabelledMesh& volume, std::size_t count, core::ProgressReporter progress)
      : result_{volume, 0, 0}, count_(static_cast<double>(count)), progress_(std::move(progress)) {}

  void cut(const Solid& solid, CutKind kind) {
    if (result_.mesh.mesh.empty()) return;
    LocalCut next = cut_locally(result_.mesh, solid, kind, next_part());
    next.epsilon = std::max(next.epsilon, result_.epsilon);
    result_ = std::move(next);
    is_cut_ = true;
  }
  core::ProgressReporter next_part() {
    ++done_;
    return progress_.part((done_ - 1) / count_, done_ / count_);
  }
  const Mesh& left() const { return result_.mesh.mesh; }
  bool is_cut() const { return is_cut_; }
  LocalCut take() { return std::move(result_); }

 private:
  LocalCut result_;
  double count_, done_ = 0;
  bool is_cut_ = false;
  core::ProgressReporter progress_;
};

/// The clearance comes last, from what the other limits leave: only obstacles near to that matter.
struct LateClearance {
  const Clearance* clearance;  ///< may be null
  std::optional<Vec3> from;    ///< a point from which the whole volume can be reached, scene frame; where one is known
};

/// What is kept comes first, the smallest first of all: it leaves the less. Nothing where nothing had to be cut. The
/// clearance is added to the regions.
std::optional<LocalCut> cut(const LabelledMesh& volume, const LateClearance& late, Regions& regions,
                            const core::ProgressReporter& progress) {
  constexpr std::size_t kForClearance = 4;
  const std::size_t more = late.clearance ? kForClearance : 0;
  Cutting cutting(volume, regions.kept.size() + regions.forbidden.size() + more, progress);
  std::vector<const Region*> alone;
  for (const Region& region : regions.kept) {
    if (region.is_cut_alone) alone.push_back(&region);
  }
  std::stable_sort(alone.begin(), alone.end(),
                   [](const Region* a, const Region* b) { return a->solid.volume() < b->solid.volume(); });
  for (const Region* region : alone) cutting.cut(region->solid, CutKind::keep_inside);
  const core::ProgressReporter one = progress.part(0, 0);  // asks only whether to go on
  const std::vector<Solid> kept = to_combine(regions.kept);
  const Solid forbidden = unite(to_combine(regions.forbidden), one);
  if (!kept.empty()) {
    const Solid all = intersect(kept, one);
    cutting.cut(forbidden.empty() ? all : subtract(all, forbidden, one), CutKind::keep_inside);
  } else if (!forbidden.empty()) {
    cutting.cut(forbidden, CutKind::keep_outside);
  }
  for (const Region& region : regions.forbidden) {
    if (region.is_cut_alone) cutting.cut(region.solid, CutKind::keep_outside);
  }
  if (late.clearance && !cutting.left().empty()) {
    const std::size_t before = regions.forbidden.size();
    add_clearance_region(*late.clearance, cutting.left(), late.from, regions, cutting.next_part());
    if (regions.forbidden.size() > before) cutting.cut(regions.forbidden.back().solid, CutKind::keep_outside);
  }
  if (!cutting.is_cut()) return std::nullopt;
  return cutting.take();
}

/// Puts the corners of cut faces into their planes exactly, where rounding left them beside it. `labelled` is in the
/// scene frame already.
void snap_to_planes(LabelledMesh& labelled, const std::vector<FacetSource>& sources, double allowance) {
  auto& [mesh, labels] = labelled;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const FacetSource& source = sources[labels[t]];
    if (!source.axis) continue;
    for (const std::uint32_t v : mesh.triangles[t]) {
      double& coordinate = mesh.vertices[v][*source.axis];
      if (std::abs(coordinate - source.at) > allowance) {
        throw Error(ErrorCode::internal_defect, "a cut face does not lie in its plane", "navigation", "");
      }
      coordinate = source.at;
    }
  }
}

void make_empty(const Emptiness& emptiness, Volume& result) {
  result.outcome = Outcome::outside_limits;
  result.reason = emptiness.reason;
  result.hint = emptiness.hint;
  result.mesh = {};
  result.cause_of.clear();
  result.polygon_of.clear();
  result.causes.clear();
}

/// `labels`: of the volume's facets, see Regions::sources.
void cut_volume(Regions regions, const LateClearance& late, std::vector<std::uint32_t> labels,
                const core::ProgressReporter& progress, Volume& result) {
  const LabelledMesh volume = moved_to_origin(result.mesh, std::move(labels), regions.origin);
  std::optional<LocalCut> found = cut(volume, late, regions, progress);
  if (!found) return;
  auto& [labelled, epsilon, through] = *found;
  core::drop_slivers(labelled, numerics::kSliverEpsilons * epsilon);
  if (labelled.mesh.empty()) {
    // The volume is known by now: that it is empty must not be lost to a limit, only since the reason takes work, too.
    const core::ProgressReporter unlimited = progress.limited(std::numeric_limits<double>::infinity(), "");
    return make_empty(explain_emptiness(Solid(volume, "the volume"), regions, unlimited), result);
  }
  for (Vec3& vertex : labelled.mesh.vertices) vertex += regions.origin;
  const double rounding = std::numeric_limits<double>::epsilon() * regions.origin.cwiseAbs().maxCoeff();
  const double allowance = numerics::kSnapEpsilons * (epsilon + rounding);
  snap_to_planes(labelled, regions.sources, allowance);
  const CleaningLimits limits = cleaning_limits(result.tolerance_m, epsilon, bounding_box(labelled.mesh));
  clean_inward(labelled, regions.origin, regions.sources, limits);
  core::mend_for_doubles(labelled);
  snap_to_planes(labelled, regions.sources, allowance);  // what was merged went to the origin and back
  const bool has_polygons = !result.polygon_of.empty();
  set_mesh(std::move(labelled), regions.sources, regions.causes, result);
  if (!has_polygons) result.polygon_of.clear();
}

/// Whether the sensor has other limits than these.
bool has_others(const Sensor& sensor, std::span<const Limit> done) {
  bool found = false;
  each_limit(sensor, [&](auto limit, const auto& /*value*/) {
    found = found || std::find(done.begin(), done.end(), decltype(limit)::value) == done.end();
  });
  return found;
}

/// Whether it was computed for that target and that sensor.
bool is_of(const Volume& volume, const PreparedTarget& target) {
  const std::optional<VolumeProvenance>& made = volume.provenance;
  return made && made->views.empty() && made->target == target.target() && made->sensor == target.sensor();
}

/// `target`: with the sensor; may be null.
Volume cut_to(const Volume& volume, const PreparedTarget* target, const Navigation& navigation,
              const Progress& callback, double work_limit) {
  const std::span<const Limit> done =
      target && is_of(volume, *target) ? std::span<const Limit>(volume.kept_limits) : std::span<const Limit>();
  if (navigation.empty() && !(target && has_others(target->sensor(), done))) return volume;
  const core::Stopwatch stopwatch;
  const core::ProgressReporter progress = core::ProgressReporter(callback).limited(
      work_limit, navigation.clearance
                      ? "ask for a shorter range, cut the volume to the altitudes or boxes that are flown in, or leave "
                        "large surfaces out of the obstacles with 'navigation.ground' or make them of fewer triangles"
                      : "ask for a shorter range, or for fewer and simpler limits");
  progress.begin("navigation");
  const std::vector<Mesh> meshes = core::checked_navigation(navigation, progress.part(0, 0.3));
  Volume result = volume;
  if (volume.outcome != Outcome::computed || volume.mesh.empty()) return result;

  core::check_volume(volume);
  const Box bounds = bounding_box(volume.mesh);
  std::vector<std::uint32_t> causes(volume.causes.size());
  std::iota(causes.begin(), causes.end(), 0u);
  FacetSourceList sources;
  std::vector<std::uint32_t> labels = sources.add(volume, causes);
  Regions regions = make_regions(volume.causes, sources.sources(), bounds, navigation, meshes, progress.part(0.3, 0.4));
  if (target) add_sensor_regions(sensor::viewed_of(*target), target->sensor(), done, bounds, regions);
  LateClearance late{navigation.clearance ? &*navigation.clearance : nullptr, {}};
  if (!volume.frame.polygon.empty()) late.from = volume.frame.origin;  // of a mesh the origin may lie outside
  cut_volume(std::move(regions), late, std::move(labels), progress.part(0.4, 1), result);
  progress.finish();
  const double seconds = stopwatch.seconds();
  result.seconds.navigation += seconds;
  result.seconds.total += seconds;
  return result;
}

}  // namespace

}  // namespace vantage::internal::solid

namespace vantage {

Volume cut_to_navigation(const Volume& volume, const Navigation& navigation, const Progress& progress,
                         double work_limit) {
  return internal::solid::cut_to(volume, nullptr, navigation, progress, work_limit);
}

Volume cut_to_limits(const Volume& volume, const PreparedTarget& target, const Navigation& navigation,
                     const Progress& progress, double work_limit) {
  return internal::solid::cut_to(volume, &target, navigation, progress, work_limit);
}

}  // namespace vantage
