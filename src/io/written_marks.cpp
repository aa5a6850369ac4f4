#include "io/written_marks.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "common/output.h"
#include "core/png_mark.h"
#include "core/version_text.h"
#include "io/output_formats.h"
#include "io/zip.h"

namespace vantage::internal::io {
namespace {

constexpr std::size_t kLooked = 64 << 10;  // bytes of the beginning that are looked at
constexpr std::string_view kPlyStart = "ply\nformat binary_little_endian 1.0\ncomment vantage ";
constexpr std::uintmax_t kMostJson = 64'000'000;  // bytes; a report of a large city has some

std::string beginning_of(const std::filesystem::path& file, std::size_t most) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(most, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(most));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return bytes;
}

bool has_all(const nlohmann::json& object, std::initializer_list<const char*> keys) {
  return std::all_of(keys.begin(), keys.end(), [&](const char* key) { return object.contains(key); });
}

bool has_version(const nlohmann::json& object) {
  return object["version"].is_string() && core::is_version(object["version"].get<std::string>());
}

/// A report of a volume or of a scene, the story of stages, or what lies beside an STL.
bool is_own_json(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kMostJson) return false;
  const nlohmann::json json = nlohmann::json::parse(beginning_of(file, size), nullptr, false);
  if (!json.is_object()) return false;
  if (json.contains("vantage")) return json["vantage"].is_object() && json["vantage"].contains("georeference");
  if (has_all(json, {"version", "method", "outcome", "causes", "bounding_box"})) return has_version(json);
  if (has_all(json, {"version", "mission", "outcome", "run", "stages"})) return has_version(json);
  return has_all(json, {"source", "triangles", "objects", "bounds", "notes"});
}

/// "scene", or "visibility volume", a colon and an outcome, of this version or of another.
bool is_content(std::string_view text) {
  constexpr std::string_view kVolume = "visibility volume: ";
  if (text == "scene") return true;
  if (!text.starts_with(kVolume) || text.size() == kVolume.size()) return false;
  return text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", kVolume.size()) == std::string_view::npos;
}

/// A region beside the certificate of a tour.
bool is_own_region(std::string_view text) {
  constexpr std::string_view kStart = "ply\nformat binary_little_endian 1.0\ncomment vantage region: ";
  if (!text.starts_with(kStart)) return false;
  text = text.substr(kStart.size());
  return text.starts_with("outer\nelement vertex ") || text.starts_with("given\nelement vertex ");
}

/// The format and its number, and nothing else in that text.
bool is_own_certificate(std::string_view text) {
  for (const std::string_view start : {kCertificateStart, kTourCertificateStart}) {
    if (!text.starts_with(start)) continue;
    const std::size_t end = text.find_first_not_of("0123456789", start.size());
    return end != start.size() && end != std::string_view::npos && text.substr(end).starts_with("\",");
  }
  return false;
}

/// What is behind `start` and a version, to the end of the line; nothing where the text does not begin so. People write
/// "# vantage point" and the like: with the version it is the writers' line.
std::string_view behind_version(std::string_view text, std::string_view start) {
  if (!text.starts_with(start)) return {};
  text = text.substr(start.size(), text.substr(start.size()).find('\n'));
  const std::size_t space = text.find(' ');
  return space != std::string_view::npos && core::is_version(text.substr(0, space)) ? text.substr(space + 1)
                                                                                    : std::string_view();
}

}  // namespace

bool begins_as_own(std::string_view bytes, std::string_view start) { return is_content(behind_version(bytes, start)); }

bool is_own_ply(std::string_view bytes) { return begins_as_own(bytes, kPlyStart) || is_own_region(bytes); }

bool is_own_obj(std::string_view bytes) { return begins_as_own(bytes, "# vantage "); }

/// All 80 bytes of the header.
bool is_own_stl(std::string_view bytes) {
  constexpr std::size_t kHeaderBytes = 80;
  if (bytes.size() < kHeaderBytes) return false;
  const std::string_view text = behind_version(bytes.substr(0, kHeaderBytes), "vantage ");
  const std::string_view content = text.substr(0, text.find_last_not_of(' ') + 1);
  return content == "visibility volume, scene frame, metres, z up" || content == "scene, scene frame, metres, z up";
}

/// The JSON begins with what made it.
bool is_own_glb(std::string_view bytes) {
  constexpr std::string_view kGlbMagic = "glTF", kJsonType = "JSON";
  constexpr std::string_view kGenerator = R"({"asset":{"version":"2.0","generator":"vantage )";
  constexpr std::size_t kTypeAt = 16, kJsonAt = 20;
  if (!bytes.starts_with(kGlbMagic) || bytes.size() < kJsonAt || bytes.substr(kTypeAt, kJsonType.size()) != kJsonType)
    return false;
  const std::string_view json = bytes.substr(kJsonAt);
  if (!json.starts_with(kGenerator)) return false;
  const std::string_view version = json.substr(kGenerator.size());
  const std::size_t end = version.find('"');
  return end != std::string_view::npos && core::is_version(version.substr(0, end));
}

bool is_own_kml(std::string_view bytes) { return begins_as_own(bytes, kKmlStart); }

bool is_own_kmz(std::string_view bytes) {
  constexpr std::size_t kOfFirstLines = 1024;
  return is_own_kml(first_file_begins(bytes, kOfFirstLines));
}

bool is_own_file(const std::filesystem::path& file) {
  const std::string extension = format_extension(file);
  const std::string bytes = beginning_of(file, kLooked);
  const std::string_view text = bytes;
  if (is_own_certificate(text)) return true;
  if (extension == ".json") return is_own_json(file);
  if (extension == ".csv") return text.substr(0, text.find_first_of("\r\n")) == kVolumeTableHeader;
  if (const OutputFormat* format = find_output_format(file)) return format->is_own(text);
  return extension == ".png" && core::has_png_mark(text);
}

}  // namespace vantage::internal::io
