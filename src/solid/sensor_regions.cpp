#include "solid/sensor_regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/enclosing_circle.h"
#include "core/portable_math.h"
#include "core/text.h"
#include "sensor/best_aim.h"
#include "solid/convex_body.h"
#include "solid/convex_hull.h"
#include "solid/frame_surface.h"
#include "solid/halve_sides.h"
#include "solid/numerics.h"
#include "solid/star_surface.h"

namespace vantage::internal::solid {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Distances are named up to so many times the range.
constexpr double kFarthestNamed = 1000;

using sensor::AimedView;
using sensor::AimFinder;
using sensor::Viewed;
using sensor::ViewedPart;

Vec3 any_across(const Vec3& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  return axis.cross(Vec3::Unit(least)).normalized();
}

/// Unit vectors round an axis of unit length.
std::vector<Vec3> ring(const Vec3& axis, int count) {
  const Vec3 u = any_across(axis), v = axis.cross(u);
  std::vector<Vec3> result;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const portable::SineCosine turn = portable::sine_cosine(angle);
    result.push_back(turn.cosine * u + turn.sine * v);
  }
  return result;
}

double most_along(const std::vector<Vec3>& corners, const Vec3& direction) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& corner : corners) most = std::max(most, corner.dot(direction));
  return most;
}

class SensorRegions {
 public:
  SensorRegions(const Viewed& viewed, const Sensor& sensor, const Box& bounds, Regions& regions)
      : viewed_(viewed), sensor_(sensor), regions_(regions) {
    const Vec3 overshoot = Vec3::Constant(numerics::kOvershoot * (bounds.max - bounds.min).norm());
    box_ = {bounds.min - overshoot - viewed.origin, bounds.max + overshoot - viewed.origin};
    reach_ =
        std::min(range_limit_m(sensor) + viewed.radius(), box_.min.cwiseAbs().cwiseMax(box_.max.cwiseAbs()).norm());
  }

  void add_incidence(const ViewedPart& part);
  void add_pixel(const ViewedPart& part);
  void add_min_range(const ViewedPart& part);
  void add_sun(const ViewedPart& part);
  void add_frame();

 private:
  std::uint32_t label_of(const std::string& name);
  Solid solid_of(Mesh mesh, std::vector<std::uint32_t> labels);
  Solid solid_of(const Mesh& mesh, const std::string& name) {
    return solid_of(mesh, std::vector<std::uint32_t>(mesh.triangles.size(), label_of(name)));
  }
  void keep(const std::string& name, std::vector<HalfSpace> half_spaces, const std::string& explanation = {});
  void forbid(const std::string& name, Solid solid, const std::string& explanation = {});
  std::string frame_explanation(double distance) const;
  void add_fixed_frame();

  const Viewed& viewed_;
  const Sensor& sensor_;
  Regions& regions_;
  Box box_;           ///< about the volume and a little more, relative to the viewed origin
  double reach_ = 0;  ///< of viewpoints from the origin, at most; metres
};

/// `explanation`: what the limit asks, as a clause; may be empty.
Region sensor_region(const std::string& name, Solid solid, const std::string& explanation) {
  return {.name = name,
          .solid = std::move(solid),
          .explain =
              [explanation](const Region& region, const Remainder& left) {
                return Emptiness{"the sensor's limit '" + region.name + "' leaves nothing of " + left.text() +
                                     (explanation.empty() ? "" : "; " + explanation),
                                 "relax it, or the limits that it goes with"};
              },
          .is_cut_alone = true};
}

std::uint32_t SensorRegions::label_of(const std::string& name) {
  const auto& causes = regions_.causes;
  const auto known = std::find_if(causes.begin(), causes.end(), [&](const Cause& cause) {
    return cause.kind == CauseKind::sensor && cause.name == name;
  });
  const auto cause = static_cast<std::uint32_t>(known - causes.begin());
  if (known == causes.end()) regions_.causes.push_back({CauseKind::sensor, name});
  regions_.sources.push_back({.cause = cause});
  return static_cast<std::uint32_t>(regions_.sources.size() - 1);
}

