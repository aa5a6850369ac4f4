#include "app/sensor_section.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <regex>
#include <span>
#include <utility>
#include <variant>

#include "app/described_section.h"
#include "app/schema.h"
#include "common/input.h"
#include "common/time_text.h"
#include "core/places.h"
#include "core/portable_math.h"
#include "request/describe_sensor.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

struct Dori {
  const char* name;
  double pixels_per_metre;
};
/// EN 62676-4, annex B.
constexpr std::array kDori = {Dori{"detection", 25}, Dori{"observation", 62}, Dori{"recognition", 125},
                              Dori{"identification", 250}};

using Keys = std::span<const request::Own>;

/// Where a mission says nothing of it: all that the gimbal of a known camera reaches.
Mount mount_without_words(const std::optional<CameraSource>& camera) {
  Mount mount;
  const auto* const model = camera ? std::get_if<CameraModel>(&*camera) : nullptr;
  for (const Camera& known : known_cameras()) {
    const auto& pitch_deg = known.carrier.pitch_deg;
    if (model == nullptr || known.name != model->name || !pitch_deg) continue;
    mount.min_pitch_deg = std::max(mount.min_pitch_deg, (*pitch_deg)[0]);
    mount.max_pitch_deg = std::min(mount.max_pitch_deg, (*pitch_deg)[1]);
  }
  return mount;
}

/// Besides what a sensor has it reads the other forms of some limits: a pilot's sight, levels, times.
class SensorReader : public SectionReader {
 public:
  SensorReader(const YamlNode& node, const ValueReader& reader)
      : SectionReader(node, std::string(request::kSection<Sensor>), reader) {}

  SensorSection read();

  void keys(Keys keys, std::optional<Pinhole>& camera, Mount& mount);
  void keys(Keys keys, std::optional<PixelLimit>& pixel);
  void keys(Keys keys, std::optional<SunLimit>& limit);
  void keys(Keys keys, std::optional<VisibleShare>& visible);
  template <typename Settings>
  void instead(const request::Key& key);

 private:
  Camera numbers(const YamlNode& camera, bool has_fov) const;
  CameraSource camera_source(const YamlNode* camera, const YamlNode* fov) const;
  void read_mount(const YamlNode& node, Mount& mount) const;
  void read_gimbal(const YamlNode& node, Mount& mount) const;
  Vec3 sun_direction(const YamlNode& sun, const std::string& form) const;
  const YamlNode* given(std::string_view key) const { return find(root(), key); }
  const YamlNode& require(const YamlNode& map, const char* key, const std::string& what, const std::string& fix) const;
  std::array<double, 2> two_angles(const YamlNode& node, const std::string& what, const std::string& form) const;
  void refuse_both(const char* one, const char* other, const std::string& fix) const;
  void check_camera_for(std::string_view key) const;

  SensorSection result_;
};

const YamlNode& SensorReader::require(const YamlNode& map, const char* key, const std::string& what,
                                      const std::string& fix) const {
  if (const YamlNode* found = find(map, key)) return *found;
  reader().fail(ErrorCode::missing_key, map, what + " lacks the key '" + key + "'", fix);
}

std::array<double, 2> SensorReader::two_angles(const YamlNode& node, const std::string& what,
                                               const std::string& form) const {
  if (reader().list(node, what, form).size() != 2) {
    reader().fail(ErrorCode::wrong_type, node, what + " must be two numbers, not " + describe(node), form);
  }
  return {reader().angle(node.items[0], what + "[0]"), reader().angle(node.items[1], what + "[1]")};
}

void SensorReader::refuse_both(const char* one, const char* other, const std::string& fix) const {
  const YamlNode* second = find(root(), other);
  if (!find(root(), one) || !second) return;
  reader().fail(ErrorCode::conflicting_keys, *second,
                std::string("sensor.") + one + " and sensor." + other + " say the same thing", fix);
}

