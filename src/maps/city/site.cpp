// Simple 3D Buildings (https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings): a building whose parts are drawn is
// not built itself; what its parts leave open is, where that is more than careless drawing leaves.
#include "maps/city/site.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "core/format.h"
#include "maps/city/structures.h"

namespace vantage::internal::city {
namespace {

/// Parts that cover this share of their building stand for all of it.
constexpr double kCovered = 0.9;
/// Across an outline, metres. No building is larger; an outline that is comes of a slip of the hand.
constexpr double kLargest = 3000;

CityRecord record_of(osm::ObjectId id, const osm::Tags& tags, ObjectKind kind) {
  CityRecord record;
  record.object = {std::string(tags.get("name")), osm::text(id), kind};
  return record;
}

void skip(Site& site, CityRecord record, std::string reason) {
  record.fate = Fate::skipped;
  record.reason = std::move(reason);
  site.skipped.push_back(std::move(record));
}

constexpr const char* kUnderground = "underground";

bool is_underground(const osm::Tags& tags) { return tags.get("location") == "underground"; }

/// Fates of outlines that were mended or cannot be built.
std::string fault_of(const Structure& structure) {
  if (structure.footprints.empty() && structure.repairs.tangled) {
    return "outline that crosses itself more than a thousand times";
  }
  if (structure.footprints.empty()) return "outline without an area";
  if ((structure.max - structure.min).maxCoeff() > kLargest) return "outline more than 3 km across";
  if (is_underground(structure.source->tags)) return kUnderground;
  return {};
}

std::string repair_of(const Repairs& repairs) {
  if (repairs.tangled) return "one of its outlines crosses itself more than a thousand times: built without it";
  if (repairs.self_crossing) return "outline that crosses itself: what is wound round an odd number of times is built";
  if (repairs.nesting) return "holes that overlap or lie outside: built without what lies outside";
  return {};
}

void note_remarks(CityRecord& record, const std::vector<TagRemark>& remarks) {
  for (const TagRemark& remark : remarks) record.remarks.push_back(remark.for_people());
}

/// Calls `visit` with the ends of each side; a single position is a side from it to itself.
template <typename Visit>
void for_sides(const std::vector<geo::LonLat>& positions, bool closed, const Visit& visit) {
  const std::size_t count = positions.size();
  const std::size_t sides = closed || count < 2 ? count : count - 1;
  for (std::size_t i = 0; i < sides; ++i) visit(positions[i], positions[(i + 1) % count]);
}

bool touches(const osm::RegionFilter& region, const std::vector<geo::LonLat>& line) {
  bool found = false;
  for_sides(line, false, [&](geo::LonLat from, geo::LonLat to) { found = found || region.meets(from, to); });
  return found;
}

/// With a corner, with some of a side, or by lying round the region's centre.
bool touches(const osm::RegionFilter& region, const osm::Area& area) {
  if (region.everything()) return true;
  bool found = false, round_centre = false;
  const auto take = [&](const osm::Ring& ring) {
    for_sides(ring, true, [&](geo::LonLat from, geo::LonLat to) {
      found = found || region.meets(from, to);
      round_centre ^= region.is_east_of_centre(from, to);
    });
  };
  for (const osm::Polygon& polygon : area.polygons) {
    take(polygon.outer);
    std::for_each(polygon.holes.begin(), polygon.holes.end(), take);
  }
  return found || round_centre;
}

double nearest(const osm::RegionFilter& region, const std::vector<geo::LonLat>& positions, bool closed = false) {
  double least = std::numeric_limits<double>::infinity();
  for_sides(positions, closed,
            [&](geo::LonLat from, geo::LonLat to) { least = std::min(least, region.distance_m(from, to)); });
  return least;
}

double nearest(const osm::RegionFilter& region, const osm::Area& area) {
  double least = std::numeric_limits<double>::infinity();
  for (const osm::Polygon& polygon : area.polygons) least = std::min(least, nearest(region, polygon.outer, true));
  return least;
}

class BuildingSorter {
 public:
  BuildingSorter(Site& site, std::vector<Structure> structures, const BuildingDefaults& defaults)
      : site_(site), structures_(std::move(structures)), defaults_(defaults) {}