/// Booleans look at all pairs of facets whose boxes overlap, and long narrow ones have large boxes.
Solid SensorRegions::solid_of(Mesh mesh, std::vector<std::uint32_t> labels) {
  const double longest = numerics::kLongestSide * reach_;
  const auto length = [&](std::uint32_t a, std::uint32_t b) { return (mesh.vertices[a] - mesh.vertices[b]).norm(); };
  const auto wants = [&](const Triangle& t) {
    Box box;
    for (const std::uint32_t i : t) box.extend(mesh.vertices[i]);
    const bool is_near = (box.min.array() < box_.max.array()).all() && (box.max.array() > box_.min.array()).all();
    return is_near && std::max({length(t[0], t[1]), length(t[1], t[2]), length(t[2], t[0])}) > longest;
  };
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  std::vector<std::uint32_t> of_triangle, relabelled;
  while (halve_sides(mesh.triangles, wants, length, middle, of_triangle)) {
    relabelled.clear();
    for (const std::uint32_t t : of_triangle) relabelled.push_back(labels[t]);
    labels.swap(relabelled);
  }
  return Solid(moved_to_origin(mesh, std::move(labels), regions_.origin - viewed_.origin), "a limit of the sensor");
}

void SensorRegions::keep(const std::string& name, std::vector<HalfSpace> half_spaces, const std::string& explanation) {
  for (HalfSpace& half_space : half_spaces) {
    const double length = half_space.normal.norm();
    half_space = {half_space.normal / length, half_space.at / length};
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    half_spaces.push_back({Vec3::Unit(axis), box_.max[axis]});
    half_spaces.push_back({-Vec3::Unit(axis), -box_.min[axis]});
  }
  Region region = sensor_region(name, Solid(), explanation);
  // A point deep inside, so that no plane is very near to it.
  std::optional<Vec3> inside;
  for (double depth = reach_; !inside && depth > numerics::kLeastDistance * reach_; depth /= 2) {
    inside = kernel_point(half_spaces, box_, depth);
  }
  if (inside) region.solid = solid_of(intersect_half_spaces(half_spaces, *inside), name);
  regions_.kept.push_back(std::move(region));
}

void SensorRegions::forbid(const std::string& name, Solid solid, const std::string& explanation) {
  regions_.forbidden.push_back(sensor_region(name, std::move(solid), explanation));
}

/// `distance`: from which the whole target is in one picture.
std::string SensorRegions::frame_explanation(double distance) const {
  const double range = range_limit_m(sensor_);
  const char* const because = range < sensor_.max_range_m ? "the size of a pixel allows " : "max_range is ";
  if (!(distance < kFarthestNamed * range)) return "the camera does not look towards the target from there";
  return "the whole target is in one picture from " + core::metres_text(distance) + " on, and " + because +
         core::metres_text(range);
}

/// A cone of as many sides, inside of the round one, at each corner.
void SensorRegions::add_incidence(const ViewedPart& part) {
  constexpr int kSides = 128;
  const double slope = portable::tan(*sensor_.incidence_deg * kDegree) * portable::cos(std::numbers::pi / kSides);
  std::vector<HalfSpace> half_spaces;
  for (const Vec3& aside : ring(*part.normal, kSides)) {
    const Vec3 normal = aside - slope * *part.normal;
    half_spaces.push_back({normal, -most_along(part.corners, -normal)});
  }
  keep("incidence", std::move(half_spaces));
}

/// What the balls that touch the target's plane in its corners have in common is convex.
void SensorRegions::add_pixel(const ViewedPart& part) {
  const double radius = sensor_.pixel->size_m * *sensor_.camera->focal_px / 2;
  // In the plane of their centres, which are the corners moved along the normal, no point lies deeper in all of them
  // than the one from which the farthest is nearest.
  const Vec3 u = any_across(*part.normal), v = part.normal->cross(u);
  std::vector<Eigen::Vector2d> centres;
  for (const Vec3& corner : part.corners) centres.emplace_back(u.dot(corner), v.dot(corner));
  const core::Circle circle = core::smallest_enclosing_circle(centres);
  Region region = sensor_region("pixel", Solid(), "");
  if (circle.radius < (1 - numerics::kLeastDistance) * radius) {
    const double height = part.normal->dot(part.centre) + radius;
    const Vec3 inside = circle.centre.x() * u + circle.centre.y() * v + height * *part.normal;
    Mesh mesh = star_inside(
        [&](const Vec3& direction) {
          double reach = std::numeric_limits<double>::infinity();
          for (const Vec3& corner : part.corners) {
            const Vec3 from = inside - corner - radius * *part.normal;
            const double along = direction.dot(from);
            reach = std::min(reach, std::sqrt(along * along + radius * radius - from.squaredNorm()) - along);
          }
          return (1 - numerics::kInward) * reach;
        },
        numerics::kPixelShare);
    for (Vec3& vertex : mesh.vertices) vertex += inside;
    region.solid = solid_of(mesh, "pixel");
  }
  regions_.kept.push_back(std::move(region));
}

