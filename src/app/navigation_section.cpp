#include "app/navigation_section.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "app/scene_section.h"
#include "app/schema.h"
#include "common/input.h"
#include "core/limit_check.h"
#include "core/zone_check.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

const char* const kZoneForms =
    "write each zone as {min: [x, y, z], max: [x, y, z]}, {polygon: [[x, y], [x, y], [x, y]], z: [low, high]} or "
    "{file: zones.json}";
const char* const kHeightsForm =
    "write 'z: [low, high]' in metres, 'agl: [low, high]' above the ground, or 'heights: any' for a zone without "
    "bounds";

std::string numbered(const std::string& what, std::size_t index) { return what + "[" + std::to_string(index) + "]"; }

class NavigationParser {
 public:
  NavigationParser(const ValueReader& reader, const std::filesystem::path& folder) : reader_(reader), folder_(folder) {}

  NavigationSection parse(const YamlNode& node);

 private:
  /// A list of zones of all kinds: those of files go to a list of their own.
  struct ZoneLists {
    std::vector<Zone>& zones;
    std::vector<ZoneFile>& files;
    std::vector<std::string>&zone_places, &file_places;
  };

  void parse_altitude(const YamlNode& node);
  void parse_ground(const YamlNode& node);
  std::array<double, 2> heights(const YamlNode& node, const std::string& what, const std::string& form) const;
  const YamlNode* kept(const YamlNode& node) const;
  void add_zones(const YamlNode& node, const std::string& what, const ZoneLists& lists) const;
  Box box(const YamlNode& node, const std::string& what) const;
  void refuse(const std::optional<core::LimitFault>& fault, const YamlNode& node, const std::string& what) const;
  Zone polygon(const YamlNode& node, const std::string& what) const;
  ZoneFile file(const YamlNode& node, const YamlNode& named, const std::string& what) const;
  /// Nothing where the node does not say.
  struct Heights {
    std::optional<std::array<double, 2>> z_m, agl_m;
    bool are_any = false;
  };
  Heights heights(const YamlNode& node, const std::string& what) const;
  std::array<double, 2> zone_heights(const YamlNode& node, const std::string& what) const;
  bool measures_from_ground() const;
  void add_mesh(const YamlNode& node);
  void refuse_beside(const YamlNode& node, const char* key, std::initializer_list<const char*> others) const;
  const YamlNode& require(const YamlNode& map, const char* name, const char* key, const std::string& fix) const;

  const ValueReader& reader_;
  const std::filesystem::path& folder_;
  NavigationSection result_;
};

NavigationSection NavigationParser::parse(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::null) return {};  // the heading alone: no limits
  check_keys(node, "navigation", reader_.file());
  Navigation& navigation = result_.navigation;
  if (const YamlNode* altitude = find(node, "altitude")) parse_altitude(*altitude);
  if (const YamlNode* keep_in = kept(node)) {
    const std::string what = keep_in == find(node, "boxes") ? "navigation.boxes" : "navigation.keep_in";
    add_zones(*keep_in, what,
              {navigation.keep_in, result_.keep_in_files, result_.places.keep_in_zones, result_.places.keep_in_files});
    // "Cut to the union of no zones" would leave nothing, and "no limit" is not what the key says either.
    if (keep_in->items.empty()) {
      reader_.fail(ErrorCode::nothing_given, *keep_in, what + " is an empty list",
                   "give at least one box or zone, or leave the key out for no limit");
    }
  }
  if (const YamlNode* keep_out = find(node, "keep_out")) {
    add_zones(
        *keep_out, "navigation.keep_out",
        {navigation.keep_out, result_.keep_out_files, result_.places.keep_out_zones, result_.places.keep_out_files});
  }
  if (const YamlNode* clearance = find(node, "clearance")) {
    navigation.clearance = {reader_.length(*clearance, "navigation.clearance"), {}};
    refuse(core::fault_of_clearance(navigation.clearance->distance_m), *clearance, "navigation.clearance");
  }
  if (result_.places.above_ground.empty()) result_.places.above_ground = place_in(reader_.file(), node.place);
  if (const YamlNode* ground = find(node, "ground")) parse_ground(*ground);
  const YamlNode* meshes = find(node, "meshes");
  if (meshes == nullptr) return std::move(result_);
  for (const YamlNode& item :
       reader_.list(*meshes, "navigation.meshes", "write a list of mesh files: [airspace.ply]")) {
    if (item.kind == YamlNode::Kind::map) {
      check_keys(item, "an entry of navigation.meshes", reader_.file());
      add_mesh(item);
      continue;
    }
    YamlNode map;  // the short form, a path alone
    map.kind = YamlNode::Kind::map;
    map.place = item.place;
    map.entries.push_back({"mesh", item.place, item});
    add_mesh(map);
  }
  return std::move(result_);
}