  void sort(const osm::RegionFilter& region) {
    for (const Structure& structure : structures_) {
      if (fault_of(structure).empty()) {
        site_.reach_m = std::max(site_.reach_m, (structure.max - structure.min).norm());
      }
    }
    const std::vector<bool> belongs = choose(region);
    for (std::size_t i = 0; i < structures_.size(); ++i) {
      const Structure& structure = structures_[i];
      if (!belongs[i]) continue;
      CityRecord record = record_of(structure.source->id, structure.source->tags,
                                    structure.is_part ? ObjectKind::building_part : ObjectKind::building);
      const std::string fault = fault_of(structure);
      const std::vector<std::size_t> parts = parts_of(structure);
      if (!fault.empty()) {
        skip(site_, std::move(record), fault);
      } else if (!parts.empty()) {
        add_remainder(structure, parts, std::move(record));
      } else {
        add(structure, std::move(record), structure.footprints);
      }
    }
  }

 private:
  /// Which structures belong to the region; the others are counted.
  std::vector<bool> choose(const osm::RegionFilter& region) const {
    std::vector<bool> belongs(structures_.size());
    for (std::size_t i = 0; i < structures_.size(); ++i) belongs[i] = touches(region, *structures_[i].source);
    for (std::size_t i = 0; i < structures_.size(); ++i) {
      const std::vector<std::size_t>& parts = structures_[i].parts;
      if (std::any_of(parts.begin(), parts.end(), [&](std::size_t part) { return belongs[part]; })) belongs[i] = true;
    }
    for (std::size_t i = 0; i < structures_.size(); ++i) {
      if (!belongs[i]) continue;
      for (const std::size_t part : structures_[i].parts) belongs[part] = true;
    }
    for (std::size_t i = 0; i < structures_.size(); ++i) {
      if (!belongs[i]) site_.outside.add(1, nearest(region, *structures_[i].source));
    }
    return belongs;
  }

  /// Those that are built.
  std::vector<std::size_t> parts_of(const Structure& building) const {
    std::vector<std::size_t> parts;
    std::copy_if(building.parts.begin(), building.parts.end(), std::back_inserter(parts),
                 [&](std::size_t part) { return fault_of(structures_[part]).empty(); });
    return parts;
  }

  void add_remainder(const Structure& building, const std::vector<std::size_t>& parts, CityRecord record) {
    const double share = 1 - area_m2(uncovered(building, structures_, parts)) / building.area_m2;
    if (share >= kCovered) {
      skip(site_, std::move(record), "its parts are built in its place");
      return;
    }
    // Parts that begin higher up, such as lift houses drawn on a roof, stand on what is built here.
    std::vector<std::size_t> grounded;
    std::copy_if(parts.begin(), parts.end(), std::back_inserter(grounded),
                 [&](std::size_t part) { return form_of(structures_[part]).bottom_m <= 0; });
    std::vector<Footprint> rest = uncovered(building, structures_, grounded);
    record.remarks.push_back(
        {core::format("its parts cover {:.0f} % of it", 100 * share), "its parts cover some of it"});
    record.fate = Fate::repaired;
    record.reason = "parts leave some of it open: that is built by its own tags";
    add(building, std::move(record), std::move(rest));
  }

  BuildingForm form_of(const Structure& structure, std::vector<TagRemark>* remarks = nullptr) const {
    const osm::Tags* const outline = structure.outline ? &structures_[*structure.outline].source->tags : nullptr;
    std::vector<TagRemark> unheard;
    return read_form(structure.source->tags, outline, defaults_, remarks ? *remarks : unheard);
  }

  void add(const Structure& structure, CityRecord record, std::vector<Footprint> footprints) {
    const std::string repair = repair_of(structure.repairs);
    if (!repair.empty()) {
      record.fate = Fate::repaired;
      record.reason = repair;
    }
    const Structure* const outline = structure.outline ? &structures_[*structure.outline] : nullptr;
    std::vector<TagRemark> remarks;
    Item item;
    const BuildingForm form = form_of(structure, &remarks);
    note_remarks(record, remarks);
    item.record = std::move(record);
    if (outline) item.record.building = osm::text(outline->source->id);
    for (Footprint& footprint : footprints) item.shapes.push_back({std::move(footprint), form, {}});
    if (outline) {
      item.standing = outline->footprints;
    } else if (!structure.parts.empty()) {
      item.standing = structure.footprints;
    }
    site_.items.push_back(std::move(item));
  }

  Site& site_;
  std::vector<Structure> structures_;
  const BuildingDefaults& defaults_;
};

bool is_switched_on(std::optional<ObjectKind> kind, const Occluders& occluders) {
  if (kind == ObjectKind::wall) return occluders.walls;
  if (kind == ObjectKind::tower) return occluders.towers;
  if (kind == ObjectKind::bridge) return occluders.bridges;
  if (kind == ObjectKind::tree) return occluders.trees;
  return kind.has_value();
}

/// Walls, towers, bridges and trees.
class OccluderSorter {
 public:
  OccluderSorter(Site& site, const osm::RegionFilter& region, const geo::LocalFrame& frame, const CityOptions& options)
      : site_(site),
        region_(region),
        frame_(frame),
        options_(options),
        defaults_(options.occluder_defaults),
        piece_m_(options.terrain.empty() ? 0 : kWallPiece) {}