Camera SensorReader::numbers(const YamlNode& camera, bool has_fov) const {
  const char* const form =
      "write {width: 8000, height: 6000, focal_length: 24.5, sensor_width: 35.9}: pixels and millimetres";
  const auto pixels = [&](const char* key) {
    const YamlNode& node = require(camera, key, "sensor.camera", form);
    const double value = reader().number(node, std::string("sensor.camera.") + key);
    if (value != std::floor(value) || value < 1 || value > 1e6) {
      reader().fail(ErrorCode::value_out_of_range, node,
                    std::string("sensor.camera.") + key + " is not a number of pixels", "write a whole number");
    }
    return static_cast<int>(value);
  };
  const auto millimetres = [&](const char* key) {
    return reader().positive(require(camera, key, "sensor.camera", form), std::string("sensor.camera.") + key);
  };
  Camera result;
  result.width_px = pixels("width");
  result.height_px = pixels("height");
  if (has_fov) {
    for (const char* const key : {"focal_length", "sensor_width"}) {
      if (const YamlNode* given = find(camera, key)) {
        reader().fail(ErrorCode::conflicting_keys, *given,
                      std::string("sensor.fov and sensor.camera.") + key + " both say how wide the picture is",
                      "keep one of them");
      }
    }
    return result;
  }
  result.focal_length_mm = millimetres("focal_length");
  result.sensor_width_mm = millimetres("sensor_width");
  return result;
}

CameraSource SensorReader::camera_source(const YamlNode* camera, const YamlNode* fov) const {
  CameraFov of_fov;
  if (fov) {
    of_fov.fov_deg = two_angles(*fov, "sensor.fov", "write the horizontal and the vertical angle in degrees: [60, 40]");
  }
  if (!camera) return of_fov;
  check_keys(*camera, "sensor.camera", reader().file());
  const YamlNode* const model = find(*camera, "model");
  if (!model) {
    const Camera read = numbers(*camera, fov != nullptr);
    if (!fov) return read;
    of_fov.width_px = read.width_px;
    of_fov.height_px = read.height_px;
    return of_fov;
  }
  for (const YamlEntry& entry : camera->entries) {
    if (entry.key == "model") continue;
    reader().fail(ErrorCode::conflicting_keys, entry.value,
                  "sensor.camera.model and sensor.camera." + entry.key + " both describe the camera",
                  "keep the model, or the numbers");
  }
  if (fov) {
    reader().fail(ErrorCode::conflicting_keys, *fov,
                  "sensor.fov and sensor.camera.model both say how wide the picture is", "keep one of them");
  }
  return CameraModel{reader().text(*model, "sensor.camera.model")};
}

void SensorReader::check_camera_for(std::string_view key) const {
  const YamlNode* const node = given(key);
  if (!node || given("camera") || given("fov")) return;
  reader().fail(
      ErrorCode::missing_key, *node, "sensor." + std::string(key) + " needs a camera",
      "name one, camera: {model: sony_a7r_iv_35mm}, or give its numbers; `vantage cameras` lists those known");
}

void SensorReader::keys(Keys /*keys*/, std::optional<Pinhole>& camera, Mount& mount) {
  const YamlNode *numbers = given("camera"), *fov = given("fov");
  if (numbers || fov) {
    const CameraSource source = camera_source(numbers, fov);
    camera = core::with_place(place_in(reader().file(), (numbers ? *numbers : *fov).place), [&] {
      if (const auto* model = std::get_if<CameraModel>(&source)) return pinhole_of(find_camera(model->name));
      if (const auto* own = std::get_if<Camera>(&source)) return pinhole_of(*own);
      const auto& [fov_deg, width_px, height_px] = std::get<CameraFov>(source);
      return pinhole_of_fov(fov_deg[0], fov_deg[1], width_px, height_px);
    });
    result_.camera = source;
  }
  refuse_both("mount", "gimbal", "keep the gimbal, or a mount of fixed angles");
  for (const std::string_view key : {"mount", "gimbal", "pixel", "dori"}) check_camera_for(key);
  mount = mount_without_words(result_.camera);
  if (const YamlNode* node = given("mount")) read_mount(*node, mount);
  if (const YamlNode* node = given("gimbal")) read_gimbal(*node, mount);
}

