// Simple 3D Buildings (https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings): a building whose parts are drawn is
// not built itself; what its parts leave open is, where that is more than careless drawing leaves.
#include "maps/city/site.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <type_traits>

#include "core/format.h"
#include "maps/city/structures.h"
#include "maps/osm/meaning.h"

namespace vantage::internal::city {
namespace {

/// Parts that cover this share of their building are all of it where they begin above the ground, too.
constexpr double kCovered = 0.9;

CityRecord record_of(osm::ObjectId id, const osm::Tags& tags, ObjectKind kind) {
  CityRecord record;
  record.object = {std::string(tags.get("name")), osm::text(id), kind};
  return record;
}

void pass_over(Site& site, const CityRecord& record, std::string reason) {
  site.passed_over.push_back({record.object, std::move(reason)});
}

/// The words of the map for what an object is: "power=tower".
std::string what_of(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 17> keys = {
      "building",   "building:part", "man_made",    "power",   "aerialway", "historic",
      "tourism",    "leisure",       "natural",     "landuse", "barrier",   "amenity",
      "attraction", "bridge",        "advertising", "height",  "type"};
  for (const std::string_view key : keys) {
    if (tags.has(key)) return std::string(key).append("=").append(tags.get(key));
  }
  return tags.all.empty() ? "untagged" : tags.all.front().first + "=" + tags.all.front().second;
}

/// What switches a kind off; nothing for buildings.
const OccluderSwitch* switch_of(ObjectKind kind, const osm::Tags& tags) {
  if (kind == ObjectKind::stand_in) return &stand_in_switch(tags);
  const std::string name = std::string(name_of(kind)) + "s";
  const auto all = occluder_switches();
  const auto found = std::find_if(all.begin(), all.end(), [&](const OccluderSwitch& one) { return name == one.name; });
  return found == all.end() ? nullptr : &*found;
}

/// `kind`: what it is by its tags, whatever stands in for it.
LedgerEntry entry_of(const CityRecord& record, const osm::Tags& tags, ObjectKind kind) {
  LedgerEntry entry;
  entry.object = record.object;
  entry.what = what_of(tags);
  entry.height_m = parse_length_m(tags.get("height"));
  const OccluderSwitch* const one = switch_of(kind, tags);
  if (one != nullptr && record.object.kind == ObjectKind::stand_in) entry.without = one->name;
  return entry;
}

/// Holds a place whatever is built there.
Box box_over(const PlanBounds& place) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  return {{place.min.x(), place.min.y(), -kUnknown}, {place.max.x(), place.max.y(), kUnknown}};
}

/// Of what is lost the place is known as far as positions of it are.
void lose(Site& site, const CityRecord& record, const osm::Tags& tags, const std::string& reason,
          const PlanBounds& place = {}) {
  LedgerEntry entry = entry_of(record, tags, record.object.kind);
  entry.reason = reason;
  if (place.min.x() <= place.max.x()) entry.box = box_over(place);
  site.lost.push_back(std::move(entry));
}

constexpr const char* kUnderground = "underground";

bool is_underground(const osm::Tags& tags) { return tags.get("location") == "underground"; }

/// Why a structure is not built; nothing where it is.
std::string hindrance(const Structure& structure) {
  if (is_underground(structure.source->tags)) return kUnderground;
  return structure.footprints.empty() ? "beyond all bounds" : "";
}

void add_faults(std::vector<Fault>& faults, const Repairs& repairs) {
  if (repairs.tangled) {
    faults.push_back({"its outline crosses itself more than a thousand times", "the smallest rectangle round it"});
  } else if (repairs.enclosed) {
    faults.push_back({"", "the smallest rectangle round what is known of its outline", true});
  } else if (repairs.self_crossing) {
    faults.push_back(
        {"its outline crosses itself", "all that it is wound round, and the hull of each crossing's corners"});
  }
  if (repairs.nesting) {
    faults.push_back(
        {"holes cross its outline or each other, or lie outside of it", "its outline without these holes"});
  }
  if (repairs.thin) faults.push_back({"one of its rings has no area", "the smallest rectangle round that ring"});
  if (repairs.beyond) faults.push_back({"some of it lies beyond all bounds", "the rest of it", true});
}

void add_faults(std::vector<Fault>& faults, const std::vector<TagRemark>& remarks) {
  for (const TagRemark& remark : remarks) {
    if (!remark.unsure) continue;
    const std::string reason = remark.key + "=" + remark.value;
    const auto is_told = [&](const Fault& fault) { return fault.reason == reason; };
    if (std::any_of(faults.begin(), faults.end(), is_told)) continue;
    // Nothing tells it: the default.
    const bool is_guessed = remark.fault != TagFault::rough && remark.fault != TagFault::unknown_roof;
    faults.push_back({reason, remark.key + " " + remark.outcome, is_guessed});
  }
}

void note_remarks(CityRecord& record, const std::vector<TagRemark>& remarks) {
  for (const TagRemark& remark : remarks) {
    const CityRemark told = remark.for_people();
    const auto is_told = [&](const CityRemark& one) { return one.text == told.text; };
    if (std::none_of(record.remarks.begin(), record.remarks.end(), is_told)) record.remarks.push_back(told);
  }
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
  BuildingSorter(Site& site, std::vector<Structure> structures, const BuildingDefaults& defaults,
                 const std::vector<osm::Problem>& problems)
      : site_(site), structures_(std::move(structures)), defaults_(defaults) {
    for (const osm::Problem& problem : problems) at_fault_.insert(problem.object);
    for (const Structure& structure : structures_) forms_.push_back(read(structure));
  }

  void sort(const osm::RegionFilter& region, const geo::LocalFrame& frame) {
    for (const Structure& structure : structures_) {
      if (hindrance(structure).empty()) {
        site_.reach_m = std::max(site_.reach_m, (structure.max - structure.min).norm());
      }
    }
    const std::vector<bool> belongs = choose(region, frame);
    for (std::size_t i = 0; i < structures_.size(); ++i) {
      const Structure& structure = structures_[i];
      if (!belongs[i]) continue;
      const ObjectKind kind = structure.repairs.enclosed ? ObjectKind::stand_in
                              : structure.is_part        ? ObjectKind::building_part
                                                         : ObjectKind::building;
      CityRecord record = record_of(structure.source->id, structure.source->tags, kind);
      const std::string fault = hindrance(structure);
      const std::vector<std::size_t> parts = parts_of(structure);
      if (!fault.empty()) {
        if (fault == kUnderground) {
          pass_over(site_, record, fault);
        } else {
          lose(site_, record, structure.source->tags, fault);
        }
      } else if (!parts.empty()) {
        add_remainder(structure, parts, std::move(record));
      } else {
        add(structure, std::move(record), structure.footprints);
      }
    }
  }

 private:
  /// Which structures belong to the region; the others are counted.
  std::vector<bool> choose(const osm::RegionFilter& region, const geo::LocalFrame& frame) const {
    std::vector<bool> belongs(structures_.size());
    for (std::size_t i = 0; i < structures_.size(); ++i) {
      belongs[i] = touches(region, *structures_[i].source) || reaches_into(region, structures_[i].footprints, frame);
    }
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
                 [&](std::size_t part) { return hindrance(structures_[part]).empty(); });
    return parts;
  }

