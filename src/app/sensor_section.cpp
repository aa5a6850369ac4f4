#include "app/sensor_section.h"

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <regex>
#include <utility>

#include "app/described_section.h"
#include "app/schema.h"
#include "common/input.h"
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

class SensorParser {
 public:
  SensorParser(const YamlNode& node, const ValueReader& reader) : node_(node), reader_(reader) {}

  SensorSection parse();

 private:
  void parse_camera(const YamlNode* camera, const YamlNode* fov);
  Camera parse_numbers(const YamlNode& camera, bool has_fov) const;
  void parse_mount(const YamlNode& mount);
  void parse_gimbal(const YamlNode& gimbal);
  void parse_roll(const YamlNode& map, const std::string& what);
  void parse_dori(const YamlNode& dori);
  void parse_sun(const YamlNode& sun);
  void parse_share();
  const YamlNode& require(const YamlNode& map, const char* key, const std::string& what, const std::string& fix) const;
  std::array<double, 2> two_angles(const YamlNode& node, const std::string& what, const std::string& form) const;
  void refuse_both(const char* one, const char* other, const std::string& fix) const;

  const YamlNode& node_;
  const ValueReader& reader_;
  SensorSection result_;
};

const YamlNode& SensorParser::require(const YamlNode& map, const char* key, const std::string& what,
                                      const std::string& fix) const {
  if (const YamlNode* found = find(map, key)) return *found;
  reader_.fail(ErrorCode::missing_key, map, what + " lacks the key '" + key + "'", fix);
}

std::array<double, 2> SensorParser::two_angles(const YamlNode& node, const std::string& what,
                                               const std::string& form) const {
  if (reader_.list(node, what, form).size() != 2) {
    reader_.fail(ErrorCode::wrong_type, node, what + " must be two numbers, not " + describe(node), form);
  }
  return {reader_.angle(node.items[0], what + "[0]"), reader_.angle(node.items[1], what + "[1]")};
}

void SensorParser::refuse_both(const char* one, const char* other, const std::string& fix) const {
  const YamlNode* second = find(node_, other);
  if (!find(node_, one) || !second) return;
  reader_.fail(ErrorCode::conflicting_keys, *second,
               std::string("sensor.") + one + " and sensor." + other + " say the same thing", fix);
}

Camera SensorParser::parse_numbers(const YamlNode& camera, bool has_fov) const {
  const char* const form =
      "write {width: 8000, height: 6000, focal_length: 24.5, sensor_width: 35.9}: pixels and millimetres";
  const auto pixels = [&](const char* key) {
    const YamlNode& node = require(camera, key, "sensor.camera", form);
    const double value = reader_.number(node, std::string("sensor.camera.") + key);
    if (value != std::floor(value) || value < 1 || value > 1e6) {
      reader_.fail(ErrorCode::value_out_of_range, node,
                   std::string("sensor.camera.") + key + " is not a number of pixels", "write a whole number");
    }
    return static_cast<int>(value);
  };
  const auto millimetres = [&](const char* key) {
    return reader_.positive(require(camera, key, "sensor.camera", form), std::string("sensor.camera.") + key);
  };
  Camera numbers;
  numbers.width_px = pixels("width");
  numbers.height_px = pixels("height");
  if (has_fov) {
    for (const char* const key : {"focal_length", "sensor_width"}) {
      if (const YamlNode* given = find(camera, key)) {
        reader_.fail(ErrorCode::conflicting_keys, *given,
                     std::string("sensor.fov and sensor.camera.") + key + " both say how wide the picture is",
                     "keep one of them");
      }
    }
    return numbers;
  }
  numbers.focal_length_mm = millimetres("focal_length");
  numbers.sensor_width_mm = millimetres("sensor_width");
  return numbers;
}

