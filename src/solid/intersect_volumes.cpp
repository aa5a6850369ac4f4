// The volume of a target in parts: what the volumes of all parts have in common. And of targets of which one is enough.
#include <algorithm>
#include <string>
#include <utility>

#include "core/causes.h"
#include "core/mend_welded.h"
#include "core/pieces.h"
#include "core/progress_reporter.h"
#include "core/volume_check.h"
#include "solid/clean.h"
#include "solid/outside_limits.h"
#include "solid/regions.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using internal::solid::FacetSourceList;
using internal::solid::LabelledMesh;
using internal::solid::Solid;

using Views = std::vector<std::vector<Target>>;

constexpr const char* kFewerParts =
    "ask for fewer targets or parts, for an outline of fewer corners, for a shorter range or a coarser tolerance, or "
    "for "
    "'combine: each'";

Views views_of(const VolumeProvenance& made) { return made.views.empty() ? Views{{made.target}} : made.views; }

/// What is stated of all holds for one scene, one sensor and one method. Of several missions it is none.
bool can_state_all(const std::vector<Volume>& volumes, VolumeProvenance& result) {
  for (const Volume& volume : volumes) {
    if (!volume.provenance) continue;
    const VolumeProvenance& other = *volume.provenance;
    if (!(other.sensor == result.sensor) || other.scene_hash != result.scene_hash || other.method != result.method) {
      return false;
    }
    if (other.mission_hash != result.mission_hash) result.mission_hash.clear();
  }
  return true;
}

/// That all of several volumes are needed: of one target, or of several.
void state_all(const VolumeProvenance& part, VolumeProvenance& result) {
  // Parts of one target have its side and its offset, and a point is none of several parts.
  const Target &one = part.target, &other = result.target;
  const bool agree = one.offset_m == other.offset_m && one.front == other.front &&
                     one.front_by_order == other.front_by_order && !one.is_point() && !other.is_point();
  if (part.views.empty() && result.views.empty() && agree) {
    result.target.parts.insert(result.target.parts.end(), part.target.parts.begin(), part.target.parts.end());
    return;
  }
  result.views = views_of(result);
  result.target.parts.clear();
  for (std::vector<Target>& list : views_of(part)) result.views.push_back(std::move(list));
}

/// That one of several volumes is enough. Nothing is stated where one of them needs several targets.
void state_any(const std::vector<Volume>& volumes, Volume& result) {
  std::vector<Target> list;
  for (const Volume& volume : volumes) {
    const Views views = volume.provenance ? views_of(*volume.provenance) : Views();
    if (views.size() != 1) {
      result.provenance.reset();
      return;
    }
    list.insert(list.end(), views[0].begin(), views[0].end());
  }
  result.provenance->target.parts.clear();
  result.provenance->views = {std::move(list)};
}

void add_work(const Volume& part, Volume& result) {
  result.tolerance_m = std::max(result.tolerance_m, part.tolerance_m);
  result.lift_m.insert(result.lift_m.end(), part.lift_m.begin(), part.lift_m.end());
  result.counts.candidate_blockers += part.counts.candidate_blockers;
  result.counts.visible_blockers += part.counts.visible_blockers;
  result.counts.visible_facets += part.counts.visible_facets;
  result.counts.constraint_edges += part.counts.constraint_edges;
  result.counts.boolean_fallbacks += part.counts.boolean_fallbacks;
  result.seconds.engine += part.seconds.engine;
  result.seconds.total += part.seconds.total;
  for (const Warning& note : part.notes) {
    if (std::find(result.notes.begin(), result.notes.end(), note) == result.notes.end()) result.notes.push_back(note);
  }
}

void make_empty(Outcome outcome, std::string reason, std::string hint, Volume& result) {
  result.outcome = outcome;
  result.reason = std::move(reason);
  result.hint = std::move(hint);
  result.mesh = {};
  result.cause_of.clear();
  result.polygon_of.clear();
  result.causes.clear();
}

Solid solid_of(const Volume& volume, const Vec3& origin, internal::core::CauseList& causes, FacetSourceList& sources) {
  std::vector<std::uint32_t> merged;
  for (const Cause& cause : volume.causes) merged.push_back(causes.add(cause));
  return Solid(internal::solid::moved_to_origin(volume.mesh, sources.add(volume, merged), origin), "the volume");
}

/// What a boolean left of the volumes' solids becomes the result's mesh. `bounds`: what it left lies within, but for
/// rounding. Altitudes and boxes that the volumes were cut to are kept exactly.
void finish(LabelledMesh labelled, const Vec3& origin, const Box& bounds, double rounding,
            const std::vector<Volume>& volumes, const FacetSourceList& sources, const internal::core::CauseList& causes,
            Volume& result) {
  for (Vec3& vertex : labelled.mesh.vertices) vertex += origin;
  // Parts share scene polygons, so most of what bounds one volume all but coincides with what bounds another.
  internal::solid::clean_inward(
      labelled, origin, {},
      internal::solid::cleaning_limits(result.tolerance_m, rounding, bounding_box(labelled.mesh)));
  internal::core::mend_for_doubles(labelled);
  for (Vec3& vertex : labelled.mesh.vertices) vertex = vertex.cwiseMax(bounds.min).cwiseMin(bounds.max);
  internal::solid::set_mesh(std::move(labelled), sources.sources(), causes.causes(), result);
  const bool has_polygons =
      std::none_of(volumes.begin(), volumes.end(), [](const Volume& volume) { return volume.polygon_of.empty(); });
  if (!has_polygons) result.polygon_of.clear();
}