/// `boxes` is the old name of `keep_in`.
const YamlNode* NavigationParser::kept(const YamlNode& node) const {
  const YamlNode* keep_in = find(node, "keep_in");
  const YamlNode* boxes = find(node, "boxes");
  if (keep_in != nullptr && boxes != nullptr) {
    reader_.fail(ErrorCode::conflicting_keys, *boxes, "navigation.boxes is the old name of navigation.keep_in",
                 "put all entries into 'keep_in'");
  }
  return keep_in != nullptr ? keep_in : boxes;
}

void NavigationParser::parse_altitude(const YamlNode& node) {
  Navigation& navigation = result_.navigation;
  const auto altitude = [&](const YamlNode& band, const std::string& what, const std::string& form) {
    const auto [low, high] = heights(band, what, form);
    navigation.altitude = {low, high};
  };
  if (node.kind != YamlNode::Kind::map) {
    return altitude(
        node, "navigation.altitude",
        "write the lowest and the highest altitude in metres: [20, 120]; or {agl: [20, 120]} above the ground");
  }
  check_keys(node, "navigation.altitude", reader_.file());
  const YamlNode *agl = find(node, "agl"), *z = find(node, "z");
  if (!agl && !z) {
    reader_.fail(
        ErrorCode::nothing_given, node, "navigation.altitude says nothing",
        "write {agl: [20, 120]} for heights above the ground, {z: [20, 120]} for heights in the scene, or both");
  }
  if (z) altitude(*z, "navigation.altitude.z", "write the lowest and the highest z in metres: [20, 120]");
  if (!agl) return;
  const auto [low, high] = heights(*agl, "navigation.altitude.agl",
                                   "write the lowest and the highest height above the ground in metres: [20, 120]");
  navigation.above_ground = {low, high, {}};
  result_.places.above_ground = place_in(reader_.file(), agl->place);
}

/// Also with zones of files: whether these are measured from the ground they say themselves.
bool NavigationParser::measures_from_ground() const {
  const Navigation& navigation = result_.navigation;
  const auto has_agl = [](const Zone& zone) { return zone.above_ground.has_value(); };
  return navigation.above_ground || !result_.keep_in_files.empty() || !result_.keep_out_files.empty() ||
         std::any_of(navigation.keep_in.begin(), navigation.keep_in.end(), has_agl) ||
         std::any_of(navigation.keep_out.begin(), navigation.keep_out.end(), has_agl);
}

void NavigationParser::parse_ground(const YamlNode& node) {
  const bool is_number =
      parse_length(node.text).fault == NumberFault::none && node.kind == YamlNode::Kind::scalar && !node.is_quoted;
  if (!measures_from_ground() && (is_number || !result_.navigation.clearance)) {
    reader_.fail(ErrorCode::not_applicable, node, "navigation.ground is given, and no limit above the ground",
                 "write 'altitude: {agl: [20, 120]}', or leave 'ground' out");
  }
  GroundSource& ground = result_.ground.emplace();
  if (is_number) {
    ground.plane_z_m = reader_.length(node, "navigation.ground");
  } else {
    ground.object = reader_.text(node, "navigation.ground");
  }
  result_.places.above_ground = place_in(reader_.file(), node.place);
}