void SensorParser::parse_camera(const YamlNode* camera, const YamlNode* fov) {
  CameraSource source;
  if (fov) {
    source.fov_deg = two_angles(*fov, "sensor.fov", "write the horizontal and the vertical angle in degrees: [60, 40]");
  }
  if (camera) {
    check_keys(*camera, Section::camera, reader_.file());
    if (const YamlNode* model = find(*camera, "model")) {
      for (const YamlEntry& entry : camera->entries) {
        if (entry.key == "model") continue;
        reader_.fail(ErrorCode::conflicting_keys, entry.value,
                     "sensor.camera.model and sensor.camera." + entry.key + " both describe the camera",
                     "keep the model, or the numbers");
      }
      if (fov) {
        reader_.fail(ErrorCode::conflicting_keys, *fov,
                     "sensor.fov and sensor.camera.model both say how wide the picture is", "keep one of them");
      }
      source.model = reader_.text(*model, "sensor.camera.model");
    } else {
      source.numbers = parse_numbers(*camera, fov != nullptr);
    }
  }
  const YamlNode& place = camera ? *camera : *fov;
  result_.sensor.camera = core::with_place(place_in(reader_.file(), place.place), [&] {
    if (!source.model.empty()) return pinhole_of(find_camera(source.model));
    if (!source.fov_deg) return pinhole_of(*source.numbers);
    const Camera& numbers = source.numbers.value_or(Camera{});
    return pinhole_of_fov((*source.fov_deg)[0], (*source.fov_deg)[1], numbers.width_px, numbers.height_px);
  });
  result_.camera = std::move(source);
}

void SensorParser::parse_roll(const YamlNode& map, const std::string& what) {
  if (const YamlNode* roll = find(map, "roll")) result_.sensor.mount.roll_deg = reader_.angle(*roll, what + ".roll");
}

void SensorParser::parse_mount(const YamlNode& mount) {
  if (mount.kind == YamlNode::Kind::scalar) {
    if (reader_.text(mount, "sensor.mount") == "gimbal") return;
    reader_.fail(ErrorCode::unknown_choice, mount, "sensor.mount is neither 'gimbal' nor a mapping of angles",
                 "write 'mount: gimbal', or {yaw: any, pitch: -90}");
  }
  check_keys(mount, Section::mount, reader_.file());
  const char* const form =
      "write {yaw: any, pitch: -90, roll: 0}: degrees; yaw is clockwise from north, pitch -90 straight down";
  const YamlNode& yaw = require(mount, "yaw", "sensor.mount", form);
  if (yaw.kind != YamlNode::Kind::scalar || yaw.text != "any") {
    result_.sensor.mount.yaw_deg = reader_.angle(yaw, "sensor.mount.yaw");
  }
  const double pitch = reader_.angle(require(mount, "pitch", "sensor.mount", form), "sensor.mount.pitch");
  result_.sensor.mount.min_pitch_deg = result_.sensor.mount.max_pitch_deg = pitch;
  parse_roll(mount, "sensor.mount");
}

void SensorParser::parse_gimbal(const YamlNode& gimbal) {
  check_keys(gimbal, Section::gimbal, reader_.file());
  Mount& mount = result_.sensor.mount;
  if (const YamlNode* yaw = find(gimbal, "yaw"); yaw && yaw->text != "any") {
    mount.yaw_deg = reader_.angle(*yaw, "sensor.gimbal.yaw");
  }
  if (const YamlNode* pitch = find(gimbal, "pitch")) {
    const auto [low, high] =
        two_angles(*pitch, "sensor.gimbal.pitch", "write the lowest and the highest pitch in degrees: [-90, 30]");
    mount.min_pitch_deg = low;
    mount.max_pitch_deg = high;
  }
  parse_roll(gimbal, "sensor.gimbal");
}

void SensorParser::parse_dori(const YamlNode& dori) {
  const std::string text = reader_.text(dori, "sensor.dori");
  for (const auto& [name, pixels_per_metre] : kDori) {
    if (text != name) continue;
    result_.sensor.pixel = {1 / pixels_per_metre, PixelLimit::Kind::perpendicular};
    return;
  }
  reader_.fail(ErrorCode::unknown_choice, dori, "sensor.dori is not a level of EN 62676-4: " + in_quotes(text),
               "write detection, observation, recognition or identification");
}

