#include "app/scene_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "app/schema.h"
#include "common/input.h"
#include "core/places.h"
#include "vantage/city.h"

namespace vantage::internal::app {
namespace {

using Kind = SceneSource::Kind;

const char* const kLatLonForm = "write degrees, the latitude first: [48.1374, 11.5755]";

class SceneParser {
 public:
  SceneParser(const YamlNode& node, const ValueReader& reader, const std::filesystem::path& folder)
      : node_(node), reader_(reader), folder_(folder) {}

  SceneSection parse() {
    check_keys(node_, "scene", reader_.file());
    choose_kind();
    parse_mesh_options();
    parse_region();
    parse_ground();
    parse_city();
    parse_frame();
    parse_missing();
    if (const YamlNode* credit = find(node_, "attribution")) {
      section_.source.attribution = reader_.text(*credit, "scene.attribution");
    }
    if (const YamlNode* sea = find(node_, "sea_level")) {
      section_.sea_level_m = reader_.length(*sea, "scene.sea_level");
      section_.source.terrain_options.sea_level_z_m = section_.sea_level_m;
    }
    return std::move(section_);
  }

 private:
  /// Which of the four kinds of file is named.
  void choose_kind() {
    const YamlNode* named = nullptr;
    const char* first = nullptr;
    for (const auto& [key, kind] :
         {std::pair{"mesh", Kind::mesh}, {"osm", Kind::map}, {"raster", Kind::raster}, {"tiles", Kind::tileset}}) {
      const YamlNode* const entry = find(node_, key);
      if (!entry) continue;
      if (named) {
        reader_.fail(ErrorCode::conflicting_keys, *entry,
                     std::string("scene has both '") + first + "' and '" + key + "'", "keep one of them");
      }
      named = entry;
      first = key;
      section_.source.kind = kind;
      const std::filesystem::path file = reader_.text(*entry, std::string("scene.") + key);
      section_.source.file = kind == Kind::tileset && is_web_address(file) ? file : folder_ / file;
      section_.where = place_in(reader_.file(), entry->place);
    }
    if (!named) {
      reader_.fail(
          ErrorCode::missing_key, node_, "scene lacks the key 'mesh'",
          "write 'mesh: city.obj', 'osm: city.osm.pbf', 'raster: dsm.tif' or 'tiles: tileset.json'; the path starts "
          "from the mission file");
    }
  }

  /// The value of `key`, which only these kinds of scene know.
  const YamlNode* take(const char* key, std::initializer_list<Kind> kinds, const char* what) const {
    const YamlNode* const entry = find(node_, key);
    if (!entry || std::find(kinds.begin(), kinds.end(), section_.source.kind) != kinds.end()) return entry;
    reader_.fail(ErrorCode::not_applicable, *entry,
                 std::string("scene.") + key + " is for " + what + ", and this scene is none", "leave it out");
  }

  void parse_mesh_options() {
    SceneReadOptions& mesh = section_.source.mesh;
    if (const YamlNode* up = take("up", {Kind::mesh}, "meshes")) mesh.up = parse_up_axis(*up, reader_, "scene.up");
    if (const YamlNode* scale = take("scale", {Kind::mesh}, "meshes"))
      mesh.scale = reader_.positive_length(*scale, "scene.scale");
    if (const YamlNode* lod = take("lod", {Kind::mesh}, "CityJSON files")) mesh.lod = reader_.text(*lod, "scene.lod");
    if (const YamlNode* crs = find(node_, "crs")) {
      SceneSource& source = section_.source;
      if (source.kind == Kind::map && !find(node_, "terrain")) {
        reader_.fail(ErrorCode::not_applicable, *crs, "scene.crs of a map is that of its terrain, and there is none",
                     "leave it out, or give 'terrain: FILE'");
      }
      mesh.crs = source.raster.crs = source.tileset.crs = source.city.terrain_crs = reader_.text(*crs, "scene.crs");
    }
    if (const YamlNode* origin = take("origin", {Kind::mesh, Kind::raster}, "meshes, CityJSON files and rasters")) {
      mesh.origin_deg = section_.source.raster.origin_deg = parse_lat_lon(*origin, reader_, "scene.origin");
    }
  }

