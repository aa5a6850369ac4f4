// A sensor as an object of JSON, and from one.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>

#include "request/describe_sensor.h"
#include "request/json_object.h"
#include "vantage/sensor.h"

namespace vantage::internal::request {

template <typename Json, typename NumberAs>
class SensorObject : public JsonObject<Json, NumberAs> {
 public:
  using JsonObject<Json, NumberAs>::JsonObject;

  void keys(std::span<const Own> /*keys*/, const std::optional<Pinhole>& camera, const Mount& mount) {
    if (!camera) return;
    const auto& [half_width, half_height, width_px, height_px, focal_px] = *camera;
    static_cast<void>(width_px), static_cast<void>(height_px);  // focal_px has what counts of them
    const auto& [yaw_deg, min_pitch_deg, max_pitch_deg, roll_deg] = mount;
    Json& lens = json_["camera"];
    lens = {{"half_width", number_as_(half_width)}, {"half_height", number_as_(half_height)}};
    if (focal_px) lens["focal_px"] = number_as_(*focal_px);
    Json& angles = json_["mount"];
    angles = {{"min_pitch_deg", number_as_(min_pitch_deg)},
              {"max_pitch_deg", number_as_(max_pitch_deg)},
              {"roll_deg", number_as_(roll_deg)}};
    if (yaw_deg) angles["yaw_deg"] = number_as_(*yaw_deg);
  }
  void keys(std::span<const Own> /*keys*/, const std::optional<PixelLimit>& /*pixel*/) {}  // it is in "pixel"
  void keys(std::span<const Own> /*keys*/, const std::optional<SunLimit>& sun) {
    if (!sun) return;
    const auto& [direction, exclude_deg] = *sun;
    const Json vector = {number_as_(direction.x()), number_as_(direction.y()), number_as_(direction.z())};
    json_["sun"] = {{"direction", vector}, {"exclude_deg", number_as_(exclude_deg)}};
  }
  void keys(std::span<const Own> /*keys*/, const std::optional<VisibleShare>& visible) {
    if (!visible) return;
    const auto& [share, cells] = *visible;
    json_["visible"] = {{"share", number_as_(share)}, {"cells", number_as_(cells)}};
  }

 protected:
  using JsonObject<Json, NumberAs>::json_;
  using JsonObject<Json, NumberAs>::number_as_;
};

/// Reads what SensorObject wrote with numbers as numbers.
template <typename Json>
class SensorReader : public JsonReader<Json> {
 public:
  explicit SensorReader(const Json& json) : JsonReader<Json>(json, kSection<Sensor>) {}

  void keys(std::span<const Own> /*keys*/, std::optional<Pinhole>& camera, Mount& mount) const {
    if (!json_.contains("camera")) return;
    const Json &lens = json_.at("camera"), &angles = json_.at("mount");
    camera.emplace();
    camera->half_width = length_of(lens.at("half_width"));
    camera->half_height = length_of(lens.at("half_height"));
    if (lens.contains("focal_px")) camera->focal_px = length_of(lens.at("focal_px"));
    mount.min_pitch_deg = angles.at("min_pitch_deg").template get<double>();
    mount.max_pitch_deg = angles.at("max_pitch_deg").template get<double>();
    mount.roll_deg = angles.at("roll_deg").template get<double>();
    if (angles.contains("yaw_deg")) mount.yaw_deg = angles.at("yaw_deg").template get<double>();
  }
  void keys(std::span<const Own> /*keys*/, std::optional<PixelLimit>& /*pixel*/) const {}
  void keys(std::span<const Own> /*keys*/, std::optional<SunLimit>& sun) const {
    if (!json_.contains("sun")) return;
    const Json &json = json_.at("sun"), &to = json.at("direction");
    sun.emplace();
    sun->direction = {to.at(0).template get<double>(), to.at(1).template get<double>(),
                      to.at(2).template get<double>()};
    if (!sun->direction.allFinite() || to.size() != 3) throw std::invalid_argument("a point is not three numbers");
    sun->exclude_deg = json.at("exclude_deg").template get<double>();
  }
  void keys(std::span<const Own> /*keys*/, std::optional<VisibleShare>& visible) const {
    if (!json_.contains("visible")) return;
    const Json& json = json_.at("visible");
    const double cells = json.at("cells").template get<double>();
    if (!(cells >= 1 && cells <= kLongest)) throw std::invalid_argument("a number of cells is out of range");
    visible = VisibleShare{json.at("share").template get<double>(), static_cast<std::size_t>(cells)};
  }

 private:
  using JsonReader<Json>::json_;

  static double length_of(const Json& json) {
    const double value = json.template get<double>();
    if (!(value >= 0) || !std::isfinite(value)) throw std::invalid_argument("a length is negative");
    return value;
  }
};

}  // namespace vantage::internal::request