bool has_volume(const Volume& volume) { return volume.outcome == Outcome::computed && !volume.mesh.empty(); }

void check_any(const std::vector<Volume>& volumes, const char* what) {
  if (volumes.empty())
    throw Error(ErrorCode::nothing_given, std::string("there are no volumes to ") + what, "", "give at least one");
  for (const Volume& volume : volumes) internal::core::check_volume(volume);
}

}  // namespace

Volume intersect_volumes(const std::vector<Volume>& volumes, const Progress& callback, double work_limit) {
  check_any(volumes, "intersect");
  Volume result = volumes.front();
  if (result.provenance && !can_state_all(volumes, *result.provenance)) result.provenance.reset();
  for (std::size_t i = 1; i < volumes.size(); ++i) {
    if (result.provenance && volumes[i].provenance) state_all(*volumes[i].provenance, *result.provenance);
    add_work(volumes[i], result);
  }
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (has_volume(volumes[i])) continue;
    const std::string part = "part " + std::to_string(i + 1) + " of the target: ";
    make_empty(volumes[i].outcome, part + volumes[i].reason, volumes[i].hint, result);
    return result;
  }
  if (volumes.size() == 1) return result;

  result.kept_limits.clear();
  const Vec3 origin = result.frame.origin;
  internal::core::CauseList causes;
  FacetSourceList sources;
  std::vector<Solid> solids;
  double sliver = 0, rounding = 0;
  Box bounds = bounding_box(volumes.front().mesh);
  for (const Volume& volume : volumes) {
    const Box own = bounding_box(volume.mesh);
    bounds = {bounds.min.cwiseMax(own.min), bounds.max.cwiseMin(own.max)};
    solids.push_back(solid_of(volume, origin, causes, sources));
    sliver = std::max(sliver, internal::solid::sliver_thickness(solids.back()));
    rounding = std::max(rounding, solids.back().epsilon());
  }
  const internal::core::ProgressReporter progress =
      internal::core::ProgressReporter(callback).limited(work_limit, kFewerParts);
  progress.begin("parts");
  LabelledMesh labelled = internal::solid::intersect(solids, progress).to_mesh();
  internal::core::drop_slivers(labelled, sliver);
  if (labelled.mesh.empty()) {
    make_empty(Outcome::no_common_view,
               "no position sees all " + std::to_string(volumes.size()) + " parts of the target",
               "choose a part of the target, or make a volume for each part", result);
    return result;
  }
  finish(std::move(labelled), origin, bounds, rounding, volumes, sources, causes, result);
  return result;
}

Volume unite_volumes(const std::vector<Volume>& volumes, const Progress& callback, double work_limit) {
  check_any(volumes, "unite");
  if (volumes.size() == 1) return volumes.front();
  Volume result = volumes.front();
  result.kept_limits.clear();
  if (result.provenance && !can_state_all(volumes, *result.provenance)) result.provenance.reset();
  for (std::size_t i = 1; i < volumes.size(); ++i) add_work(volumes[i], result);
  if (result.provenance) state_any(volumes, result);
  const auto first = std::find_if(volumes.begin(), volumes.end(), has_volume);
  if (first == volumes.end()) {
    make_empty(result.outcome, "none of the " + std::to_string(volumes.size()) + " targets: " + result.reason,
               result.hint, result);
    return result;
  }
  result.outcome = Outcome::computed;
  result.reason.clear();
  result.hint.clear();
  result.frame = first->frame;

  const Vec3 origin = first->frame.origin;
  internal::core::CauseList causes;
  FacetSourceList sources;
  std::vector<Solid> solids;
  std::vector<Volume> used;
  double rounding = 0;
  Box bounds;
  for (const Volume& volume : volumes) {
    if (!has_volume(volume)) continue;
    const Box own = bounding_box(volume.mesh);
    bounds.extend(own.min);
    bounds.extend(own.max);
    solids.push_back(solid_of(volume, origin, causes, sources));
    rounding = std::max(rounding, solids.back().epsilon());
    used.push_back(volume);
  }
  const internal::core::ProgressReporter progress =
      internal::core::ProgressReporter(callback).limited(work_limit, kFewerParts);
  progress.begin("targets");
  finish(internal::solid::unite(solids, progress).to_mesh(), origin, bounds, rounding, used, sources, causes, result);
  return result;
}

}  // namespace vantage
