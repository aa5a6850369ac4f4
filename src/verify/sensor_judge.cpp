#include "verify/sensor_judge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "vantage/error.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2;

/// Between two vectors of any length but 0; exact near 0 and near a right angle.
double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

double distance_to_segment(const Vec3& point, const Vec3& start, const Vec3& end) {
  const Vec3 along = end - start;
  const double share = std::clamp((point - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - start - share * along).norm();
}

double distance_to(const TargetView& part, const Vec3& point) {
  const std::vector<Vec3>& vertices = part.vertices();
  if (part.is_point()) return (point - vertices[0]).norm();
  if (part.over(point, 0)) return std::abs(part.height(point));
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    least = std::min(least, distance_to_segment(point, vertices[i], vertices[(i + 1) % vertices.size()]));
  }
  return least;
}

/// The least angle between a direction of unit length and that to a point of the segment, both from 0. The angle's
/// cosine, (x . d) / |x| with x = start + t (end - start), has one stationary point.
double least_angle_to_segment(const Vec3& start, const Vec3& end, const Vec3& direction) {
  const Vec3 along = end - start;
  const double s = start.dot(direction), a = along.dot(direction), across = start.dot(along);
  const double t = (a * start.squaredNorm() - s * across) / (s * along.squaredNorm() - a * across);
  double least = std::min(angle_between(start, direction), angle_between(end, direction));
  if (t > 0 && t < 1) least = std::min(least, angle_between(start + t * along, direction));  // false for NaN
  return least;
}

/// The least angle at which a point of the part is seen from the direction. The sets nearer than an angle of at most 90
/// degrees are convex cones: so it is 0 where the direction meets the polygon, or else that to its outline.
double least_angle(const TargetView& part, const Vec3& point, const Vec3& direction) {
  const std::vector<Vec3>& vertices = part.vertices();
  if (part.is_point()) return angle_between(vertices[0] - point, direction);
  const double sinking = -part.normal().dot(direction), height = part.height(point);
  const double distance = height / sinking;
  if (distance > 0 && std::isfinite(distance) && part.over(point + distance * direction, 0)) return 0;
  double least = std::numbers::pi;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3 &start = vertices[i], &end = vertices[(i + 1) % vertices.size()];
    least = std::min(least, least_angle_to_segment(start - point, end - point, direction));
  }
  return least;
}

/// Where each of `angle_of`'s tangents is that of a cone with flat sides. A right angle is flat as it is.
double with_tangent_times(double angle, double factor) {
  return angle < kRightAngle ? std::atan(std::tan(angle) * factor) : angle;
}

void require_planes(const Sensor& sensor, const std::vector<TargetView>& parts) {
  if (sensor.link && !parts.front().is_point()) {
    throw Error(ErrorCode::not_applicable, "a radio link ends in an antenna, and the target is no point", "sensor.link",
                "give the antenna's place as a target of one point, or leave out the link");
  }
  if (!parts.front().all_sides()) return;
  const bool is_pixel = sensor.pixel && sensor.pixel->kind == PixelLimit::Kind::worst;
  if (!sensor.incidence_deg && !is_pixel) return;
  throw Error(ErrorCode::direction_invalid, "a point without a front has no plane, which the limit is about",
              sensor.incidence_deg ? "sensor incidence" : "sensor pixel", "give the target a front");
}

}  // namespace

