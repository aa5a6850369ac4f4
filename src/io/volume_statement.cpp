#include "io/volume_statement.h"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "io/json_text.h"
#include "io/sidecar.h"
#include "request/sensor_json.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::internal::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kVolumeMark = "vantage volume: ";
constexpr std::size_t kLine = 160;  // some readers of PLY take no more than a kilobyte

Json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Vec3 vector_of(const Json& json) {
  Vec3 v(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
  if (!v.allFinite() || json.size() != 3) throw std::invalid_argument("a point is not three numbers");
  return v;
}

double length_of(const Json& json) {
  const double value = json.get<double>();
  if (!(value >= 0) || !std::isfinite(value)) throw std::invalid_argument("a length is negative");
  return value;
}

/// All but the farthest distance, which stands by itself.
Json limits_json(const Sensor& sensor) {
  const auto number_as = [](auto value) { return Json(value); };
  request::SensorObject<Json, decltype(number_as)> object(number_as);
  describe(sensor, object);
  Json json = object.json();
  json.erase("max_range_m");
  return json;
}

/// Throws for one that no volume is computed for: what reads a statement need not look again.
void read_sensor(const Json& json, Sensor& sensor) {
  if (!json.is_object()) throw std::invalid_argument("the sensor is not an object");
  request::SensorReader<Json> reader(json);
  describe(sensor, reader);
  check_sensor(sensor);
}

Target target_of(const Json& json) {
  Target target;
  target.name = json.at("name").get<std::string>();
  target.parts.clear();
  for (const Json& part : json.at("parts")) {
    std::vector<Vec3>& vertices = target.parts.emplace_back();
    for (const Json& vertex : part) vertices.push_back(vector_of(vertex));
  }
  target.offset_m = json.at("offset_m").get<double>();
  target.front_by_order = json.value("front_by_order", false);
  if (json.contains("front")) target.front = vector_of(json.at("front"));
  return target;
}

Json target_json(const Target& target) {
  Json json = {{"name", target.name}, {"parts", Json::array()}, {"offset_m", target.offset_m}};
  for (const std::vector<Vec3>& part : target.parts) {
    Json vertices = Json::array();
    for (const Vec3& vertex : part) vertices.push_back(json_of(vertex));
    json["parts"].push_back(std::move(vertices));
  }
  if (target.front) json["front"] = json_of(*target.front);
  if (target.front_by_order) json["front_by_order"] = true;
  return json;
}

VolumeStatement parse(const Json& json) {
  VolumeStatement statement;
  VolumeProvenance& made = statement.provenance;
  made.version = json.at("version").get<std::string>();
  made.method = json.at("method").get<std::string>();
  std::size_t parts = 0;
  if (json.contains("views")) {
    made.target.parts.clear();
    for (const Json& list : json.at("views")) {
      std::vector<Target>& view = made.views.emplace_back();
      for (const Json& target : list) {
        view.push_back(target_of(target));
        parts += view.back().parts.size();
      }
      if (view.empty()) throw std::invalid_argument("a list of targets is empty");
    }
    if (made.views.empty()) throw std::invalid_argument("there are no targets");
  } else {
    made.target = target_of(json.at("target"));
    parts = made.target.parts.size();
  }
  if (json.contains("max_range_m")) made.sensor.max_range_m = length_of(json.at("max_range_m"));
  if (json.contains("sensor")) read_sensor(json.at("sensor"), made.sensor);
  if (!std::isfinite(range_limit_m(made.sensor))) throw std::invalid_argument("nothing limits the range");
  statement.tolerance_m = length_of(json.at("tolerance_m"));
  for (const Json& lift : json.at("lift_m")) statement.lift_m.push_back(length_of(lift));
  if (statement.lift_m.size() != parts) throw std::invalid_argument("not one lift for each part");
  made.scene_hash = json.value("scene_hash", "");
  made.mission_hash = json.value("mission_hash", "");
  statement.volume_hash = json.at("volume_hash").get<std::string>();
  return statement;
}

/// The text of the comments that hold a statement; `start` begins each line.
std::string joined_comments(std::string_view text, std::string_view start) {
  const std::string mark = std::string(start).append(kVolumeMark);
  std::string joined;
  for (std::size_t at = text.find(mark); at != std::string_view::npos; at = text.find(mark, at)) {
    at += mark.size();
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    joined += text.substr(at, end - at);
  }
  return joined;
}

/// The comments at the head of an OBJ, the header of a PLY, the JSON of a GLB.
std::string statement_text(const MeshSource& source, const core::ProgressReporter& progress) {
  const std::string_view bytes = source.bytes();
  if (bytes.starts_with("ply")) return joined_comments(bytes.substr(0, bytes.find("end_header")), "comment ");
  if (bytes.starts_with("# vantage ")) return joined_comments(bytes.substr(0, bytes.find("\nv ")), "# ");
  Json json;
  if (bytes.starts_with("glTF")) {
    constexpr std::size_t kJsonAt = 20, kLengthAt = 12;
    std::uint32_t length = 0;
    if (bytes.size() < kJsonAt) return {};
    std::memcpy(&length, bytes.data() + kLengthAt, sizeof length);
    json = Json::parse(bytes.substr(kJsonAt, length), nullptr, false);
    if (!json.is_object() || !json.contains("asset") || !json["asset"].is_object()) return {};
    json = json["asset"].value("extras", Json::object());
  } else {
    std::error_code ignored;
    const std::filesystem::path beside = sidecar_file(source.file());
    if (!std::filesystem::exists(beside, ignored)) return {};
    json = Json::parse(read_file_bytes(beside, progress), nullptr, false);
  }
  if (!json.is_object() || !json.contains("vantage") || !json["vantage"].is_object()) return {};
  return json["vantage"].contains("volume") ? json["vantage"]["volume"].dump() : std::string();
}

}  // namespace

