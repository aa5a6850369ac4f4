// PLY (G. Turk, The PLY Polygon File Format, Stanford 1994): ASCII and binary of either byte order. Read are the
// elements "vertex" (x, y, z), "face" and "tristrips" (vertex_indices or vertex_index). Others are passed over; those
// that may refer to vertices, such as "edge", are in the ledger.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

#include "io/mesh_builder.h"
#include "io/mesh_readers.h"
#include "io/ply_header.h"
#include "io/text_cursor.h"

namespace vantage::internal::io {
namespace {

using ply::Element;
using ply::Encoding;
using PlyHeader = ply::Header;
using ply::Property;
using ply::Type;

constexpr const char* kGarbled = "export the mesh again; the file is cut off or garbled";

/// Values in text, by line.
class AsciiValues {
 public:
  static constexpr MeshBuilder::PlaceUnit kUnit = MeshBuilder::PlaceUnit::line;

  AsciiValues(const MeshSource& source, const PlyHeader& header)
      : source_(source), text_(source.bytes().substr(header.data), header.data_line) {}

  std::uint64_t place() {
    text_.skip_spaces();
    return text_.line();
  }
  std::uint64_t left() const { return text_.left(); }

  void skip(Type) { word(); }
  void skip(Type type, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) skip(type);
  }
  double number(Type) {
    next();
    double value = 0;
    if (!text_.number(value) || !text_.at_word_end()) fail(shown_word(text_.word_around()) + " is not a number");
    return value;
  }
  std::int64_t integer(Type) {
    next();
    std::int64_t value = 0;
    if (!text_.integer(value) || !text_.at_word_end()) fail(shown_word(text_.word_around()) + " is not a whole number");
    return value;
  }
  [[noreturn]] void fail(std::string problem) const {
    source_.fail_at_line(ErrorCode::mesh_syntax, text_.line(), std::move(problem), kGarbled);
  }

 private:
  void next() {
    text_.skip_spaces();
    if (text_.at_end()) fail("the file ends too early");
  }
  void word() {
    next();
    text_.word();
  }

  const MeshSource& source_;
  TextCursor text_;
};

/// Values in binary, by byte.
class BinaryValues {
 public:
  static constexpr MeshBuilder::PlaceUnit kUnit = MeshBuilder::PlaceUnit::byte;

  BinaryValues(const MeshSource& source, const PlyHeader& header)
      : source_(source),
        at_(header.data),
        swap_((header.encoding == Encoding::little_endian) != (std::endian::native == std::endian::little)) {}

  std::uint64_t place() const { return at_; }
  std::uint64_t left() const { return source_.bytes().size() - at_; }

  void skip(Type type) { take(size_of(type)); }
  void skip(Type type, std::uint64_t count) {
    if (count > left() / size_of(type)) fail("the file ends within a list of " + std::to_string(count) + " values");
    take(count * size_of(type));
  }
  double number(Type type) {
    if (type == Type::float32) return value<float>();
    if (type == Type::float64) return value<double>();
    return static_cast<double>(integer(type));
  }
  std::int64_t integer(Type type) {
    switch (type) {
      case Type::int8:
        return value<std::int8_t>();
      case Type::uint8:
        return value<std::uint8_t>();
      case Type::int16:
        return value<std::int16_t>();
      case Type::uint16:
        return value<std::uint16_t>();
      case Type::int32:
        return value<std::int32_t>();
      default:
        return value<std::uint32_t>();
    }
  }
  [[noreturn]] void fail(std::string problem) const {
    source_.fail_at_byte(ErrorCode::mesh_syntax, place(), std::move(problem), kGarbled);
  }

 private:
  const char* take(std::uint64_t size) {
    if (size > left()) fail("the file ends too early");
    const char* bytes = source_.bytes().data() + at_;
    at_ += size;
    return bytes;
  }

  template <class T>
  T value() {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), take(sizeof(T)), sizeof(T));
    if (swap_) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }

  const MeshSource& source_;
  std::uint64_t at_;
  bool swap_;
};

template <class Values>
class PlyReader {
 public:
  PlyReader(const MeshSource& source, const PlyHeader& header, const core::ProgressReporter& progress,
            const core::ReadLimits& limits)
      : source_(source),
        header_(header),
        progress_(progress),
        builder_(source, MeshFormat::ply, Values::kUnit, limits),
        values_(source, header) {}

