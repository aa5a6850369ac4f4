// compute_visibility: one prepared target, and how it ended.
#include <Eigen/Geometry>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/mend_welded.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "exact/half_space_volume.h"
#include "exact/limited_visibility.h"
#include "exact/link_scene.h"
#include "exact/star_target.h"
#include "target/lengths.h"
#include "target/prepared_target_data.h"
#include "target/range_check.h"
#include "vantage/error.h"
#include "vantage/version.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using namespace internal::exact;

void check_tolerance(const ExactOptions& options) {
  if (!(options.tolerance_m > 0) || !std::isfinite(options.tolerance_m)) {
    throw Error(ErrorCode::value_out_of_range, "tolerance must be a positive, finite number of metres", "exact options",
                "give for example 0.01");
  }
}

void check(const PreparedTarget& target, const ExactOptions& options) {
  check_tolerance(options);
  if (target.part_count() > 1) {
    throw Error(ErrorCode::target_of_parts, "the target has " + std::to_string(target.part_count()) + " parts",
                "target", "use compute_volume, or compute each part and intersect the volumes");
  }
}

/// Tells where the scene covers the target within a hand's breadth: most likely the wrong side of it is looked at. The
/// volume is right all the same.
void note_cover(const HalfSpaceVolume& side, const TargetFrame& frame, double max_range, Volume& volume) {
  const auto widest = widest_cause(side.causes);
  if (!side.ends_within(internal::target::hand_breadth(max_range)) || widest.kind != CauseKind::scene) return;
  volume.notes.push_back(
      {WarningCode::target_covered,
       '"' + widest.name + "\" covers the target within " + internal::core::metres_text(side.height) +
           (frame.all_sides ? ": if it lies in there, move it out"
                            : ": if it looks into what it lies on, turn it round with front:, or raise it with "
                              "offset:")});
}

void set_mesh(HalfSpaceVolume side, const TargetFrame& frame, double max_range, Volume& volume) {
  note_cover(side, frame, max_range, volume);
  volume.counts = side.counts;
  for (Vec3& v : side.mesh.vertices) v = frame.to_scene(v);
  volume.causes = std::move(side.causes);
  if (!internal::core::has_narrow_facets(side.mesh, internal::core::flat_width(side.mesh))) {
    volume.mesh = std::move(side.mesh);
    volume.cause_of = std::move(side.cause_of);
    volume.polygon_of = std::move(side.polygon_of);
    return;
  }
  // At map coordinates rounding leaves narrow facets without area.
  std::vector<std::uint32_t> facets(side.cause_of.size());
  std::iota(facets.begin(), facets.end(), 0u);
  internal::core::LabelledMesh labelled{std::move(side.mesh), std::move(facets)};
  internal::core::mend_for_doubles(labelled);
  volume.mesh = std::move(labelled.mesh);
  for (const std::uint32_t facet : labelled.labels) {
    volume.cause_of.push_back(side.cause_of[facet]);
    volume.polygon_of.push_back(side.polygon_of[facet]);
  }
}

/// Makes the result of what was computed in `frame`. `what` and `hint` are for a view that is blocked at once.
void fill_volume(HalfSpaceVolume side, const TargetFrame& frame, double max_range, Volume& volume,
                 const std::string& what, const std::string& hint) {
  const double near = internal::target::most_lift(max_range);
  if (!side.ends_within(near)) return set_mesh(std::move(side), frame, max_range, volume);
  volume.counts = side.counts;
  volume.outcome = Outcome::blocked_at_once;
  volume.reason =
      '"' + widest_cause(side.causes).name + "\" covers " + what + " within " + internal::core::metres_text(near);
  volume.hint = hint;
}

void compute_polygon(const PreparedTarget& target, const ExactOptions& options,
                     const internal::core::ProgressReporter& progress, Volume& volume) {
  const Sensor& sensor = target.sensor();
  if (!target.data().parts[0].is_reachable) return internal::target::set_out_of_range(volume.frame, sensor, volume);
  const internal::target::RangeRegion range(volume.frame.polygon, range_limit_m(sensor));
  fill_volume(compute_half_space(target.scene(), volume.frame, range, options, progress), volume.frame,
              range_limit_m(sensor), volume, "the target's front",
              "the target looks into what it lies on: turn it round with front:, or raise it with offset:");
}

void set_at_antenna(const PreparedTarget& target, std::uint32_t polygon, Volume& volume) {
  const PreparedScene& scene = target.scene();
  volume.outcome = Outcome::blocked_at_once;
  volume.reason = '"' + display_name(scene.objects()[scene.object_of_polygon(polygon)]) +
                  "\" is so near to the antenna that it enters the zone of every position";
  volume.hint = "raise the antenna, or give a higher frequency or a smaller share of the zone to keep clear";
}

