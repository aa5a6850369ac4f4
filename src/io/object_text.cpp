#include "io/object_text.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/input.h"
#include "common/ledger.h"
#include "core/read_limits.h"
#include "core/text.h"
#include "io/json_text.h"
#include "io/mesh_builder.h"
#include "io/text_cursor.h"
#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

using ObjectJson = nlohmann::json;

constexpr std::string_view kObjectMark = "vantage object:";

constexpr std::array kObjectKinds = {
    ObjectKind::other, ObjectKind::ground, ObjectKind::surface, ObjectKind::building, ObjectKind::building_part,
    ObjectKind::wall,  ObjectKind::tower,  ObjectKind::bridge,  ObjectKind::tree,     ObjectKind::stand_in};

std::optional<ObjectKind> object_kind_named(std::string_view name) {
  for (const ObjectKind kind : kObjectKinds) {
    if (name == name_of(kind)) return kind;
  }
  return std::nullopt;
}

}  // namespace

std::optional<SceneObject> parse_object(const ObjectJson& written) {
  if (!written.is_object()) return std::nullopt;
  SceneObject object;
  for (const auto& [key, value] : written.items()) {
    if (!value.is_string()) return std::nullopt;
    const auto& text = value.get_ref<const std::string&>();
    if (key == "name") object.name = text;
    if (key == "source_id") object.source_id = text;
    if (key == "kind") {
      const auto kind = object_kind_named(text);
      if (!kind) return std::nullopt;
      object.kind = *kind;
    }
  }
  return object;
}

bool says_more_than_name(const SceneObject& object) { return !(object == object_named(display_name(object))); }

std::string object_text(const SceneObject& object) {
  std::string text = "{";
  const auto add = [&](const char* key, std::string_view value) {
    text.append(text.size() > 1 ? ",\"" : "\"").append(key).append("\":");
    text.append(ObjectJson(value).dump(-1, ' ', true, ObjectJson::error_handler_t::replace));
  };
  if (!object.name.empty()) add("name", object.name);
  if (!object.source_id.empty()) add("source_id", object.source_id);
  if (object.kind != ObjectKind::other) add("kind", name_of(object.kind));
  return text + "}";
}

std::string object_comment(const SceneObject& object) {
  return std::string(kObjectMark).append(" ").append(object_text(object));
}

std::optional<SceneObject> object_in(const ObjectJson& extras) {
  if (!extras.is_object()) return std::nullopt;
  const auto ours = extras.find("vantage");
  if (ours == extras.end() || !ours->is_object()) return std::nullopt;
  const auto object = ours->find("object");
  return object == ours->end() ? std::nullopt : parse_object(*object);
}

std::optional<SceneObject> object_in_comment(std::string_view comment) {
  const std::size_t first = comment.find_first_not_of(' ');
  if (first == std::string_view::npos || !comment.substr(first).starts_with(kObjectMark)) return std::nullopt;
  const ObjectJson json = ObjectJson::parse(comment.substr(first + kObjectMark.size()), nullptr, false);
  return json.is_discarded() ? std::nullopt : parse_object(json);
}

SceneObject object_named(std::string name) {
  SceneObject object{std::move(name), "", ObjectKind::other};
  if (object.name == "ground") object.kind = ObjectKind::ground;
  if (object.name == "surface") object.kind = ObjectKind::surface;
  return object;
}

// ---- the ledger

namespace {

using LedgerJson = nlohmann::json;

constexpr std::string_view kLedgerMark = "vantage ledger:";
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kTooFarM = 100e3;  // from all triangles: then its numbers are wrong
constexpr double kFarM = 1e3;       // a scene smaller than that may have been moved without its ledger

[[noreturn]] void fail_entry(const std::string& problem) {
  throw LedgerProblem{"an entry of the ledger of vantage in it cannot be read: " + problem};
}

/// A number; null is an infinite one where that may be.
double coordinate(const LedgerJson& value, double if_null) {
  if (value.is_null() && std::isinf(if_null)) return if_null;
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (!(std::abs(number) <= core::kMaxCoordinate)) fail_entry("a coordinate is no number up to 1e9");
  return number;
}

Box parse_box(const LedgerJson& written) {
  const auto is_triple = [](const LedgerJson& one) { return one.is_array() && one.size() == 3; };
  if (!written.is_array() || written.size() != 2 || !is_triple(written[0]) || !is_triple(written[1])) {
    fail_entry("\"box\" is not two corners");
  }
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    box.min[axis] = coordinate(written[0][i], axis == 2 ? -kInfinite : 0);
    box.max[axis] = coordinate(written[1][i], axis == 2 ? kInfinite : 0);
  }
  if (!(box.min.array() <= box.max.array()).all()) fail_entry("\"box\" is reversed");
  return box;
}

