#include "app/certified_ply.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

std::optional<std::uint64_t> size_of(const std::string& type) {
  constexpr std::array<std::pair<std::string_view, std::uint64_t>, 5> kSizes = {
      {{"uchar", 1}, {"int", 4}, {"uint", 4}, {"float", 4}, {"double", 8}}};
  for (const auto& [name, size] : kSizes) {
    if (type == name) return size;
  }
  return std::nullopt;
}

/// One of the two elements: how many rows, and the bytes of each. A face is a list of three, and then numbers.
struct Rows {
  std::uint64_t count = 0, size = 0;
  std::set<std::string> properties;

  bool add_property(std::istringstream& words, bool is_face) {
    constexpr std::uint64_t kCorners = 3;
    std::string type, length, name;
    words >> type;
    const bool is_list = type == "list";
    if (is_list != (is_face && properties.empty())) return false;
    if (is_list) words >> length >> type;
    words >> name;
    const auto bytes = size_of(type), of_length = is_list ? size_of(length) : 0;
    if (!words || !bytes || !of_length || (is_list && name != "vertex_indices")) return false;
    size += is_list ? *of_length + kCorners * *bytes : *bytes;
    return properties.insert(name).second;
  }
};

bool is_as_written(std::istream& in, std::uint64_t file_size) {
  std::array<Rows, 2> rows;  // of vertices and of faces
  std::size_t elements = 0;
  std::string line, word, name;
  for (const char* first : {"ply", "format binary_little_endian 1.0"}) {
    if (!std::getline(in, line) || line != first) return false;
  }
  while (std::getline(in, line) && line != "end_header") {
    std::istringstream words(line);
    words >> word;
    if (word == "element") {
      if (elements == rows.size()) return false;
      words >> name >> rows[elements].count;
      if (!words || name != (elements == 0 ? "vertex" : "face")) return false;
      ++elements;
    } else if (word == "property") {
      if (elements == 0 || !rows[elements - 1].add_property(words, elements == 2)) return false;
    }
  }
  if (!in || elements != rows.size()) return false;
  // With other faces than triangles it is longer.
  const auto header = static_cast<std::uint64_t>(in.tellg());
  return file_size == header + rows[0].count * rows[0].size + rows[1].count * rows[1].size;
}

}  // namespace

void check_certified_ply(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code ignored;
  if (in && is_as_written(in, std::filesystem::file_size(file, ignored))) return;
  throw Error(ErrorCode::not_applicable, "a certificate is about a binary, little-endian PLY of triangles alone",
              file.string(),
              "write it anew: \"vantage simplify\" with --facets 1000000000 leaves the mesh as it is, also in a .ply");
}

}  // namespace vantage::internal::app
