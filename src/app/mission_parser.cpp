// docs/mission-file.md describes every key.
#include "app/mission_parser.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/input_file.h"
#include "app/navigation_section.h"
#include "app/places.h"
#include "app/scene_section.h"
#include "app/schema.h"
#include "app/sensor_section.h"
#include "app/spheres_section.h"
#include "app/value_reader.h"
#include "vantage/error.h"
#include "vantage/input.h"

namespace vantage::internal::app {
namespace {

namespace fs = std::filesystem;

class MissionParser : private ValueReader {
 public:
  explicit MissionParser(const fs::path& file) : ValueReader(file.string()), path_(file) {}

  MissionFile parse(std::string_view text);

 private:
  // Sections.
  void parse_scene(const YamlNode& node);
  void parse_target(const YamlNode& node);
  void parse_sensor(const YamlNode& node);
  void parse_navigation(const YamlNode& node);
  void parse_method(const YamlNode& node);
  void parse_exact(const YamlNode& node);
  void check_edges(const YamlNode& node, std::size_t vertex_count) const;
  void refuse_beside(const YamlNode& node, const char* key, std::initializer_list<const char*> others,
                     const char* fix) const;
  const YamlNode& parse_vertices(const YamlNode& node);
  const YamlNode& parse_parts(const YamlNode& node, const YamlNode& parts);
  const YamlNode& parse_ground_target(const YamlNode& node);
  const YamlNode& parse_point(const YamlNode& node, const YamlNode& point);
  void check_target(const YamlNode& place);

  const YamlNode& require(const YamlNode& map, Section section, std::string_view key, const std::string& fix) const;

