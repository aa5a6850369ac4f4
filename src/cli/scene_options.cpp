#include "cli/scene_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "cli/command.h"
#include "common/input.h"
#include "common/shown_address.h"
#include "vantage/city.h"
#include "vantage/error.h"

namespace vantage::cli {
namespace {

[[noreturn]] void fail(ErrorCode code, const std::string& problem, const std::string& option, const std::string& fix) {
  throw Error(code, problem, "command line, " + option, fix);
}

template <std::size_t N>
std::array<double, N> numbers(const std::string& text, const std::string& option, const std::string& form) {
  std::array<double, N> values{};
  const std::vector<std::string_view> parts = split_at_commas(text);
  bool is_good = parts.size() == N;
  for (std::size_t i = 0; i < N && is_good; ++i) {
    const ParsedNumber parsed = parse_number(parts[i]);
    values[i] = parsed.value;
    is_good = parsed.fault == NumberFault::none;
  }
  if (!is_good) {
    fail(ErrorCode::value_syntax, in_quotes(text).append(" is not ").append(form), option,
         "write numbers joined by commas, in quotes if there are blanks: " + form);
  }
  return values;
}

CityRegion region_of(const SceneOptions& options) {
  CityRegion region;
  if (!options.center.empty()) region.center_deg = numbers<2>(options.center, "--center", "latitude,longitude");
  if (!options.bbox.empty()) region.bbox_deg = numbers<4>(options.bbox, "--bbox", "west,south,east,north");
  if (!options.radius.empty()) region.radius_m = positive_length_option("--radius", options.radius);
  if (region.center_deg && options.radius.empty())
    fail(ErrorCode::missing_key, "--center without --radius", "--center", "add --radius METRES");
  return region;
}

/// "level=3.2".
void apply(const std::string& setting, CityOptions& options) {
  const std::string where = "--set " + setting;
  const std::size_t sign = setting.find('=');
  if (sign == std::string::npos)
    fail(ErrorCode::value_syntax, "'" + setting + "' sets nothing", where, "write --set NAME=VALUE, such as level=3.2");
  set_city_option(options, setting.substr(0, sign), positive_option(where, setting.substr(sign + 1)),
                  "command line, " + where);
}

std::array<int, 4> window_of(const std::string& text) {
  std::array<int, 4> window{};
  const std::array<double, 4> values = numbers<4>(text, "--window", "column,row,columns,rows");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] != std::floor(values[i]) || std::abs(values[i]) > 1e9) {
      fail(ErrorCode::value_syntax, "'" + text + "' is not a window", "--window",
           "give whole numbers: column,row,columns,rows");
    }
    window[i] = static_cast<int>(values[i]);
  }
  return window;
}

SceneSource source_of(const SceneOptions& options) {
  SceneSource source;
  source.file = options.input;
  source.kind = source_kind(options.input);
  source.city.region = region_of(options);
  (source.kind == SceneSource::Kind::tileset ? source.terrain : source.city.terrain) = options.terrain;
  for (const std::string& setting : options.settings) apply(setting, source.city);
  for (const std::string& kind : options.without) leave_out(source.city.occluders, kind, "--without " + kind);
  const CityRegion& region = source.city.region;
  source.raster.region = {region.center_deg, region.radius_m, region.bbox_deg, {}};
  source.tileset.center_deg = region.center_deg;
  if (region.center_deg) source.tileset.radius_m = region.radius_m;
  source.tileset.crs = options.crs;
  if (!options.ground.empty()) source.tileset.ground_m = length_option("--ground", options.ground);
  source.terrain_options.reach_m = source.tileset.radius_m.value_or(0);
  if (!options.sea_level.empty())
    source.terrain_options.sea_level_z_m = length_option("--sea-level", options.sea_level);
  if (!options.detail.empty()) source.tileset.detail_m = length_option("--detail", options.detail);
  if (!options.window.empty()) source.raster.region.pixels = window_of(options.window);
  if (!options.error.empty()) {
    source.city.terrain_error_m = source.raster.max_error_m = source.terrain_options.max_error_m =
        positive_length_option("--error", options.error);
  }
  for (const MissingPolicy policy : {MissingPolicy::block, MissingPolicy::warn, MissingPolicy::refuse}) {
    if (options.missing == name_of(policy)) set_missing(source, policy);
  }
  source.mesh.up = options.up == "y" ? UpAxis::y : UpAxis::z;
  source.mesh.scale = positive_length_option("--scale", options.scale);
  source.mesh.lod = options.lod;
  source.mesh.crs = source.raster.crs = source.city.terrain_crs = options.crs;
  HeightOptions heights;
  if (!options.z_unit.empty()) heights.unit = height_unit(options.z_unit, "command line, --z-unit");
  if (!options.void_height.empty()) heights.void_m = length_option("--void", options.void_height);
  source.raster.heights = source.city.terrain_heights = source.terrain_options.heights = heights;
  source.city.partial = options.partial;
  if (!options.origin.empty()) {
    source.mesh.origin_deg = source.raster.origin_deg = numbers<2>(options.origin, "--origin", "latitude,longitude");
  }
  return source;
}

