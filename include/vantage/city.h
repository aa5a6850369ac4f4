// From OpenStreetMap and terrain to a scene: docs/scene.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/export.h"
#include "vantage/georeference.h"
#include "vantage/ground.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage {

/// What is assumed where the map says nothing. The table in docs/scene.md is made of these; each can be set.
struct BuildingDefaults {
  double level_m = 3.0;  ///< height of a storey (building:levels counts them)
  double levels = 3;     ///< storeys of a building that has neither height nor levels
  /// Storeys by the value of building=*, which overrides `levels`.
  std::map<std::string, double> levels_of = {{"house", 2},          {"detached", 2}, {"semidetached_house", 2},
                                             {"terrace", 2},        {"bungalow", 1}, {"farm", 2},
                                             {"garage", 1},         {"garages", 1},  {"carport", 1},
                                             {"shed", 1},           {"hut", 1},      {"cabin", 1},
                                             {"kiosk", 1},          {"roof", 1},     {"greenhouse", 1},
                                             {"static_caravan", 1}, {"service", 1},  {"industrial", 2},
                                             {"warehouse", 2},      {"retail", 2},   {"church", 4},
                                             {"cathedral", 8}};
  double roof_level_m = 2.5;  ///< height of a storey in the roof (roof:levels)
  double roof_pitch_deg =
      30;                    ///< of a roof that is not flat and has no height of its own; at most a third of the height
  double roof_deck_m = 0.5;  ///< thickness of building=roof, carport and the like, which stand on posts
};

/// Sizes of walls, towers, bridges and trees where the tags say none, metres. Part of the same table.
struct OccluderDefaults {
  struct Size {
    double height_m = 0;
    double width_m = 0;  ///< of a wall its thickness, of a tower its diameter
  };
  /// By barrier=*; a wall with wall=noise_barrier by that.
  std::map<std::string, Size, std::less<>> walls = {{"wall", {2, 0.25}},   {"city_wall", {6, 2}},
                                                    {"fence", {1.5, 0.1}}, {"retaining_wall", {1.5, 0.4}},
                                                    {"hedge", {1.5, 1}},   {"noise_barrier", {4, 0.3}}};
  /// By man_made=*; a tower by tower:type=*, where that is here.
  std::map<std::string, Size, std::less<>> towers = {
      {"tower", {20, 6}},       {"communications_tower", {100, 12}},
      {"mast", {25, 0.6}},      {"chimney", {30, 3}},
      {"water_tower", {25, 8}}, {"storage_tank", {10, 15}},
      {"silo", {12, 6}},        {"gasometer", {30, 40}},
      {"lighthouse", {20, 6}},  {"cooling_tower", {100, 60}},
      {"cooling", {100, 60}},   {"communication", {40, 4}},
      {"bell_tower", {25, 6}},  {"minaret", {25, 3}},
      {"lighting", {15, 0.5}},  {"observation", {25, 6}},
  };
  double layer_m = 5;    ///< underside of a bridge for each layer=*; one layer when it says none
  double deck_m = 1;     ///< thickness of a bridge's deck
  double lane_m = 3.5;   ///< width of a lane (lanes=*)
  double track_m = 4.5;  ///< width of a railway track (tracks=*)
  /// Width of a bridge by highway=*, aeroway=* or waterway=*; of others `other_way_m`.
  std::map<std::string, double, std::less<>> ways = {
      {"motorway", 11},     {"trunk", 11},       {"primary", 8}, {"secondary", 7}, {"tertiary", 7},
      {"residential", 6},   {"unclassified", 6}, {"service", 4}, {"track", 3},     {"pedestrian", 4},
      {"footway", 2.5},     {"cycleway", 2.5},   {"path", 2},    {"steps", 2.5},   {"bridleway", 2.5},
      {"living_street", 5}, {"taxiway", 25},     {"runway", 45}, {"canal", 15}};
  double other_way_m = 5;
  double tree_m = 10;              ///< height of a tree
  double crown_share = 0.5;        ///< diameter of its crown by its height
  double trunk_share = 0.03;       ///< diameter of its trunk by its height
  double crown_base_share = 0.25;  ///< of its height that is trunk
  double tree_spacing_m = 8;       ///< along a tree_row
};

