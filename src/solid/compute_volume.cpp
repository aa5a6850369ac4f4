#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "exact/limited_visibility.h"
#include "solid/cell_volumes.h"
#include "solid/kernel_point.h"
#include "solid/sensor_region_builder.h"
#include "solid/share_plan.h"
#include "vantage/version.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

/// Whether a position can be in front of all parts, each from its side, and within range of them along each axis. Where
/// it says no there is none: it says yes where no more than a thousandth of the range is missing.
bool may_have_common_front(const PreparedTarget& target) {
  const double range = range_limit_m(target.sensor()), slack = 1e-3 * range;
  const Vec3 origin = target.frame().origin;
  Box near{Vec3::Constant(-range - slack), Vec3::Constant(range + slack)};  // about the origin
  std::vector<internal::solid::HalfSpace> fronts;
  for (std::size_t i = 0; i < target.part_count(); ++i) {
    const TargetFrame& frame = target.frame(i);
    for (const Eigen::Vector2d& corner : frame.polygon) {
      const Vec3 at = frame.to_scene({corner.x(), corner.y(), 0}) - origin, reach = Vec3::Constant(range + slack);
      near.min = near.min.cwiseMax(at - reach);
      near.max = near.max.cwiseMin(at + reach);
    }
    if (!frame.all_sides) fronts.push_back({-frame.normal, slack - frame.normal.dot(frame.origin - origin)});
  }
  if (!(near.min.array() < near.max.array()).all()) return false;
  return internal::solid::kernel_point(fronts, near, slack / 2).has_value();
}

/// `volume`: of some parts.
void state_whole_target(const PreparedTarget& target, Volume& volume) {
  volume.lift_m.clear();
  for (std::size_t i = 0; i < target.part_count(); ++i) volume.lift_m.push_back(target.lift_m(i));
  if (volume.provenance) volume.provenance->target = target.target();
}

Volume without_common_front(const PreparedTarget& target, const ExactOptions& options) {
  Volume volume;
  volume.tolerance_m = options.tolerance_m;
  volume.frame = target.frame();
  volume.notes = target.notes();
  volume.provenance = {VANTAGE_VERSION, "exact", target.target(), target.sensor(), "", ""};
  volume.counts.scene_polygons = target.scene().statistics().polygons;
  state_whole_target(target, volume);
  volume.outcome = Outcome::no_common_view;
  volume.reason = "no position is in front of all " + std::to_string(target.part_count()) +
                  " parts of the target and within range of them";
  volume.hint = "choose parts that face the same way, or make a volume for each part";
  return volume;
}

Volume volume_of_all(const PreparedTarget& target, const ExactOptions& options, const Progress& progress) {
  if (target.part_count() > 1 && !may_have_common_front(target)) return without_common_front(target, options);
  if (internal::solid::has_share(target)) return internal::solid::share_volume(target, options, progress);
  if (target.part_count() > 1) {
    if (auto volume = internal::exact::compute_star_visibility(target, options, progress)) return *std::move(volume);
    if (auto volume = internal::solid::volume_of_parts(target, options, progress)) return *std::move(volume);
  }
  std::vector<Volume> volumes;
  for (std::size_t i = 0; i < target.part_count(); ++i) {
    volumes.push_back(compute_visibility(target.part(i), options, progress));
    if (volumes.back().outcome != Outcome::computed) break;  // nor has the whole a volume
  }
  if (target.part_count() == 1) return std::move(volumes[0]);
  const bool has_all = volumes.size() == target.part_count();
  Volume volume = intersect_volumes(volumes, progress, options.work_limit);
  if (!has_all) state_whole_target(target, volume);
  return volume;
}

/// compute_visibility with the limits that are cut in the chart. nullopt where booleans are needed; counts in
/// `fallbacks` where these stand in.
std::optional<Volume> volume_in_chart(const PreparedTarget& target, const ExactOptions& options,
                                      const Progress& progress, std::size_t& fallbacks) {
  using How = internal::exact::LimitedVisibility::How;
  const std::optional<internal::exact::StarTarget> star = internal::exact::star_target(target);
  if (!star) return std::nullopt;
  const internal::solid::LimitsInChart chart = internal::solid::sensor_limits_in_chart(*star, target.sensor());
  auto [how, volume] =
      internal::exact::compute_visibility_within(target, *star, chart.limits, chart.causes, options, progress);
  if (how == How::failed) ++fallbacks;
  if (how != How::computed) return std::nullopt;
  volume.kept_limits = chart.done;
  return std::move(volume);
}

}  // namespace

bool has_limits_in_view(const PreparedTarget& target) {
  if (target.target().is_point() || internal::solid::has_share(target)) return false;
  bool found = false;
  each_limit(target.sensor(), [&](auto limit, const auto& /*value*/) {
    found = found || internal::solid::is_cut_in_chart(decltype(limit)::value);
  });
  return found && (target.part_count() == 1 || internal::exact::star_target(target).has_value());
}

Volume compute_view(const PreparedTarget& target, const ExactOptions& options, const Progress& progress) {
  std::size_t fallbacks = 0;
  if (has_limits_in_view(target)) {
    std::optional<Volume> volume;
    internal::parallel::with_threads(options.threads,
                                     [&] { volume = volume_in_chart(target, options, progress, fallbacks); });
    if (volume) return std::move(*volume);
  }
  Volume volume = compute_parts(target, options, progress);
  volume.counts.boolean_fallbacks += fallbacks;
  return volume;
}

Volume compute_parts(const PreparedTarget& target, const ExactOptions& options, const Progress& progress) {
  Volume volume;
  internal::parallel::with_threads(options.threads, [&] { volume = volume_of_all(target, options, progress); });
  return volume;
}

Volume compute_volume(const PreparedTarget& target, const Navigation& navigation, const ExactOptions& options,
                      const Progress& progress) {
  Volume volume;
  internal::parallel::with_threads(options.threads, [&] {
    volume = cut_to_limits(compute_view(target, options, progress), target, navigation, progress, options.work_limit);
  });
  return volume;
}

}  // namespace vantage