  /// Whether a part takes the place of what it lies in. One that is guessed from a faulty outline may be too large, one
  /// below the ground and a roof on posts are no walls, and one whose height is a guess, or that belongs to another
  /// building, may be too low.
  bool covers(const Structure& part, const Structure& building) const {
    if (part.repairs.any() || at_fault_.contains(part.source->id)) return false;
    if (parse_levels(part.source->tags.get("layer")).value_or(0) < 0) return false;
    const BuildingForm &form = form_of(part), &replaced = form_of(building);
    if (form.deck_m > 0 && replaced.deck_m == 0) return false;
    const bool is_of_it = part.outline && &structures_[*part.outline] == &building;
    return (is_of_it && !form.is_guessed) || form.top_m >= replaced.top_m;
  }

  /// What parts leave open.
  std::vector<Footprint> uncovered_by(const Structure& building, std::vector<std::size_t> parts) const {
    std::erase_if(parts, [&](std::size_t part) { return !covers(structures_[part], building); });
    return uncovered(building, structures_, parts);
  }

  void add_remainder(const Structure& building, const std::vector<std::size_t>& parts, CityRecord record) {
    std::vector<Footprint> rest = uncovered_by(building, parts);
    const double share = 1 - area_m2(rest) / building.area_m2;
    if (share < kCovered) {
      // Parts that begin higher up, such as lift houses drawn on a roof, stand on what is built here.
      std::vector<std::size_t> grounded;
      std::copy_if(parts.begin(), parts.end(), std::back_inserter(grounded),
                   [&](std::size_t part) { return form_of(structures_[part]).bottom_m <= 0; });
      rest = uncovered_by(building, std::move(grounded));
    }
    if (rest.empty()) return pass_over(site_, record, "its parts are built in its place");
    record.remarks.push_back(
        {core::format("its parts cover {:.0f} % of it", 100 * share), "its parts cover some of it"});
    add(building, std::move(record), std::move(rest));
  }