std::vector<std::vector<std::array<double, 2>>> parse_outlines(const LedgerJson& written) {
  std::vector<std::vector<std::array<double, 2>>> outlines;
  if (!written.is_array()) fail_entry("\"outlines\" is not an array");
  for (const LedgerJson& ring : written) {
    if (!ring.is_array()) fail_entry("an outline is not an array");
    outlines.emplace_back();
    for (const LedgerJson& point : ring) {
      if (!point.is_array() || point.size() != 2) fail_entry("a corner of an outline is not x and y");
      outlines.back().push_back({coordinate(point[0], 0), coordinate(point[1], 0)});
    }
  }
  return outlines;
}

std::string entry_text(const LedgerJson& written, const char* key) {
  const auto found = written.find(key);
  if (found == written.end()) return {};
  if (!found->is_string()) fail_entry(std::string("\"").append(key).append("\" is not a text"));
  return clean_name(found->get_ref<const std::string&>());
}

std::uint32_t parse_stand_in(const LedgerJson& written) {
  if (!written.is_number_unsigned() || written.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
    fail_entry("\"stand_in\" is not the number of an object");
  }
  return written.get<std::uint32_t>();
}

Missing parse_entry(const LedgerJson& written) {
  if (!written.is_object()) fail_entry("it is no JSON object");
  Missing missing;
  missing.is_stated = true;
  LedgerEntry& entry = missing.entry;
  if (const auto object = written.find("object"); object != written.end()) {
    const auto parsed = parse_object(*object);
    if (!parsed) fail_entry("\"object\" is garbled");
    entry.object = {clean_name(parsed->name), clean_name(parsed->source_id), parsed->kind};
  }
  entry.what = entry_text(written, "what");
  entry.reason = entry_text(written, "reason");
  entry.instead = entry_text(written, "instead");
  if (const auto box = written.find("box"); box != written.end()) entry.box = parse_box(*box);
  if (const auto rings = written.find("outlines"); rings != written.end()) entry.outlines = parse_outlines(*rings);
  if (const auto height = written.find("height_m"); height != written.end()) entry.height_m = coordinate(*height, 0);
  if (const auto holder = written.find("stand_in"); holder != written.end()) entry.stand_in = parse_stand_in(*holder);
  const auto larger = written.find("may_be_larger");
  entry.may_be_larger = larger != written.end() && *larger == LedgerJson(true);
  return missing;
}

/// A point as JSON, an infinite number as null.
LedgerJson point_json(const Vec3& point) {
  LedgerJson numbers = LedgerJson::array();
  for (const double number : point) numbers.push_back(std::isfinite(number) ? LedgerJson(number) : LedgerJson());
  return numbers;
}

}  // namespace

Mesh hexahedron(std::vector<Vec3> corners) {
  Mesh mesh{std::move(corners),
            {{0, 2, 3},
             {0, 3, 1},
             {4, 5, 7},
             {4, 7, 6},
             {0, 1, 5},
             {0, 5, 4},
             {2, 6, 7},
             {2, 7, 3},
             {0, 4, 6},
             {0, 6, 2},
             {1, 3, 7},
             {1, 7, 5}}};
  const std::vector<Vec3>& v = mesh.vertices;
  if ((v[1] - v[0]).cross(v[2] - v[0]).dot(v[4] - v[0]) < 0) {
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

Mesh box_mesh(const Box& box) {
  std::vector<Vec3> corners;
  for (unsigned i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1U) != 0 ? box.max.x() : box.min.x(), (i & 2U) != 0 ? box.max.y() : box.min.y(),
                         (i & 4U) != 0 ? box.max.z() : box.min.z());
  }
  return hexahedron(std::move(corners));
}

Missing held_by_box(LedgerEntry entry, const Box& box) {
  entry.box = box;
  entry.instead = "its box";
  return {std::move(entry), box_mesh(box)};
}