/// Options that mean nothing for this kind of file are more likely a slip than a wish.
void check_options(const SceneOptions& options, SceneSource::Kind kind) {
  using Kind = SceneSource::Kind;
  const auto only_for = [&](bool is_given, const char* option, std::initializer_list<Kind> kinds, const char* what) {
    if (!is_given || std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) return;
    fail(ErrorCode::not_applicable,
         std::string(option) + " is for " + what + ", and " + shown_address(options.input).string() + " is none",
         option, "leave it out");
  };
  only_for(!options.center.empty(), "--center", {Kind::map, Kind::raster, Kind::tileset}, "maps, rasters and tilesets");
  only_for(!options.detail.empty(), "--detail", {Kind::tileset}, "tilesets");
  only_for(!options.ground.empty(), "--ground", {Kind::tileset}, "tilesets");
  only_for(!options.bbox.empty(), "--bbox", {Kind::map, Kind::raster}, "maps and rasters");
  only_for(!options.error.empty(), "--error", {Kind::map, Kind::raster, Kind::tileset}, "terrain and rasters");
  only_for(!options.terrain.empty(), "--terrain", {Kind::map, Kind::tileset}, "maps and tilesets");
  only_for(!options.sea_level.empty(), "--sea-level", {Kind::tileset}, "tilesets with terrain");
  if (!options.ground.empty() && !options.terrain.empty()) {
    fail(ErrorCode::conflicting_keys, "--ground and --terrain cannot be combined", "--terrain", "give one of the two");
  }
  only_for(!options.settings.empty(), "--set", {Kind::map}, "maps");
  only_for(!options.without.empty(), "--without", {Kind::map}, "maps");
  only_for(options.up == "y", "--up", {Kind::mesh}, "meshes");
  only_for(options.scale != "1", "--scale", {Kind::mesh}, "meshes");
  only_for(!options.lod.empty(), "--lod", {Kind::mesh}, "CityJSON files");
  const bool is_terrain = !options.terrain.empty();
  only_for(!options.crs.empty() && !is_terrain, "--crs", {Kind::mesh, Kind::raster, Kind::tileset},
           "meshes, rasters, tilesets and terrain");
  only_for(!options.z_unit.empty() && !is_terrain, "--z-unit", {Kind::raster}, "rasters and terrain");
  only_for(!options.void_height.empty() && !is_terrain, "--void", {Kind::raster}, "rasters and terrain");
  only_for(options.partial, "--partial", {Kind::map}, "maps");
  only_for(!options.origin.empty(), "--origin", {Kind::mesh, Kind::raster}, "meshes, CityJSON files and rasters");
  only_for(!options.window.empty(), "--window", {Kind::raster}, "rasters");
}

}  // namespace

SceneSource scene_source(const SceneOptions& options, const std::string& what) {
  if (!is_web_address(options.input)) check_readable(options.input, what, "");
  SceneSource source = source_of(options);
  check_options(options, source.kind);
  return source;
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--center", options.center, "Centre of the area, degrees (WGS 84); with --radius")
      ->option_text("LAT,LON");
  command
      .add_option("--radius", options.radius, "Radius of the area; an object that is partly inside is built completely")
      ->option_text("METRES");
  command.add_option("--bbox", options.bbox, "The area as a box, degrees")->option_text("W,S,E,N");
  command.add_option("--window", options.window, "Part of a raster, in posts")->option_text("COLUMN,ROW,COLUMNS,ROWS");
  command.add_option("--terrain", options.terrain, "Ground heights: GeoTIFF, .hgt or .hgt.zip (default: a plane)")
      ->option_text("FILE");
  command
      .add_option(
          "--sea-level", options.sea_level,
          "z of the mean sea level in the scene, from which --terrain of a tileset is measured: on the earth how "
          "high the geoid lies above the ellipsoid there")
      ->option_text("Z");
  command
      .add_option("--error", options.error,
                  "How far the ground may lie above the raster at its posts (0.5; of a raster alone 0.25)")
      ->option_text("METRES");
  command
      .add_option("--z-unit", options.z_unit, "What the heights of a raster or terrain are in (default: as it says)")
      ->option_text("m|ft|us-ft");
  command.add_option("--void", options.void_height, "Height of the posts of a raster or terrain that have none")
      ->option_text("METRES");
  command.add_flag("--partial", options.partial, "Read a map that says that it is not complete as far as it goes");
  command.add_option("--set", options.settings, "A value to use where the map has no tag, see docs/scene.md")
      ->allow_extra_args(false)
      ->option_text("NAME=VALUE");
  command
      .add_option("--without", options.without,
                  "Leave out a kind of object, such as walls, trees or woods (docs/scene.md)")
      ->allow_extra_args(false)
      ->option_text("KIND");
  command
      .add_option("--missing", options.missing,
                  "What holds the place of what cannot be built as the file has it: block (default), a stand-in; warn, "
                  "nothing; refuse, it is an error")
      ->check(CLI::IsMember({"block", "warn", "refuse"}))
      ->option_text("POLICY");
  command.add_option("--detail", options.detail, "Largest geometric error of a tile of 3D Tiles (default 1)")
      ->option_text("METRES");
  command.add_option("--ground", options.ground, "Height of a plane that is the ground of a tileset (default: none)")
      ->option_text("Z");
  command.add_option("--lod", options.lod, "Level of detail of CityJSON (default: the highest)")->option_text("LOD");
  command
      .add_option("--crs", options.crs,
                  "Reference system of the coordinates, such as EPSG:28992; of a map, that of its terrain")
      ->option_text("CRS");
  command.add_option("--origin", options.origin, "Origin of the scene frame (default: the middle)")
      ->option_text("LAT,LON");
  command.add_option("--up", options.up, "Axis of a mesh file that points up: y or z (default); glTF is always y up")
      ->check(CLI::IsMember({"y", "z"}))
      ->option_text("AXIS");
  command.add_option("--scale", options.scale, "Metres in one unit of a mesh file (default 1)")->option_text("S");
}

std::array<double, 2> place_option(const std::string& name, const std::string& text) {
  return numbers<2>(text, name, "latitude,longitude");
}

}  // namespace vantage::cli