  const BuildingForm& form_of(const Structure& structure) const { return forms_[&structure - structures_.data()]; }

  BuildingForm read(const Structure& structure, std::vector<TagRemark>* remarks = nullptr) const {
    const osm::Area& area = *structure.source;
    const osm::Tags* const outline = structure.outline ? &structures_[*structure.outline].source->tags : nullptr;
    std::vector<TagRemark> unheard;
    std::vector<TagRemark>& heard = remarks ? *remarks : unheard;
    BuildingForm form = read_form(area.tags, outline, defaults_, heard);
    for (const osm::Tags& heights : area.heights) {
      form = joined(form, read_form(osm::with_heights(area.tags, heights), outline, defaults_, heard));
    }
    return form;
  }

  void add(const Structure& structure, CityRecord record, std::vector<Footprint> footprints) {
    const Structure* const outline = structure.outline ? &structures_[*structure.outline] : nullptr;
    std::vector<TagRemark> remarks;
    Item item;
    const BuildingForm form = read(structure, &remarks);
    note_remarks(record, remarks);
    item.entry = entry_of(record, structure.source->tags, ObjectKind::building);
    add_faults(item.faults, structure.repairs);
    add_faults(item.faults, remarks);
    item.record = std::move(record);
    if (outline) item.record.building = osm::text(outline->source->id);
    for (Footprint& footprint : footprints) item.shapes.push_back({std::move(footprint), form, {}});
    if (outline || !structure.parts.empty()) item.standing = (outline ? *outline : structure).footprints;
    site_.items.push_back(std::move(item));
  }

  Site& site_;
  std::vector<Structure> structures_;
  std::vector<BuildingForm> forms_;  // of the structures
  const BuildingDefaults& defaults_;
  std::set<osm::ObjectId> at_fault_;  ///< not read as they are drawn
};

bool is_switched_on(std::optional<ObjectKind> kind, const osm::Tags& tags, const Occluders& occluders) {
  const OccluderSwitch* const one = kind ? switch_of(*kind, tags) : nullptr;
  return kind && (one == nullptr || occluders.*one->on);
}

/// Of things without a model of their own, and of buildings that are drawn as a point.
Fault stand_in_fault(osm::ObjectId id, const osm::Tags& tags) {
  const bool is_point = id.type == osm::ObjectType::node;
  const bool is_building = is_point && kind_of(tags, Geometry::point) != ObjectKind::stand_in;
  return {is_building ? "it is drawn as a point, without an outline" : "it is of a kind that has no model",
          is_point ? "a column round it" : "its outline", is_point};
}