  RawMesh read() {
    builder_.add_object(source_.stem());
    bool has_vertices = false, has_faces = false;
    for (const Element& element : header_.elements) {
      if (element.properties.empty()) continue;  // its rows take no space
      check_count(element);
      if (element.name == "vertex") {
        vertices(element);
        has_vertices = true;
      } else if (element.name == "face") {
        faces(element);
        has_faces = true;
      } else if (element.name == "tristrips") {
        lists(element, "strips", [&](const Property& property) { strip(property); });
        has_faces = true;
      } else {
        other(element);
      }
    }
    if (!has_vertices) source_.fail(ErrorCode::mesh_empty, "the PLY file has no element \"vertex\"", "export a mesh");
    if (!has_faces) {
      source_.fail(ErrorCode::mesh_empty, "the PLY file has no element \"face\"",
                   "export a surface mesh, not a point cloud");
    }
    check_end();
    RawMesh mesh = builder_.finish();
    mesh.georeference = header_.georeference;
    mesh.rounding_m = header_.rounding_m;
    tell_others(mesh);
    for (const Missing& missing : header_.ledger) mesh.ledger.push_back(missing);
    return mesh;
  }

 private:
  /// A file cannot hold more rows than it has room for.
  void check_count(const Element& element) {
    values_.place();  // past spaces
    const bool ascii = header_.encoding == Encoding::ascii;
    const std::uint64_t left = values_.left() + (ascii ? 1 : 0);  // the last row needs no line end
    if (element.count <= left / element.smallest_row(header_.encoding)) return;
    values_.fail("the header announces " + std::to_string(element.count) + " rows of \"" + printable(element.name) +
                 "\", but only " + std::to_string(values_.left()) + " bytes follow");
  }

  /// A line end that an editor added is no row.
  void check_end() {
    constexpr std::uint64_t kLineEnd = 2;  // bytes
    const bool ascii = header_.encoding == Encoding::ascii;
    if (ascii) values_.place();  // past spaces
    if (values_.left() <= (ascii ? 0 : kLineEnd)) return;
    values_.fail(std::to_string(values_.left()) + " bytes follow the last row that the header announces");
  }

  static std::string printable(const std::string& name) {
    const std::string text = shown_word(name);
    return text.substr(1, text.size() - 2);
  }

  /// Calls `read(property, index)` for each property of each row; it must take the property's values.
  template <class Read>
  void rows(const Element& element, const Read& read) {
    const std::uint64_t total = source_.bytes().size();
    for (std::uint64_t row = 0; row < element.count; ++row) {
      progress_.tick(total - values_.left(), total);
      for (std::size_t i = 0; i < element.properties.size(); ++i) read(element.properties[i], i);
    }
  }

  void pass_over(const Property& property) {
    if (property.is_list) {
      values_.skip(property.type, list_length(property));
    } else {
      values_.skip(property.type);
    }
  }

  std::uint64_t list_length(const Property& property) {
    const std::int64_t length = values_.integer(property.length_type);
    if (length < 0) values_.fail("a list of " + std::to_string(length) + " values");
    return static_cast<std::uint64_t>(length);
  }