void SensorReader::read_mount(const YamlNode& node, Mount& mount) const {
  if (node.kind == YamlNode::Kind::scalar) {
    if (reader().text(node, "sensor.mount") == "gimbal") return;
    reader().fail(ErrorCode::unknown_choice, node, "sensor.mount is neither 'gimbal' nor a mapping of angles",
                  "write 'mount: gimbal', or {yaw: any, pitch: -90}");
  }
  check_keys(node, "sensor.mount", reader().file());
  const char* const form =
      "write {yaw: any, pitch: -90, roll: 0}: degrees; yaw is clockwise from north, pitch -90 straight down";
  const YamlNode& yaw = require(node, "yaw", "sensor.mount", form);
  if (yaw.kind != YamlNode::Kind::scalar || yaw.text != "any") {
    mount.yaw_deg = reader().angle(yaw, "sensor.mount.yaw");
  }
  const double pitch = reader().angle(require(node, "pitch", "sensor.mount", form), "sensor.mount.pitch");
  mount.min_pitch_deg = mount.max_pitch_deg = pitch;
  if (const YamlNode* roll = find(node, "roll")) mount.roll_deg = reader().angle(*roll, "sensor.mount.roll");
}

void SensorReader::read_gimbal(const YamlNode& node, Mount& mount) const {
  check_keys(node, "sensor.gimbal", reader().file());
  if (const YamlNode* yaw = find(node, "yaw"); yaw && yaw->text != "any") {
    mount.yaw_deg = reader().angle(*yaw, "sensor.gimbal.yaw");
  }
  if (const YamlNode* pitch = find(node, "pitch")) {
    const auto [low, high] =
        two_angles(*pitch, "sensor.gimbal.pitch", "write the lowest and the highest pitch in degrees: [-90, 30]");
    mount.min_pitch_deg = low;
    mount.max_pitch_deg = high;
  }
  if (const YamlNode* roll = find(node, "roll")) mount.roll_deg = reader().angle(*roll, "sensor.gimbal.roll");
}

void SensorReader::keys(Keys /*keys*/, std::optional<PixelLimit>& pixel) {
  refuse_both("pixel", "dori", "keep one of them");
  const YamlNode* const dori = given("dori");
  if (!dori) return;
  const std::string text = reader().text(*dori, "sensor.dori");
  for (const auto& [name, pixels_per_metre] : kDori) {
    if (text != name) continue;
    pixel = {1 / pixels_per_metre, PixelLimit::Kind::perpendicular};
    return;
  }
  reader().fail(ErrorCode::unknown_choice, *dori, "sensor.dori is not a level of EN 62676-4: " + in_quotes(text),
                "write detection, observation, recognition or identification");
}

void SensorReader::keys(Keys /*keys*/, std::optional<SunLimit>& limit) {
  const YamlNode* const sun = given("sun");
  if (!sun) return;
  check_keys(*sun, "sensor.sun", reader().file());
  const char* const form = "write {time: 2026-06-21T16:00Z, exclude: 20}, or azimuth and elevation instead of the time";
  limit.emplace();
  limit->exclude_deg = reader().angle(require(*sun, "exclude", "sensor.sun", form), "sensor.sun.exclude");
  const YamlNode* const time = find(*sun, "time");
  if (!time) {
    limit->direction = sun_direction(*sun, form);
    return;
  }
  if (find(*sun, "azimuth") || find(*sun, "elevation")) {
    reader().fail(ErrorCode::conflicting_keys, *time, "sensor.sun has a time and a direction", "keep one of them");
  }
  const std::string text = reader().text(*time, "sensor.sun.time");
  result_.sun_time = parse_time(text);
  if (!result_.sun_time) {
    reader().fail(ErrorCode::value_syntax, *time, "sensor.sun.time is not a time with a zone: " + in_quotes(text),
                  "write it as 2026-06-21T16:00Z (UTC), or with its offset from UTC: 2026-06-21T18:00+02:00");
  }
  limit->direction = Vec3::UnitZ();  // until the scene is known
}

