#include "io/written_marks.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/png_mark.h"
#include "vantage/output.h"

namespace vantage::internal::io {
namespace {

constexpr std::size_t kLooked = 64 << 10;         // bytes of the beginning that are looked at
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

/// A report of a volume or of a scene, or what lies beside an STL.
bool is_own_json(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kMostJson) return false;
  const nlohmann::json json = nlohmann::json::parse(beginning_of(file, size), nullptr, false);
  if (!json.is_object()) return false;
  if (json.contains("vantage")) return json["vantage"].is_object() && json["vantage"].contains("georeference");
  return has_all(json, {"version", "method", "outcome", "causes", "bounding_box"}) ||
         has_all(json, {"source", "triangles", "objects", "bounds", "notes"});
}

bool is_own_ply(std::string_view bytes) {
  const std::string_view header = bytes.substr(0, bytes.find("\nend_header\n"));
  return header.starts_with("ply\n") && header.find("\ncomment vantage ") != std::string_view::npos;
}

}  // namespace

bool is_own_file(const std::filesystem::path& file) {
  const std::string extension = format_extension(file);
  if (extension == ".json") return is_own_json(file);
  const std::string bytes = beginning_of(file, kLooked);
  const std::string_view text = bytes;
  if (extension == ".csv") return text.substr(0, text.find_first_of("\r\n")) == kVolumeTableHeader;
  if (extension == ".ply") return is_own_ply(text);
  if (extension == ".obj") return text.starts_with("# vantage ");
  if (extension == ".stl") return text.starts_with("vantage ");
  if (extension == ".glb") {
    return text.starts_with("glTF") && text.find("\"generator\":\"vantage ") != std::string_view::npos;
  }
  return extension == ".png" && core::has_png_mark(text);
}

}  // namespace vantage::internal::io
