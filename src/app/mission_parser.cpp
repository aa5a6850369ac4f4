// docs/mission-file.md describes every key.
#include "app/mission_parser.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "app/described_section.h"
#include "app/input_file.h"
#include "app/links_section.h"
#include "app/navigation_section.h"
#include "app/scene_section.h"
#include "app/schema.h"
#include "app/sensor_section.h"
#include "app/target_section.h"
#include "app/value_reader.h"
#include "common/input.h"
#include "core/places.h"
#include "options/spheres_options.h"
#include "request/describe_mission.h"
#include "request/describe_spheres.h"
#include "request/describe_tour.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

namespace fs = std::filesystem;

bool has_volumes_alone(const MissionFile& mission) {
  return std::all_of(mission.targets.begin(), mission.targets.end(), [](const MissionTarget& one) {
    const auto* const file = std::get_if<TargetFile>(&one.source);
    return file && file->is_volume;
  });
}

class MissionParser : private ValueReader {
 public:
  /// `source`: of a scene that is loaded already; null where the text says it.
  MissionParser(const fs::path& file, const SceneSource* source)
      : ValueReader(file.string()), path_(file), source_(source) {}

  MissionFile parse(std::string_view text);
  MissionFile parse_scene_alone(std::string_view text);

 private:
  // Sections.
  void parse_scene(const YamlNode& root);
  void parse_targets(const YamlNode& root);
  void parse_combine(const YamlNode& node);
  void parse_sensor(const YamlNode& node);
  void parse_navigation(const YamlNode& node);
  void parse_method(const YamlNode& node);
  void parse_spheres(const YamlNode& node);
  void parse_work_limit(const YamlNode& node);

  const YamlNode& require(const YamlNode& map, const char* name, std::string_view key, const std::string& fix) const;

  fs::path path_;
  const SceneSource* source_;
  MissionFile mission_;
};

/// What a plan of a flight begins with, which is easily given in a mission's place; empty for other texts.
std::string plan_in(std::string_view text) {
  text.remove_prefix(std::min(text.size(), text.find_first_not_of("\xEF\xBB\xBF \t\r\n")));
  if (text.starts_with("QGC WPL")) return "a list of waypoints";
  if (text.starts_with("PK\x03\x04")) return "a zip archive, as KMZ is";
  if (text.starts_with('<')) return "XML, as GPX and KML are";
  const bool is_json = text.starts_with('{') && text.find("\"fileType\"") != std::string_view::npos;
  return is_json && text.find("\"Plan\"") != std::string_view::npos ? "a plan of QGroundControl" : "";
}

MissionFile MissionParser::parse(std::string_view mission_text) {
  if (const std::string plan = plan_in(mission_text); !plan.empty()) {
    const std::string name = path_.filename().string();
    throw Error(ErrorCode::wrong_type, "the file is " + plan + ", and no mission", file(),
                "to judge a flight give the mission, and then it: vantage check mission.yaml " + name +
                    "; its zones are named in a mission: 'keep_out: [{file: " + name + "}]'");
  }
  const YamlNode root = parse_yaml(mission_text, file());
  check_keys(root, "the mission", file());
  mission_.file = fs::absolute(path_);

  if (const YamlNode* method = find(root, "method")) parse_method(*method);
  if (const YamlNode* crs = find(root, "crs")) mission_.crs = text(*crs, "crs");
  parse_scene(root);
  parse_targets(root);
  // What is only flown through needs no sensor.
  if (find(root, "sensor") || !has_volumes_alone(mission_)) {
    parse_sensor(
        require(root, "the mission", "sensor", "write 'sensor:' and below it, indented, 'max_range: 100' (metres)"));
  }
  if (const YamlNode* navigation = find(root, "navigation")) parse_navigation(*navigation);
  if (const YamlNode* exact = find(root, "exact")) read_section(*exact, *this, mission_.exact);
  if (const YamlNode* spheres = find(root, "spheres")) parse_spheres(*spheres);
  if (const YamlNode* tour = find(root, "tour")) {
    read_section(*tour, *this, mission_.tour.emplace());
    mission_.places.tour = place_in(file(), tour->place);
  }
  if (const YamlNode* links = find(root, "links")) mission_.links = parse_links(*links, *this);
  if (const YamlNode* limit = find(root, "work_limit")) parse_work_limit(*limit);
  return std::move(mission_);
}

MissionFile MissionParser::parse_scene_alone(std::string_view mission_text) {
  const YamlNode root = parse_yaml(mission_text, file());
  check_keys(root, "the mission", file());
  for (const YamlEntry& entry : root.entries) {
    if (entry.key == "scene") continue;
    fail(ErrorCode::not_applicable, entry.value, "'" + entry.key + "' stands where there is a scene alone",
         "leave it out");
  }
  mission_.file = fs::absolute(path_);
  parse_scene(root);
  return std::move(mission_);
}