/// What else is built; each can be switched off.
struct Occluders {
  bool walls = true;    ///< barrier=wall, city_wall, fence, retaining_wall, hedge, with or without a height
  bool towers = true;   ///< man_made=tower, mast, chimney, water_tower, storage_tank, silo, communications_tower, …
  bool bridges = true;  ///< bridge decks, so that one can look under them
  bool trees = true;    ///< natural=tree and tree_row
  // Stand-ins, for what is tagged with a height and is none of these: docs/scene.md, "The ledger".
  bool woods = true;      ///< natural=wood, scrub, tree_group; landuse=forest, orchard
  bool stadiums = true;   ///< leisure=stadium, sports_hall, …
  bool masts = true;      ///< power=tower, pole, …; aerialway=pylon; man_made=antenna, utility_pole
  bool turbines = true;   ///< wind turbines and windmills
  bool cranes = true;     ///< man_made=crane
  bool tanks = true;      ///< man_made=tank, bunker_silo
  bool monuments = true;  ///< historic=*, man_made=obelisk, tourism=artwork
  bool others = true;     ///< all other things with a height, and buildings that are drawn as a point
  bool lines = true;      ///< power lines, cable cars and pipelines overhead, for clearance alone: Scene::overhead
};

/// A member of Occluders by its name, which `scene.without` takes.
struct OccluderSwitch {
  const char* name;
  bool Occluders::*on;
};

/// All of them, in the order of their declaration.
VANTAGE_API std::span<const OccluderSwitch> occluder_switches();

/// The part of the map that is built. An object belongs to it, whole, when some of it does, be it but a side's middle.
struct CityRegion {
  std::optional<std::array<double, 2>> center_deg;  ///< latitude, longitude (WGS 84)
  double radius_m = 0;                              ///< about the centre; > 0 with `center_deg`
  std::optional<std::array<double, 4>> bbox_deg;    ///< west, south, east, north; west > east crosses the antimeridian
};

/// What regions of one map have in common that are built one by one as if the map were built whole: vantage/city.h.
struct CityFrame {
  std::array<double, 2> origin_deg{};  ///< of the scene frame: latitude, longitude (WGS 84)
  std::array<double, 4> ground_m{};    ///< west, south, east, north of the flat ground of the whole map, scene frame
  double reach_m = 0;  ///< as far as an object may depend on others: so far beyond a region the map is read
};

struct CityOptions {
  CityRegion region;  ///< neither: all of the file
  /// With it the region is a part of the whole map: an object belongs to it when the box round it meets the box round
  /// the region, the ground is that of the whole map, and Scene::whole is set. A region may then hold nothing.
  std::optional<CityFrame> frame;
  std::filesystem::path terrain;  ///< GeoTIFF, .hgt or .hgt.zip; empty: a plane at z = 0
  /// No post of the raster lies above the triangulated ground, and none farther below it than this, vertically. Between
  /// posts it is not known: a cell of four is taken for two triangles, folded along its higher diagonal
  /// (docs/terrain.md).
  double terrain_error_m = 0.5;
  HeightOptions terrain_heights = {};
  std::string terrain_crs = {};  ///< of the raster, as RasterOptions::crs; empty: what the file says
  double ground_margin_m = 50;   ///< how far the ground goes on round what is built
  BuildingDefaults defaults;
  Occluders occluders;
  OccluderDefaults occluder_defaults;
  MissingPolicy missing = MissingPolicy::block;  ///< what cannot be built as it is drawn: Scene::ledger
  /// A file that says itself that it is not complete is read as far as it goes; a note and the ledger say so. Overpass
  /// writes a <remark> of an error into an answer that it could not finish. False: Error(input), scene_incomplete.
  bool partial = false;
};