Vec3 SensorReader::sun_direction(const YamlNode& sun, const std::string& form) const {
  const double from_north = reader().angle(require(sun, "azimuth", "sensor.sun", form), "sensor.sun.azimuth");
  const YamlNode& elevation = require(sun, "elevation", "sensor.sun", form);
  const double up = reader().angle(elevation, "sensor.sun.elevation");
  if (!(up >= 0 && up <= 90)) {
    reader().fail(ErrorCode::value_out_of_range, elevation, "sensor.sun.elevation is not between 0 and 90 degrees",
                  "below the horizon the sun does not shine: leave the limit out");
  }
  const double a = from_north / kDegreesPerRadian, e = up / kDegreesPerRadian;
  return {portable::cos(e) * portable::sin(a), portable::cos(e) * portable::cos(a), portable::sin(e)};
}

void SensorReader::keys(Keys /*keys*/, std::optional<VisibleShare>& visible) {
  const YamlNode *const share = given("visible"), *const cells = given("cells");
  if (cells && !share) {
    reader().fail(ErrorCode::missing_key, *cells, "sensor.cells needs sensor.visible",
                  "say how much of the target must be seen, visible: 0.8, or leave 'cells' out");
  }
  if (!share) return;
  visible.emplace();
  visible->share = reader().number(*share, "sensor.visible");
  if (!(visible->share > 0 && visible->share <= 1)) {
    reader().fail(ErrorCode::value_out_of_range, *share, "sensor.visible is not between 0 and 1",
                  "write the part of the target's area that must be seen: 0.8");
  }
  if (!cells) return;
  const double count = reader().number(*cells, "sensor.cells");
  if (count != std::floor(count) || count < 1 || count > 1024) {
    reader().fail(ErrorCode::value_out_of_range, *cells, "sensor.cells is not a whole number from 1 to 1024",
                  "write for example 16, or 64 for a larger volume in more time");
  }
  visible->cells = static_cast<std::size_t>(count);
}

template <>
void SensorReader::instead<PilotSight>(const request::Key& key) {
  refuse_both("max_range", "vlos", "keep the range, or let it follow from the aircraft");
  map(key, result_.vlos);
  if (result_.vlos) result_.sensor.max_range_m = visual_range_m(result_.vlos->range);
}

SensorSection SensorReader::read() {
  check_keys(root(), "sensor", reader().file());
  describe(result_.sensor, *this);
  if (!given("max_range") && !result_.vlos && !result_.sensor.pixel) {
    reader().fail(ErrorCode::missing_key, root(), "sensor lacks the key 'max_range'",
                  "write 'max_range: 100': metres, to every point of the target");
  }
  core::with_place(place_in(reader().file(), root().place), [&] {
    check_sensor(result_.sensor);
    return 0;
  });
  return std::move(result_);
}

std::string pair_text(double a, double b) { return "[" + shortest(a) + ", " + shortest(b) + "]"; }

class SensorWriter : public SectionWriter {
 public:
  explicit SensorWriter(const MissionFile& mission) : mission_(mission) {}

  using SectionWriter::number;
  void number(const request::Key& key, double value, const request::Bounds& bounds, const request::Only& only) {
    const bool follows = key.path == "max_range" && mission_.vlos;
    if (!follows) SectionWriter::number(key, value, bounds, only);
  }
  template <typename Settings>
  void instead(const request::Key& key) {
    map(key, mission_.vlos);
  }
  void keys(Keys /*keys*/, const std::optional<Pinhole>& camera, const Mount& mount) {
    if (!camera) return;
    add_camera(*camera);
    add_mount(mount);
  }
  void keys(Keys /*keys*/, const std::optional<PixelLimit>& /*pixel*/) {}  // written as "pixel"
  void keys(Keys /*keys*/, const std::optional<SunLimit>& sun) {
    if (!sun) return;
    if (mission_.sun_time) {
      add("sun.time", mission_.sun_time->text);
    } else {
      const Vec3& to = sun->direction;
      add("sun.azimuth", shortest(std::atan2(to.x(), to.y()) * kDegreesPerRadian));
      add("sun.elevation", shortest(std::atan2(to.z(), to.head<2>().norm()) * kDegreesPerRadian));
    }
    add("sun.exclude", shortest(sun->exclude_deg));
  }
  void keys(Keys /*keys*/, const std::optional<VisibleShare>& visible) {
    if (!visible) return;
    add("visible", shortest(visible->share));
    add("cells", std::to_string(visible->cells));
  }

