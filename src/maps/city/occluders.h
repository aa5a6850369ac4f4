// What hides besides buildings: walls, towers, bridges and trees, as shapes to build on some ground.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "maps/city/building_form.h"
#include "maps/city/building_solid.h"
#include "maps/city/footprint.h"
#include "maps/osm/extract.h"
#include "vantage/city.h"
#include "vantage/scene.h"

namespace vantage::internal::city {

enum class Geometry { point, line, area };

/// What the tags make of an object, from building to stand-in, or nothing for what hides nothing. A stand-in is what
/// says how high it is, or of a kind that is high (lacks_height), stands in the open, and is neither of the other kinds
/// nor only furniture of a street. A building that is a tower as well is a building, but a tower where it is a point.
/// What an object is may depend on how it is drawn: a garden with barrier=fence is a wall as a line and nothing as an
/// area (unless area=yes says that the barrier itself is drawn, or nothing else is).
std::optional<ObjectKind> kind_of(const osm::Tags& tags, Geometry geometry);

/// What an area that is a building is besides, and may be higher as: a tower of which no tag says how high it is, a
/// wind turbine.
std::optional<ObjectKind> kind_besides(const osm::Tags& tags);

/// Whether a tag says how many levels an object has.
bool says_levels(const osm::Tags& tags);

/// Whatever else it is: a fence may stand on a bridge.
bool is_wall(const osm::Tags& tags);
bool is_on_bridge(const osm::Tags& tags);

/// A stand-in, a wood or a crane, of which no tag says how high it is: it is told of, and nothing is built.
bool lacks_height(const osm::Tags& tags, Geometry geometry);

/// How high above the ground the supports of a line overhead are whose tags and nodes say no height, metres; nothing
/// for what is no such line.
std::optional<double> overhead_height_m(const osm::Tags& tags);

/// Which member of Occluders switches the stand-in of such tags off: "woods", "others".
const OccluderSwitch& stand_in_switch(const osm::Tags& tags);

constexpr double kRotorShare = 0.4;  ///< half a rotor's width, of a turbine's height, where no tag says it

/// Half the width of the column that stands in for a point whose tags say no width, metres: docs/scene.md.
double column_radius_m(const osm::Tags& tags, double height_m);

/// Whether the tags make any of these of some geometry: for osm::ReadOptions.
bool wanted(const osm::Tags& tags);

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

/// A rectangle in plan; empty at first.
struct PlanBounds {
  Vec2 min = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 max = Vec2::Constant(-std::numeric_limits<double>::infinity());

  void extend(const Vec2& point);
  void extend(const Footprint& footprint);
  bool meets(const PlanBounds& other) const;
};

/// Holds all solids that are made of some shapes.
PlanBounds bounds_of(const std::vector<Shape>& shapes);

/// The shapes of a line: walls, tree rows, bridges, stand-ins. `points`: in scene metres, of a closed line the first
/// repeated at the end. `piece_m` > 0: walls come in pieces of that length, each to stand on ground of its own; else in
/// one. Bridges: the underside lies layer=* times `layer_m` above the ground, or at min_height; the top is at its
/// height where that is said. Empty, with a remark, for what has no length.
std::vector<Shape> shapes_of_line(const osm::Tags& tags, const std::vector<Vec2>& points, double piece_m,
                                  const OccluderDefaults& defaults, const BuildingDefaults& buildings,
                                  std::vector<TagRemark>& remarks);

/// The shapes of a point: towers (regular 16-gons), trees, and columns that stand in for buildings and other things.
std::vector<Shape> shapes_of_point(const osm::Tags& tags, const Vec2& point, const OccluderDefaults& defaults,
                                   const BuildingDefaults& buildings, std::vector<TagRemark>& remarks);

/// The shapes of an area, cleaned: towers, bridges, walls drawn as areas, stand-ins.
std::vector<Shape> shapes_of_area(const osm::Tags& tags, const std::vector<Footprint>& area,
                                  const OccluderDefaults& defaults, const BuildingDefaults& buildings,
                                  std::vector<TagRemark>& remarks);

/// As make_solid does it for buildings; `ground_m`: z of the ground that the heights count from.
CitySolid make_solid(const Shape& shape, double ground_m);

}  // namespace vantage::internal::city
