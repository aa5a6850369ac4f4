#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "camera/camera_check.h"
#include "common/input.h"
#include "core/format.h"
#include "core/portable_math.h"
#include "vantage/camera.h"
#include "vantage/error.h"

namespace vantage {

namespace portable = internal::portable;

namespace {

constexpr double kDegreesInRadian = 180 / std::numbers::pi;

std::string place_of_camera(const Camera& camera) {
  return camera.name.empty() ? "camera" : "camera " + in_quotes(camera.name);
}

[[noreturn]] void fail_camera(const Camera& camera, std::string problem, std::string fix) {
  throw Error(ErrorCode::camera_invalid, std::move(problem), place_of_camera(camera), std::move(fix));
}

double half_of_fov(double fov_deg, const char* which) {
  constexpr double kNarrowest = 0.001, kWidest = 179;
  if (fov_deg >= kNarrowest && fov_deg <= kWidest) return portable::tan(fov_deg / 2 / kDegreesInRadian);  // not for NaN
  fail_camera({}, internal::core::format("the {} field of view cannot be {} degrees", which, shortest(fov_deg)),
              internal::core::format("give {} to {} degrees", kNarrowest, kWidest));
}

/// What the picture, if it is known, gives for focal_px.
void add_picture(Pinhole& pinhole, int width_px, int height_px) {
  if (width_px == 0) return;
  pinhole.width_px = width_px;
  pinhole.height_px = height_px;
  pinhole.focal_px = std::min(width_px / (2 * pinhole.half_width), height_px / (2 * pinhole.half_height));
}

}  // namespace

std::array<double, 2> Pinhole::fov_deg() const {
  return {2 * kDegreesInRadian * portable::atan(half_width), 2 * kDegreesInRadian * portable::atan(half_height)};
}

Camera completed(const Camera& camera) {
  if (auto fault = internal::camera::fault_of(camera)) {
    fail_camera(camera, std::move(fault->problem), std::move(fault->fix));
  }
  Camera complete = camera;
  if (camera.width_px == 0) return complete;
  const double aspect = static_cast<double>(camera.height_px) / camera.width_px;
  if (camera.sensor_height_mm == 0) complete.sensor_height_mm = camera.sensor_width_mm * aspect;
  if (camera.sensor_width_mm == 0) complete.sensor_width_mm = camera.sensor_height_mm / aspect;
  return complete;
}

Pinhole pinhole_of(const Camera& camera) {
  const Camera complete = completed(camera);
  if (complete.focal_length_mm == 0) fail_camera(camera, "the focal length is not known", "give it in millimetres");
  if (complete.sensor_width_mm == 0 || complete.sensor_height_mm == 0) {
    fail_camera(camera, "the size of the sensor is not known",
                "give its width and height in millimetres, or one of them and the pixels of the picture");
  }
  Pinhole pinhole;
  pinhole.half_width = complete.sensor_width_mm / (2 * complete.focal_length_mm);
  pinhole.half_height = complete.sensor_height_mm / (2 * complete.focal_length_mm);
  add_picture(pinhole, complete.width_px, complete.height_px);
  return pinhole;
}

std::optional<Pinhole> pinhole_if_known(const ListedCamera& listed) {
  if (!listed.problem.empty()) return std::nullopt;
  const Camera complete = completed(listed.camera);
  const bool is_known = complete.focal_length_mm > 0 && complete.sensor_width_mm > 0 && complete.sensor_height_mm > 0;
  return is_known ? std::optional(pinhole_of(complete)) : std::nullopt;
}

Pinhole pinhole_of_fov(double horizontal_deg, double vertical_deg, int width_px, int height_px) {
  Camera picture;
  picture.width_px = width_px;
  picture.height_px = height_px;
  completed(picture);
  Pinhole pinhole;
  pinhole.half_width = half_of_fov(horizontal_deg, "horizontal");
  pinhole.half_height = half_of_fov(vertical_deg, "vertical");
  add_picture(pinhole, width_px, height_px);
  return pinhole;
}

}  // namespace vantage