std::optional<Json> statement_json(const Volume& volume, const Mesh& stored) {
  if (!volume.provenance) return std::nullopt;
  const VolumeProvenance& made = *volume.provenance;
  Json json = {{"version", made.version}, {"method", made.method}};
  if (made.views.empty()) {
    json["target"] = target_json(made.target);
  } else {
    json["views"] = Json::array();
    for (const std::vector<Target>& list : made.views) {
      Json& view = json["views"].emplace_back(Json::array());
      for (const Target& target : list) view.push_back(target_json(target));
    }
  }
  if (std::isfinite(made.sensor.max_range_m)) json["max_range_m"] = made.sensor.max_range_m;
  if (Json sensor = limits_json(made.sensor); !sensor.empty()) json["sensor"] = std::move(sensor);
  json["tolerance_m"] = volume.tolerance_m;
  json["lift_m"] = volume.lift_m;
  if (!made.scene_hash.empty()) json["scene_hash"] = made.scene_hash;
  if (!made.mission_hash.empty()) json["mission_hash"] = made.mission_hash;
  json["volume_hash"] = volume_hash(stored);
  return json;
}

std::string statement_comments(const Volume& volume, const Mesh& stored, const char* start) {
  const auto json = statement_json(volume, stored);
  if (!json) return {};
  const std::string text = json->dump(-1, ' ', true, Json::error_handler_t::replace);
  std::string lines;
  for (std::size_t at = 0; at < text.size();) {
    // No line ends with a blank, which some programs take away.
    std::size_t length = std::min(kLine, text.size() - at);
    while (length > 1 && at + length < text.size() && text[at + length - 1] == ' ') --length;
    lines.append(start).append(kVolumeMark).append(text, at, length).append("\n");
    at += length;
  }
  return lines;
}

std::optional<VolumeStatement> read_statement(const MeshSource& source, const core::ProgressReporter& progress) {
  const std::string text = statement_text(source, progress);
  if (text.empty()) return std::nullopt;
  const auto refuse = [&](const std::string& problem) {
    throw Error(ErrorCode::record_garbled, "what vantage wrote about the volume is garbled: " + problem,
                source.file().string(), "write the volume again with \"vantage compute\"");
  };
  try {
    return parse(Json::parse(text));
  } catch (const Json::exception& error) {
    refuse(words_of(error));
  } catch (const std::exception& problem) {
    refuse(problem.what());
  }
  return std::nullopt;
}

}  // namespace vantage::internal::io
