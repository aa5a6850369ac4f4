// Wavefront OBJ: the polygonal part of the format (Wavefront, Advanced Visualizer Manual, appendix B1, 1995). Normals,
// texture coordinates and materials are passed over; free-form curves and surfaces are refused.
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/text.h"
#include "io/axes_text.h"
#include "io/georeference_text.h"
#include "io/mesh_builder.h"
#include "io/mesh_readers.h"
#include "io/object_text.h"
#include "io/rounding_text.h"
#include "io/text_cursor.h"

namespace vantage::internal::io {
namespace {

// Statements that add no polygon.
constexpr std::array<std::string_view, 38> kPassedOver = {
    "bevel",  "bmat",       "c_interp", "con",   "csh",    "cstype",    "ctech",     "curv2", "d_interp", "deg",
    "end",    "hole",       "lod",      "mg",    "maplib", "mtllib",    "parm",      "res",   "s",        "scmp",
    "scrv",   "shadow_obj", "sp",       "stech", "step",   "tech",      "trace_obj", "trim",  "usemap",   "usemat",
    "usemtl", "vn",         "vp",       "vt",    "matlib", "usemtllib", "xyzrgb",    "mrgb"};
// Statements that add what is not read: free-form curves and surfaces, and other files.
constexpr std::array<std::string_view, 7> kRefused = {"bsp", "bzp", "call", "cdc", "cdp", "curv", "surf"};

class ObjReader {
 public:
  ObjReader(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits)
      : source_(source),
        progress_(progress),
        builder_(source, MeshFormat::obj, MeshBuilder::PlaceUnit::line, limits, 1),
        text_(source.bytes()) {
    if (source.bytes().starts_with("\xef\xbb\xbf")) text_ = TextCursor(source.bytes().substr(3));
  }

  RawMesh read() {
    while (!text_.at_end()) {
      progress_.tick(text_.offset(), source_.bytes().size());
      statement();
      text_.next_line();
    }
    RawMesh mesh = builder_.finish(name_parts());
    mesh.georeference = std::move(georeference_);
    mesh.axes = axes_;
    mesh.rounding_m = rounding_;
    tell_thin(mesh);
    for (Missing& missing : ledger_) mesh.ledger.push_back(std::move(missing));
    return mesh;
  }

 private:
  /// The faces of one group within one object; the builder's object of the same number. Which of the two is the
  /// building shows only when the whole file is read.
  struct Part {
    std::uint32_t object;  // in object_names_
    std::string_view group;
    bool has_triangles = false;
  };

  [[noreturn]] void fail(ErrorCode code, std::string problem, std::string fix) {
    source_.fail_at_line(code, text_.line(), std::move(problem), std::move(fix));
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
      comment(text_.rest_of_line());
      return;
    }
    const std::string_view keyword = text_.word();
    if (keyword == "v") {
      vertex();
    } else if (keyword == "f" || keyword == "fo") {  // "fo" is the name that "f" once had
      face();
    } else if (keyword == "o") {
      begin_object(trimmed(text_.rest_of_line()));
    } else if (keyword == "g") {
      group_ = trimmed(text_.rest_of_line());
      part_is_known_ = false;
    } else if (keyword == "l" || keyword == "p") {
      thin(keyword);
    } else if (std::find(kRefused.begin(), kRefused.end(), keyword) != kRefused.end()) {
      fail(ErrorCode::mesh_unsupported,
           keyword == "call" ? "the file takes in another file, which is not read"
                             : "free-form curves and surfaces (" + std::string(keyword) + ") cannot be read",
           "export the mesh with polygons alone, in one file");
    } else if (std::find(kPassedOver.begin(), kPassedOver.end(), keyword) != kPassedOver.end()) {
      pass_over();
    } else {
      fail(ErrorCode::mesh_syntax, "unknown statement " + shown_word(keyword),
           "check that this is an OBJ file; remove the line if it is");
    }
  }