  void parse_region() {
    CityRegion region;
    const char* const what = "maps, rasters and tilesets";
    const YamlNode* const center = take("center", {Kind::map, Kind::raster, Kind::tileset}, what);
    const YamlNode* const radius = take("radius", {Kind::map, Kind::raster, Kind::tileset}, what);
    const YamlNode* const box = take("bbox", {Kind::map, Kind::raster}, "maps and rasters");
    if (center) region.center_deg = parse_lat_lon(*center, reader_, "scene.center");
    if (radius) region.radius_m = reader_.positive_length(*radius, "scene.radius");
    if (center && !radius) {
      reader_.fail(ErrorCode::missing_key, *center, "scene has a 'center' without a 'radius'",
                   "add 'radius: 600' (metres)");
    }
    if (radius && !center)
      reader_.fail(ErrorCode::missing_key, *radius, "scene has a 'radius' without a 'center'", kLatLonForm);
    if (box) {
      if (center)
        reader_.fail(ErrorCode::conflicting_keys, *box, "scene has both 'center' and 'bbox'", "keep one of them");
      region.bbox_deg = four_numbers(*box, "scene.bbox", "write degrees: [west, south, east, north]");
    }
    section_.source.city.region = region;
    section_.source.raster.region = {region.center_deg, region.radius_m, region.bbox_deg, {}};
    TilesetOptions& tileset = section_.source.tileset;
    if (center) {
      tileset.center_deg = region.center_deg;
      tileset.radius_m = region.radius_m;
    }
    if (const YamlNode* ground = take("ground", {Kind::tileset}, "tilesets")) {
      tileset.ground_m = reader_.length(*ground, "scene.ground");
    }
    if (const YamlNode* detail = take("detail", {Kind::tileset}, "tilesets")) {
      tileset.detail_m = reader_.length(*detail, "scene.detail");
    }
  }

  void parse_ground() {
    SceneSource& source = section_.source;
    if (const YamlNode* terrain = take("terrain", {Kind::map, Kind::tileset}, "maps and tilesets")) {
      if (source.tileset.ground_m) {
        reader_.fail(ErrorCode::conflicting_keys, *terrain, "scene has both 'ground' and 'terrain'",
                     "keep one of them");
      }
      (source.kind == Kind::tileset ? source.terrain : source.city.terrain) =
          folder_ / reader_.text(*terrain, "scene.terrain");
      section_.terrain_where = place_in(reader_.file(), terrain->place);
    }
    if (const YamlNode* error = take("error", {Kind::map, Kind::raster, Kind::tileset}, "terrain and rasters")) {
      source.city.terrain_error_m = source.raster.max_error_m = source.terrain_options.max_error_m =
          reader_.positive_length(*error, "scene.error");
    }
    source.terrain_options.reach_m = source.tileset.radius_m.value_or(0);
    HeightOptions heights;
    if (const YamlNode* unit = take_of_heights("z_unit")) {
      heights.unit = height_unit(reader_.text(*unit, "scene.z_unit"), place_in(reader_.file(), unit->place));
    }
    if (const YamlNode* filled = take_of_heights("void")) heights.void_m = reader_.length(*filled, "scene.void");
    source.city.terrain_heights = source.raster.heights = source.terrain_options.heights = heights;
  }

  /// The value of a key that only rasters know, be they the scene or its ground.
  const YamlNode* take_of_heights(const char* key) const {
    const YamlNode* const entry = take(key, {Kind::map, Kind::raster, Kind::tileset}, "terrain and rasters");
    if (!entry || section_.source.kind == Kind::raster || !terrain_of(section_.source).empty()) return entry;
    reader_.fail(ErrorCode::not_applicable, *entry, std::string("scene.") + key + " is for terrain, and there is none",
                 "leave it out, or give 'terrain: FILE'");
  }