// All members are named, here and below: a limit that is added does not compile here before it is judged.
SensorJudge::SensorJudge(const Sensor& sensor, const std::vector<TargetView>& parts, double tolerance_m)
    : sensor_(sensor), parts_(parts) {
  check_sensor(sensor);
  require_planes(sensor, parts);
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = sensor_;
  pixel_range_ = pixel ? pixel->size_m * *camera->focal_px : std::numeric_limits<double>::infinity();
  range_ = std::min(max_range_m, pixel_range_);
  // A foreshortened pixel is judged by itself; else its range is one.
  const double range_m = pixel && pixel->kind == PixelLimit::Kind::worst ? max_range_m : range_;
  claimed_ = {.max_range = range_m * (1 + kRangeSlack),
              .min_range = min_range_m * (1 - kRangeSlack),
              .pixel_slack = kRangeSlack};
  // A ball with the same centre as that of the largest pixel, of diameter pixel_range_, and a radius that is smaller by
  // `loose` of it, is that of all heights that are greater by (2 loose - loose^2) / 4 of the diameter.
  unclaimed_ = {.max_range = range_m - tolerance_m,
                .min_range = min_range_m * (1 + kMinRangeLoose),
                .pixel_height = pixel_range_ / 4 * (kPixelLoose * kPixelLoose - 2 * kPixelLoose),
                .frame_loose = mount.is_fixed() ? 0 : kFrameLoose};
  const double flat_sides = std::cos(std::numbers::pi / kConeSides);
  if (incidence_deg) {
    claimed_.incidence = *incidence_deg * kDegree + kAngleSlack;
    unclaimed_.incidence = with_tangent_times(*incidence_deg * kDegree, flat_sides);
  }
  if (sun) {
    sun_ = sun->direction.normalized();
    claimed_.sun = sun->exclude_deg * kDegree - kAngleSlack;
    unclaimed_.sun = with_tangent_times(sun->exclude_deg * kDegree, 1 / flat_sides);
  }
  if (camera) {
    mounted_.emplace(*camera, mount);
    free_.emplace(*camera, Mount{.yaw_deg = {}, .roll_deg = mount.roll_deg});
  }
  Vec3 sum = Vec3::Zero();
  std::size_t count = 0;
  for (const TargetView& part : parts_) {
    for (const Vec3& vertex : part.vertices()) sum += vertex - in_frame_of(part, Vec3::Zero());
    count += part.vertices().size();
  }
  middle_ = sum / static_cast<double>(count);
}

std::vector<Vec3> SensorJudge::directions(const Vec3& position) const {
  std::vector<Vec3> result;
  for (const TargetView& part : parts_) {
    const Vec3 own = in_frame_of(part, position);
    for (const Vec3& vertex : part.vertices()) {
      const Vec3 towards = vertex - own;
      if (towards.squaredNorm() > 0) result.push_back(towards.normalized());  // what touches the camera is anywhere
    }
  }
  return result;
}

std::optional<std::string> SensorJudge::broken_by_part(const TargetView& part, const Vec3& own,
                                                       const Thresholds& than) const {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = sensor_;
  if (part.farthest(own) > than.max_range) return "max_range";
  if (min_range_m > 0 && distance_to(part, own) < than.min_range) return "min_range";
  for (const Vec3& vertex : part.vertices()) {
    const Vec3 x = own - vertex;
    if (incidence_deg && angle_between(x, part.normal()) > than.incidence) return "incidence";
    if (pixel && pixel->kind == PixelLimit::Kind::worst) {
      // d * d / (f h) <= size, as a condition on the height. What keeps it is a ball that touches the plane in the
      // vertex.
      const double too_low = x.squaredNorm() / pixel_range_ - part.normal().dot(x);
      if (too_low > than.pixel_height + than.pixel_slack * x.norm()) return "pixel";
    }
  }
  if (sun && least_angle(part, own, sun_) < than.sun) return "sun";
  return std::nullopt;
}

/// The only limit that is searched, so it comes last. What lies nearer to the target, and to all sides, must keep it
/// too where facets may be the reason that the point is not claimed.
SensorJudge::Judgement SensorJudge::frame(const Vec3& position, const Thresholds& than) const {
  if (than.frame_loose == 0) return frame_at(position);
  const Vec3 nearer = than.frame_loose * (middle_ - position);
  const Vec3 beside = nearer.norm() * nearer.unitOrthogonal(), above = nearer.cross(beside) / nearer.norm();
  for (const Vec3& move : {nearer, beside, above, Vec3(-beside), Vec3(-above)}) {
    Judgement judgement = frame_at(position + move);
    if (judgement.finding != Finding::kept) return judgement;
  }
  return {};
}

SensorJudge::Judgement SensorJudge::frame_at(const Vec3& position) const {
  const std::vector<Vec3> seen = directions(position);
  const Finding finding = mounted_->search(seen).finding;
  if (finding != Finding::broken) return {finding, {}};
  const bool by_mount = free_->search(seen).finding == Finding::kept;
  return {finding, by_mount ? "gimbal" : "frame"};
}

SensorJudge::Judgement SensorJudge::judge(const Vec3& position, const Thresholds& than) const {
  for (const TargetView& part : parts_) {
    if (auto limit = broken_by_part(part, in_frame_of(part, position), than)) {
      return {Finding::broken, std::move(*limit)};
    }
  }
  return mounted_ ? frame(position, than) : Judgement{};
}

}  // namespace vantage::internal::verify