 private:
  void add_camera(const Pinhole& camera) {
    const CameraSource source =
        mission_.camera.value_or(CameraFov{camera.fov_deg(), camera.width_px, camera.height_px});
    if (const auto* model = std::get_if<CameraModel>(&source)) return add("camera.model", model->name);
    if (const auto* own = std::get_if<Camera>(&source)) {
      add_pixels(own->width_px, own->height_px);
      add("camera.focal_length", shortest(own->focal_length_mm));
      add("camera.sensor_width", shortest(own->sensor_width_mm));
      return;
    }
    const auto& [fov_deg, width_px, height_px] = std::get<CameraFov>(source);
    add("fov", pair_text(fov_deg[0], fov_deg[1]));
    if (width_px > 0 && height_px > 0) add_pixels(width_px, height_px);
  }

  void add_pixels(int width, int height) {
    add("camera.width", std::to_string(width));
    add("camera.height", std::to_string(height));
  }

  void add_mount(const Mount& mount) {
    const auto& [yaw_deg, min_pitch_deg, max_pitch_deg, roll_deg] = mount;
    if (mount == mount_without_words(mission_.camera)) return;
    const bool is_fixed = min_pitch_deg == max_pitch_deg;
    const std::string yaw = yaw_deg ? shortest(*yaw_deg) : "any", roll = shortest(roll_deg);
    add(is_fixed ? "mount.yaw" : "gimbal.yaw", yaw);
    add(is_fixed ? "mount.pitch" : "gimbal.pitch",
        is_fixed ? shortest(min_pitch_deg) : pair_text(min_pitch_deg, max_pitch_deg));
    add(is_fixed ? "mount.roll" : "gimbal.roll", roll);
  }

  const MissionFile& mission_;
};

}  // namespace

SensorSection parse_sensor_section(const YamlNode& node, const ValueReader& reader) {
  return SensorReader(node, reader).read();
}

std::string sensor_section_text(const MissionFile& mission) {
  SensorWriter writer(mission);
  describe(mission.sensor, writer);
  return writer.is_empty() ? "" : writer.text(request::kSection<Sensor>);  // of targets that are volumes
}

std::optional<SunTime> parse_time(const std::string& text) {
  static const std::regex form(
      R"((\d{4})-(\d\d)-(\d\d)[T ](\d\d):(\d\d)(?::(\d\d)(?:\.\d+)?)?(Z|([+-])(\d\d):?(\d\d)))");
  std::smatch found;
  if (!std::regex_match(text, found, form)) return std::nullopt;
  const auto number = [&](std::size_t group) { return found[group].matched ? std::stoi(found[group].str()) : 0; };
  const std::chrono::year_month_day date{std::chrono::year(number(1)),
                                         std::chrono::month(static_cast<unsigned>(number(2))),
                                         std::chrono::day(static_cast<unsigned>(number(3)))};
  if (!date.ok() || number(4) > 23 || number(5) > 59 || number(6) > 60 || number(10) > 59) return std::nullopt;
  const double days = std::chrono::sys_days{date}.time_since_epoch().count();
  const double zone = (found[8] == "-" ? -1 : 1) * (number(9) * 3600.0 + number(10) * 60);
  return SunTime{text, days * 86400 + number(4) * 3600 + number(5) * 60 + number(6) - zone};
}

}  // namespace vantage::internal::app

namespace vantage {

double unix_time_of(const std::string& text, const std::string& where) {
  if (const auto time = internal::app::parse_time(text)) return time->unix_time_s;
  throw Error(ErrorCode::value_syntax, "not a time with a zone: " + in_quotes(text), where,
              "write it as 2026-06-21T16:00Z (UTC), or with its offset from UTC: 2026-06-21T18:00+02:00");
}

}  // namespace vantage
