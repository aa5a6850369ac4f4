// compute_visibility: one target of a prepared scene, from blockers to the closed mesh.
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "exact/collect.h"
#include "exact/number_text.h"
#include "exact/numerics.h"
#include "exact/target_check.h"
#include "exact/triangulation.h"
#include "parallel/parallel.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using namespace exact;
using Clock = std::chrono::steady_clock;

// A volume that ends this close to the target, in metres, is of no use to anyone: the view is blocked at once.
constexpr double kHandsBreadth = 0.1;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void check(const Sensor& sensor, const ExactOptions& options) {
  if (!(sensor.max_range_m > 0) || !std::isfinite(sensor.max_range_m))
    throw Error(ErrorKind::input, "max_range must be a positive, finite number of metres", "sensor",
                "give the farthest distance at which the target can be seen");
  if (!(options.tolerance_m > 0) || !std::isfinite(options.tolerance_m))
    throw Error(ErrorKind::input, "tolerance must be a positive, finite number of metres", "exact options",
                "give for example 0.01");
}

void add_causes(const PreparedScene& scene, const BlockerSet& blockers, const Boundary& boundary, Volume& volume) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> of_object(scene.objects().size(), kNone);
  std::uint32_t range = kNone, plane = kNone;
  const auto cause = [&](std::uint32_t& slot, CauseKind kind, const std::string& name) {
    if (slot == kNone) slot = std::uint32_t(volume.causes.size()), volume.causes.push_back({kind, name, 0});
    return slot;
  };
  volume.cause_of.reserve(boundary.blocker_of.size());
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
    volume.cause_of.push_back(index);
    const Triangle& t = boundary.mesh.triangles[i];
    const auto& v = boundary.mesh.vertices;
    volume.causes[index].area_m2 += 0.5 * (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).norm();
  }
}

bool blocked_at_once(const RangeRegion& range, const Boundary& boundary) {
  if (1 / range.gauge(Vec3::UnitZ()) <= kHandsBreadth) return false;  // the range alone ends that close
  return std::all_of(boundary.mesh.vertices.begin(), boundary.mesh.vertices.end(),
                     [](const Vec3& v) { return v.z() < kHandsBreadth; });
}

void set_blocked(Volume& volume) {
  const auto widest = std::max_element(volume.causes.begin(), volume.causes.end(), [](const Cause& a, const Cause& b) {
    return (a.kind == CauseKind::scene ? a.area_m2 : 0) < (b.kind == CauseKind::scene ? b.area_m2 : 0);
  });
  volume.outcome = Outcome::blocked_at_once;
  volume.reason = "\"" + widest->name + "\" covers the target's front within " + metres_text(kHandsBreadth);
  volume.hint = "the target looks into what it lies on: turn it round with front:, or raise it with offset:";
  volume.causes.clear();
  volume.cause_of.clear();
}

void compute(const PreparedScene& scene, const Sensor& sensor, const ExactOptions& options, const Progress& progress,
             Volume& volume) {
  const LocalTarget target = make_local_target(volume.frame.polygon);
  const RangeRegion range(target, sensor.max_range_m);
  ChartGrid grid(range, options.tolerance_m);
  Watch watch(progress);
  watch.begin("finding blockers", 0);
  BlockerSet blockers;
  DirectionTree tree(blockers, range);
  collect_blockers(scene.data(), volume.frame, target, range, blockers, tree, watch);
  watch.begin("tracing the envelope", 0.3);
  // Seen from the centre a chord must also stay well within a cell of the grid: a region may be no wider than the
  // tolerance.
  const double widest = 0.1 * range.inner_radius() * M_PI / 2 / grid.size();
  const CurveSampling sampling{std::min(options.tolerance_m * 0.5, widest),
                               std::sqrt(8 * sensor.max_range_m * options.tolerance_m)};
  const Skeleton skeleton = trace_envelope(blockers, tree, range, sampling, watch);
  watch.begin("triangulating", 0.6);
  Boundary boundary = triangulate_boundary(skeleton, blockers, tree, range, grid, options.tolerance_m, watch);
  watch.begin("triangulating", 1.0);

  volume.counts = {scene.data().polygon_count(), blockers.count(), skeleton.visible_blockers, skeleton.visible_facets,
                   boundary.constraint_edges};
  add_causes(scene, blockers, boundary, volume);
  if (blocked_at_once(range, boundary)) {
    set_blocked(volume);
    return;
  }
  volume.mesh = std::move(boundary.mesh);
  for (Vec3& v : volume.mesh.vertices) v = volume.frame.to_scene(v);
}

}  // namespace

Volume compute_visibility(const PreparedScene& scene, const Target& target, const Sensor& sensor,
                          const ExactOptions& options, const Progress& progress) {
  const auto start = Clock::now();
  check(sensor, options);
  Volume volume;
  volume.tolerance_m = options.tolerance_m;
  volume.frame = make_target_frame(target);
  volume.lift_m = clearing_lift(scene.data(), target, volume.frame, sensor.max_range_m);
  volume.frame.origin += volume.frame.normal * volume.lift_m;
  volume.counts.scene_polygons = scene.data().polygon_count();
  if (volume.frame.enclosing_radius_m * (1 + 1e-9) >= sensor.max_range_m) {
    volume.outcome = Outcome::out_of_range;
    volume.reason = "no point within " + metres_text(sensor.max_range_m) +
                    " of all vertices: the target's enclosing circle has radius " +
                    metres_text(volume.frame.enclosing_radius_m);
    volume.hint = "raise max_range, or split the target";
  } else {
    move_into_range(volume.frame, sensor.max_range_m);
    parallel::with_threads(options.threads, [&] { compute(scene, sensor, options, progress, volume); });
  }
  volume.seconds.engine = volume.seconds.total = seconds_since(start);
  return volume;
}

}  // namespace vantage
