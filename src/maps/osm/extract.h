// What an OpenStreetMap file holds that may hide something, read with libosmium. The only module that sees it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geo/local_frame.h"
#include "vantage/progress.h"

namespace vantage::internal::osm {

using geo::LonLat;

enum class ObjectType { node, way, relation };

struct ObjectId {
  ObjectType type = ObjectType::way;
  std::int64_t id = 0;

  auto operator<=>(const ObjectId&) const = default;
};
std::string text(ObjectId id);                                   ///< "way/265517"
std::optional<ObjectId> parse_object_id(std::string_view text);  ///< "way/265517", also "w265517"

/// Keys and values as in the file. Few per object: searched one by one.
class Tags {
 public:
  std::vector<std::pair<std::string, std::string>> all;

  /// The value, or an empty text when there is none.
  std::string_view get(std::string_view key) const;
  bool has(std::string_view key) const;
};

using Ring = std::vector<LonLat>;  ///< open: the first position is not repeated

struct Polygon {
  Ring outer;               ///< counter-clockwise
  std::vector<Ring> holes;  ///< clockwise
  /// Not all of the ring is known: `outer` are the positions that are, in no order, and what encloses them stands in.
  bool incomplete = false;
};

/// A closed way or a multipolygon relation, assembled. The tags of a multipolygon are the relation's without its type,
/// or of an old-style one those that all its outer ways have in common.
struct Area {
  ObjectId id;
  Tags tags;
  std::vector<Polygon> polygons;
  bool partial = false;  ///< members are not in the file: there may be more of it
  /// What pieces of its rings and its building relation say of its height besides: the highest counts (with_heights).
  std::vector<Tags> heights = {};
};

struct Line {
  ObjectId id;
  Tags tags;
  std::vector<LonLat> points;  ///< of a closed line the first is repeated at the end

  bool is_closed() const {
    const LonLat &first = points.front(), &last = points.back();
    return points.size() > 3 && first.longitude_deg == last.longitude_deg && first.latitude_deg == last.latitude_deg;
  }
};

struct Point {
  ObjectId id;
  Tags tags;
  LonLat position;
};

/// type=building (Simple 3D Buildings): which parts belong to which outline. Members that are not in the file are left
/// out.
struct BuildingRelation {
  ObjectId id;
  Tags tags;
  std::vector<ObjectId> outlines, parts;
};

/// An object that could not be read as it should be; at most one for each object.
struct Problem {
  enum class Kind {
    missing_nodes,    ///< a way refers to nodes that are not in the file or not on the earth; built from the rest
    missing_members,  ///< a relation refers to objects that are not in the file
    /// Rings do not close, cross, overlap, or nest wrongly: taken as they are drawn, where they bound anything. Also a
    /// building relation of a type that is none
    broken_multipolygon,
    wrong_role,    ///< an inner member lies outside of the outer ones, or an outer one inside of another: no hole
    degenerate,    ///< fewer than 3 different positions (of a line: 2), no area, or nowhere on the earth
    open_outline,  ///< a way tagged as an area that is not closed; a building is, by a straight side
    /// A way that bounds a multipolygon and says nothing that it does not say, or is tagged like the multipolygon whose
    /// hole it bounds and no building: the multipolygon stands for it
    repeated_outline
  };
  ObjectId object;
  Kind kind = Kind::missing_nodes;
  std::string what;   ///< for people: "3 of 12 nodes are not in the file"; all that is wrong, the cause first
  bool lost = false;  ///< nothing of the object is in the extract
  Tags tags;          ///< of the object, to tell whether a building was lost
  std::vector<LonLat> places = {};  ///< of what is lost: positions that are known of it
};

/// Positions that are wanted. An object is taken, whole, when some of it lies inside, a corner or a part of a side, and
/// what is closed or may be an area also when a box round it reaches inside: it may be wound round the region, or stand
/// there though it is drawn open. The members of a building relation are taken together. With both a circle and a box a
/// position must lie in both.
struct Region {
  std::optional<std::pair<LonLat, double>> circle;  ///< centre and radius in metres (on the ellipsoid)
  std::optional<std::array<double, 4>> box_deg;     ///< west, south, east, north; west > east: over the date line
};

/// Asked for every tagged node, way and multipolygon: whether its tags are of interest as a point, a line or an area.
/// What is not is not read any further.
using Wanted = std::function<bool(const Tags& tags)>;

struct ReadOptions {
  std::optional<Region> region;  ///< nothing: all of the file
  Wanted wanted;                 ///< nothing: all that is tagged
};

struct Extract {
  std::vector<Area> areas;  ///< in the order of type and id, as all lists here
  std::vector<Line> lines;  ///< wanted ways, closed ones that are areas excepted; members of areas with a wall round
  std::vector<Point> points;
  std::vector<BuildingRelation> building_relations;
  std::vector<Problem> problems;

  /// West, south, east, north of all nodes of the file, whatever the region. West > east: across the antimeridian;
  /// where they lie round a pole, from the lowest to the highest.
  std::array<double, 4> bounds_deg{};
  std::size_t nodes = 0, ways = 0, relations = 0;  ///< in the file
  std::size_t outside = 0;                         ///< wanted objects that were left out because of the region
  double nearest_outside_m = 0;  ///< of these the nearest one's distance from the region's centre; 0 when none
  bool sorted = true;            ///< by type and id; else it was sorted in memory
  std::size_t superseded = 0;    ///< older versions, and copies, of objects that the file holds more than once
  std::string remark;            ///< on an error that ended the file early, in its words; empty: it says nothing
};

/// Reads .osm, .osm.gz, .osm.bz2, .osm.pbf and JSON of Overpass, told by content, whatever the name. A closed way is an
/// area when it is tagged building, building:part, area=yes, area:*, or with a key of areas (leisure, landuse, natural,
/// amenity, place, man_made, ...: see means_area) whose value is not linear (natural=tree_row), and not area=no. Other
/// closed ways are lines (a wall round a garden), those with both meanings are in both lists. Members of a multipolygon
/// are areas of their own where they say what it does not (Kind::repeated_outline). Deleted objects (visible=false) and
/// history files: only current versions; of copies with equal versions the last counts. Memory: 24 bytes for each node
/// of the file, 16 for each way, and what is wanted. Cost: the file is read twice, once for its relations alone.
///
/// Throws Error(input) naming the file for: no such file, a folder or pipe, not an OSM file (what it looks like),
/// truncated or garbled (where, in XML the line), an empty one; a region that has no extent or is not on the earth.
/// Error(cancelled) when told to stop.
Extract read_extract(const std::filesystem::path& file, const ReadOptions& options = {}, const Progress& progress = {});

}  // namespace vantage::internal::osm