  void vertices(const Element& element) {
    std::vector<int> axis_of(element.properties.size(), -1);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      const int index = element.find(name);
      if (index < 0 || element.properties[static_cast<std::size_t>(index)].is_list) {
        source_.fail(ErrorCode::mesh_syntax, "the PLY file's vertices have no coordinate \"" + name + "\"",
                     "export the mesh with x, y and z");
      }
      axis_of[static_cast<std::size_t>(index)] = axis;
    }
    builder_.reserve(element.count, 0);
    Vec3 position;
    std::uint64_t place = 0;
    const std::size_t last = element.properties.size() - 1;
    rows(element, [&](const Property& property, std::size_t i) {
      if (i == 0) place = values_.place();
      if (axis_of[i] < 0) {
        pass_over(property);
      } else {
        position[axis_of[i]] = values_.number(property.type);
      }
      if (i == last) builder_.add_vertex(position, place);
    });
  }

  void faces(const Element& element) {
    builder_.reserve(builder_.vertex_count(), element.count);
    lists(element, "faces", [&](const Property& property) { face(property); });
  }

  /// Calls `read(property)` for the list of vertices of each row.
  template <class Read>
  void lists(const Element& element, const std::string& what, const Read& read) {
    int corners = element.find("vertex_indices");
    const int others = element.find("vertex_index");
    if (corners >= 0 && others >= 0) {
      source_.fail(ErrorCode::mesh_syntax,
                   "the PLY file's " + what + " have two lists, \"vertex_indices\" and \"vertex_index\"",
                   "export the mesh with one of them");
    }
    if (corners < 0) corners = others;
    if (corners < 0 || !element.properties[static_cast<std::size_t>(corners)].is_list ||
        !ply::is_integer(element.properties[static_cast<std::size_t>(corners)].type)) {
      source_.fail(ErrorCode::mesh_syntax,
                   "the PLY file's " + what + " have no list of whole numbers \"vertex_indices\"",
                   "export the mesh with faces");
    }
    rows(element, [&](const Property& property, std::size_t i) {
      if (i == static_cast<std::size_t>(corners)) {
        read(property);
      } else {
        pass_over(property);
      }
    });
  }

  void face(const Property& property) {
    const std::uint64_t length = list_length(property);
    builder_.begin_face(values_.place());
    for (std::uint64_t i = 0; i < length; ++i) {
      const std::int64_t index = values_.integer(property.type);
      if (index < 0) values_.fail("a face refers to vertex " + std::to_string(index));
      builder_.add_corner(static_cast<std::uint64_t>(index));
    }
    builder_.end_face();
  }

  /// Strips of triangles, one behind the other with -1 between them. The turn of every second triangle is reversed; one
  /// with a corner twice only leads on.
  void strip(const Property& property) {
    const std::uint64_t length = list_length(property);
    std::array<std::int64_t, 3> last{};
    std::uint64_t count = 0;  // corners of the strip so far
    for (std::uint64_t i = 0; i < length; ++i) {
      const std::int64_t index = values_.integer(property.type);
      if (index < -1) values_.fail("a strip refers to vertex " + std::to_string(index));
      last = {last[1], last[2], index};
      count = index < 0 ? 0 : count + 1;
      if (count < 3 || last[0] == last[1] || last[1] == last[2] || last[0] == last[2]) continue;
      if (i % 256 == 0) progress_.check();
      builder_.begin_face(values_.place());
      const bool odd = count % 2 == 0;
      for (const std::int64_t corner : {last[0], last[odd ? 2 : 1], last[odd ? 1 : 2]}) {
        builder_.add_corner(static_cast<std::uint64_t>(corner));
      }
      builder_.end_face();
    }
  }

  /// Whether a property says by its name that it is the numbers of vertices.
  static bool refers_to_vertices(const Property& property) {
    const std::string& name = property.name;
    const bool is_list_of_them = property.is_list && (name == "vertices" || name == "indices" || name == "corners");
    return (is_list_of_them || name.starts_with("vertex")) && ply::is_integer(property.type);
  }

  /// Whether a property may be the number of a vertex, whatever its name is. Colours are bytes.
  static bool is_wide_integer(const Property& property) {
    return ply::is_integer(property.type) && ply::size_of(property.type) > 1;
  }

  /// An element that is not built: in the ledger where it refers to vertices, or has lists or three numbers that may.
  void other(const Element& element) {
    std::vector<std::int64_t> corners;
    rows(element, [&](const Property& property, std::size_t) {
      if (!refers_to_vertices(property)) {
        pass_over(property);
        return;
      }
      const std::uint64_t length = property.is_list ? list_length(property) : 1;
      for (std::uint64_t i = 0; i < length; ++i) {
        progress_.tick();
        corners.push_back(values_.integer(property.type));
      }
    });
    const std::vector<Property>& all = element.properties;
    const bool may_refer = std::count_if(all.begin(), all.end(), is_wide_integer) >= 3 ||
                           std::any_of(all.begin(), all.end(), [](const Property& property) {
                             return property.is_list || refers_to_vertices(property);
                           });
    if (element.count > 0 && may_refer) others_.emplace_back(&element, std::move(corners));
  }

  /// When all vertices are known.
  void tell_others(RawMesh& mesh) const {
    for (const auto& [element, corners] : others_) {
      LedgerEntry entry;
      entry.what = std::to_string(element->count) + " of \"" + printable(element->name) + "\"";
      entry.reason = "only faces and strips of triangles are built";
      Box box;
      for (const std::int64_t corner : corners) {
        const auto i = static_cast<std::uint64_t>(corner);
        if (corner >= 0 && i < mesh.vertices.size()) box.extend(mesh.vertices[i]);
      }
      if (!box.empty()) entry.box = box;
      mesh.ledger.push_back({std::move(entry), {}});
    }
  }

  const MeshSource& source_;
  const PlyHeader& header_;
  const core::ProgressReporter& progress_;
  MeshBuilder builder_;
  Values values_;
  std::vector<std::pair<const Element*, std::vector<std::int64_t>>> others_;  // and the vertices that they refer to
};

}  // namespace

RawMesh read_ply(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits) {
  progress.begin("parse PLY");
  const PlyHeader header = ply::read_header(source);
  if (header.encoding == Encoding::ascii) return PlyReader<AsciiValues>(source, header, progress, limits).read();
  return PlyReader<BinaryValues>(source, header, progress, limits).read();
}

}  // namespace vantage::internal::io
