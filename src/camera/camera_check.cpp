#include "camera/camera_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/input.h"
#include "core/format.h"
#include "core/text.h"

namespace vantage::internal::camera {
namespace {

using core::number_text;

// Bounds of what is built. They only have to tell slips, such as another unit, from cameras.
constexpr int kMostPixels = 1'000'000;       // a side; line scanners and mosaics have some 100,000
constexpr double kLargestSensorMm = 250;     // aerial film has 230
constexpr double kLongestFocalMm = 10'000;   // telescopes
constexpr double kSmallestMm = 0.01;         // of a sensor or a focal length
constexpr double kLargestPixelMm = 0.4;      // thermal arrays of 8 x 8 have 0.3
constexpr double kSmallestPixelMm = 0.0003;  // telephones have 0.0005
// Sensors of more than 100 mm are those of mapping cameras, with pixels of 4 to 10 um, and film, scanned at up to 25
// um.
constexpr double kLargeSensorMm = 100, kLargestPixelOfLargeSensorMm = 0.03;
// Tangent of half the field of view: 168.6 degrees. Fisheye lenses, which are no pinholes, reach 3 with their nominal
// focal length.
constexpr double kWidestHalf = 10;
// Data sheets round, and some give the sensor and not the part that makes the picture.
constexpr double kLargestPixelDifference = 0.05;

constexpr const char* kInPixels = "the sensor seems to be in pixels instead of millimetres";
constexpr const char* kGiveMillimetres = "give the millimetres of the data sheet";

/// Or not known.
bool is_length(double mm, double largest) { return mm == 0 || (mm >= kSmallestMm && mm <= largest); }  // not for NaN

std::optional<CameraFault> fault_of_numbers(const Camera& camera) {
  for (const auto& [pixels, side] : {std::pair(camera.width_px, "wide"), std::pair(camera.height_px, "high")}) {
    if (pixels >= 0 && pixels <= kMostPixels) continue;
    return CameraFault{core::format("the picture cannot be {} pixels {}", pixels, side),
                       core::format("give 1 to {} pixels", kMostPixels)};
  }
  for (const auto& [mm, side] :
       {std::pair(camera.sensor_width_mm, "wide"), std::pair(camera.sensor_height_mm, "high")}) {
    if (is_length(mm, kLargestSensorMm)) continue;
    if (mm > kLargestSensorMm && std::isfinite(mm)) {
      return CameraFault{core::format("{}: {} mm {}", kInPixels, shortest(mm), side), kGiveMillimetres};
    }
    return CameraFault{core::format("the sensor cannot be {} mm {}", shortest(mm), side), kGiveMillimetres};
  }
  if (!is_length(camera.focal_length_mm, kLongestFocalMm)) {
    return CameraFault{core::format("the focal length cannot be {} mm", shortest(camera.focal_length_mm)),
                       core::format("give {} to {} mm", kSmallestMm, kLongestFocalMm)};
  }
  return std::nullopt;
}

/// What is wrong with the pixels of one side; the sensor and the picture are known.
std::optional<CameraFault> fault_of_pixel(double sensor_mm, int pixels, const char* side) {
  const double pixel = sensor_mm / pixels;
  if (pixel > kLargestPixelMm || (sensor_mm > kLargeSensorMm && pixel > kLargestPixelOfLargeSensorMm)) {
    return CameraFault{core::format("{}: {} mm {} for {} pixels", kInPixels, number_text(sensor_mm), side, pixels),
                       kGiveMillimetres};
  }
  if (pixel < kSmallestPixelMm) {
    return CameraFault{core::format("the sensor is too small for its pixels: {} mm {} for {} pixels",
                                    number_text(sensor_mm), side, pixels),
                       "give the millimetres of the data sheet, not inches or centimetres"};
  }
  return std::nullopt;
}

std::optional<CameraFault> fault_of_shape(const Camera& camera) {
  const double width = camera.sensor_width_mm / camera.width_px, height = camera.sensor_height_mm / camera.height_px;
  if (std::max(width, height) <= (1 + kLargestPixelDifference) * std::min(width, height)) return std::nullopt;
  return CameraFault{core::format("the pixels would be {} x {} um, and pixels are square", number_text(1000 * width),
                                  number_text(1000 * height)),
                     "give the part of the sensor that makes the picture, and the whole picture"};
}

}  // namespace

std::optional<CameraFault> fault_of(const Camera& camera) {
  if (auto fault = fault_of_numbers(camera)) return fault;
  if ((camera.width_px == 0) != (camera.height_px == 0)) {
    return CameraFault{"the picture has only one side", "give both its width and its height in pixels"};
  }
  const bool has_picture = camera.width_px > 0;
  const bool has_width = camera.sensor_width_mm > 0, has_height = camera.sensor_height_mm > 0;
  if (has_picture && has_width) {
    if (auto fault = fault_of_pixel(camera.sensor_width_mm, camera.width_px, "wide")) return fault;
  }
  if (has_picture && has_height) {
    if (auto fault = fault_of_pixel(camera.sensor_height_mm, camera.height_px, "high")) return fault;
  }
  if (has_picture && has_width && has_height) {
    if (auto fault = fault_of_shape(camera)) return fault;
  }
  const double side = std::max(camera.sensor_width_mm, camera.sensor_height_mm);
  if (camera.focal_length_mm > 0 && side > 2 * kWidestHalf * camera.focal_length_mm) {
    return CameraFault{core::format("a focal length of {} mm is too short for a sensor of {} mm",
                                    number_text(camera.focal_length_mm), number_text(side)),
                       "give both in millimetres, the focal length of the lens itself"};
  }
  return std::nullopt;
}

}  // namespace vantage::internal::camera
