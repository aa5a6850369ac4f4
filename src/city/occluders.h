// What hides besides buildings: walls, towers, bridges and trees, as shapes to build on some ground.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "city/building_form.h"
#include "city/building_solid.h"
#include "city/footprint.h"
#include "osm/extract.h"

namespace vantage::city {

enum class Geometry { point, line, area };

/// "building", "building part", "wall", "tower", "bridge", "tree", or an empty text for what hides nothing. A building
/// that is a tower as well is a building. What an object is may depend on how it is drawn: a garden with barrier=fence
/// is a wall as a line and nothing as an area (unless area=yes says that the barrier itself is drawn).
std::string_view kind_of(const osm::Tags& tags, Geometry geometry);

/// Whether the tags make any of these of some geometry: for osm::ReadOptions.
bool wanted(const osm::Tags& tags);

/// Sizes where the tags say none. Metres.
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
  /// Width of a bridge by highway=*; of others `other_way_m`.
  std::map<std::string, double, std::less<>> ways = {
      {"motorway", 11}, {"trunk", 11},      {"primary", 8},      {"secondary", 7},
      {"tertiary", 7},  {"residential", 6}, {"unclassified", 6}, {"service", 4},
      {"track", 3},     {"pedestrian", 4},  {"footway", 2.5},    {"cycleway", 2.5},
      {"path", 2},      {"steps", 2.5},     {"bridleway", 2.5},  {"living_street", 5}};
  double other_way_m = 5;
  double tree_m = 10;              ///< height of a tree
  double crown_share = 0.5;        ///< diameter of its crown by its height
  double trunk_share = 0.03;       ///< diameter of its trunk by its height
  double crown_base_share = 0.25;  ///< of its height that is trunk
  double tree_spacing_m = 8;       ///< along a tree_row
};

/// A tree: an eight-sided trunk that widens into a crown; one closed surface, every upright section convex but for the
/// crown's underside.
struct Tree {
  Vec2 foot = Vec2::Zero();
  double bottom_m = 0, top_m = 0;   ///< above the ground
  double crown_m = 0, trunk_m = 0;  ///< diameters
  double crown_base_share = 0.25;
  bool needles = false;  ///< the crown is a cone; else an egg
};

/// One solid: something extruded, or a tree. Heights count from the ground where it stands.
struct Shape {
  Footprint footprint;  ///< empty for a tree
  BuildingForm form;
  std::optional<Tree> tree;
};

/// Of a line: walls, tree rows, bridges. `points`: in scene metres, of a closed line the first repeated at the end.
/// `piece_m` > 0: walls come in pieces of that length, each to stand on ground of its own; else in one.
/// Bridges: the underside lies layer=* times `layer_m` above the ground, or at min_height.
/// Empty, with a remark, for what has no length.
std::vector<Shape> shapes_of_line(const osm::Tags& tags, const std::vector<Vec2>& points, double piece_m,
                                  const OccluderDefaults& defaults, std::vector<TagRemark>& remarks);

/// Of a point: towers (regular 16-gons) and trees.
std::vector<Shape> shapes_of_point(const osm::Tags& tags, const Vec2& point, const OccluderDefaults& defaults,
                                   std::vector<TagRemark>& remarks);

/// Of an area, cleaned: towers, bridges, and walls drawn as areas.
std::vector<Shape> shapes_of_area(const osm::Tags& tags, const std::vector<Footprint>& area,
                                  const OccluderDefaults& defaults, std::vector<TagRemark>& remarks);

/// As make_solid does it for buildings; `ground_m`: z of the ground that the heights count from.
Solid make_solid(const Shape& shape, double ground_m);

}  // namespace vantage::city