/// Walls, towers, bridges, trees and stand-ins.
class OccluderSorter {
 public:
  OccluderSorter(Site& site, const osm::RegionFilter& region, const geo::LocalFrame& frame, const CityOptions& options)
      : site_(site),
        region_(region),
        frame_(frame),
        options_(options),
        defaults_(options.occluder_defaults),
        levels_(options.defaults),
        piece_m_(options.terrain.empty() ? 0 : kWallPiece) {}

  void sort(const osm::Extract& extract) {
    for (const osm::Area& area : extract.areas) {
      std::optional<ObjectKind> kind = kind_of(area.tags, Geometry::area);
      if (is_building(kind)) {
        kind = kind_besides(area.tags);
        if (!is_switched_on(kind, area.tags, options_.occluders)) continue;
        osm::Area other = area;
        std::erase_if(other.tags.all, [](const auto& tag) { return tag.first.starts_with("building"); });
        add(other, *kind);
      } else if (is_switched_on(kind, area.tags, options_.occluders)) {
        add(area, *kind);
      }
    }
    for (const osm::Line& line : extract.lines) {
      std::optional<ObjectKind> kind = kind_of(line.tags, Geometry::line);
      const bool has_model = kind && kind != ObjectKind::stand_in, means_area = osm::means_area(line.tags);
      const bool is_member = line.id.type == osm::ObjectType::relation;
      if ((line.is_closed() || is_member) && means_area && !has_model) continue;  // it is among the areas
      // A wood or a tank whose outline is not closed is none the less an area; so is what is closed and no line.
      const bool is_area = kind ? !has_model && (line.is_closed() ? !osm::is_linear(line.tags) : means_area)
                                : !overhead_height_m(line.tags);
      if (is_area) kind = kind_of(line.tags, Geometry::area);
      if (is_building(kind) || !is_switched_on(kind, line.tags, options_.occluders)) continue;
      std::vector<Vec2> points;
      for (const geo::LonLat& position : line.points) points.push_back(frame_.to_local(position));
      if (is_area) {
        const auto end = line.points.end() - (line.is_closed() ? 1 : 0);
        add(osm::Area{line.id, line.tags, {{{line.points.begin(), end}, {}, !line.is_closed()}}}, *kind, points);
        continue;
      }
      PlanBounds drawn;
      for (const Vec2& at : points) drawn.extend(at);
      add(line.id, line.tags, *kind, line.points, drawn, {},
          [&](auto& remarks) { return shapes_of_line(line.tags, points, piece_m_, defaults_, levels_, remarks); });
    }
    if (options_.occluders.lines) add_overhead(extract);
    for (const osm::Point& point : extract.points) {
      std::optional<ObjectKind> kind = kind_of(point.tags, Geometry::point);
      if (is_building(kind)) kind = ObjectKind::stand_in;
      if (!is_switched_on(kind, point.tags, options_.occluders)) continue;
      const Vec2 place = frame_.to_local(point.position);
      add(point.id, point.tags, *kind, std::vector{point.position}, {place, place}, {},
          [&](auto& remarks) { return shapes_of_point(point.tags, place, defaults_, levels_, remarks); });
    }
  }

 private:
  static constexpr double kWallPiece = 10;  // metres of wall that stand level, where there is terrain

  /// As it is drawn, or as it is built.
  template <typename Positions>
  bool belongs(const Positions& positions, const std::vector<Shape>& shapes) {
    if (touches(region_, positions)) return true;
    std::vector<Footprint> built;
    for (const Shape& shape : shapes) {
      const auto& [min, max] = bounds_of({shape});  // of a tree
      built.push_back(shape.tree ? Footprint{{min, {max.x(), min.y()}, max, {min.x(), max.y()}}, {}} : shape.footprint);
    }
    if (reaches_into(region_, built, frame_)) return true;
    site_.outside.add(1, nearest(region_, positions));
    return false;
  }