  void comment(std::string_view text) {
    if (object_ != kNoObject) {
      if (auto stated = object_in_comment(text.substr(1))) identities_[object_] = std::move(*stated);
    }
    try {
      read_georeference_comment(text.substr(1), georeference_);
      read_axes_comment(text.substr(1), axes_);
      read_rounding_comment(text.substr(1), rounding_);
      read_ledger_comment(text.substr(1), ledger_);
    } catch (const LedgerProblem& problem) {
      fail(ErrorCode::record_garbled, problem.text, "correct or remove the line");
    } catch (const GeoreferenceProblem& problem) {
      fail(ErrorCode::record_garbled, problem.text, "correct or remove the line; the mesh is read without");
    } catch (const RoundingProblem& problem) {
      fail(ErrorCode::record_garbled, problem.text, "correct or remove the line");
    } catch (const AxesProblem& problem) {
      fail(ErrorCode::record_garbled, problem.text, "correct or remove the line, and say how it is with up and scale");
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
      if (text_.at_line_end())
        fail(ErrorCode::mesh_syntax, "a vertex has only " + std::to_string(i) + " coordinates", kGarbled);
      if (!text_.number(position[i]) || !text_.at_word_end())
        fail(ErrorCode::mesh_syntax, shown_word(text_.word_around()) + " is not a valid coordinate", kGarbled);
    }
    pass_over();
    builder_.add_vertex(position, line);
  }

  void face() {
    if (!part_is_known_) find_part();
    builder_.begin_face(text_.line());
    skip_blanks();
    while (!text_.at_line_end() && text_.peek() != '#') {
      corner();
      skip_blanks();
    }
    if (text_.at_end() && builder_.corner_count() < 3)
      fail(ErrorCode::mesh_syntax, "the file ends within a face", kGarbled);
    text_.rest_of_line();
    builder_.end_face();
    if (builder_.corner_count() >= 3) parts_[part_].has_triangles = true;
  }

  /// A line or points, which are not built. Numbers that cannot be read, or of vertices that come later, do not count.
  void thin(std::string_view keyword) {
    Thin& found = thin_[{object_, keyword == "p"}];
    ++found.count;
    const auto count = static_cast<std::int64_t>(builder_.vertex_count());
    for (skip_blanks(); !text_.at_line_end() && text_.peek() != '#'; skip_blanks()) {
      std::int64_t number = 0;
      if (text_.integer(number)) {
        if (number < 0) number += count + 1;
        if (number > 0 && number <= count) found.box.extend(builder_.vertex(static_cast<std::uint32_t>(number - 1)));
      }
      if (!text_.at_word_end()) text_.word();
    }
    text_.rest_of_line();
  }

  void tell_thin(RawMesh& mesh) const {
    for (const auto& [key, found] : thin_) {
      const auto& [object, is_points] = key;
      LedgerEntry entry;
      if (object != kNoObject) entry.object = object_named(clean_name(object_names_[object]));
      entry.what = is_points ? core::count_text(found.count, "statement of points", "statements of points")
                             : core::count_text(found.count, "line", "lines");
      entry.reason = "only faces are built";
      if (!found.box.empty()) entry.box = found.box;
      mesh.ledger.push_back({std::move(entry), {}});
    }
  }

  /// "12", "12/5", "12//7" or "12/5/7": only the first number matters. Negative numbers count back from the last
  /// vertex.
  void corner() {
    std::int64_t number = 0;
    if (!text_.integer(number))
      fail(ErrorCode::mesh_syntax, shown_word(text_.word()) + " is not a vertex number", kGarbled);
    if (number == 0) fail(ErrorCode::mesh_syntax, "a face refers to vertex 0; vertices count from 1", kGarbled);
    const auto count = static_cast<std::int64_t>(builder_.vertex_count());
    if (number < -count) {
      fail(ErrorCode::mesh_syntax,
           "a face refers to vertex " + std::to_string(number) + ", but only " + std::to_string(count) +
               " come before it",
           kGarbled);
    }
    builder_.add_corner(static_cast<std::uint64_t>(number < 0 ? count + number : number - 1));
    for (int i = 0; i < 2 && text_.skip('/'); ++i) {
      std::int64_t ignored = 0;
      text_.integer(ignored);
    }
    if (!text_.at_word_end() && text_.peek() != '\\')
      fail(ErrorCode::mesh_syntax, shown_word(text_.word_around()) + " in a face", kGarbled);
  }

