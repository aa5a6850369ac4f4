// docs/mission-file.md describes every key.
#include "app/target_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>
#include <variant>

#include "app/scene_section.h"
#include "app/schema.h"
#include "common/input.h"
#include "core/places.h"
#include "core/zone_check.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

/// Clockwise from north.
constexpr std::array<const char*, 8> kHeadings = {"north", "northeast", "east", "southeast",
                                                  "south", "southwest", "west", "northwest"};
constexpr double kHeadingStep = 45;  // degrees

class TargetParser : private ValueReader {
 public:
  TargetParser(const ValueReader& reader, const MissionFile& mission) : ValueReader(reader), mission_(mission) {}

  MissionTarget parse(const YamlNode& node);

 private:
  void check_edges(const YamlNode& node, std::size_t vertex_count) const;
  void refuse_beside(const YamlNode& node, const char* key, std::initializer_list<const char*> others,
                     const char* fix) const;
  const YamlNode& parse_vertices(const YamlNode& node);
  const YamlNode& parse_parts(const YamlNode& node, const YamlNode& parts);
  const YamlNode& parse_ground_target(const YamlNode& node);
  struct Corners {
    Zone::Ring ring;
    std::vector<double> z_m;
  };
  Corners corners(const YamlNode& node, const std::string& what) const;
  const YamlNode& parse_outline(const YamlNode& node, const YamlNode& outline);
  void parse_holes(const YamlNode& node, std::vector<TargetOutline>& outlines) const;
  const YamlNode& parse_file(const YamlNode& node, const YamlNode& named);
  const YamlNode& parse_volume(const YamlNode& node, const YamlNode& named);
  const YamlNode& parse_faces(const YamlNode& node, const YamlNode& part);
  double heading(const YamlNode& node) const;
  const YamlNode& parse_point(const YamlNode& node, const YamlNode& point);
  void check_target(const YamlNode& place);
  void check_is_map(const YamlNode& osm) const;
  void refuse_without_part(const YamlNode& node) const;
  void refuse_without_file(const YamlNode& node) const;
  void parse_sides(const YamlNode& node, const YamlNode& sides);
  const YamlNode& require(const YamlNode& map, std::string_view key, const std::string& fix) const;

  const MissionFile& mission_;
  MissionTarget section_;
};

