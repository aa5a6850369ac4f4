// Where the camera cannot have the whole target in one picture.
#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "core/portable_math.h"
#include "core/text.h"
#include "sensor/best_aim.h"
#include "solid/frame_surface.h"
#include "solid/numerics.h"
#include "solid/sensor_region_builder.h"

namespace vantage::internal::solid {
namespace {

/// `distance`: from which the whole target is in one picture.
std::string explanation(const Sensor& sensor, double distance) {
  constexpr double kFarthestNamed = 1000;  // times the range
  const double range = range_limit_m(sensor);
  const char* const because = range < sensor.max_range_m ? "the size of a pixel allows " : "max_range is ";
  if (!(distance < kFarthestNamed * range)) return "the camera does not look towards the target from there";
  return "the whole target is in one picture from " + core::metres_text(distance) + " on, and " + because +
         core::metres_text(range);
}

void add_fixed(const Pinhole& camera, SensorRegionBuilder& builder) {
  constexpr double kDegree = std::numbers::pi / 180;
  const Mount& mount = builder.sensor().mount;
  const std::vector<Vec3>& corners = builder.viewed().corners;
  const sensor::AimFinder finder(corners, camera, mount, 0);
  const sensor::AimedView view = finder.next_to({*mount.yaw_deg * kDegree, mount.min_pitch_deg * kDegree});
  std::vector<HalfSpace> half_spaces;
  for (const Vec3& edge : view.edges) half_spaces.push_back({edge, -most_along(corners, -edge)});
  const Vec3 back = -(view.edges[0] + view.edges[1]).normalized();
  builder.keep("frame", std::move(half_spaces), explanation(builder.sensor(), view.distance(back)));
}

/// How far from the origin viewpoints can keep the sensor's other limits, along a direction and some that differ from
/// it by `angle`, radians.
double reach_along(const Vec3& direction, double angle, const Sensor& sensor, const std::optional<Vec3>& front) {
  constexpr double kDegree = std::numbers::pi / 180;
  const auto angle_to = [&](const Vec3& unit) { return portable::acos(std::clamp(unit.dot(direction), -1.0, 1.0)); };
  const double range = range_limit_m(sensor);
  if (sensor.sun) {
    const Vec3 from_sun = -sensor.sun->direction.stableNormalized();
    if (angle_to(from_sun) + angle < sensor.sun->exclude_deg * kDegree) return 0;
  }
  if (!front) return range;
  const double slant = std::max(angle_to(*front) - angle, 0.0);
  if (sensor.incidence_deg && slant > *sensor.incidence_deg * kDegree) return 0;
  if (!sensor.pixel || sensor.pixel->kind != PixelLimit::Kind::worst) return range;
  const double diameter = sensor.pixel->size_m * *sensor.camera->focal_px;
  return std::min(range, diameter * std::max(portable::cos(slant), 0.0));
}

}  // namespace

void add_frame_region(const Pinhole& camera, SensorRegionBuilder& builder) {
  if (builder.sensor().mount.is_fixed()) return add_fixed(camera, builder);
  const sensor::Viewed& viewed = builder.viewed();
  FrameView view{.corners = viewed.corners,
                 .front = viewed.parts.size() == 1 ? viewed.parts[0].normal : std::nullopt,
                 .camera = camera,
                 .mount = builder.sensor().mount,
                 .reach = builder.reach(),
                 .least = numerics::kLeastDistance * builder.reach()};
  builder.forbid_star("frame", {"frame", "gimbal"},
                      [view, sensor = builder.sensor()](const exact::ChartLimits::Reach& reach) {
                        FrameView seen = view;
                        seen.reach_along = [&](const Vec3& direction, double angle) {
                          const double own = reach_along(direction, angle, sensor, view.front);
                          return reach ? std::min(own, reach(direction, angle)) : own;
                        };
                        FrameSurface surface = make_frame_surface(seen);
                        return SensorRegionBuilder::Star{std::move(surface.mesh),
                                                         {surface.by_mount.begin(), surface.by_mount.end()},
                                                         explanation(sensor, surface.least_distance)};
                      });
}

}  // namespace vantage::internal::solid