void SensorParser::parse_sun(const YamlNode& sun) {
  check_keys(sun, Section::sun, reader_.file());
  const char* const form = "write {time: 2026-06-21T16:00Z, exclude: 20}, or azimuth and elevation instead of the time";
  SunLimit limit;
  limit.exclude_deg = reader_.angle(require(sun, "exclude", "sensor.sun", form), "sensor.sun.exclude");
  const YamlNode* time = find(sun, "time");
  const YamlNode* azimuth = find(sun, "azimuth");
  if (time && (azimuth || find(sun, "elevation"))) {
    reader_.fail(ErrorCode::conflicting_keys, *time, "sensor.sun has a time and a direction", "keep one of them");
  }
  if (time) {
    const std::string text = reader_.text(*time, "sensor.sun.time");
    result_.sun_time = parse_time(text);
    if (!result_.sun_time) {
      reader_.fail(ErrorCode::value_syntax, *time, "sensor.sun.time is not a time with a zone: " + in_quotes(text),
                   "write it as 2026-06-21T16:00Z (UTC), or with its offset from UTC: 2026-06-21T18:00+02:00");
    }
    limit.direction = Vec3::UnitZ();  // until the scene is known
  } else {
    const double from_north = reader_.angle(require(sun, "azimuth", "sensor.sun", form), "sensor.sun.azimuth");
    const YamlNode& elevation = require(sun, "elevation", "sensor.sun", form);
    const double up = reader_.angle(elevation, "sensor.sun.elevation");
    if (!(up >= 0 && up <= 90)) {
      reader_.fail(ErrorCode::value_out_of_range, elevation, "sensor.sun.elevation is not between 0 and 90 degrees",
                   "below the horizon the sun does not shine: leave the limit out");
    }
    const double a = from_north / kDegreesPerRadian, e = up / kDegreesPerRadian;
    limit.direction = {portable::cos(e) * portable::sin(a), portable::cos(e) * portable::cos(a), portable::sin(e)};
  }
  result_.sensor.sun = limit;
}

void SensorParser::parse_share() {
  const YamlNode* const share = find(node_, "visible");
  const YamlNode* const cells = find(node_, "cells");
  if (cells && !share) {
    reader_.fail(ErrorCode::missing_key, *cells, "sensor.cells needs sensor.visible",
                 "say how much of the target must be seen, visible: 0.8, or leave 'cells' out");
  }
  if (!share) return;
  VisibleShare visible;
  visible.share = reader_.number(*share, "sensor.visible");
  if (!(visible.share > 0 && visible.share <= 1)) {
    reader_.fail(ErrorCode::value_out_of_range, *share, "sensor.visible is not between 0 and 1",
                 "write the part of the target's area that must be seen: 0.8");
  }
  if (cells) {
    const double count = reader_.number(*cells, "sensor.cells");
    if (count != std::floor(count) || count < 1 || count > 1024) {
      reader_.fail(ErrorCode::value_out_of_range, *cells, "sensor.cells is not a whole number from 1 to 1024",
                   "write for example 16, or 64 for a larger volume in more time");
    }
    visible.cells = static_cast<std::size_t>(count);
  }
  result_.sensor.visible = visible;
}

SensorSection SensorParser::parse() {
  check_keys(node_, Section::sensor, reader_.file());
  Sensor& sensor = result_.sensor;
  if (const YamlNode* range = find(node_, "max_range"))
    sensor.max_range_m = reader_.positive_length(*range, "sensor.max_range");
  refuse_both("max_range", "vlos", "keep the range, or let it follow from the aircraft");
  if (const YamlNode* vlos = find(node_, "vlos")) {
    read_section(*vlos, reader_, result_.vlos.emplace());
    sensor.max_range_m = visual_range_m(result_.vlos->range);
  }
  if (const YamlNode* range = find(node_, "min_range"))
    sensor.min_range_m = reader_.positive_length(*range, "sensor.min_range");
  if (const YamlNode* angle = find(node_, "incidence")) {
    sensor.incidence_deg = reader_.angle(*angle, "sensor.incidence");
  }
  const YamlNode* camera = find(node_, "camera");
  const YamlNode* fov = find(node_, "fov");
  if (camera || fov) parse_camera(camera, fov);
  refuse_both("mount", "gimbal", "keep the gimbal, or a mount of fixed angles");
  refuse_both("pixel", "dori", "keep one of them");
  for (const char* const key : {"mount", "gimbal", "pixel", "dori"}) {
    const YamlNode* given = find(node_, key);
    if (!given || sensor.camera) continue;
    reader_.fail(
        ErrorCode::missing_key, *given, std::string("sensor.") + key + " needs a camera",
        "name one, camera: {model: sony_a7r_iv_35mm}, or give its numbers; `vantage cameras` lists those known");
  }
  if (const YamlNode* mount = find(node_, "mount")) parse_mount(*mount);
  if (const YamlNode* gimbal = find(node_, "gimbal")) parse_gimbal(*gimbal);
  if (const YamlNode* pixel = find(node_, "pixel")) read_section(*pixel, reader_, sensor.pixel.emplace());
  if (const YamlNode* dori = find(node_, "dori")) parse_dori(*dori);
  if (const YamlNode* sun = find(node_, "sun")) parse_sun(*sun);
  if (const YamlNode* link = find(node_, "link")) {
    read_section(*link, reader_, sensor.link.emplace());
  }
  parse_share();
  if (!find(node_, "max_range") && !result_.vlos && !sensor.pixel) {
    reader_.fail(ErrorCode::missing_key, node_, "sensor lacks the key 'max_range'",
                 "write 'max_range: 100': metres, to every point of the target");
  }
  core::with_place(place_in(reader_.file(), node_.place), [&] {
    check_sensor(sensor);
    return 0;
  });
  return std::move(result_);
}