void compute_point(const PreparedTarget& target, const ExactOptions& options,
                   const internal::core::ProgressReporter& progress, Volume& volume) {
  const double max_range = range_limit_m(target.sensor());
  const internal::target::PointSides& sides = *target.data().parts[0].sides;
  // The range about the point itself: the triangle would cost micrometres.
  const internal::target::RangeRegion range(volume.frame.polygon, max_range);
  std::optional<LinkScene> link;
  if (target.sensor().link) link.emplace(target, range);
  if (const auto polygon = link ? link->polygon_at_antenna() : std::nullopt) {
    return set_at_antenna(target, *polygon, volume);
  }
  const auto compute = [&](const TargetFrame& side) {
    return link ? link->compute_half_space(side, options, progress)
                : compute_half_space(target.scene(), side, range, options, progress);
  };
  if (!sides.back) {
    fill_volume(compute(sides.front), sides.front, max_range, volume, "the point's front",
                "the point looks into what it lies on: turn it round with front:, or move it with offset:");
    return;
  }
  const HalfSpaceVolume front = compute(sides.front);
  const HalfSpaceVolume back = compute(*sides.back);
  fill_volume(join_half_spaces(front, back), sides.front, max_range, volume, "the point on all sides",
              "move the point out of what it lies in");
}

Volume volume_for(const PreparedTarget& target, const ExactOptions& options) {
  Volume volume;
  volume.tolerance_m = options.tolerance_m;
  volume.frame = target.frame();
  for (std::size_t i = 0; i < target.part_count(); ++i) volume.lift_m.push_back(target.lift_m(i));
  volume.notes = target.notes();
  volume.provenance = {VANTAGE_VERSION, "exact", target.target(), target.sensor(), "", ""};
  volume.counts.scene_polygons = target.scene().data().polygon_count();
  return volume;
}

}  // namespace

Volume compute_visibility(const PreparedTarget& target, const ExactOptions& options, const Progress& callback) {
  const internal::core::Stopwatch stopwatch;
  const internal::core::ProgressReporter progress(callback);
  check(target, options);
  Volume volume = volume_for(target, options);
  internal::parallel::with_threads(options.threads, [&] {
    (target.target().is_point() ? compute_point : compute_polygon)(target, options, progress, volume);
  });
  volume.seconds.engine = volume.seconds.total = stopwatch.seconds();
  return volume;
}

namespace internal::exact {

std::optional<Volume> compute_star_visibility(const PreparedTarget& target, const ExactOptions& options,
                                              const Progress& callback) {
  const core::Stopwatch stopwatch;
  const core::ProgressReporter progress(callback);
  check_tolerance(options);
  const std::optional<StarTarget> star = star_target(target);
  if (!star) return std::nullopt;
  const double max_range = range_limit_m(target.sensor());
  const target::RangeRegion range(star->frame.polygon, max_range);
  HalfSpaceVolume side = compute_half_space(target.scene(), star->frame, star->cover, range, options, progress);
  if (side.ends_within(target::most_lift(max_range))) return std::nullopt;
  Volume volume = volume_for(target, options);
  set_mesh(std::move(side), star->frame, max_range, volume);
  volume.seconds.engine = volume.seconds.total = stopwatch.seconds();
  return volume;
}

LimitedVisibility compute_visibility_within(const PreparedTarget& target, const StarTarget& star,
                                            const ChartLimits& limits, const std::vector<Cause>& causes,
                                            const ExactOptions& options, const Progress& callback) {
  using How = LimitedVisibility::How;
  const core::Stopwatch stopwatch;
  const core::ProgressReporter progress(callback);
  check_tolerance(options);
  Volume volume = volume_for(target, options);
  const target::RangeRegion range(star.frame.polygon, range_limit_m(target.sensor()));
  const std::optional<LimitsOfView> ready = limits_of_view(limits, causes, star.frame, range);
  if (!ready) return {How::needs_booleans, {}};
  std::optional<HalfSpaceVolume> side;
  parallel::with_threads(options.threads, [&] {
    side = compute_half_space_within(target.scene(), star.frame, star.cover, range, *ready, options, progress);
  });
  if (!side) return {How::failed, {}};
  if (side->mesh.empty()) return {How::needs_booleans, {}};
  set_mesh(std::move(*side), star.frame, range_limit_m(target.sensor()), volume);
  volume.seconds.engine = volume.seconds.total = stopwatch.seconds();
  return {How::computed, std::move(volume)};
}

}  // namespace internal::exact
}  // namespace vantage
