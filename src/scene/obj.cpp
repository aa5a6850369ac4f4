// Wavefront OBJ: the polygonal part of the format (Wavefront, Advanced Visualizer Manual, appendix B1, 1995). Normals,
// texture coordinates, materials, lines, points and free-form surfaces are passed over.
#include <algorithm>
#include <array>
#include <unordered_map>

#include "scene/mesh_builder.h"
#include "scene/mesh_readers.h"
#include "scene/text_cursor.h"

namespace vantage::scene {
namespace {

// Statements that add no polygon.
constexpr std::array<std::string_view, 47> kPassedOver = {
    "bevel",  "bmat",  "bsp",    "bzp",    "c_interp",  "call",      "cdc",  "cdp",    "con",    "csh",
    "cstype", "ctech", "curv",   "curv2",  "d_interp",  "deg",       "end",  "hole",   "l",      "lod",
    "maplib", "mg",    "mtllib", "p",      "parm",      "res",       "s",    "scmp",   "scrv",   "shadow_obj",
    "sp",     "stech", "step",   "surf",   "tech",      "trace_obj", "trim", "usemap", "usemat", "usemtl",
    "vn",     "vp",    "vt",     "matlib", "usemtllib", "xyzrgb",    "mrgb"};

class ObjReader {
 public:
  ObjReader(const MeshSource& source, ReadProgress& progress, const ReadLimits& limits)
      : source_(source),
        progress_(progress),
        builder_(source, MeshFormat::obj, MeshBuilder::PlaceUnit::line, limits, 1),
        text_(source.bytes()) {
    if (source.bytes().starts_with("\xef\xbb\xbf")) text_ = TextCursor(source.bytes().substr(3));
  }

  RawMesh read() {
    while (!text_.at_end()) {
      progress_.update(text_.offset(), source_.bytes().size());
      statement();
      text_.next_line();
    }
    return builder_.finish();
  }

 private:
  [[noreturn]] void fail(std::string problem, std::string fix) {
    source_.fail_at_line(text_.line(), std::move(problem), std::move(fix));
  }

  /// Blanks, and line ends with a backslash before them.
  void skip_blanks() {
    while (true) {
      text_.skip_blanks();
      TextCursor ahead = text_;
      if (!ahead.skip('\\') || ahead.at_end() || !ahead.at_line_end()) return;
      ahead.next_line();
      text_ = ahead;
    }
  }

  void statement() {
    text_.skip_blanks();
    if (text_.at_line_end()) return;
    if (text_.peek() == '#') {
      text_.rest_of_line();
      return;
    }
    const std::string_view keyword = text_.word();
    if (keyword == "v") {
      vertex();
    } else if (keyword == "f" || keyword == "fo") {  // "fo" is the name that "f" once had
      face();
    } else if (keyword == "o") {
      object(trimmed(text_.rest_of_line()));
    } else if (keyword == "g") {
      group(trimmed(text_.rest_of_line()));
    } else if (std::find(kPassedOver.begin(), kPassedOver.end(), keyword) != kPassedOver.end()) {
      pass_over();
    } else {
      fail("unknown statement " + in_quotes(keyword), "check that this is an OBJ file; remove the line if it is");
    }
  }

  static std::string_view trimmed(std::string_view name) {
    while (!name.empty() && TextCursor::is_blank(name.front())) name.remove_prefix(1);
    while (!name.empty() && TextCursor::is_blank(name.back())) name.remove_suffix(1);
    return name;
  }

  /// The rest of the statement, continued lines included.
  void pass_over() {
    while (true) {
      const std::string_view rest = text_.rest_of_line();
      if (text_.at_end() || rest.empty() || rest.back() != '\\') return;
      text_.next_line();
    }
  }

  /// "v x y z", and perhaps a weight or a colour, which are passed over.
  void vertex() {
    const std::uint64_t line = text_.line();
    Vec3 position;
    for (int i = 0; i < 3; ++i) {
      skip_blanks();
      if (text_.at_line_end()) fail("a vertex has only " + std::to_string(i) + " coordinates", kGarbled);
      if (!text_.number(position[i]) || !text_.at_word_end())
        fail(in_quotes(text_.word_around()) + " is no coordinate", kGarbled);
    }
    pass_over();
    builder_.add_vertex(position, line);
  }

  void face() {
    builder_.begin_face(text_.line());
    skip_blanks();
    while (!text_.at_line_end() && text_.peek() != '#') {
      corner();
      skip_blanks();
    }
    if (text_.at_end() && builder_.corner_count() < 3) fail("the file ends within a face", kGarbled);
    text_.rest_of_line();
    builder_.end_face();
  }

  /// "12", "12/5", "12//7" or "12/5/7": only the first number matters. Negative numbers count back from the last
  /// vertex.
  void corner() {
    std::int64_t number = 0;
    if (!text_.integer(number)) fail(in_quotes(text_.word()) + " is no vertex number", kGarbled);
    if (number == 0) fail("a face refers to vertex 0; vertices count from 1", kGarbled);
    const auto count = static_cast<std::int64_t>(builder_.vertex_count());
    if (number < -count) {
      fail("a face refers to vertex " + std::to_string(number) + ", but only " + std::to_string(count) +
               " come before it",
           kGarbled);
    }
    builder_.add_corner(static_cast<std::uint64_t>(number < 0 ? count + number : number - 1));
    for (int i = 0; i < 2 && text_.skip('/'); ++i) {
      std::int64_t ignored = 0;
      text_.integer(ignored);
    }
    if (!text_.at_word_end() && text_.peek() != '\\') fail(in_quotes(text_.word_around()) + " in a face", kGarbled);
  }

  /// Each "o" starts an object, whatever its name: two buildings may have the same.
  void object(std::string_view name) {
    named_object_ = !name.empty();
    if (named_object_) {
      builder_.add_object(name);
    } else {
      group(group_);
    }
  }

  /// Groups are objects where no object is named. Faces of a group may be scattered over the file.
  void group(std::string_view name) {
    group_ = name;
    if (named_object_) return;
    const auto [known, is_new] = groups_.try_emplace(name, 0);
    if (is_new) {
      known->second = builder_.add_object(name);
    } else {
      builder_.set_object(known->second);
    }
  }

  static constexpr const char* kGarbled = "export the mesh again; the file is cut off or garbled";

  const MeshSource& source_;
  ReadProgress& progress_;
  MeshBuilder builder_;
  TextCursor text_;
  bool named_object_ = false;
  std::string_view group_;
  std::unordered_map<std::string_view, std::uint32_t> groups_;  // names lie in source_
};

}  // namespace

RawMesh read_obj(const MeshSource& source, ReadProgress& progress, const ReadLimits& limits) {
  progress.begin("parse OBJ");
  return ObjReader(source, progress, limits).read();
}

}  // namespace vantage::scene