namespace {

/// Whether the object may be what holds the place, by who it is. A file that does not tell objects apart has one.
bool may_hold(const RawMesh& mesh, std::uint32_t object, const LedgerEntry& entry) {
  if (object >= mesh.objects.size()) return false;
  const SceneObject& holder = mesh.objects[object];
  const bool is_terrain = holder.kind == ObjectKind::ground || holder.kind == ObjectKind::surface;
  return mesh.objects.size() == 1 || holder.kind == ObjectKind::stand_in ||
         (is_terrain && holder.kind == entry.object.kind) || display_name(holder) == display_name(entry.object);
}

double distance(const Box& a, const Box& b) { return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm(); }

/// Whether `box`, which meets the holder's, does not reach out of that but for the rounding of files and the turn from
/// one origin to another. Where heights are not known it may: posts of a raster lie in the midst of their places.
bool covers(const Box& holder, const Box& box) {
  constexpr double kOfSize = 0.01, kOfPlace = 1e-6, kLeastM = 1e-3;
  if (!box.min.allFinite() || !box.max.allFinite()) return distance(holder, box) == 0;
  const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  const double allowed = kOfSize * (box.max - box.min).norm() + kOfPlace * largest + kLeastM;
  return ((holder.min - box.min).array() <= allowed).all() && ((box.max - holder.max).array() <= allowed).all();
}

/// `boxes`: of the objects; `built`: of all of them.
void bear_out(const RawMesh& mesh, const std::vector<Box>& boxes, const Box& built, LedgerEntry& entry) {
  const Box* holder = entry.stand_in && may_hold(mesh, *entry.stand_in, entry) ? &boxes[*entry.stand_in] : nullptr;
  const double far_m = std::clamp((built.max - built.min).norm(), kFarM, kTooFarM);
  const bool is_lost = entry.box && (distance(*entry.box, built) > far_m ||
                                     (holder && distance(*entry.box, *holder) > 0 && !covers(*holder, *entry.box)));
  const bool is_held = holder && !is_lost && (!entry.box || covers(*holder, *entry.box));
  if (is_lost) {
    entry.box.reset();
    entry.outlines.clear();
  }
  if (is_held) return;
  if (entry.stand_in) entry.reason += "; what held its place is not there any more";
  entry.stand_in.reset();
  entry.instead.clear();
}

/// Stand-ins that no entry names, as in files that lost their ledger: nobody knows what they stand in for.
void add_unnamed(RawMesh& mesh, const std::vector<Box>& boxes) {
  std::vector<bool> is_named(boxes.size());
  for (const Missing& missing : mesh.ledger) {
    if (missing.entry.stand_in) is_named.at(*missing.entry.stand_in) = true;
  }
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (mesh.objects[i].kind != ObjectKind::stand_in || is_named[i] || boxes[i].empty()) continue;
    Missing& missing = mesh.ledger.emplace_back();
    missing.entry = {mesh.objects[i], "", "it is a stand-in, and no ledger of its file tells what for", boxes[i]};
    missing.entry.stand_in = i;
    missing.entry.instead = "it as it is";
    missing.entry.may_be_larger = true;
  }
}

}  // namespace

void apply_policy(RawMesh& mesh, MissingPolicy policy, const std::filesystem::path& file,
                  const core::ProgressReporter& progress) {
  std::vector<Box> boxes(mesh.objects.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    progress.tick();
    for (const std::uint32_t vertex : mesh.triangles[t]) boxes[mesh.object_of[t]].extend(mesh.vertices[vertex]);
  }
  Box built;
  for (const Box& box : boxes) built.extend(box);
  for (Missing& missing : mesh.ledger) {
    if (missing.is_stated) bear_out(mesh, boxes, built, missing.entry);
  }
  add_unnamed(mesh, boxes);
  for (Missing& missing : mesh.ledger) {
    if (missing.is_stated || missing.entry.stand_in) continue;
    const Mesh holder = std::exchange(missing.holder, {});
    const bool is_near = std::all_of(holder.vertices.begin(), holder.vertices.end(), [&](const Vec3& vertex) {
      progress.tick();
      return ((vertex - built.min).array() > -kTooFarM).all() && ((vertex - built.max).array() < kTooFarM).all();
    });
    if (policy != MissingPolicy::block || holder.triangles.empty() || !is_near) {
      if (!is_near) missing.entry.reason += "; its place is more than 100 km from all else";
      missing.entry.instead.clear();
      continue;
    }
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    missing.entry.stand_in = static_cast<std::uint32_t>(mesh.objects.size());
    mesh.objects.push_back({missing.entry.object.name, missing.entry.object.source_id, ObjectKind::stand_in});
    if (display_name(mesh.objects.back()).empty()) mesh.objects.back().name = missing.entry.what;
    make_room(mesh.vertices, holder.vertices.size(), progress);
    make_room(mesh.triangles, holder.triangles.size(), progress);
    make_room(mesh.object_of, holder.triangles.size(), progress);
    mesh.vertices.insert(mesh.vertices.end(), holder.vertices.begin(), holder.vertices.end());
    for (Triangle triangle : holder.triangles) {
      progress.tick();
      for (std::uint32_t& corner : triangle) corner += first;
      mesh.triangles.push_back(triangle);
      mesh.object_of.push_back(*missing.entry.stand_in);
    }
  }
  if (policy != MissingPolicy::refuse) return;
  std::vector<LedgerEntry> entries;
  for (const Missing& missing : mesh.ledger) entries.push_back(missing.entry);
  refuse_incomplete(entries, file.string());
}