  static bool is_building(std::optional<ObjectKind> kind) {
    return kind == ObjectKind::building || kind == ObjectKind::building_part;
  }

  /// 0: it says none.
  static double height_of(const osm::Tags& tags) { return any_length_m(tags.get("height")).value_or(0); }

  void add_overhead(const osm::Extract& extract) {
    std::map<std::pair<double, double>, double> supports;
    for (const osm::Point& point : extract.points) {
      const double height = height_of(point.tags);
      if (height > 0) supports[{point.position.longitude_deg, point.position.latitude_deg}] = height;
    }
    for (const osm::Line& line : extract.lines) {
      const std::optional<double> usual = overhead_height_m(line.tags);
      if (!usual || !touches(region_, line.points)) continue;
      Overhead& overhead = site_.overhead.emplace_back();
      overhead.object = record_of(line.id, line.tags, ObjectKind::other).object;
      if (overhead.object.name.empty()) overhead.object.name = "line overhead";
      const double own = height_of(line.tags);
      bool all_known = true;
      for (const geo::LonLat& at : line.points) {
        overhead.points.push_back(frame_.to_local(at));
        const auto support = supports.find({at.longitude_deg, at.latitude_deg});
        all_known &= support != supports.end();
        if (support != supports.end()) overhead.height_m = std::max(overhead.height_m, support->second);
      }
      overhead.height_m = std::max(overhead.height_m, own > 0 || all_known ? own : *usual);
    }
  }

  /// `line`: of what is drawn as a line. Where it says its width, it may be wider than what it bounds.
  void add(const osm::Area& area, ObjectKind kind, const std::vector<Vec2>& line = {}) {
    Repairs repairs;
    const std::vector<Footprint> footprints = footprints_of(area, frame_, repairs);
    PlanBounds drawn;
    for (const Footprint& footprint : footprints) drawn.extend(footprint);
    const bool is_wide = !line.empty() && (area.tags.has("width") || area.tags.has("est_width"));
    const std::size_t before = site_.items.size();
    add(area.id, area.tags, kind, area, drawn, repairs, [&](auto& remarks) {
      std::vector<Shape> shapes = shapes_of_area(area.tags, footprints, defaults_, levels_, remarks);
      for (const osm::Tags& heights : area.heights) {
        const osm::Tags tags = osm::with_heights(area.tags, heights);
        const std::vector<Shape> higher = shapes_of_area(tags, std::vector<Footprint>(1), defaults_, levels_, remarks);
        for (Shape& shape : shapes) {
          if (!higher.empty()) shape.form = joined(shape.form, higher.front().form);
        }
      }
      if (!is_wide) return shapes;
      const std::vector<Shape> wide = shapes_of_line(area.tags, line, piece_m_, defaults_, levels_, remarks);
      shapes.insert(shapes.end(), wide.begin(), wide.end());
      return shapes;
    });
    const bool is_open = !line.empty() && area.polygons.front().incomplete;
    if (is_open && site_.items.size() > before) {
      std::vector<Fault>& faults = site_.items.back().faults;
      faults.insert(faults.begin(), {"it is not closed", ""});
    }
  }