std::array<double, 2> NavigationParser::heights(const YamlNode& node, const std::string& what,
                                                const std::string& form) const {
  if (reader_.list(node, what, form).size() != 2) {
    reader_.fail(ErrorCode::wrong_type, node, what + " must be two numbers, not " + describe(node), form);
  }
  const double low = reader_.length(node.items[0], what + "[0]"), high = reader_.length(node.items[1], what + "[1]");
  refuse(core::fault_of_band(low, high), node, what);
  return {low, high};
}

/// `what`: the limit.
void NavigationParser::refuse(const std::optional<core::LimitFault>& fault, const YamlNode& node,
                              const std::string& what) const {
  if (fault) reader_.fail(fault->code, node, problem_of(what, *fault), fault->fix);
}

void NavigationParser::add_zones(const YamlNode& node, const std::string& what, const ZoneLists& lists) const {
  reader_.list(node, what, std::string("write a list of zones; ") + kZoneForms);
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& item = node.items[i];
    const std::string name = numbered(what, i);
    if (item.kind != YamlNode::Kind::map) {
      reader_.fail(ErrorCode::wrong_type, item, name + " must be a mapping, not " + describe(item), kZoneForms);
    }
    check_keys(item, "a zone", reader_.file());
    if (const YamlNode* named = find(item, "file")) {
      lists.files.push_back(file(item, *named, name));
      lists.file_places.push_back(place_in(reader_.file(), named->place));
      continue;
    }
    lists.zones.push_back(find(item, "polygon") != nullptr ? polygon(item, name) : Zone(box(item, name)));
    lists.zones.back().name = std::to_string(i);
    lists.zone_places.push_back(place_in(reader_.file(), item.place));
  }
}

/// Keys that belong to another kind of zone than `key` does.
void NavigationParser::refuse_beside(const YamlNode& node, const char* key,
                                     std::initializer_list<const char*> others) const {
  for (const char* other : others) {
    if (const YamlNode* entry = find(node, other)) {
      reader_.fail(ErrorCode::conflicting_keys, *entry,
                   std::string("'") + other + "' and '" + key + "' are of different kinds of zones", kZoneForms);
    }
  }
}

Box NavigationParser::box(const YamlNode& node, const std::string& what) const {
  const YamlNode& min = require(node, "a zone", "min", kZoneForms);
  const YamlNode& max = require(node, "a zone", "max", kZoneForms);
  refuse_beside(node, "min", {"holes", "z", "heights", "skip"});
  Box result;
  result.min = reader_.vector(min, what + ".min");
  result.max = reader_.vector(max, what + ".max");
  refuse(core::fault_of(result), node, what);
  return result;
}

Zone NavigationParser::polygon(const YamlNode& node, const std::string& what) const {
  refuse_beside(node, "polygon", {"min", "max", "skip"});
  Zone zone;
  zone.outer = reader_.ring(*find(node, "polygon"), what + ".polygon");
  if (const YamlNode* holes = find(node, "holes")) {
    const std::string name = what + ".holes";
    reader_.list(*holes, name, "write a list of polygons: [[[x, y], [x, y], [x, y]]]");
    for (std::size_t i = 0; i < holes->items.size(); ++i) {
      zone.holes.push_back(reader_.ring(holes->items[i], numbered(name, i)));
    }
  }
  const Heights given = heights(node, what);
  if (!given.z_m && !given.agl_m && !given.are_any) {
    reader_.fail(ErrorCode::missing_key, node, what + " does not say between which heights it lies", kHeightsForm);
  }
  if (given.z_m) {
    zone.min_z_m = (*given.z_m)[0];
    zone.max_z_m = (*given.z_m)[1];
  }
  if (given.agl_m) zone.above_ground = {(*given.agl_m)[0], (*given.agl_m)[1], {}};
  refuse(core::fault_of(zone), node, what);
  return zone;
}

