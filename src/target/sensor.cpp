#include "vantage/sensor.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "core/text.h"
#include "request/checker.h"
#include "request/describe_sensor.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using internal::core::number_text;

constexpr double kLargestTangent = 1e3;  // half a picture of 179.9 degrees
constexpr std::size_t kMostCells = 1024;
constexpr double kShortest = 1e-60;        // metres: the square of a square of it is no zero yet
constexpr double kSmallestTangent = 1e-6;  // and one of a fifth of a second of arc

void require(bool holds, const char* problem, const char* where, const char* fix,
             ErrorCode code = ErrorCode::value_out_of_range) {
  if (!holds) throw Error(code, problem, where, fix);  // false for NaN too
}

void check_camera(const Pinhole& camera) {
  for (const double tangent : {camera.half_width, camera.half_height}) {
    require(tangent >= kSmallestTangent && tangent <= kLargestTangent,
            "an angle of view of the camera is not between 0.0002 and 179.8 degrees", "sensor.camera",
            "give the angles of view, or the size of the sensor and the focal length in the same unit");
  }
  require(!camera.focal_px || (*camera.focal_px > 0 && std::isfinite(*camera.focal_px)),
          "the focal length is not a positive, finite number", "sensor.camera", "give pixels");
}

void check_mount(const Mount& mount) {
  require(!mount.yaw_deg || std::isfinite(*mount.yaw_deg), "the yaw is not finite", "sensor.mount", "give degrees");
  require(mount.roll_deg >= -180 && mount.roll_deg <= 180, "the roll is not between -180 and 180 degrees",
          "sensor.mount", "give degrees; a positive roll lowers the right edge of the picture");
  require(mount.min_pitch_deg >= -90 && mount.max_pitch_deg <= 90, "a pitch is not between -90 and 90 degrees",
          "sensor.gimbal", "0 is level, -90 is straight down");
  if (mount.min_pitch_deg > mount.max_pitch_deg) {
    throw Error(ErrorCode::limits_reversed,
                "the gimbal's pitch is reversed: " + number_text(mount.min_pitch_deg) + " is above " +
                    number_text(mount.max_pitch_deg),
                "sensor.gimbal", "give the lower pitch first: 0 is level, -90 is straight down");
  }
  require(mount.min_pitch_deg <= mount.max_pitch_deg, "a pitch is not a number", "sensor.gimbal", "give degrees");
}

void check_share(const VisibleShare& visible) {
  require(visible.share > 0 && visible.share <= 1, "the visible share is not between 0 and 1", "sensor.visible",
          "give the part of the target's area that must be seen: 0.8");
  require(visible.cells >= 1 && visible.cells <= kMostCells, "the number of cells is not between 1 and 1024",
          "sensor.cells", "give for example 16, or 64 for a larger volume in more time");
}

void check_sun(const SunLimit& sun) {
  require(sun.direction.allFinite() && sun.direction != Vec3::Zero(), "the direction to the sun is zero or not finite",
          "sensor.sun", "give a vector towards the sun", ErrorCode::direction_invalid);
  require(sun.exclude_deg > 0 && sun.exclude_deg <= 90, "the angle to the sun is not between 0 and 90 degrees",
          "sensor.sun", "give the least angle that is wanted: exclude: 20");
}

/// Each limit by itself.
class SensorChecker : public internal::request::Checker {
  using Keys = std::span<const internal::request::Own>;

 public:
  SensorChecker() : Checker(internal::request::kSection<Sensor>) {}

  void keys(Keys /*keys*/, const std::optional<Pinhole>& camera, const Mount& mount) const {
    if (camera) check_camera(*camera);
    check_mount(mount);
  }
  void keys(Keys /*keys*/, const std::optional<PixelLimit>& /*pixel*/) const {}
  void keys(Keys /*keys*/, const std::optional<SunLimit>& sun) const {
    if (sun) check_sun(*sun);
  }
  void keys(Keys /*keys*/, const std::optional<VisibleShare>& visible) const {
    if (visible) check_share(*visible);
  }
};

}  // namespace

double range_limit_m(const Sensor& sensor) {
  if (!sensor.pixel || !sensor.camera || !sensor.camera->focal_px) return sensor.max_range_m;
  return std::min(sensor.max_range_m, sensor.pixel->size_m * *sensor.camera->focal_px);
}

void check_sensor(const Sensor& sensor) {
  SensorChecker checker;
  describe(sensor, checker);
  require(!sensor.pixel || (sensor.camera && sensor.camera->focal_px),
          "the size of a pixel needs a focal length in pixels", "sensor.pixel",
          "give a camera with its width and height in pixels", ErrorCode::missing_key);
  const double range_m = range_limit_m(sensor);
  require(std::isfinite(range_m), "max_range must be a positive, finite number of metres", "sensor",
          "give the farthest distance at which the target can be seen, or the size of a pixel, which limits it too");
  require(range_m <= internal::request::kLongest, "max_range is larger than 1e9 m", "sensor", "give metres");
  require(range_m >= kShortest, "max_range is shorter than 1e-60 m", "sensor", "give metres");
  if (sensor.min_range_m < range_m) return;
  throw Error(ErrorCode::limits_empty,
              "min_range is " + number_text(sensor.min_range_m) + " m, and " +
                  (range_m < sensor.max_range_m ? "the size of a pixel allows " : "max_range is ") +
                  number_text(range_m) + " m",
              "sensor", "give a min_range below that");
}

}  // namespace vantage