  fs::path path_;
  MissionFile mission_;
};

const char* const kVerticesForm =
    "write 'vertices: [[x, y, z], [x, y, z], [x, y, z]]', 3 to 64 points, or 'point: [x, y, z]'";

std::string indexed(const std::string& what, std::size_t index) { return what + "[" + std::to_string(index) + "]"; }

std::string edge_text(std::size_t from, std::size_t to) {
  std::string text = "[";
  text += std::to_string(from);
  text += ", ";
  text += std::to_string(to);
  text += "]";
  return text;
}

MissionFile MissionParser::parse(std::string_view mission_text) {
  const YamlNode root = parse_yaml(mission_text, file());
  check_keys(root, Section::mission, file());
  mission_.file = fs::absolute(path_);

  if (const YamlNode* method = find(root, "method")) parse_method(*method);
  if (const YamlNode* crs = find(root, "crs")) mission_.crs = text(*crs, "crs");
  parse_scene(require(root, Section::mission, "scene", "write 'scene:' and below it, indented, 'mesh: city.obj'"));
  parse_target(require(root, Section::mission, "target",
                       "write 'target:' and below it, indented, 'vertices: [[x, y, z], [x, y, z], [x, y, z]]'"));
  parse_sensor(
      require(root, Section::mission, "sensor", "write 'sensor:' and below it, indented, 'max_range: 100' (metres)"));
  if (const YamlNode* navigation = find(root, "navigation")) parse_navigation(*navigation);
  if (const YamlNode* exact = find(root, "exact")) parse_exact(*exact);
  if (const YamlNode* spheres = find(root, "spheres")) parse_spheres(*spheres, *this, mission_.spheres);
  return std::move(mission_);
}

void MissionParser::parse_scene(const YamlNode& node) {
  // Not made shorter here: "a/../b" is not "b" where a is a symbolic link.
  SceneSection section = parse_scene_section(node, *this, mission_.file.parent_path());
  mission_.scene = std::move(section.source);
  mission_.sea_level_m = section.sea_level_m;
  mission_.places.scene = std::move(section.where);
  mission_.places.terrain = std::move(section.terrain_where);
}

void MissionParser::parse_target(const YamlNode& node) {
  check_keys(node, Section::target, file());
  Target& target = mission_.target;
  if (const YamlNode* name = find(node, "name")) target.name = text(*name, "target.name");
  const YamlNode* point = find(node, "point");
  const bool is_on_ground = find(node, "osm") || find(node, "center");
  const YamlNode* parts = find(node, "parts");
  const YamlNode& place = point          ? parse_point(node, *point)
                          : parts        ? parse_parts(node, *parts)
                          : is_on_ground ? parse_ground_target(node)
                                         : parse_vertices(node);
  if (const YamlNode* offset = find(node, "offset")) target.offset_m = length(*offset, "target.offset");
  if (const YamlNode* front = find(node, "front")) target.front = vector(*front, "target.front");
  check_target(place);
  if (const YamlNode* edges = find(node, "edges")) check_edges(*edges, target.parts[0].size());
}

const YamlNode& MissionParser::parse_parts(const YamlNode& node, const YamlNode& parts) {
  const char* const form = "write a list of polygons: [[[x, y, z], [x, y, z], [x, y, z]], [[x, y, z], ...]]";
  refuse_beside(node, "parts", {"vertices", "edges", "osm", "center"}, "keep 'parts' for several polygons");
  if (list(parts, "target.parts", form).empty())
    fail(ErrorCode::nothing_given, parts, "target.parts is an empty list", form);
  mission_.target.parts.clear();
  for (std::size_t i = 0; i < parts.items.size(); ++i) {
    const std::string what = indexed("target.parts", i);
    std::vector<Vec3>& part = mission_.target.parts.emplace_back();
    list(parts.items[i], what, form);
    for (std::size_t k = 0; k < parts.items[i].items.size(); ++k) {
      part.push_back(vector(parts.items[i].items[k], indexed(what, k)));
    }
  }
  return parts;
}

/// Returns the node that stands for the target in messages.
const YamlNode& MissionParser::parse_vertices(const YamlNode& node) {
  Target& target = mission_.target;
  for (const char* key : {"width", "length", "heading"}) {
    if (const YamlNode* entry = find(node, key)) {
      fail(ErrorCode::not_applicable, *entry,
           std::string("target.") + key + " is of a rectangle, and the target has no 'center'",
           "write 'center: [latitude, longitude]'");
    }
  }
  const YamlNode& vertices = require(node, Section::target, "vertices", kVerticesForm);
  list(vertices, "target.vertices", kVerticesForm);
  for (std::size_t i = 0; i < vertices.items.size(); ++i) {
    target.parts[0].push_back(vector(vertices.items[i], indexed("target.vertices", i)));
  }
  if (target.is_point()) {
    fail(ErrorCode::target_vertex_count, vertices, "a polygon needs at least 3 vertices, this one has 1",
         "add vertices, or write 'point: [x, y, z]' for a single point");
  }
  return vertices;
}

/// Keys that say another thing than `key` does.
void MissionParser::refuse_beside(const YamlNode& node, const char* key, std::initializer_list<const char*> others,
                                  const char* fix) const {
  for (const char* other : others) {
    if (const YamlNode* entry = find(node, other)) {
      fail(ErrorCode::conflicting_keys, *entry, std::string("target has both '") + key + "' and '" + other + "'", fix);
    }
  }
}

/// Where it lies is found out when the scene is read.
const YamlNode& MissionParser::parse_ground_target(const YamlNode& node) {
  GroundTarget& ground = mission_.ground_target.emplace();
  if (const YamlNode* osm = find(node, "osm")) {
    refuse_beside(node, "osm", {"vertices", "edges", "parts", "center", "width", "length", "heading"},
                  "keep 'osm' for an area of the map, or give the target yourself");
    ground.osm = text(*osm, "target.osm");
    if (find(node, "name") == nullptr) mission_.target.name = ground.osm;
    if (mission_.scene.kind != SceneSource::Kind::map) {
      fail(ErrorCode::not_applicable, *osm, "target.osm names an object of a map, and the scene is none",
           "write 'scene: {osm: city.osm.pbf}', or give the target's vertices");
    }
    return *osm;
  }
  const YamlNode& center = *find(node, "center");
  refuse_beside(node, "center", {"vertices", "edges", "parts"},
                "keep 'center' for a rectangle, or 'vertices' for a polygon");
  ground.center_deg = parse_lat_lon(center, *this, "target.center");
  const std::string form = "write 'width: 20' and 'length: 30' (metres), and 'heading: 45' (degrees from north)";
  ground.width_m = positive(require(node, Section::target, "width", form), "target.width");
  ground.length_m = positive(require(node, Section::target, "length", form), "target.length");
  if (const YamlNode* heading = find(node, "heading")) ground.heading_deg = number(*heading, "target.heading");
  return center;
}

const YamlNode& MissionParser::parse_point(const YamlNode& node, const YamlNode& point) {
  refuse_beside(node, "point", {"vertices", "edges", "parts", "osm", "center"},
                "keep 'point' for a single point, or 'vertices' for a polygon");
  mission_.target.parts = {{vector(point, "target.point")}};
  const YamlNode* offset = find(node, "offset");
  if (offset != nullptr && find(node, "front") == nullptr) {
    fail(ErrorCode::conflicting_keys, *offset, "a point without 'front' has no side to be moved towards by 'offset'",
         "move the point itself, or give 'front', the side that is looked at");
  }
  return point;
}

/// The checks that need no scene, told with the place of the vertices or the point.
void MissionParser::check_target(const YamlNode& place) {
  mission_.places.target = place_in(file(), place.place);
  if (!mission_.crs.empty() || mission_.ground_target) return;  // georeference() does it
  with_place(mission_.places.target, [&] {
    for (std::size_t i = 0; i < mission_.target.parts.size(); ++i) make_target_frame(mission_.target, i);
    return 0;
  });
}

/// The edges must be the polygon's own: each joins neighbours in `vertices`, none is missing, none stands twice. Which
/// way round an edge or the whole list runs does not matter.
void MissionParser::check_edges(const YamlNode& node, std::size_t vertex_count) const {
  const std::string fix = "list the edges as [0, 1], [1, 2], ..., [" + std::to_string(vertex_count - 1) +
                          ", 0], or leave 'edges' out: the vertices' order says it all";
  list(node, "target.edges", "write pairs of vertex numbers, counted from 0: [[0, 1], [1, 2], [2, 0]]");
  std::vector<const YamlNode*> edge_from(vertex_count, nullptr);  // the edge from vertex i to vertex i + 1
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& item = node.items[i];
    const std::string what = indexed("target.edges", i);
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

void MissionParser::parse_sensor(const YamlNode& node) {
  SensorSection section = parse_sensor_section(node, *this);
  mission_.sensor = std::move(section.sensor);
  mission_.camera = std::move(section.camera);
  mission_.sun_time = std::move(section.sun_time);
  mission_.vlos = section.vlos;
  if (mission_.vlos && !mission_.target.is_point()) {
    fail(ErrorCode::not_applicable, node, "sensor.vlos is of a pilot, and the target is no point",
         "give the pilot's place: 'target: {point: [x, y, z]}', or 'max_range' instead of 'vlos'");
  }
  mission_.places.sensor = place_in(file(), node.place);
}

void MissionParser::parse_navigation(const YamlNode& node) {
  NavigationSection section = parse_navigation_section(node, *this, mission_.file.parent_path());
  mission_.navigation = std::move(section.navigation);
  mission_.ground = std::move(section.ground);
  mission_.navigation_meshes = std::move(section.meshes);
  mission_.keep_in_files = std::move(section.keep_in_files);
  mission_.keep_out_files = std::move(section.keep_out_files);
  mission_.places.navigation_meshes = std::move(section.places.navigation_meshes);
  mission_.places.keep_in_zones = std::move(section.places.keep_in_zones);
  mission_.places.keep_out_zones = std::move(section.places.keep_out_zones);
  mission_.places.keep_in_files = std::move(section.places.keep_in_files);
  mission_.places.keep_out_files = std::move(section.places.keep_out_files);
  mission_.places.above_ground = std::move(section.places.above_ground);
}

void MissionParser::parse_method(const YamlNode& node) {
  const std::string method = text(node, "method");
  if (method == "spheres") {
    mission_.method = Method::spheres;
  } else if (method != "exact") {
    fail(ErrorCode::unknown_choice, node, "there is no method " + in_quotes(method),
         "write 'method: exact' or 'method: spheres'");
  }
}

void MissionParser::parse_exact(const YamlNode& node) {
  check_keys(node, Section::exact, file());
  if (const YamlNode* tolerance = find(node, "tolerance")) {
    mission_.exact.tolerance_m = positive(*tolerance, "exact.tolerance");
  }
}

const YamlNode& MissionParser::require(const YamlNode& map, Section section, std::string_view key,
                                       const std::string& fix) const {
  if (const YamlNode* node = find(map, key)) return *node;
  fail(ErrorCode::missing_key, map, std::string(section_name(section)) + " lacks the key '" + std::string(key) + "'",
       fix);
}

}  // namespace

MissionFile parse_mission(std::string_view text, const fs::path& file) { return MissionParser(file).parse(text); }

}  // namespace vantage::internal::app