NavigationParser::Heights NavigationParser::heights(const YamlNode& node, const std::string& what) const {
  const YamlNode *z = find(node, "z"), *agl = find(node, "agl");
  Heights result;
  if (const YamlNode* word_node = find(node, "heights")) {
    const std::string word = reader_.text(*word_node, what + ".heights");
    if (word != "any") {
      reader_.fail(ErrorCode::unknown_choice, *word_node, what + ".heights cannot be " + in_quotes(word), kHeightsForm);
    }
    if (z != nullptr || agl != nullptr) {
      reader_.fail(ErrorCode::conflicting_keys, *word_node,
                   what + " has both '" + (z != nullptr ? "z" : "agl") + "' and 'heights: any'", "keep one of them");
    }
    result.are_any = true;
  }
  if (z != nullptr) result.z_m = zone_heights(*z, what + ".z");
  if (agl != nullptr) result.agl_m = zone_heights(*agl, what + ".agl");
  return result;
}

std::array<double, 2> NavigationParser::zone_heights(const YamlNode& node, const std::string& what) const {
  if (reader_.list(node, what, kHeightsForm).size() != 2) {
    reader_.fail(ErrorCode::wrong_type, node, what + " must be two numbers, not " + describe(node), kHeightsForm);
  }
  return {reader_.length(node.items[0], what + "[0]"), reader_.length(node.items[1], what + "[1]")};
}

ZoneFile NavigationParser::file(const YamlNode& node, const YamlNode& named, const std::string& what) const {
  refuse_beside(node, "file", {"min", "max", "polygon", "holes"});
  ZoneFile result;
  result.name = reader_.text(named, what + ".file");
  result.file = folder_ / result.name;
  const Heights given = heights(node, what);
  result.z_m = given.z_m;
  result.agl_m = given.agl_m;
  result.any_height = given.are_any;
  if (const YamlNode* skip = find(node, "skip")) result.skip = reader_.flag(*skip, what + ".skip");
  if (given.z_m) refuse(core::fault_of_band((*given.z_m)[0], (*given.z_m)[1]), node, what + ".z");
  if (given.agl_m) refuse(core::fault_of_band((*given.agl_m)[0], (*given.agl_m)[1]), node, what + ".agl");
  return result;
}

void NavigationParser::add_mesh(const YamlNode& node) {
  const YamlNode& mesh = require(node, "an entry of navigation.meshes", "mesh",
                                 "write 'mesh: city.obj'; the path starts from the mission file");
  NavigationMeshFile named;
  named.name = reader_.text(mesh, "navigation.meshes.mesh");
  named.file = folder_ / named.name;
  if (const YamlNode* up = find(node, "up")) named.up = parse_up_axis(*up, reader_, "navigation.meshes.up");
  if (const YamlNode* scale = find(node, "scale"))
    named.scale = reader_.positive_length(*scale, "navigation.meshes.scale");
  result_.meshes.push_back(std::move(named));
  result_.places.navigation_meshes.push_back(place_in(reader_.file(), mesh.place));
}

const YamlNode& NavigationParser::require(const YamlNode& map, const char* name, const char* key,
                                          const std::string& fix) const {
  if (const YamlNode* node = find(map, key)) return *node;
  reader_.fail(ErrorCode::missing_key, map, std::string(name) + " lacks the key '" + std::string(key) + "'", fix);
}

}  // namespace

NavigationSection parse_navigation_section(const YamlNode& node, const ValueReader& reader,
                                           const std::filesystem::path& folder) {
  return NavigationParser(reader, folder).parse(node);
}

}  // namespace vantage::internal::app
