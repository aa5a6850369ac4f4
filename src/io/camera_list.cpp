// Lists of cameras: QGroundControl's CameraMetaData.json and OpenSfM's sensor_data.json. The two are told apart by
// their outermost value: an array, an object.
#include "io/camera_list.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>

#include "camera/camera_check.h"
#include "common/input.h"
#include "core/format.h"
#include "core/progress_reporter.h"
#include "core/read_limits.h"
#include "io/json_text.h"
#include "io/mesh_builder.h"
#include "io/mesh_source.h"
#include "vantage/camera.h"
#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kMostListBytes = 64'000'000;  // the lists that are known have 0.2 MB
constexpr std::size_t kMostValues = 2'000'000;         // of the JSON
constexpr const char* kListAdvice = "give QGroundControl's CameraMetaData.json or OpenSfM's sensor_data.json";

std::string bytes_of_list(const std::filesystem::path& file) {
  check_readable(file, "the list of cameras");
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size == 0) {
    throw Error(ErrorCode::file_empty, "the list of cameras is empty", file.string(), kListAdvice);
  }
  if (!error && size > kMostListBytes) {
    throw Error(ErrorCode::file_too_large,
                core::format("the list of cameras is too large: {} bytes, at most {}", size, kMostListBytes),
                file.string(), kListAdvice);
  }
  return read_file_bytes(file, {});
}

/// One member of an entry: nothing is taken over if it is not of the right type.
class CameraEntry {
 public:
  explicit CameraEntry(const json& entry) : entry_(entry) {}

  std::string text(const char* key) {
    const json* value = find(key);
    if (value == nullptr) return {};
    if (value->is_string()) return clean_name(value->get_ref<const std::string&>());
    note(core::format("\"{}\" is not a text", key));
    return {};
  }

  /// A length of something that has a size.
  double length(const char* key) {
    const json* value = find(key);
    if (value == nullptr) {
      note(core::format("\"{}\" is missing", key));
      return 0;
    }
    const double number = value->is_number() ? value->get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (number > 0 && std::isfinite(number)) return number;
    note(core::format("\"{}\" is not a number greater than 0", key));
    return 0;
  }

  int pixels(const char* key) {
    const double number = length(key);
    if (number <= std::numeric_limits<int>::max() && number == std::floor(number)) return static_cast<int>(number);
    note(core::format("\"{}\" is not a whole number of pixels", key));
    return 0;
  }

  /// The first thing that was wrong.
  const std::string& problem() const { return problem_; }

 private:
  const json* find(const char* key) const {
    const auto found = entry_.find(key);
    return found == entry_.end() ? nullptr : &*found;
  }
  void note(std::string problem) {
    if (problem_.empty()) problem_ = std::move(problem);
  }

  const json& entry_;
  std::string problem_;
};

ListedCamera checked_entry(Camera camera, std::string problem) {
  if (problem.empty()) {
    if (auto fault = camera::fault_of(camera)) problem = std::move(fault->problem);
  }
  return {std::move(camera), std::move(problem)};
}

ListedCamera qgroundcontrol_camera(const json& entry, const std::string& source) {
  Camera camera;
  camera.source = source;
  if (!entry.is_object()) return {camera, "it is not an object with the numbers of a camera"};
  CameraEntry reader(entry);
  camera.name = reader.text("canonicalName");
  camera.maker = reader.text("brand");
  camera.model = reader.text("model");
  camera.sensor_width_mm = reader.length("sensorWidth");
  camera.sensor_height_mm = reader.length("sensorHeight");
  camera.width_px = reader.pixels("imageWidth");
  camera.height_px = reader.pixels("imageHeight");
  camera.focal_length_mm = reader.length("focalLength");
  if (camera.name.empty() && reader.problem().empty()) return {camera, "\"canonicalName\" is missing"};
  return checked_entry(std::move(camera), reader.problem());
}

ListedCamera opensfm_camera(const std::string& name, const json& width, const std::string& source) {
  Camera camera;
  camera.source = source;
  camera.name = clean_name(name);
  if (camera.name.empty()) return {camera, "the name is empty"};
  const double mm = width.is_number() ? width.get<double>() : 0;
  if (!(mm > 0) || !std::isfinite(mm)) return {camera, "the width of the sensor is not a number greater than 0"};
  camera.sensor_width_mm = mm;
  return checked_entry(std::move(camera), {});
}

bool seems_a_camera(const json& entry) {
  return entry.is_object() && (entry.contains("canonicalName") || entry.contains("sensorWidth"));
}

/// Other JSON files have a number here and there too: more than half of the members must be widths.
bool seems_widths(const json& root) {
  const auto numbers = std::count_if(root.begin(), root.end(), [](const json& value) { return value.is_number(); });
  return 2 * static_cast<std::size_t>(numbers) > root.size();
}

json json_of_list(std::string_view text, const std::filesystem::path& file) {
  core::ReadLimits limits;
  limits.json_values = kMostValues;
  try {
    return parse_json(text, {}, limits);
  } catch (const JsonProblem& problem) {
    std::string where = file.string();
    if (problem.line > 0) where += core::format(", line {}, column {}", problem.line, problem.column);
    throw Error(ErrorCode::camera_list_syntax, "not a list of cameras: " + problem.text, where, kListAdvice);
  }
}

}  // namespace

std::vector<ListedCamera> parse_cameras(std::string_view text, const std::filesystem::path& file) {
  const json root = json_of_list(text, file);
  const std::string name = clean_name(file.filename().string());
  std::vector<ListedCamera> cameras;
  if (root.is_array() && std::any_of(root.begin(), root.end(), seems_a_camera)) {
    for (const json& entry : root) {
      cameras.push_back(qgroundcontrol_camera(entry, core::format("{}, entry {}", name, cameras.size() + 1)));
    }
    return cameras;
  }
  if (root.is_object() && seems_widths(root)) {
    for (const auto& [key, width] : root.items()) cameras.push_back(opensfm_camera(key, width, name));
    return cameras;
  }
  throw Error(ErrorCode::camera_list_syntax, "not a list of cameras: neither entries in an array nor names with widths",
              file.string(), kListAdvice);
}

}  // namespace vantage::internal::io

namespace vantage {

std::vector<ListedCamera> read_cameras(const std::filesystem::path& file) {
  return internal::io::parse_cameras(internal::io::bytes_of_list(file), file);
}

}  // namespace vantage
