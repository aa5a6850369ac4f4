// Where the camera cannot have the whole target in one picture.
#include <numbers>
#include <optional>
#include <utility>

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

}  // namespace

void add_frame_region(const Pinhole& camera, SensorRegionBuilder& builder) {
  if (builder.sensor().mount.is_fixed()) return add_fixed(camera, builder);
  const sensor::Viewed& viewed = builder.viewed();
  const bool has_one_front = viewed.parts.size() == 1;
  const FrameSurface surface = make_frame_surface({.corners = viewed.corners,
                                                   .front = has_one_front ? viewed.parts[0].normal : std::nullopt,
                                                   .camera = camera,
                                                   .mount = builder.sensor().mount,
                                                   .reach = builder.reach(),
                                                   .least = numerics::kLeastDistance * builder.reach()});
  std::vector<std::string> names;
  for (const bool by_mount : surface.by_mount) names.emplace_back(by_mount ? "gimbal" : "frame");
  builder.forbid_star("frame", surface.mesh, names, explanation(builder.sensor(), surface.least_distance));
}

}  // namespace vantage::internal::solid