void refuse_incomplete(const std::vector<LedgerEntry>& ledger, const std::string& where) {
  if (ledger.empty()) return;
  const LedgerEntry& first = ledger.front();
  const std::string name = display_name(first.object);
  throw Error(ErrorCode::scene_incomplete,
              core::count_text(ledger.size(), "thing is not built as the source has it",
                               "things are not built as the source has them") +
                  "; the first: " + (name.empty() ? first.what : in_quotes(name)) + ": " + first.reason,
              where,
              "mend the source ('vantage inspect' lists all), or let stand-ins hold their place with 'missing: block'");
}

namespace {

/// {"object": {…}, "what": …, "reason": …, "box": [[…], […]], …} on one line, in ASCII; what is empty is left out. The
/// numbers read back exactly. `stand_in`: as the file counts.
std::string entry_json(const LedgerEntry& entry, std::optional<std::uint32_t> stand_in) {
  nlohmann::ordered_json written = nlohmann::ordered_json::object();
  if (!(entry.object == SceneObject{})) written["object"] = nlohmann::ordered_json::parse(object_text(entry.object));
  written["what"] = entry.what;
  written["reason"] = entry.reason;
  const auto is_readable = [](double number) { return std::abs(number) <= core::kMaxCoordinate; };
  const auto is_place = [&](const Vec3& corner) {
    return is_readable(corner.x()) && is_readable(corner.y()) && (std::isinf(corner.z()) || is_readable(corner.z()));
  };
  if (entry.box && is_place(entry.box->min) && is_place(entry.box->max)) {
    written["box"] = {point_json(entry.box->min), point_json(entry.box->max)};
  }
  if (!entry.outlines.empty()) written["outlines"] = entry.outlines;
  if (entry.height_m && is_readable(*entry.height_m)) written["height_m"] = *entry.height_m;
  if (stand_in) written["stand_in"] = *stand_in;
  if (!entry.instead.empty()) written["instead"] = entry.instead;
  if (entry.may_be_larger) written["may_be_larger"] = true;
  return written.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::vector<std::string> ledger_texts(const Scene& scene, FileObjects objects) {
  std::vector<std::string> texts;
  const std::vector<LedgerEntry> ledger = written_ledger(scene);
  if (ledger.empty()) return texts;
  std::vector<std::uint32_t> number(scene.objects.size(), 0);
  for (const std::uint32_t object : scene.object_of) number[object] = 1;
  std::uint32_t count = 0;
  for (std::uint32_t& one : number) one = one == 0 ? std::numeric_limits<std::uint32_t>::max() : count++;
  for (const LedgerEntry& entry : ledger) {
    std::optional<std::uint32_t> stand_in;
    if (entry.stand_in && *entry.stand_in < number.size() && number[*entry.stand_in] < count) {
      stand_in = objects == FileObjects::apart ? number[*entry.stand_in] : 0;
    }
    texts.push_back(entry_json(entry, stand_in));
  }
  return texts;
}

std::string ledger_comments(const Scene& scene, FileObjects objects, const char* start) {
  std::string lines;
  for (const std::string& text : ledger_texts(scene, objects)) {
    lines.append(start).append(kLedgerMark).append(" ").append(text).append("\n");
  }
  return lines;
}

void read_ledger_comment(std::string_view comment, std::vector<Missing>& known) {
  while (!comment.empty() && TextCursor::is_blank(comment.front())) comment.remove_prefix(1);
  if (!comment.starts_with(kLedgerMark)) return;
  try {
    known.push_back(parse_entry(parse_json(comment.substr(kLedgerMark.size()), {}, {})));
  } catch (const JsonProblem& problem) {
    fail_entry(problem.text);
  }
}

std::vector<Missing> ledger_in(const nlohmann::json& object) {
  std::vector<Missing> ledger;
  if (!object.is_object()) return ledger;
  const auto ours = object.find("vantage");
  if (ours == object.end() || !ours->is_object()) return ledger;
  const auto found = ours->find("ledger");
  if (found == ours->end()) return ledger;
  if (!found->is_array()) throw LedgerProblem{"the ledger of vantage in it is not an array"};
  for (const LedgerJson& entry : *found) ledger.push_back(parse_entry(entry));
  return ledger;
}

}  // namespace vantage::internal::io

namespace vantage {

std::vector<LedgerEntry> written_ledger(const Scene& scene) {
  std::vector<LedgerEntry> ledger = scene.ledger;
  for (const OverheadLine& line : scene.overhead) {
    LedgerEntry entry{line.object, "", "clearance is kept from it, and files of scenes do not hold lines overhead"};
    if (!line.mesh.empty()) entry.box = bounding_box(line.mesh);
    ledger.push_back(std::move(entry));
  }
  return ledger;
}

}  // namespace vantage