std::string pair_text(double a, double b) { return "[" + shortest(a) + ", " + shortest(b) + "]"; }

std::string camera_text(const MissionFile& mission) {
  const auto fov = [](double horizontal, double vertical) {
    return "  fov: " + pair_text(horizontal, vertical) + "\n";
  };
  const auto pixels = [](int width, int height) {
    return "width: " + std::to_string(width) + ", height: " + std::to_string(height);
  };
  if (!mission.camera) {
    const Pinhole& camera = *mission.sensor.camera;
    const auto [horizontal, vertical] = camera.fov_deg();
    const bool has_pixels = camera.width_px > 0 && camera.height_px > 0;
    return fov(horizontal, vertical) +
           (has_pixels ? "  camera: {" + pixels(camera.width_px, camera.height_px) + "}\n" : "");
  }
  const CameraSource& source = *mission.camera;
  if (!source.model.empty()) return "  camera: {model: " + source.model + "}\n";
  std::string text;
  if (source.fov_deg) text += fov((*source.fov_deg)[0], (*source.fov_deg)[1]);
  if (!source.numbers) return text;
  const Camera& numbers = *source.numbers;
  text += "  camera: {" + pixels(numbers.width_px, numbers.height_px);
  if (!source.fov_deg) {
    text +=
        ", focal_length: " + shortest(numbers.focal_length_mm) + ", sensor_width: " + shortest(numbers.sensor_width_mm);
  }
  return text + "}\n";
}

std::string mount_text(const Mount& mount) {
  if (!mount.yaw_deg && mount.min_pitch_deg == -90 && mount.max_pitch_deg == 90 && mount.roll_deg == 0) return {};
  const std::string yaw = mount.yaw_deg ? shortest(*mount.yaw_deg) : "any";
  const bool is_fixed = mount.min_pitch_deg == mount.max_pitch_deg;
  return std::string(is_fixed ? "  mount" : "  gimbal") + ": {yaw: " + yaw + ", pitch: " +
         (is_fixed ? shortest(mount.min_pitch_deg) : pair_text(mount.min_pitch_deg, mount.max_pitch_deg)) +
         ", roll: " + shortest(mount.roll_deg) + "}\n";
}

std::string sun_text(const MissionFile& mission) {
  const SunLimit& sun = *mission.sensor.sun;
  std::string direction;
  if (mission.sun_time) {
    direction = "time: " + mission.sun_time->text;
  } else {
    const Vec3& to = sun.direction;
    direction = "azimuth: " + shortest(std::atan2(to.x(), to.y()) * kDegreesPerRadian) +
                ", elevation: " + shortest(std::atan2(to.z(), to.head<2>().norm()) * kDegreesPerRadian);
  }
  return "  sun: {" + direction + ", exclude: " + shortest(sun.exclude_deg) + "}\n";
}

}  // namespace

SensorSection parse_sensor_section(const YamlNode& node, const ValueReader& reader) {
  return SensorParser(node, reader).parse();
}

// All members are named: a limit that is added does not compile here before it is written.
std::string sensor_section_text(const MissionFile& mission) {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = mission.sensor;
  std::string text = "sensor:\n";
  if (mission.vlos) {
    text += "  vlos: " + flow_text(*mission.vlos) + "\n";
  } else if (std::isfinite(max_range_m)) {
    text += "  max_range: " + shortest(max_range_m) + "\n";
  }
  if (min_range_m > 0) text += "  min_range: " + shortest(min_range_m) + "\n";
  if (incidence_deg) text += "  incidence: " + shortest(*incidence_deg) + "\n";
  if (camera) text += camera_text(mission) + mount_text(mount);
  if (pixel) text += "  pixel: " + flow_text(*pixel) + "\n";
  if (sun) text += sun_text(mission);
  if (link) text += "  link: " + flow_text(*link) + "\n";
  if (visible) {
    text += "  visible: " + shortest(visible->share) + "\n  cells: " + std::to_string(visible->cells) + "\n";
  }
  if (text.ends_with("sensor:\n")) return "";  // of targets that are volumes
  return text;
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