/// A polyhedron round the ball, at each corner. Its vertices matter at those corners only that lie farthest in nearly
/// their directions.
void SensorRegions::add_min_range(const ViewedPart& part) {
  const SphereMesh sphere = make_sphere_for(numerics::kMinRangeShare);
  const double radius = sensor_.min_range_m / portable::cos(sphere.cover);
  double extent = 0;
  for (const Vec3& corner : part.corners) extent = std::max(extent, 2 * (corner - part.centre).norm());
  std::vector<Vec3> points;
  for (const Vec3& direction : sphere.mesh.vertices) {
    const double least = most_along(part.corners, direction) - 2 * sphere.cover * extent;
    for (const Vec3& corner : part.corners) {
      if (corner.dot(direction) >= least) points.push_back(corner + radius * direction);
    }
  }
  Mesh mesh = convex_hull(points);
  grow_to_hold(mesh, part.centre, [&](const Vec3& direction) {
    return most_along(part.corners, direction) + sensor_.min_range_m * direction.norm();
  });
  forbid("min_range", solid_of(mesh, "min_range"));
}

/// From the target away from the sun, by a cone of as many sides round the wanted one.
void SensorRegions::add_sun(const ViewedPart& part) {
  constexpr int kSides = 128;
  const Vec3 sun = sensor_.sun->direction.normalized();
  const double angle = sensor_.sun->exclude_deg * kDegree;
  // At a right angle the cone is a half-space, and the tangent large but finite.
  const double slope = portable::tan(angle) / portable::cos(std::numbers::pi / kSides);
  const double sides_angle = sensor_.sun->exclude_deg < 90 ? portable::atan(slope) : std::numbers::pi / 2;
  const double length = 4 * (reach_ + viewed_.radius());
  std::vector<Vec3> points;
  for (const Vec3& corner : part.corners) {
    points.push_back(corner);
    points.push_back(corner - length * sun);
    for (const Vec3& aside : ring(sun, kSides)) {
      points.push_back(corner - length * (portable::cos(sides_angle) * sun + portable::sin(sides_angle) * aside));
    }
  }
  forbid("sun", solid_of(convex_hull(points), "sun"));
}

void SensorRegions::add_fixed_frame() {
  const AimFinder finder(viewed_.corners, *sensor_.camera, sensor_.mount, 0);
  const sensor::Aim aim{*sensor_.mount.yaw_deg * kDegree, sensor_.mount.min_pitch_deg * kDegree};
  const AimedView view = finder.next_to(aim);
  std::vector<HalfSpace> half_spaces;
  for (const Vec3& edge : view.edges) half_spaces.push_back({edge, -most_along(viewed_.corners, -edge)});
  const Vec3 back = -(view.edges[0] + view.edges[1]).normalized();
  keep("frame", std::move(half_spaces), frame_explanation(view.distance(back)));
}

void SensorRegions::add_frame() {
  if (sensor_.mount.is_fixed()) return add_fixed_frame();
  const bool has_one_front = viewed_.parts.size() == 1;
  const FrameSurface surface = make_frame_surface({.corners = viewed_.corners,
                                                   .front = has_one_front ? viewed_.parts[0].normal : std::nullopt,
                                                   .camera = *sensor_.camera,
                                                   .mount = sensor_.mount,
                                                   .reach = reach_,
                                                   .least = numerics::kLeastDistance * reach_});
  const std::uint32_t frame = label_of("frame"), gimbal = label_of("gimbal");
  std::vector<std::uint32_t> labels;
  for (const bool by_mount : surface.by_mount) labels.push_back(by_mount ? gimbal : frame);
  forbid("frame", solid_of(surface.mesh, std::move(labels)), frame_explanation(surface.least_distance));
}

}  // namespace

// All members are named: a limit that is added does not compile here before it is cut.
void add_sensor_regions(const Viewed& viewed, const Sensor& limits, const Box& bounds, Regions& regions) {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = limits;
  SensorRegions builder(viewed, limits, bounds, regions);
  for (const ViewedPart& part : viewed.parts) {
    if (incidence_deg) builder.add_incidence(part);
    if (pixel && pixel->kind == PixelLimit::Kind::worst) builder.add_pixel(part);
    if (min_range_m > 0) builder.add_min_range(part);
    if (sun) builder.add_sun(part);
  }
  if (camera) builder.add_frame();
}

}  // namespace vantage::internal::solid