  void sort(const osm::Extract& extract) {
    for (const osm::Area& area : extract.areas) {
      const std::optional<ObjectKind> kind = kind_of(area.tags, Geometry::area);
      if (is_building(kind) || !is_switched_on(kind, options_.occluders) || !belongs(area)) continue;
      Repairs repairs;
      const std::vector<Footprint> footprints = clean(project(area, frame_), repairs);
      PlanBounds drawn;
      for (const Footprint& footprint : footprints) drawn.extend(footprint);
      add(area.id, area.tags, *kind, drawn,
          [&](auto& remarks) { return shapes_of_area(area.tags, footprints, defaults_, remarks); });
    }
    for (const osm::Line& line : extract.lines) {
      const std::optional<ObjectKind> kind = kind_of(line.tags, Geometry::line);
      if (is_building(kind) || !is_switched_on(kind, options_.occluders) || !belongs(line.points)) continue;
      std::vector<Vec2> points;
      for (const geo::LonLat& position : line.points) points.push_back(frame_.to_local(position));
      PlanBounds drawn;
      for (const Vec2& at : points) drawn.extend(at);
      add(line.id, line.tags, *kind, drawn,
          [&](auto& remarks) { return shapes_of_line(line.tags, points, piece_m_, defaults_, remarks); });
    }
    for (const osm::Point& point : extract.points) {
      const std::optional<ObjectKind> kind = kind_of(point.tags, Geometry::point);
      if (!is_switched_on(kind, options_.occluders) || !belongs(std::vector{point.position})) continue;
      if (is_building(kind)) {
        skip(site_, record_of(point.id, point.tags, *kind), "drawn as a point: it has no outline");
        continue;
      }
      const Vec2 place = frame_.to_local(point.position);
      add(point.id, point.tags, *kind, {place, place},
          [&](auto& remarks) { return shapes_of_point(point.tags, place, defaults_, remarks); });
    }
  }

 private:
  static constexpr double kWallPiece = 10;  // metres of wall that stand level, where there is terrain

  template <typename Positions>
  bool belongs(const Positions& positions) {
    if (touches(region_, positions)) return true;
    site_.outside.add(1, nearest(region_, positions));
    return false;
  }

  static bool is_building(std::optional<ObjectKind> kind) {
    return kind == ObjectKind::building || kind == ObjectKind::building_part;
  }

  template <typename MakeShapes>
  void add(osm::ObjectId id, const osm::Tags& tags, ObjectKind kind, const PlanBounds& drawn,
           const MakeShapes& make_shapes) {
    Item item;
    item.record = record_of(id, tags, kind);
    if (is_underground(tags)) return skip(site_, std::move(item.record), kUnderground);
    std::vector<TagRemark> remarks;
    item.shapes = make_shapes(remarks);
    note_remarks(item.record, remarks);
    if (item.shapes.empty()) return skip(site_, std::move(item.record), "without a length or an area");
    const PlanBounds built = bounds_of(item.shapes);
    site_.reach_m = std::max({site_.reach_m, (drawn.min - built.min).norm(), (built.max - drawn.max).norm()});
    if (kind == ObjectKind::wall || kind == ObjectKind::tree) item.stand = Item::Stand::each;
    if (kind == ObjectKind::bridge) item.stand = Item::Stand::above;
    site_.items.push_back(std::move(item));
  }