  /// Each "o" starts an object, whatever its name: two buildings may have the same. One without a name ends it.
  void begin_object(std::string_view name) {
    object_ = kNoObject;
    if (!name.empty()) {
      object_ = static_cast<std::uint32_t>(object_names_.size());
      object_names_.push_back(name);
    }
    part_is_known_ = false;
  }

  /// Faces of a group may be scattered over the file.
  void find_part() {
    const auto [known, is_new] =
        part_numbers_.try_emplace(std::pair(object_, group_), static_cast<std::uint32_t>(parts_.size()));
    part_ = known->second;
    if (is_new) {
      parts_.push_back({object_, group_});
      builder_.add_object(group_);
    } else {
      builder_.set_object(part_);
    }
    part_is_known_ = true;
  }

  /// Whether the groups are what the file tells apart: it holds one object only, and that is subdivided. Where there
  /// are several objects, groups are their parts (walls and roof, materials) or kinds of them.
  bool groups_are_objects() const {
    std::set<std::uint32_t> objects;
    std::set<std::string_view> groups;
    for (const Part& part : parts_) {
      if (!part.has_triangles || part.object == kNoObject) continue;
      objects.insert(part.object);
      groups.insert(part.group);
    }
    return objects.size() == 1 && groups.size() > 1;
  }

  /// What a comment says of an object, unless its name was changed since.
  void name_object(std::uint32_t built, std::uint32_t object) {
    const auto stated = identities_.find(object);
    const bool holds = stated != identities_.end() && display_name(stated->second) == clean_name(object_names_[object]);
    if (holds) {
      builder_.identify_object(built, stated->second);
    } else {
      builder_.rename_object(built, object_names_[object]);
    }
  }

  /// Names the builder's objects. Returns for each the one that it is joined with.
  std::vector<std::uint32_t> name_parts() {
    const bool by_group = groups_are_objects();
    std::vector<std::uint32_t> joined(parts_.size());
    std::vector<std::uint32_t> first(object_names_.size(), kNoObject);
    for (std::uint32_t i = 0; i < parts_.size(); ++i) {
      const Part& part = parts_[i];
      joined[i] = i;
      if (part.object == kNoObject || (by_group && !part.group.empty())) continue;  // has its group's name
      name_object(i, part.object);
      if (first[part.object] == kNoObject) first[part.object] = i;
      joined[i] = first[part.object];
    }
    return joined;
  }

  static constexpr const char* kGarbled = "export the mesh again; the file is cut off or garbled";

  const MeshSource& source_;
  const core::ProgressReporter& progress_;
  MeshBuilder builder_;
  TextCursor text_;
  std::optional<Georeference> georeference_;
  std::optional<double> rounding_;
  std::optional<Axes> axes_;
  std::vector<Missing> ledger_;

  static constexpr std::uint32_t kNoObject = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::string_view> object_names_;       // names lie in source_
  std::map<std::uint32_t, SceneObject> identities_;  // of objects, where a comment states them
  std::uint32_t object_ = kNoObject;
  std::string_view group_;
  /// Lines or points of an object.
  struct Thin {
    std::size_t count = 0;
    Box box;
  };
  std::map<std::pair<std::uint32_t, bool>, Thin> thin_;  // by object, and whether they are points
  std::vector<Part> parts_;
  std::map<std::pair<std::uint32_t, std::string_view>, std::uint32_t> part_numbers_;
  std::uint32_t part_ = 0;
  bool part_is_known_ = false;
};

}  // namespace

RawMesh read_obj(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits) {
  progress.begin("parse OBJ");
  return ObjReader(source, progress, limits).read();
}

}  // namespace vantage::internal::io