void MissionParser::parse_scene(const YamlNode& root) {
  if (source_) {
    if (const YamlNode* scene = find(root, "scene")) {
      fail(ErrorCode::conflicting_keys, *scene, "the scene is given already", "leave out 'scene'");
    }
    mission_.scene = *source_;
    return;
  }
  const YamlNode& node =
      require(root, "the mission", "scene", "write 'scene:' and below it, indented, 'mesh: city.obj'");
  // Not made shorter here: "a/../b" is not "b" where a is a symbolic link.
  SceneSection section = parse_scene_section(node, *this, mission_.file.parent_path());
  mission_.scene = std::move(section.source);
  mission_.sea_level_m = section.sea_level_m;
  mission_.places.scene = std::move(section.where);
  mission_.places.terrain = std::move(section.terrain_where);
}

void MissionParser::parse_targets(const YamlNode& root) {
  const YamlNode *one = find(root, "target"), *several = find(root, "targets");
  if (const YamlNode* combine = find(root, "combine")) parse_combine(*combine);
  if (several == nullptr) {
    const YamlNode& node =
        require(root, "the mission", "target",
                "write 'target:' and below it, indented, 'vertices: [[x, y, z], [x, y, z], [x, y, z]]'");
    mission_.targets = {parse_target_section(node, *this, mission_)};
    mission_.places.target = mission_.targets.front().place;
    return;
  }
  if (one) {
    fail(ErrorCode::conflicting_keys, *several, "the mission has both 'target' and 'targets'",
         "keep 'target' for one, 'targets' for a list of them");
  }
  const std::string form = "write a list of targets: [{vertices: [...]}, {point: [x, y, z]}]";
  if (list(*several, "targets", form).empty())
    fail(ErrorCode::nothing_given, *several, "targets is an empty list", form);
  mission_.places.target = place_in(file(), several->place);
  mission_.is_list = true;
  mission_.targets.clear();
  for (std::size_t i = 0; i < several->items.size(); ++i) {
    MissionTarget target = parse_target_section(several->items[i], *this, mission_);
    const bool has_name = find(several->items[i], "name") != nullptr;
    if (!has_name && target.target.name == Target{}.name) target.target.name += " " + std::to_string(i + 1);
    mission_.targets.push_back(std::move(target));
  }
}

void MissionParser::parse_combine(const YamlNode& node) {
  const std::string word = text(node, "combine");
  for (const Combine combine : {Combine::all, Combine::any, Combine::each}) {
    if (word != name_of(combine)) continue;
    mission_.combine = combine;
    return;
  }
  fail(ErrorCode::unknown_choice, node, "targets cannot be combined by " + in_quotes(word),
       "write 'combine: all', 'combine: any' or 'combine: each'");
}

void MissionParser::parse_sensor(const YamlNode& node) {
  SensorSection section = parse_sensor_section(node, *this);
  mission_.sensor = std::move(section.sensor);
  mission_.camera = std::move(section.camera);
  mission_.sun_time = std::move(section.sun_time);
  mission_.vlos = section.vlos;
  const bool is_of_points = std::all_of(mission_.targets.begin(), mission_.targets.end(),
                                        [](const MissionTarget& one) { return one.target.is_point(); });
  if (mission_.vlos && !is_of_points) {
    fail(ErrorCode::not_applicable, node, "sensor.vlos is of a pilot, and the target is no point",
         "give the pilot's place: 'target: {point: [x, y, z]}', or 'max_range' instead of 'vlos'");
  }
  if (mission_.sensor.link && !is_of_points) {
    fail(ErrorCode::not_applicable, node, "sensor.link is of an antenna, and the target is no point",
         "give the antenna's place: 'target: {point: [x, y, z]}', or leave out the link");
  }
  if (mission_.sensor.visible && is_of_points) {
    fail(ErrorCode::not_applicable, *find(node, "visible"),
         "sensor.visible is a part of the target's area, and a point has none",
         "leave 'visible' out, or give a polygon");
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

void MissionParser::parse_spheres(const YamlNode& node) {
  read_section(node, *this, mission_.spheres);
  core::with_place(place_in(file(), node.place), [&] {
    options::check_options(mission_.spheres);
    return 0;
  });
}

void MissionParser::parse_work_limit(const YamlNode& node) {
  mission_.exact.work_limit = number(node, "work_limit");
  if (!(mission_.exact.work_limit > 0)) {
    fail(ErrorCode::value_out_of_range, node,
         "work_limit must be greater than 0, not " + shortest(mission_.exact.work_limit),
         "write how many facets may go through boolean operations: 1.0e+7 is the default");
  }
}

const YamlNode& MissionParser::require(const YamlNode& map, const char* name, std::string_view key,
                                       const std::string& fix) const {
  if (const YamlNode* node = find(map, key)) return *node;
  fail(ErrorCode::missing_key, map, std::string(name) + " lacks the key '" + std::string(key) + "'", fix);
}

}  // namespace

MissionFile parse_mission(std::string_view text, const fs::path& file, const SceneSource* source) {
  return MissionParser(file, source).parse(text);
}

MissionFile parse_scene(std::string_view text, const fs::path& file) {
  return MissionParser(file, nullptr).parse_scene_alone(text);
}

}  // namespace vantage::internal::app