/// Whether a place lies in a ring, by how often a line from it to the east crosses the ring.
bool is_in(const Zone::Ring& ring, const Eigen::Vector2d& at) {
  bool inside = false;
  for (std::size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++) {
    const Eigen::Vector2d &a = ring[before], &b = ring[i];
    if ((a.y() > at.y()) == (b.y() > at.y())) continue;
    if (at.x() < a.x() + (b.x() - a.x()) * (at.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

const char* const kVerticesForm =
    "write 'vertices: [[x, y, z], [x, y, z], [x, y, z]]', 3 to 64 points, or 'point: [x, y, z]'";

std::string indexed_item(const std::string& what, std::size_t index) {
  return what + "[" + std::to_string(index) + "]";
}

std::string edge_text(std::size_t from, std::size_t to) {
  std::string text = "[";
  text += std::to_string(from);
  text += ", ";
  text += std::to_string(to);
  text += "]";
  return text;
}

MissionTarget TargetParser::parse(const YamlNode& node) {
  check_keys(node, "target", file());
  Target& target = section_.target;
  if (const YamlNode* name = find(node, "name")) target.name = text(*name, "target.name");
  const YamlNode* point = find(node, "point");
  const bool is_on_ground = find(node, "osm") || find(node, "center");
  const YamlNode* parts = find(node, "parts");
  const YamlNode* part = find(node, "part");
  const YamlNode* outline = find(node, "outline");
  if (part == nullptr) refuse_without_part(node);
  const YamlNode* from = find(node, "file");
  const YamlNode* volume = find(node, "volume");
  if (from == nullptr && volume == nullptr) refuse_without_file(node);
  const YamlNode& place = volume         ? parse_volume(node, *volume)
                          : part         ? parse_faces(node, *part)
                          : from         ? parse_file(node, *from)
                          : point        ? parse_point(node, *point)
                          : parts        ? parse_parts(node, *parts)
                          : outline      ? parse_outline(node, *outline)
                          : is_on_ground ? parse_ground_target(node)
                                         : parse_vertices(node);
  if (const YamlNode* offset = find(node, "offset")) target.offset_m = length(*offset, "target.offset");
  if (const YamlNode* front = find(node, "front")) target.front = vector(*front, "target.front");
  if (const YamlNode* sides = find(node, "sides")) parse_sides(node, *sides);
  check_target(place);
  if (const YamlNode* edges = find(node, "edges")) check_edges(*edges, target.parts[0].size());
  return std::move(section_);
}

const YamlNode& TargetParser::parse_parts(const YamlNode& node, const YamlNode& parts) {
  const char* const form = "write a list of polygons: [[[x, y, z], [x, y, z], [x, y, z]], [[x, y, z], ...]]";
  refuse_beside(node, "parts", {"vertices", "edges", "outline", "holes", "osm", "center"},
                "keep 'parts' for several polygons");
  if (list(parts, "target.parts", form).empty())
    fail(ErrorCode::nothing_given, parts, "target.parts is an empty list", form);
  section_.target.parts.clear();
  for (std::size_t i = 0; i < parts.items.size(); ++i) {
    const std::string what = indexed_item("target.parts", i);
    std::vector<Vec3>& part = section_.target.parts.emplace_back();
    list(parts.items[i], what, form);
    for (std::size_t k = 0; k < parts.items[i].items.size(); ++k) {
      part.push_back(vector(parts.items[i].items[k], indexed_item(what, k)));
    }
    if (part.size() == 1) {
      fail(ErrorCode::target_vertex_count, parts.items[i], what + " needs at least 3 vertices, and has 1",
           "add vertices, or write 'point: [x, y, z]' for a single point");
    }
  }
  return parts;
}

/// Returns the node that stands for the target in messages.
const YamlNode& TargetParser::parse_vertices(const YamlNode& node) {
  Target& target = section_.target;
  if (const YamlNode* holes = find(node, "holes")) {
    fail(ErrorCode::not_applicable, *holes, "target.holes are of an outline, and the target has no 'outline'",
         "write 'outline: [[x, y], [x, y], [x, y]]'");
  }
  for (const char* key : {"width", "length", "heading"}) {
    if (const YamlNode* entry = find(node, key)) {
      fail(ErrorCode::not_applicable, *entry,
           std::string("target.") + key + " is of a rectangle, and the target has no 'center'",
           "write 'center: [latitude, longitude]'");
    }
  }
  const YamlNode& vertices = require(node, "vertices", kVerticesForm);
  list(vertices, "target.vertices", kVerticesForm);
  for (std::size_t i = 0; i < vertices.items.size(); ++i) {
    target.parts[0].push_back(vector(vertices.items[i], indexed_item("target.vertices", i)));
  }
  if (target.is_point()) {
    fail(ErrorCode::target_vertex_count, vertices, "a polygon needs at least 3 vertices, this one has 1",
         "add vertices, or write 'point: [x, y, z]' for a single point");
  }
  return vertices;
}

/// Keys that say another thing than `key` does.
void TargetParser::refuse_beside(const YamlNode& node, const char* key, std::initializer_list<const char*> others,
                                 const char* fix) const {
  for (const char* other : others) {
    if (const YamlNode* entry = find(node, other)) {
      fail(ErrorCode::conflicting_keys, *entry, std::string("target has both '") + key + "' and '" + other + "'", fix);
    }
  }
}

/// Where it lies is found out when the scene is read.
const YamlNode& TargetParser::parse_ground_target(const YamlNode& node) {
  GroundTarget& ground = section_.source.emplace<GroundTarget>();
  if (const YamlNode* osm = find(node, "osm")) {
    refuse_beside(node, "osm", {"vertices", "edges", "parts", "holes", "center", "width", "length", "heading"},
                  "keep 'osm' for an area of the map, or give the target yourself");
    ground.osm = text(*osm, "target.osm");
    if (find(node, "name") == nullptr) section_.target.name = ground.osm;
    check_is_map(*osm);
    return *osm;
  }
  const YamlNode& center = *find(node, "center");
  refuse_beside(node, "center", {"vertices", "edges", "parts", "holes"},
                "keep 'center' for a rectangle, or 'vertices' for a polygon");
  ground.center_deg = parse_lat_lon(center, *this, "target.center");
  const std::string form = "write 'width: 20' and 'length: 30' (metres), and 'heading: 45' (degrees from north)";
  ground.width_m = positive_length(require(node, "width", form), "target.width");
  ground.length_m = positive_length(require(node, "length", form), "target.length");
  if (const YamlNode* heading = find(node, "heading")) ground.heading_deg = angle(*heading, "target.heading");
  return center;
}

const char* const kOutlineForm =
    "write the corners in order: [[x, y], [x, y], [x, y]], or [x, y, z] for each; or a list of such polygons";

bool is_list(const YamlNode& node) { return node.kind == YamlNode::Kind::sequence; }

/// Corners of a polygon in plan, and their heights where they have some.
TargetParser::Corners TargetParser::corners(const YamlNode& node, const std::string& what) const {
  Corners result;
  list(node, what, kOutlineForm);
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& corner = node.items[i];
    const std::string name = indexed_item(what, i);
    const std::size_t count = list(corner, name, kOutlineForm).size();
    if (count != 2 && count != 3) {
      fail(ErrorCode::wrong_type, corner, name + " must be two numbers, or three, not " + describe(corner),
           kOutlineForm);
    }
    result.ring.emplace_back(coordinate(corner.items[0], name + ".x"), coordinate(corner.items[1], name + ".y"));
    if (count == 3) result.z_m.push_back(coordinate(corner.items[2], name + ".z"));
  }
  if (!result.z_m.empty() && result.z_m.size() < result.ring.size()) {
    fail(ErrorCode::wrong_type, node, what + " has corners with a z and corners without", kOutlineForm);
  }
  return result;
}

/// On which heights it lies is found out when the scene is read, unless its corners say it.
const YamlNode& TargetParser::parse_outline(const YamlNode& node, const YamlNode& outline) {
  refuse_beside(node, "outline", {"vertices", "edges", "osm", "center", "width", "length", "heading"},
                "keep 'outline' for polygons that need not be convex");
  std::vector<TargetOutline>& outlines = section_.source.emplace<GroundTarget>().outlines;
  list(outline, "target.outline", kOutlineForm);
  const auto& first = outline.items;
  const bool are_several = !first.empty() && is_list(first[0]) && !first[0].items.empty() && is_list(first[0].items[0]);
  for (std::size_t i = 0; i < (are_several ? first.size() : 1); ++i) {
    Corners read =
        are_several ? corners(first[i], indexed_item("target.outline", i)) : corners(outline, "target.outline");
    outlines.push_back({std::move(read.ring), {}, std::move(read.z_m)});
  }
  if (const YamlNode* holes = find(node, "holes")) parse_holes(*holes, outlines);
  for (const TargetOutline& one : outlines) {
    if (one.z_m.empty() != outlines.front().z_m.empty()) {
      fail(ErrorCode::wrong_type, outline, "target.outline has polygons with heights and polygons without",
           "give all corners a z, or none: then they lie on the ground");
    }
    Zone area;
    area.outer = one.outer;
    area.holes = one.holes;
    if (const auto fault = core::fault_of(area)) {
      fail(fault->code, outline, "target.outline: " + fault->problem, advice_for_outline(*fault, one.z_m));
    }
  }
  return outline;
}

/// Each belongs to the polygon that it lies in.
void TargetParser::parse_holes(const YamlNode& node, std::vector<TargetOutline>& outlines) const {
  list(node, "target.holes", "write a list of polygons: [[[x, y], [x, y], [x, y]]]");
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string what = indexed_item("target.holes", i);
    Corners hole = corners(node.items[i], what);
    const auto holds = [&](const TargetOutline& one) { return !hole.ring.empty() && is_in(one.outer, hole.ring[0]); };
    const auto found = outlines.size() == 1 ? outlines.begin() : std::find_if(outlines.begin(), outlines.end(), holds);
    if (found == outlines.end()) {
      fail(ErrorCode::value_out_of_range, node.items[i], what + " lies in none of the polygons of target.outline",
           "leave it out, or move it");
    }
    if (hole.z_m.empty() != found->z_m.empty()) {
      fail(ErrorCode::wrong_type, node.items[i], what + " has heights and its outline has none, or the other way round",
           "give all corners a z, or none: then they lie on the ground");
    }
    found->holes.push_back(std::move(hole.ring));
    found->z_m.insert(found->z_m.end(), hole.z_m.begin(), hole.z_m.end());
  }
}

/// What it says is read with the scene.
const YamlNode& TargetParser::parse_file(const YamlNode& node, const YamlNode& named) {
  refuse_beside(
      node, "file",
      {"vertices", "edges", "parts", "point", "outline", "holes", "osm", "center", "width", "length", "heading"},
      "keep 'file' for a polygon of a file, or give the target yourself");
  TargetFile& from = section_.source.emplace<TargetFile>();
  from.name = text(named, "target.file");
  from.file = mission_.file.parent_path() / from.name;
  if (const YamlNode* feature = find(node, "feature")) from.feature = text(*feature, "target.feature");
  if (find(node, "name") == nullptr) section_.target.name.clear();
  return named;
}

/// Which mesh it is is found out when the scene is read.
const YamlNode& TargetParser::parse_volume(const YamlNode& node, const YamlNode& named) {
  for (const YamlEntry& entry : node.entries) {
    if (entry.key == "volume" || entry.key == "name") continue;
    fail(ErrorCode::conflicting_keys, entry.value, "target has both 'volume' and '" + entry.key + "'",
         "keep 'volume', with a 'name' alone, for a region to fly through, or give what is to be seen");
  }
  TargetFile& from = section_.source.emplace<TargetFile>();
  from.is_volume = true;
  from.name = text(named, "target.volume");
  from.file = mission_.file.parent_path() / from.name;
  if (find(node, "name") == nullptr) section_.target.name.clear();
  return named;
}

void TargetParser::parse_sides(const YamlNode& node, const YamlNode& sides) {
  const std::string word = text(sides, "target.sides");
  if (word != "front" && word != "both") {
    fail(ErrorCode::unknown_choice, sides, "there are no sides " + in_quotes(word) + " of a target",
         "write 'sides: both', or 'sides: front', the default");
  }
  if (word == "front") return;
  if (find(node, "point")) {
    fail(ErrorCode::not_applicable, sides, "a point has no sides",
         "leave 'sides' out: without 'front' a point is seen from all sides");
  }
  section_.both_sides = true;
}

void TargetParser::check_is_map(const YamlNode& osm) const {
  if (mission_.scene.kind == SceneSource::Kind::map) return;
  fail(ErrorCode::not_applicable, osm, "target.osm names an object of a map, and the scene is none",
       "write 'scene: {osm: city.osm.pbf}', or give the target's vertices");
}

void TargetParser::refuse_without_part(const YamlNode& node) const {
  for (const char* key : {"object", "at", "facing", "nearest"}) {
    if (const YamlNode* entry = find(node, key)) {
      fail(ErrorCode::missing_key, *entry, std::string("target has '") + key + "' without 'part'",
           "add 'part: roof' or 'part: facade'");
    }
  }
}

void TargetParser::refuse_without_file(const YamlNode& node) const {
  if (const YamlNode* feature = find(node, "feature")) {
    fail(ErrorCode::missing_key, *feature, "target has 'feature' without 'file'",
         "write 'file: areas.geojson', the file that has it");
  }
}

/// Which faces these are is found out when the scene is read.
const YamlNode& TargetParser::parse_faces(const YamlNode& node, const YamlNode& part) {
  refuse_beside(node, "part",
                {"vertices", "edges", "parts", "point", "outline", "holes", "center", "width", "length", "heading",
                 "front", "file"},
                "keep 'part' for a roof or facades of an object, which know their outer side");
  FaceTarget& faces = section_.source.emplace<FaceTarget>();
  const std::string kind = text(part, "target.part");
  if (kind != "roof" && kind != "facade") {
    fail(ErrorCode::unknown_choice, part, "there is no part " + in_quotes(kind) + " of an object",
         "write 'part: roof' or 'part: facade'");
  }
  faces.kind = kind == "roof" ? FaceKind::roof : FaceKind::facade;
  const YamlNode *object = find(node, "object"), *osm = find(node, "osm"), *at = find(node, "at");
  const char* const form = "write one of 'object: NAME', 'osm: way/123' and 'at: [latitude, longitude]'";
  if (object) refuse_beside(node, "object", {"osm", "at"}, form);
  if (osm) refuse_beside(node, "osm", {"at"}, form);
  const YamlNode* const place = object ? object : osm ? osm : at;
  if (place == nullptr) fail(ErrorCode::missing_key, part, "target.part does not say of which object", form);
  if (object) faces.object = text(*object, "target.object");
  if (osm) {
    faces.osm = text(*osm, "target.osm");
    check_is_map(*osm);
  }
  if (at) faces.at_deg = parse_lat_lon(*at, *this, "target.at");
  if (const YamlNode* facing = find(node, "facing")) faces.facing_deg = heading(*facing);
  if (const YamlNode* nearest = find(node, "nearest")) faces.nearest = vector(*nearest, "target.nearest");
  if (faces.facing_deg && faces.nearest) {
    fail(ErrorCode::conflicting_keys, *find(node, "nearest"), "target has both 'facing' and 'nearest'",
         "keep 'nearest' for one face, 'facing' for all that face that way");
  }
  if (find(node, "name") == nullptr) section_.target.name.clear();
  return *place;
}

double TargetParser::heading(const YamlNode& node) const {
  const auto word = std::find(kHeadings.begin(), kHeadings.end(), node.text);
  if (word != kHeadings.end()) return kHeadingStep * static_cast<double>(word - kHeadings.begin());
  const std::string form =
      "write north, northeast, east, southeast, south, southwest, west, northwest, or degrees "
      "clockwise from north: 135";
  if (node.kind != YamlNode::Kind::scalar || parse_angle(node.text).fault != NumberFault::none) {
    fail(ErrorCode::unknown_choice, node, "target.facing is no direction: " + describe(node), form);
  }
  const double degrees = angle(node, "target.facing");
  if (std::abs(degrees) > 360) {
    fail(ErrorCode::value_out_of_range, node, "target.facing is beyond 360 degrees: " + shortest(degrees), form);
  }
  return degrees;
}

const YamlNode& TargetParser::parse_point(const YamlNode& node, const YamlNode& point) {
  refuse_beside(node, "point", {"vertices", "edges", "parts", "outline", "holes", "osm", "center"},
                "keep 'point' for a single point, or 'vertices' for a polygon");
  section_.target.parts = {{vector(point, "target.point")}};
  const YamlNode* offset = find(node, "offset");
  if (offset != nullptr && find(node, "front") == nullptr) {
    fail(ErrorCode::conflicting_keys, *offset, "a point without 'front' has no side to be moved towards by 'offset'",
         "move the point itself, or give 'front', the side that is looked at");
  }
  return point;
}

/// The checks that need no scene, told with the place of the vertices or the point.
void TargetParser::check_target(const YamlNode& place) {
  section_.place = place_in(file(), place.place);
  const bool is_placed_later = !std::holds_alternative<std::monostate>(section_.source);
  if (!mission_.crs.empty() || is_placed_later) return;  // georeference() does it
  core::with_place(section_.place, [&] {
    for (std::size_t i = 0; i < section_.target.parts.size(); ++i) make_target_frame(section_.target, i);
    return 0;
  });
}

/// The edges must be the polygon's own: each joins neighbours in `vertices`, none is missing, none stands twice. Which
/// way round an edge or the whole list runs does not matter.
void TargetParser::check_edges(const YamlNode& node, std::size_t vertex_count) const {
  const std::string fix = "list the edges as [0, 1], [1, 2], ..., [" + std::to_string(vertex_count - 1) +
                          ", 0], or leave 'edges' out: the vertices' order says it all";
  list(node, "target.edges", "write pairs of vertex numbers, counted from 0: [[0, 1], [1, 2], [2, 0]]");
  std::vector<const YamlNode*> edge_from(vertex_count, nullptr);  // the edge from vertex i to vertex i + 1
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& item = node.items[i];
    const std::string what = indexed_item("target.edges", i);
    if (list(item, what, "write a pair of vertex numbers, such as [0, 1]").size() != 2) {
      fail(ErrorCode::wrong_type, item, what + " must be a pair of vertex numbers, not " + describe(item), fix);
    }
    std::size_t ends[2];
    for (std::size_t k = 0; k < 2; ++k) {
      const double value = number(item.items[k], what);
      if (value < 0 || value >= static_cast<double>(vertex_count) || value != std::floor(value)) {
        fail(ErrorCode::edges_mismatch, item.items[k],
             what + " names vertex " + shortest(value) + ", but the vertices are 0 to " +
                 std::to_string(vertex_count - 1),
             fix);
      }
      ends[k] = static_cast<std::size_t>(value);
    }
    const std::string pair = edge_text(ends[0], ends[1]);
    const bool is_forward = (ends[0] + 1) % vertex_count == ends[1];
    const bool is_backward = (ends[1] + 1) % vertex_count == ends[0];
    if (!is_forward && !is_backward) {
      fail(ErrorCode::edges_mismatch, item,
           "target.edges and target.vertices disagree: edge " + pair + " joins vertices that are not neighbours", fix);
    }
    const YamlNode*& seen = edge_from[is_forward ? ends[0] : ends[1]];
    if (seen != nullptr) fail(ErrorCode::edges_mismatch, item, "target.edges lists the edge " + pair + " twice", fix);
    seen = &item;
  }
  const auto missing = std::find(edge_from.begin(), edge_from.end(), nullptr);
  if (missing != edge_from.end()) {
    const auto from = static_cast<std::size_t>(missing - edge_from.begin());
    fail(
        ErrorCode::edges_mismatch, node,
        "target.edges and target.vertices disagree: edge " + edge_text(from, (from + 1) % vertex_count) + " is missing",
        fix);
  }
}

const YamlNode& TargetParser::require(const YamlNode& map, std::string_view key, const std::string& fix) const {
  if (const YamlNode* node = find(map, key)) return *node;
  fail(ErrorCode::missing_key, map, "target lacks the key '" + std::string(key) + "'", fix);
}

}  // namespace

std::string advice_for_outline(const core::LimitFault& fault, const std::vector<double>& z_m) {
  const bool has_heights = std::any_of(z_m.begin(), z_m.end(), [](double z) { return std::isfinite(z); });
  if (fault.code != ErrorCode::zone_not_simple || !has_heights) return fault.fix;
  return fault.fix + "; a polygon that stands upright, as a wall, cannot be given so: " + kUprightAdvice;
}

std::string heading_text(double heading_deg) {
  for (std::size_t i = 0; i < kHeadings.size(); ++i) {
    if (heading_deg == kHeadingStep * static_cast<double>(i)) return kHeadings[i];
  }
  return shortest(heading_deg) + " degrees from north";
}

MissionTarget parse_target_section(const YamlNode& node, const ValueReader& reader, const MissionFile& mission) {
  return TargetParser(reader, mission).parse(node);
}

}  // namespace vantage::internal::app