  template <typename Positions, typename MakeShapes>
  void add(osm::ObjectId id, const osm::Tags& tags, ObjectKind kind, const Positions& positions,
           const PlanBounds& drawn, const Repairs& repairs, const MakeShapes& make_shapes) {
    Item item;
    std::vector<TagRemark> remarks;
    item.shapes = make_shapes(remarks);
    if (!belongs(positions, item.shapes)) return;
    item.record = record_of(id, tags, repairs.enclosed ? ObjectKind::stand_in : kind);
    if (is_underground(tags)) return pass_over(site_, item.record, kUnderground);
    note_remarks(item.record, remarks);
    if (item.shapes.empty()) return lose(site_, item.record, tags, "without a length or an area", drawn);
    const Geometry geometry = std::is_same_v<Positions, osm::Area> ? Geometry::area
                              : id.type == osm::ObjectType::node   ? Geometry::point
                                                                   : Geometry::line;
    if (lacks_height(tags, geometry)) {
      return lose(site_, item.record, tags, "nothing tells how high it is", bounds_of(item.shapes));
    }
    item.entry = entry_of(item.record, tags, kind);
    add_faults(item.faults, repairs);
    add_faults(item.faults, remarks);
    if (kind == ObjectKind::stand_in && !repairs.enclosed) item.faults.push_back(stand_in_fault(id, tags));
    const PlanBounds built = bounds_of(item.shapes);
    site_.reach_m = std::max({site_.reach_m, (drawn.min - built.min).norm(), (built.max - drawn.max).norm()});
    if (kind == ObjectKind::wall || kind == ObjectKind::tree) item.stand = Item::Stand::each;
    if (kind == ObjectKind::bridge && !repairs.enclosed) item.stand = Item::Stand::above;
    site_.items.push_back(std::move(item));
  }

  Site& site_;
  const osm::RegionFilter& region_;
  const geo::LocalFrame& frame_;
  const CityOptions& options_;
  const OccluderDefaults& defaults_;
  const BuildingDefaults& levels_;
  double piece_m_;
};

/// What an object would have been, had it been read.
std::optional<ObjectKind> kind_of_lost(const osm::Problem& problem) {
  const bool is_point = problem.object.type == osm::ObjectType::node;
  const std::optional<ObjectKind> as_area = kind_of(problem.tags, is_point ? Geometry::point : Geometry::area);
  if (!as_area && problem.tags.get("type") == "building") return ObjectKind::building;
  return !as_area && !is_point ? kind_of(problem.tags, Geometry::line) : as_area;
}

/// Objects that were wanted and of which nothing could be read.
void add_lost(Site& site, const osm::Extract& extract, const geo::LocalFrame& frame, const CityOptions& options) {
  for (const osm::Problem& problem : extract.problems) {
    if (!problem.lost) continue;
    const std::optional<ObjectKind> kind = kind_of_lost(problem);
    if (!is_switched_on(kind, problem.tags, options.occluders)) continue;
    PlanBounds place;
    for (const geo::LonLat& position : problem.places) place.extend(frame.to_local(position));
    const CityRecord record = record_of(problem.object, problem.tags, *kind);
    if (problem.kind == osm::Problem::Kind::repeated_outline) {
      pass_over(site, record, problem.what);
    } else {
      lose(site, record, problem.tags, problem.what, place);
    }
  }
}

