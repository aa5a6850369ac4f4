// STL, ASCII and binary (3D Systems, StereoLithography Interface Specification, 1989). An STL has no shared vertices:
// each facet brings its own three.
#include <algorithm>
#include <bit>
#include <cstring>

#include "core/text.h"
#include "io/mesh_builder.h"
#include "io/mesh_readers.h"
#include "io/text_cursor.h"

namespace vantage::internal::io {
namespace {

constexpr std::size_t kHeader = 80, kFacet = 50;
constexpr std::size_t kCountEnd = kHeader + 4;

static_assert(std::endian::native == std::endian::little, "binary STL is read as little-endian");

template <class T>
T value_at(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Length that a binary STL's facet count asks for.
std::uint64_t binary_length(std::string_view bytes) {
  return kCountEnd + kFacet * std::uint64_t{value_at<std::uint32_t>(bytes, kHeader)};
}

RawMesh read_binary(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits) {
  const std::string_view bytes = source.bytes();
  if (bytes.size() < kCountEnd)
    source.fail_at_byte(ErrorCode::mesh_syntax, bytes.size(), "the binary STL ends in its header", "export it again");
  if (!is_binary_stl(bytes)) {
    source.fail_at_byte(ErrorCode::mesh_syntax, kHeader,
                        "the binary STL announces " + std::to_string(value_at<std::uint32_t>(bytes, kHeader)) +
                            " facets, which take " + std::to_string(binary_length(bytes)) + " bytes, but has " +
                            std::to_string(bytes.size()),
                        "export the mesh again; the file is cut off or garbled");
  }
  MeshBuilder builder(source, MeshFormat::stl, MeshBuilder::PlaceUnit::byte, limits);
  const std::size_t facets = value_at<std::uint32_t>(bytes, kHeader), end = binary_length(bytes);
  builder.reserve(3 * facets, facets);
  builder.add_object(source.stem());
  for (std::size_t at = kCountEnd; at < end; at += kFacet) {
    progress.tick(at, bytes.size());
    Triangle triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t place = at + 12 * (corner + 1);  // the normal comes first
      triangle[corner] = builder.add_vertex(
          Vec3(value_at<float>(bytes, place), value_at<float>(bytes, place + 4), value_at<float>(bytes, place + 8)),
          place);
    }
    builder.add_triangle(triangle);
  }
  RawMesh mesh = builder.finish();
  if (end < bytes.size()) {
    mesh.notes.push_back("the file has " + core::count_text(bytes.size() - end, "byte", "bytes") +
                         " more than its facets take: passed over");
  }
  return mesh;
}

class AsciiStlReader {
 public:
  AsciiStlReader(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits)
      : source_(source),
        progress_(progress),
        builder_(source, MeshFormat::stl, MeshBuilder::PlaceUnit::line, limits),
        text_(source.bytes()) {}

  RawMesh read() {
    for (text_.skip_spaces(); !text_.at_end(); text_.skip_spaces()) solid();
    return builder_.finish();
  }

 private:
  [[noreturn]] void fail(std::string problem) {
    source_.fail_at_line(ErrorCode::mesh_syntax, text_.line(), std::move(problem),
                         "export the mesh again; the file is cut off or garbled");
  }

  /// The next word in lower case.
  std::string_view keyword() {
    text_.skip_spaces();
    if (text_.at_end()) fail("the file ends within a solid");
    keyword_ = text_.word();
    std::transform(keyword_.begin(), keyword_.end(), keyword_.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return keyword_;
  }

  void expect(std::string_view expected) {
    if (keyword() != expected) fail(shown_word(keyword_) + " where \"" + std::string(expected) + "\" belongs");
  }

  /// "solid name", facets, "endsolid name". A solid without a name has the file's.
  void solid() {
    expect("solid");
    const std::string name = clean_name(text_.rest_of_line());
    builder_.add_object(name.empty() ? source_.stem() : name);
    while (keyword() == "facet") {
      progress_.tick(text_.offset(), source_.bytes().size());
      facet();
    }
    if (keyword_ != "endsolid") fail(shown_word(keyword_) + " where \"facet\" or \"endsolid\" belongs");
    text_.rest_of_line();
  }

  void facet() {
    expect("normal");
    for (int i = 0; i < 3; ++i) keyword();  // the normal, which may be "nan" or "-1.#IND"
    expect("outer");
    expect("loop");
    builder_.begin_face(text_.line());
    while (keyword() == "vertex") builder_.add_corner(vertex());
    if (keyword_ != "endloop") fail(shown_word(keyword_) + " where \"vertex\" or \"endloop\" belongs");
    builder_.end_face();
    expect("endfacet");
  }

  std::uint32_t vertex() {
    Vec3 position;
    for (int i = 0; i < 3; ++i) {
      text_.skip_spaces();
      if (!text_.number(position[i]) || !text_.at_word_end())
        fail(shown_word(text_.word_around()) + " is not a valid coordinate");
    }
    return builder_.add_vertex(position, text_.line());
  }

  const MeshSource& source_;
  const core::ProgressReporter& progress_;
  MeshBuilder builder_;
  TextCursor text_;
  std::string keyword_;
};

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= kCountEnd && binary_length(bytes) <= bytes.size() &&
         bytes.size() - binary_length(bytes) < kFacet;
}

bool is_ascii_stl(std::string_view bytes) {
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  constexpr std::string_view kSolid = "solid";
  const std::string_view first = bytes.substr(0, kSolid.size());
  const bool solid = std::equal(first.begin(), first.end(), kSolid.begin(), kSolid.end(),
                                [](char c, char expected) { return (c | 0x20) == expected; });
  // Binary files may begin with "solid" too; zeros, which their header or count hold, tell them from text.
  return solid && bytes.substr(0, 1024).find('\0') == std::string_view::npos;
}

RawMesh read_stl(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits) {
  progress.begin("parse STL");
  const bool ascii = is_ascii_stl(source.bytes()) && !is_binary_stl(source.bytes());
  return ascii ? AsciiStlReader(source, progress, limits).read() : read_binary(source, progress, limits);
}

}  // namespace vantage::internal::io