/// A number of BuildingDefaults or OccluderDefaults by its name: for command lines, missions and the table in
/// docs/scene.md.
struct CitySetting {
  const char* name;
  double& (*value)(CityOptions&);
  double least, most;
  const char* meaning;  ///< with the unit
};

/// Those that are single numbers.
VANTAGE_API const std::vector<CitySetting>& city_settings();

/// `name`: one of `city_settings()`, or one of a kind: "levels.KIND" (storeys of building=KIND), "wall.KIND" (height of
/// barrier=KIND), "tower.KIND" (height of man_made=KIND or tower:type=KIND), "way.KIND" (width of a bridge that carries
/// highway=KIND). Throws Error(input) for an unknown name and a value out of range, with `where`.
VANTAGE_API void set_city_option(CityOptions& options, const std::string& name, double value, const std::string& where);

/// Switches off one of `occluder_switches()`. Throws Error(input) for another word.
VANTAGE_API void leave_out(Occluders& occluders, const std::string& kind, const std::string& where);

/// On something that is drawn or tagged in another way than it should be.
struct CityRemark {
  std::string text;  ///< "height=concrete: taken as untagged"
  std::string sort;  ///< the same for all remarks of a sort: "height: taken as untagged"
};

/// An object that is built. What of the map is not built as it stands is in Scene::ledger.
struct CityRecord {
  SceneObject object;    ///< `source_id`: "way/265517"; `name`: its name tag; `kind`: building to tree
  std::string building;  ///< of a building part: `source_id` of the building that it belongs to, where it has one
  std::vector<CityRemark> remarks;  ///< on its tags
  double ground_m = 0;              ///< z it stands on
  double base_m = 0, top_m = 0;     ///< lowest and highest z
  double footprint_m2 = 0;
};

/// An object that is wanted and not built, though nothing is missing: it is underground, or others stand for it.
struct CityPassedOver {
  SceneObject object;
  std::string reason;
};

struct CityReport {
  Georeference georeference;
  std::vector<CityRecord> records;
  std::vector<CityPassedOver> passed_over;
  std::size_t outside = 0;             ///< left out because of the region
  std::array<double, 4> bounds_deg{};  ///< west, south, east, north of all that the file holds; west > east: across
                                       ///< the antimeridian
  std::vector<std::string> notes;      ///< on the file and the terrain: voids filled, missing references, not sorted
  double read_seconds = 0, build_seconds = 0;  ///< checking is part of building
};

struct City {
  /// One object per solid: that of its record; then the ground, of ObjectKind::ground. Another one of that kind follows
  /// where terrain has voids in which the ground may lie lower.
  Scene scene;
  CityReport report;
};

/// Reads an OpenStreetMap file (.osm, .osm.gz, .osm.bz2, .osm.pbf) and builds what it holds. Throws Error(input) for:
/// all that reading refuses; a region without an area, out of range, or outside the file (says its bounds, and when
/// latitude and longitude are the wrong way round); nothing to build in it (says how far the nearest building is); a
/// terrain that cannot be used (docs/scene.md). Error(cancelled) when told to stop.
VANTAGE_API City build_city(const std::filesystem::path& file, const CityOptions& options = {},
                            const Progress& progress = {});

/// Lets missions use what the library vantage_maps does: scenes of maps and rasters, targets on the ground. A program
/// calls it once, when it starts, before missions are resolved. Any number of times, from any thread.
VANTAGE_API void enable_maps();

// ---- A city larger than memory, in tiles: docs/python-areas.md

/// A square of the map, and what must be built for targets in it.
struct Tile {
  std::array<double, 4>
      square_m{};     ///< west, south, east, north, scene frame; targets with their centre here are its own
  CityRegion region;  ///< to build, with the plan's frame
};