/// Relations that only say which outline and parts belong together, but are tagged as if they were a building. They
/// belong to the region when one of their members does. What of their members is not in the file is lost, and so is one
/// of which no member is built, or is another object.
void pass_over_groups(Site& site, const osm::Extract& extract, const geo::LocalFrame& frame) {
  std::map<osm::ObjectId, const osm::Problem*> problems;
  for (const osm::Problem& problem : extract.problems) {
    if (!problem.lost) problems[problem.object] = &problem;
  }
  std::set<std::string> built, not_built, read;
  for (const osm::Area& area : extract.areas) read.insert(osm::text(area.id));
  for (const Item& item : site.items) built.insert(item.record.object.source_id);
  for (const CityPassedOver& one : site.passed_over) not_built.insert(one.object.source_id);
  for (const LedgerEntry& entry : site.lost) not_built.insert(entry.object.source_id);
  for (const osm::BuildingRelation& relation : extract.building_relations) {
    const std::optional<ObjectKind> kind = kind_of(relation.tags, Geometry::area);
    const auto problem = problems.find(relation.id);
    if (!kind && problem == problems.end()) continue;
    const auto has_member_in = [&](const std::set<std::string>& objects) {
      const auto is_in = [&](osm::ObjectId id) { return objects.contains(osm::text(id)); };
      return std::any_of(relation.outlines.begin(), relation.outlines.end(), is_in) ||
             std::any_of(relation.parts.begin(), relation.parts.end(), is_in);
    };
    if (built.contains(osm::text(relation.id))) continue;
    const bool is_built = has_member_in(built), is_told = is_built || has_member_in(not_built);
    if (!is_told && has_member_in(read)) continue;  // outside, or left out by choice
    const CityRecord record = record_of(relation.id, relation.tags, kind.value_or(ObjectKind::building));
    if (problem != problems.end() || !is_told) {
      PlanBounds place;
      std::string reason = "none of its members could be read";
      if (problem != problems.end()) {
        reason = problem->second->what;
        for (const geo::LonLat& position : problem->second->places) place.extend(frame.to_local(position));
      }
      lose(site, record, relation.tags, reason, place);
    } else {
      pass_over(site, record, is_built ? "its members are built in its place" : "its members are not built either");
    }
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

/// What is made of an object that could not be read as it is drawn; nothing where nothing is made up.
std::optional<Fault> reading_fault(const osm::Problem& problem) {
  using Kind = osm::Problem::Kind;
  switch (problem.kind) {
    case Kind::missing_nodes:
    case Kind::missing_members:
      return Fault{problem.what, "what the file has of it", true};
    case Kind::open_outline:
      return Fault{problem.what, "its outline, closed by a straight side"};
    case Kind::broken_multipolygon:
    case Kind::wrong_role:
      return Fault{problem.what, "its rings as they are drawn"};
    case Kind::degenerate:
      return Fault{problem.what, ""};
    case Kind::repeated_outline:
      break;
  }
  return std::nullopt;
}

void note_reading_faults(Site& site, const osm::Extract& extract) {
  std::map<std::string, const osm::Problem*> problems;
  for (const osm::Problem& problem : extract.problems) {
    if (!problem.lost) problems[osm::text(problem.object)] = &problem;
  }
  for (Item& item : site.items) {
    const auto found = problems.find(item.record.object.source_id);
    const auto fault = found == problems.end() ? std::nullopt : reading_fault(*found->second);
    if (fault) item.faults.insert(item.faults.begin(), *fault);
    if (item.faults.empty() || !item.faults.front().reason.empty()) continue;
    item.faults.front().reason = "its outline has no area";
  }
}

/// With `MissingPolicy::warn` nothing holds the place of what could only be made up.
void drop_stand_ins(Site& site) {
  for (const Item& item : site.items) {
    if (item.record.object.kind != ObjectKind::stand_in) continue;
    site.lost.push_back(item.entry);
    site.lost.back().reason = item.faults.front().reason;
    site.lost.back().box = box_over(bounds_of(item.shapes));
  }
  std::erase_if(site.items, [](const Item& item) { return item.record.object.kind == ObjectKind::stand_in; });
}

}  // namespace

std::vector<std::string> reasons_of(const Site& site) {
  std::vector<std::string> reasons;
  for (const CityPassedOver& one : site.passed_over) reasons.push_back(one.reason);
  for (const LedgerEntry& entry : site.lost) reasons.push_back(entry.reason);
  return reasons;
}

Site make_site(const osm::Extract& extract, const osm::RegionFilter& region, const geo::LocalFrame& frame,
               const CityOptions& options) {
  Site site;
  site.outside.add(extract.outside, extract.nearest_outside_m);
  std::vector<Structure> structures = structures_of(extract.areas, frame);
  assign_parts(structures, extract.building_relations);
  BuildingSorter(site, std::move(structures), options.defaults, extract.problems).sort(region, frame);
  OccluderSorter(site, region, frame, options).sort(extract);
  add_lost(site, extract, frame, options);
  pass_over_groups(site, extract, frame);
  note_reading_faults(site, extract);
  if (options.missing == MissingPolicy::warn) drop_stand_ins(site);
  set_bounds(site);
  return site;
}

}  // namespace vantage::internal::city
