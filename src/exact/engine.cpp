// compute_visibility: one target of a prepared scene, checked, lifted off its surface, and its outcome told.
#include <Eigen/Geometry>
#include <chrono>
#include <cmath>

#include "core/mend_welded.h"
#include "core/number_text.h"
#include "core/parallel.h"
#include "exact/side.h"
#include "target/lengths.h"
#include "target/point_target.h"
#include "target/range_check.h"
#include "target/target_check.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using namespace exact;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void check(const Sensor& sensor, const ExactOptions& options) {
  target::check_sensor(sensor);
  if (!(options.tolerance_m > 0) || !std::isfinite(options.tolerance_m))
    throw Error(ErrorKind::input, "tolerance must be a positive, finite number of metres", "exact options",
                "give for example 0.01");
}

/// Makes the result of what was computed in `frame`. `what` and `hint` are for a view that is blocked at once.
void take_over(Side side, const TargetFrame& frame, double max_range, Volume& volume, const std::string& what,
               const std::string& hint) {
  volume.counts = side.counts;
  const double near = target::hands_breadth(max_range);
  if (side.blocked_within(near)) {
    volume.outcome = Outcome::blocked_at_once;
    volume.reason = '"' + widest_scene_cause(side.causes) + "\" covers " + what + " within " + core::metres_text(near);
    volume.hint = hint;
    return;
  }
  core::LabelledMesh labelled{std::move(side.mesh), std::move(side.cause_of)};
  for (Vec3& v : labelled.mesh.vertices) v = frame.to_scene(v);
  // At map coordinates rounding leaves narrow facets without area.
  core::mend_for_doubles(labelled);
  volume.mesh = std::move(labelled.mesh);
  volume.cause_of = std::move(labelled.labels);
  volume.causes = std::move(side.causes);
}

void compute_polygon(const PreparedScene& scene, const Target& target, const Sensor& sensor,
                     const ExactOptions& options, const core::ProgressReporter& progress, Volume& volume) {
  target::Clearance clearance = target::clear_target(scene.data(), target, volume.frame, sensor.max_range_m);
  volume.lift_m = clearance.lift_m;
  volume.notes = std::move(clearance.notes);
  volume.frame.origin += volume.frame.normal * volume.lift_m;
  if (!target::can_reach(volume.frame, sensor)) return target::set_out_of_range(volume.frame, sensor, volume);
  target::move_into_range(volume.frame, sensor.max_range_m);
  const target::RangeRegion range(volume.frame.polygon, sensor.max_range_m);
  take_over(compute_side(scene, volume.frame, range, options, progress), volume.frame, sensor.max_range_m, volume,
            "the target's front",
            "the target looks into what it lies on: turn it round with front:, or raise it with offset:");
}

void compute_point(const PreparedScene& scene, const Target& target, const Sensor& sensor, const ExactOptions& options,
                   const core::ProgressReporter& progress, Volume& volume) {
  const target::PointSides sides = target::make_point_sides(scene.data(), target, volume.frame, sensor.max_range_m);
  volume.lift_m = sides.lift;
  volume.notes = sides.notes;
  volume.frame.origin = sides.front.origin;
  // Of the point itself: the triangle would cost micrometres.
  const target::RangeRegion range(volume.frame.polygon, sensor.max_range_m);
  if (!sides.back) {
    take_over(compute_side(scene, sides.front, range, options, progress), sides.front, sensor.max_range_m, volume,
              "the point's front",
              "the point looks into what it lies on: turn it round with front:, or move it with offset:");
    return;
  }
  const Side front = compute_side(scene, sides.front, range, options, progress);
  const Side back = compute_side(scene, *sides.back, range, options, progress);
  take_over(join_sides(front, back, progress), sides.front, sensor.max_range_m, volume, "the point on all sides",
            "move the point out of what it lies in");
}

}  // namespace

Volume compute_visibility(const PreparedScene& scene, const Target& target, const Sensor& sensor,
                          const ExactOptions& options, const Progress& callback) {
  const auto start = Clock::now();
  const core::ProgressReporter progress(callback);
  check(sensor, options);
  Volume volume;
  volume.tolerance_m = options.tolerance_m;
  volume.frame = make_target_frame(target);
  volume.counts.scene_polygons = scene.data().polygon_count();
  parallel::with_threads(options.threads, [&] {
    (target.is_point() ? compute_point : compute_polygon)(scene, target, sensor, options, progress, volume);
  });
  volume.seconds.engine = volume.seconds.total = seconds_since(start);
  return volume;
}

}  // namespace vantage