/// How a map is cut. The volume of a target is the same in its tile as in the whole map built with the frame: vertices,
/// facets and causes, but for the index of the object of a cause. That holds for every target of which each part has
/// its centre within a tile's square, or beyond it by e metres, where e and the longest reach (its range, and the
/// distance to keep from obstacles) make `margin_m` at the most.
struct TilePlan {
  CityFrame frame;
  double size_m = 0, margin_m = 0;
  std::size_t columns = 0, rows = 0;
  std::vector<Tile> tiles;  ///< row by row from the south, each from the west

  /// Which tile a place of the scene frame belongs to. What lies outside of all belongs to the nearest: beyond the
  /// tiles there is nothing to build.
  VANTAGE_API std::size_t tile_at(double east_m, double north_m) const;
};

/// Cuts a map into squares of `size_m` metres, and says what to build for each, so that it holds all within `margin_m`
/// of the square. The map is read and its outlines are cleaned once, but nothing is built.
/// `options`: as for build_city, without a region, a frame and terrain.
///
/// Throws Error(input) for what build_city refuses, a size or a margin out of range (1 m to 50 km; the margin may be
/// 0), more than 10^6 tiles, a map round a pole, and terrain. Error(cancelled) when told to stop.
VANTAGE_API TilePlan plan_tiles(const std::filesystem::path& file, const CityOptions& options, double size_m,
                                double margin_m, const Progress& progress = {});

// ---- The areas of a map, as targets: every parking lot, every pitch

/// A tag that an area must have.
struct AreaTag {
  std::string key;    ///< "amenity"
  std::string value;  ///< "parking"; empty: any but "no"
};

/// "amenity=parking", or "amenity=*" for any value but "no". The key ends at the first '='. Throws Error(input), with
/// `where`, for a text without '=', without a key or without a value.
VANTAGE_API AreaTag area_tag(const std::string& text, const std::string& where);

/// Which areas are listed: those of which all of this holds.
struct AreaFilter {
  std::vector<AreaTag> tags;  ///< all of these; none: any tags
  bool named = false;         ///< only those with a name
  CityRegion region;          ///< an area belongs to it when some of it does; default: all of the map
};

/// Degrees, WGS 84; rings are open: the first position is not repeated.
struct AreaPolygon {
  using Ring = std::vector<std::array<double, 2>>;  ///< longitude, latitude
  Ring outer;                                       ///< counter-clockwise
  std::vector<Ring> holes;                          ///< clockwise
};

/// A closed way or a multipolygon of a map.
struct MapArea {
  std::string source_id;                                  ///< "way/265517", "relation/5": what a target's `osm` takes
  std::string name;                                       ///< its tag `name`; may be empty
  std::vector<std::pair<std::string, std::string>> tags;  ///< in the order of the file
  std::vector<AreaPolygon> polygons;                      ///< at least one
  std::array<double, 2> center_deg{};                     ///< latitude, longitude of the middle of its bounds
  double area_m2 = 0;                                     ///< holes taken off
};

/// The areas of an OpenStreetMap file (.osm, .osm.gz, .osm.bz2, .osm.pbf) that `filter` wants, by type and id, each
/// once. Areas are closed ways and multipolygons whose tags bound an area; closed ways that are lines, as a wall round
/// a garden, are not listed. Neither are outlines that bound less than 0.01 m2, since they can be no
/// target. Memory: 24 bytes for each node of the file, and what is wanted. Cost: the file is read twice; a third and a
/// fourth time to explain why there is none.
///
/// Throws Error(input) for what build_city refuses in files and regions, and with ErrorCode::map_object_missing where
/// no area is wanted: it says which tag no area has, and the nearest that areas have. Error(cancelled) when told to
/// stop.
VANTAGE_API std::vector<MapArea> read_areas(const std::filesystem::path& file, const AreaFilter& filter = {},
                                            const Progress& progress = {});

}  // namespace vantage
