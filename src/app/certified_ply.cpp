#include "app/certified_ply.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "common/input.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

bool starts_with_word(std::string_view line, std::string_view word, std::string_view& rest) {
  if (!line.starts_with(word) || line.size() <= word.size() || line[word.size()] != ' ') return false;
  rest = line.substr(word.size() + 1);
  return true;
}

bool is_one_word(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

std::size_t count_of(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Whether all programs read this line alike.
bool is_plain_comment(std::string_view comment) {
  const auto is_ascii = [](char c) { return c >= ' ' && c <= '~'; };
  const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; };
  if (std::any_of(comment.begin(), comment.end(), is_control)) return false;
  for (const char* line_end : {"\xc2\x85", "\xe2\x80\xa8", "\xe2\x80\xa9", "end_header"}) {
    if (comment.find(line_end) != std::string_view::npos) return false;
  }
  for (const char* mark : {"vantage volume: ", "vantage rounding_m ", "vantage georeference:"}) {
    if (count_of(comment, mark) != (comment.starts_with(mark) ? 1U : 0U)) return false;
  }
  return comment.starts_with("vantage cause ") || std::all_of(comment.begin(), comment.end(), is_ascii);
}

/// One of the two elements: how many rows, and the bytes of each. A face is a list of three, and then numbers.
class Rows {
 public:
  bool begin(std::string_view line, std::string_view element) {
    std::string_view name, count;
    if (!starts_with_word(line, "element", name) || !starts_with_word(name, element, count)) return false;
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), count_);
    return error == std::errc() && std::to_string(count_) == count;
  }

  bool add_property(std::string_view line) {
    std::string_view words;
    if (!starts_with_word(line, "property", words)) return false;
    for (const auto& [type, bytes] : kSizes) {
      std::string_view name;
      if (!starts_with_word(words, type, name)) continue;
      size_ += bytes;
      const bool is_fraction = type == "float" || type == "double";
      if ((name == "x" || name == "y" || name == "z") && !is_fraction) return false;
      if (name == "object" && type != "int" && type != "uint") return false;
      return is_one_word(name) && names_.insert(std::string(name)).second;
    }
    return false;
  }

  bool add_corners(std::string_view line) {
    constexpr std::uint64_t kBytes = 1 + 3 * 4;
    if (line != "property list uchar int vertex_indices" && line != "property list uchar uint vertex_indices") {
      return false;
    }
    size_ += kBytes;
    return names_.insert("vertex_indices").second;
  }

  bool has(const char* name) const { return names_.count(name) > 0; }
  std::uint64_t bytes() const { return count_ * size_; }

 private:
  static constexpr std::array<std::pair<std::string_view, std::uint64_t>, 5> kSizes = {
      {{"uchar", 1}, {"int", 4}, {"uint", 4}, {"float", 4}, {"double", 8}}};

  std::uint64_t count_ = 0, size_ = 0;
  std::set<std::string> names_;
};

/// The grammar is HEADER of the checker.
bool is_as_written(std::istream& in, std::uint64_t file_size) {
  std::string line;
  const auto next = [&] { return static_cast<bool>(std::getline(in, line)) && !in.eof(); };
  for (const char* first : {"ply", "format binary_little_endian 1.0"}) {
    if (!next() || line != first) return false;
  }
  constexpr std::string_view kComment = "comment ";
  while (next() && line.starts_with(kComment)) {
    if (!is_plain_comment(std::string_view{line}.substr(kComment.size()))) return false;
  }
  Rows vertices, faces;
  if (!in || !vertices.begin(line, "vertex")) return false;
  while (next() && !line.starts_with("element")) {
    if (!vertices.add_property(line)) return false;
  }
  if (!in || !faces.begin(line, "face")) return false;
  if (!next() || !faces.add_corners(line)) return false;
  while (next() && line != "end_header") {
    if (!faces.add_property(line)) return false;
  }
  if (!in || !vertices.has("x") || !vertices.has("y") || !vertices.has("z")) return false;
  // With other faces than triangles it is longer.
  return file_size == static_cast<std::uint64_t>(in.tellg()) + vertices.bytes() + faces.bytes();
}

}  // namespace

void check_certified_ply(const std::filesystem::path& file) {
  check_readable(file, "the volume");
  std::ifstream in(file, std::ios::binary);
  std::error_code ignored;
  if (in && is_as_written(in, std::filesystem::file_size(file, ignored))) return;
  throw Error(ErrorCode::not_applicable,
              "a certificate is about a binary, little-endian PLY of triangles, as vantage writes it", file.string(),
              "write it anew: \"vantage simplify\" with --facets 1000000000 leaves the mesh as it is, also in a .ply");
}

}  // namespace vantage::internal::app
