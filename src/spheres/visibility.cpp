#include "spheres/visibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <utility>

#include "core/progress_reporter.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "options/spheres_options.h"
#include "scene/prepared_data.h"
#include "spheres/algorithm.h"
#include "spheres/numerics.h"
#include "target/lengths.h"
#include "target/prepared_target_data.h"
#include "target/range_check.h"
#include "target/range_region.h"
#include "vantage/error.h"
#include "vantage/version.h"

namespace vantage::internal::spheres {
namespace {

using core::metres_text;

/// "vertex 2 at (10.00, 4.50, 0.00)" for a corner of the target as used, by the number that the user gave it; a
/// midpoint of an edge has only its place.
std::string point_name(const Target& target, const Vec3& place) {
  std::size_t nearest = 0;
  const Vec3 moved = target.parts[0][0] - place;
  double least = moved.squaredNorm();
  for (std::size_t i = 1; i < target.parts[0].size(); ++i) {
    const double distance = (target.parts[0][i] - place).squaredNorm();
    if (distance < least) {
      least = distance;
      nearest = i;
    }
  }
  return "vertex " + std::to_string(nearest) + " at " + core::fixed_text(place, 2);
}

void set_blocked(const Target& target, const Vec3& place, double max_range, Volume& volume) {
  volume.outcome = Outcome::blocked_at_once;
  volume.reason = point_name(target, place) + " sees nothing farther than " +
                  metres_text(target::hand_breadth(max_range)) +
                  ": it is inside a solid, or faces the surface that it lies on";
  volume.hint = "turn the target round with front:, or raise it with offset:";
}

void set_unseen(const Target& target, const Vec3& a, const Vec3& b, Volume& volume) {
  volume.outcome = Outcome::blocked_at_once;
  volume.reason = "no point is in all visibility spheres: " + point_name(target, a);
  volume.reason +=
      a == b ? " sees none that the points before it see" : " and " + point_name(target, b) + " see none together";
  volume.hint = "make the spheres finer with cubemap:, or try method: exact";
}

void set_mesh(const TargetFrame& frame, solid::LabelledMesh labelled, Volume& volume) {
  const std::array<Cause, 3> causes = {
      {{CauseKind::scene, "scene"}, {CauseKind::range, "max_range"}, {CauseKind::target_plane, "target plane"}}};
  constexpr std::uint32_t kNone = ~0u;
  std::array<std::uint32_t, 3> index = {kNone, kNone, kNone};
  volume.mesh = std::move(labelled.mesh);
  for (Vec3& v : volume.mesh.vertices) v = frame.to_scene(v);
  volume.cause_of.reserve(labelled.labels.size());
  for (std::size_t t = 0; t < labelled.labels.size(); ++t) {
    std::uint32_t& cause = index[labelled.labels[t]];
    if (cause == kNone) {
      cause = static_cast<std::uint32_t>(volume.causes.size());
      volume.causes.push_back(causes[labelled.labels[t]]);
    }
    volume.cause_of.push_back(cause);
    const Triangle& triangle = volume.mesh.triangles[t];
    const Vec3& a = volume.mesh.vertices[triangle[0]];
    volume.causes[cause].area_m2 +=
        0.5 * (volume.mesh.vertices[triangle[1]] - a).cross(volume.mesh.vertices[triangle[2]] - a).norm();
  }
}

/// How far the target is raised: as for the exact method, but at the least off the surface that it lies on. Seen from
/// a point of its own plane a polygon has no depth.
double lift_of(const PreparedTarget& target) {
  const TargetFrame& frame = target.data().parts[0].given;
  const double clear = target::lengths_of(target.scene().data(), frame, range_limit_m(target.sensor())).clear;
  return std::max(target.lift_m(), clear);
}

void compute(const Target& target, const Sensor& sensor, const SpheresOptions& options, depth::DepthRenderer& renderer,
             SpheresReport& report, const StageSink& stages, const core::ProgressReporter& progress, Volume& volume) {
  const bool front_only = !target.is_point() || target.front;
  const SphereMaker maker(renderer, options, range_limit_m(sensor), volume.frame, front_only);
  Intersection found = intersect_spheres(volume.frame, maker, options, report, stages, progress);
  progress.finish();
  const auto place = [&](const Vec3& point) { return volume.frame.to_scene(point); };
  if (found.blocked) {
    set_blocked(target, place(*found.blocked), range_limit_m(sensor), volume);
  } else if (found.mesh.mesh.empty()) {
    set_unseen(target, place(found.unseen[0]), place(found.unseen[1]), volume);
  } else {
    set_mesh(volume.frame, std::move(found.mesh), volume);
  }
}

}  // namespace

Volume compute_visibility(const PreparedTarget& target, const SpheresOptions& options, depth::DepthRenderer& renderer,
                          SpheresReport* report, const StageSink& stages, const Progress& callback) {
  const core::ProgressReporter progress(callback);
  const core::Stopwatch stopwatch;
  options::check_options(options);
  if (target.part_count() > 1) {
    throw Error(ErrorCode::target_of_parts, "the target has " + std::to_string(target.part_count()) + " parts",
                "target", "compute each part and intersect the volumes");
  }
  const Sensor& sensor = target.sensor();
  if (sensor.link) {
    throw Error(ErrorCode::not_applicable, "the method of spheres knows no zones of radio links", "sensor.link",
                "use 'method: exact', or leave out the link");
  }
  SpheresReport own_report;
  SpheresReport& told = report ? *report : own_report;
  told = {};
  Volume volume;
  volume.tolerance_m = range_tolerance(options, range_limit_m(sensor));
  volume.frame = target.data().parts[0].given;
  volume.lift_m = {lift_of(target)};
  volume.notes = target.notes();
  volume.provenance = {VANTAGE_VERSION, "spheres", target.target(), sensor, "", ""};
  volume.frame.origin += volume.frame.normal * volume.lift_m[0];
  volume.counts.scene_polygons = target.scene().data().polygon_count();
  if (target::can_reach(volume.frame, sensor)) {
    target::move_into_range(volume.frame, range_limit_m(sensor));
    compute(target.target(), sensor, options, renderer, told, stages, progress, volume);
  } else {
    target::set_out_of_range(volume.frame, sensor, volume);
  }
  told.device = renderer.device();  // only now: it may have changed on the way
  volume.seconds.engine = volume.seconds.total = stopwatch.seconds();
  return volume;
}

Mesh visibility_sphere(const Vec3& viewpoint, double radius_m, const SpheresOptions& options,
                       depth::DepthRenderer& renderer, const Progress& callback) {
  const core::ProgressReporter progress(callback);
  if (!viewpoint.allFinite()) {
    throw Error(ErrorCode::coordinate_not_finite, "the viewpoint has a coordinate that is not finite",
                "visibility sphere", "give three finite numbers");
  }
  check_sensor({.max_range_m = radius_m});
  options::check_options(options);
  TargetFrame frame;
  frame.origin = viewpoint;
  frame.axis_u = Vec3::UnitX();
  frame.axis_v = Vec3::UnitY();
  frame.normal = Vec3::UnitZ();
  const SphereMaker maker(renderer, options, radius_m, frame, false);
  progress.begin("making spheres");
  Mesh mesh;
  maker.make({Vec3::Zero()}, [&](std::size_t, Sphere sphere) { mesh = std::move(sphere.mesh.mesh); });
  progress.finish();
  for (Vec3& v : mesh.vertices) v += viewpoint;
  return mesh;
}

}  // namespace vantage::internal::spheres