  void parse_city() {
    CityOptions& city = section_.source.city;
    if (const YamlNode* without = take("without", {Kind::map}, "maps")) {
      for (const YamlNode& kind : reader_.list(*without, "scene.without", "write a list: [trees, walls]")) {
        leave_out(city.occluders, reader_.text(kind, "scene.without"), place_in(reader_.file(), kind.place));
      }
    }
    if (const YamlNode* partial = take("partial", {Kind::map}, "maps")) {
      city.partial = reader_.flag(*partial, "scene.partial");
    }
    const YamlNode* const defaults = take("defaults", {Kind::map}, "maps");
    if (!defaults) return;
    if (defaults->kind != YamlNode::Kind::map) {
      reader_.fail(ErrorCode::wrong_type, *defaults, "scene.defaults must be a mapping, not " + describe(*defaults),
                   "write {level: 3.2, levels.house: 2}");
    }
    for (const YamlEntry& entry : defaults->entries) {
      set_city_option(city, entry.key, reader_.number(entry.value, "scene.defaults." + entry.key),
                      place_in(reader_.file(), entry.place));
    }
  }

  void parse_missing() {
    const YamlNode* const node = find(node_, "missing");
    if (!node) return;
    const std::string word = reader_.text(*node, "scene.missing");
    for (const MissingPolicy policy : {MissingPolicy::block, MissingPolicy::warn, MissingPolicy::refuse}) {
      if (word == name_of(policy)) return set_missing(section_.source, policy);
    }
    reader_.fail(ErrorCode::unknown_choice, *node,
                 "scene.missing must be block, warn or refuse, not " + in_quotes(word),
                 "write block, so that stand-ins hold the place of what cannot be built");
  }

  void parse_frame() {
    const YamlNode* const node = take("frame", {Kind::map}, "maps");
    if (!node) return;
    check_keys(*node, "scene.frame", reader_.file());
    const auto needed = [&](const char* key) -> const YamlNode& {
      if (const YamlNode* const entry = find(*node, key)) return *entry;
      reader_.fail(ErrorCode::missing_key, *node, std::string("scene.frame lacks the key '") + key + "'",
                   "write what a plan of tiles says: {origin: [latitude, longitude], ground: [west, south, east, "
                   "north], reach: metres}");
    };
    CityFrame& frame = section_.source.city.frame.emplace();
    frame.origin_deg = parse_lat_lon(needed("origin"), reader_, "scene.frame.origin");
    frame.ground_m = four_numbers(needed("ground"), "scene.frame.ground", "write metres: [west, south, east, north]");
    frame.reach_m = reader_.number(needed("reach"), "scene.frame.reach");
  }

  std::array<double, 4> four_numbers(const YamlNode& node, const std::string& what, const char* form) const {
    if (reader_.list(node, what, form).size() != 4) {
      reader_.fail(ErrorCode::wrong_type, node, what + " must be four numbers, not " + describe(node), form);
    }
    std::array<double, 4> numbers{};
    for (std::size_t i = 0; i < 4; ++i) numbers[i] = reader_.number(node.items[i], what);
    return numbers;
  }

  const YamlNode& node_;
  const ValueReader& reader_;
  const std::filesystem::path& folder_;
  SceneSection section_;
};

}  // namespace

SceneSection parse_scene_section(const YamlNode& node, const ValueReader& reader, const std::filesystem::path& folder) {
  return SceneParser(node, reader, folder).parse();
}

UpAxis parse_up_axis(const YamlNode& node, const ValueReader& reader, const std::string& what) {
  const std::string axis = reader.text(node, what);
  if (axis == "y") return UpAxis::y;
  if (axis == "z") return UpAxis::z;
  reader.fail(ErrorCode::unknown_choice, node, what + " must be y or z, not " + in_quotes(axis),
              "write the axis of the file that points up: y or z");
}

std::array<double, 2> parse_lat_lon(const YamlNode& node, const ValueReader& reader, const std::string& what) {
  if (reader.list(node, what, kLatLonForm).size() != 2) {
    reader.fail(ErrorCode::wrong_type, node, what + " must be two numbers, not " + describe(node), kLatLonForm);
  }
  const double latitude = reader.angle(node.items[0], what), longitude = reader.angle(node.items[1], what);
  if (std::abs(latitude) > 90 || std::abs(longitude) > 180) {
    const bool is_swapped = std::abs(longitude) <= 90 && std::abs(latitude) <= 180;
    reader.fail(ErrorCode::not_on_earth, node,
                what + " is not a place: latitude " + shortest(latitude) + ", longitude " + shortest(longitude),
                is_swapped ? "write the latitude first: [" + shortest(longitude) + ", " + shortest(latitude) + "]"
                           : std::string(kLatLonForm));
  }
  return {latitude, longitude};
}

}  // namespace vantage::internal::app