  Site& site_;
  const osm::RegionFilter& region_;
  const geo::LocalFrame& frame_;
  const CityOptions& options_;
  const OccluderDefaults& defaults_;
  double piece_m_;
};

/// What an object would have been, had it been read.
std::optional<ObjectKind> kind_of_lost(const osm::Problem& problem) {
  const bool is_point = problem.object.type == osm::ObjectType::node;
  const std::optional<ObjectKind> as_area = kind_of(problem.tags, is_point ? Geometry::point : Geometry::area);
  return !as_area && !is_point ? kind_of(problem.tags, Geometry::line) : as_area;
}

/// Objects that were wanted and of which nothing could be read.
void skip_lost(Site& site, const osm::Extract& extract, const CityOptions& options) {
  for (const osm::Problem& problem : extract.problems) {
    if (!problem.lost) continue;
    const std::optional<ObjectKind> kind = kind_of_lost(problem);
    if (!is_switched_on(kind, options.occluders)) continue;
    skip(site, record_of(problem.object, problem.tags, *kind), problem.what);
  }
}

/// Relations that only say which outline and parts belong together, but are tagged as if they were a building. They
/// belong to the region when one of their members does.
void skip_groups(Site& site, const osm::Extract& extract, const osm::RegionFilter& region) {
  std::set<std::string> built, skipped;
  for (const Item& item : site.items) built.insert(item.record.object.source_id);
  for (const CityRecord& record : site.skipped) skipped.insert(record.object.source_id);
  for (const osm::BuildingRelation& relation : extract.building_relations) {
    const std::optional<ObjectKind> kind = kind_of(relation.tags, Geometry::area);
    if (kind != ObjectKind::building && kind != ObjectKind::building_part) continue;
    const auto has_member_in = [&](const std::set<std::string>& objects) {
      const auto is_in = [&](osm::ObjectId id) { return objects.contains(osm::text(id)); };
      return std::any_of(relation.outlines.begin(), relation.outlines.end(), is_in) ||
             std::any_of(relation.parts.begin(), relation.parts.end(), is_in);
    };
    const bool is_built = has_member_in(built), is_read = is_built || has_member_in(skipped);
    if (!is_read && !region.everything()) continue;
    skip(site, record_of(relation.id, relation.tags, *kind),
         is_built  ? "its members are built in its place"
         : is_read ? "its members are skipped too"
                   : "none of its members could be read");
  }
}

void set_bounds(Site& site) {
  PlanBounds bounds;
  for (const Item& item : site.items) {
    for (const Footprint& footprint : item.standing) bounds.extend(footprint);
    for (const Shape& shape : item.shapes) {
      bounds.extend(shape.footprint);
      if (shape.tree) bounds.extend(shape.tree->foot);
    }
  }
  site.min = bounds.min;
  site.max = bounds.max;
}

/// How an object was built that could not be read as it is drawn; an empty text where nothing was made up.
std::string reading_repair(osm::Problem::Kind kind) {
  using Kind = osm::Problem::Kind;
  switch (kind) {
    case Kind::missing_nodes:
      return "some of its nodes are not in the file: built from the others";
    case Kind::missing_members:
      return "some of its members are not in the file: built from the others";
    case Kind::open_outline:
      return "outline that is not closed: a straight side closes it";
    case Kind::broken_multipolygon:
      return "rings that do not fit together: taken as drawn";
    case Kind::degenerate:
    case Kind::repeated_outline:
      break;
  }
  return {};
}

void note_reading_repairs(Site& site, const osm::Extract& extract) {
  std::map<std::string, const osm::Problem*> problems;
  for (const osm::Problem& problem : extract.problems) {
    if (!problem.lost && !reading_repair(problem.kind).empty()) problems[osm::text(problem.object)] = &problem;
  }
  for (Item& item : site.items) {
    const auto found = problems.find(item.record.object.source_id);
    if (found == problems.end()) continue;
    item.record.fate = Fate::repaired;
    if (item.record.reason.empty()) item.record.reason = reading_repair(found->second->kind);
    item.record.remarks.push_back({found->second->what, reading_repair(found->second->kind)});
  }
}

}  // namespace

void PlanBounds::extend(const Vec2& point) {
  min = min.cwiseMin(point);
  max = max.cwiseMax(point);
}

void PlanBounds::extend(const Footprint& footprint) {
  for (const Vec2& corner : footprint.outer) extend(corner);
}

bool PlanBounds::meets(const PlanBounds& other) const {
  return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
}

PlanBounds bounds_of(const std::vector<Shape>& shapes) {
  PlanBounds bounds;
  for (const Shape& shape : shapes) {
    bounds.extend(shape.footprint);
    if (!shape.tree) continue;
    const Vec2 crown = Vec2::Constant(shape.tree->crown_m / 2);
    bounds.extend(shape.tree->foot - crown);
    bounds.extend(shape.tree->foot + crown);
  }
  return bounds;
}

Site make_site(const osm::Extract& extract, const osm::RegionFilter& region, const geo::LocalFrame& frame,
               const CityOptions& options) {
  Site site;
  site.outside.add(extract.outside, extract.nearest_outside_m);
  std::vector<Structure> structures = structures_of(extract.areas, frame);
  assign_parts(structures, extract.building_relations);
  BuildingSorter(site, std::move(structures), options.defaults).sort(region);
  OccluderSorter(site, region, frame, options).sort(extract);
  skip_lost(site, extract, options);
  skip_groups(site, extract, region);
  set_bounds(site);
  note_reading_repairs(site, extract);
  return site;
}

}  // namespace vantage::internal::city
