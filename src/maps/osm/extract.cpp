#include "maps/osm/extract.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/format.h"
#include "core/progress_reporter.h"
#include "maps/osm/area_assembler.h"
#include "maps/osm/map_file.h"
#include "maps/osm/map_objects.h"
#include "maps/osm/meaning.h"
#include "maps/osm/multipolygons.h"
#include "maps/osm/problem_builder.h"
#include "maps/osm/region_filter.h"
#include "maps/osm/selection.h"
#include "vantage/error.h"

namespace vantage::internal::osm {
namespace {

using Kind = Problem::Kind;

class ExtractBuilder {
 public:
  ExtractBuilder(const MapObjects& objects, const RegionFilter& region, const ReadOptions& options,
                 const core::ProgressReporter& progress)
      : objects_(objects),
        progress_(progress),
        selection_(objects, region),
        multipolygons_(objects, options.wanted, selection_, extract_, progress) {}

  Extract build() {
    const std::size_t steps = objects_.relations.size() + objects_.ways.size();
    std::size_t done = 0;
    // Multipolygons first: their ways may have nothing more to say.
    for (const osmium::Relation* const relation : objects_.relations) {
      multipolygons_.add(*relation);
      progress_.report(++done, steps);
    }
    for (const osmium::Relation* const relation : objects_.unwanted) multipolygons_.add_pieces(*relation);
    for (const KeptWay& kept : objects_.ways) {
      if (kept.wanted) add(kept);
      progress_.tick(++done, steps);
    }
    for (const Point& point : objects_.points) add(point);
    describe_file();
    sort();
    raise_outlines();
    return std::move(extract_);
  }

 private:
  void describe_file() {
    extract_.bounds_deg = objects_.bounds_deg;
    extract_.nodes = objects_.nodes;
    extract_.ways = objects_.ways_in_file;
    extract_.relations = objects_.relations_in_file;
    extract_.superseded = objects_.superseded;
    extract_.remark = objects_.remark;
    extract_.sorted = objects_.sorted;
    extract_.outside = selection_.outside();
    extract_.nearest_outside_m = selection_.nearest_outside_m();
  }

  void sort() {
    const auto sort_by_id = [](auto& list) {
      std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    };
    sort_by_id(extract_.areas);
    sort_by_id(extract_.lines);
    sort_by_id(extract_.points);
    sort_by_id(extract_.building_relations);
    std::stable_sort(extract_.problems.begin(), extract_.problems.end(),
                     [](const Problem& a, const Problem& b) { return a.object < b.object; });
  }

  /// A building relation may say how high its outline is, or without one how high those of its parts are that do not.
  void raise_outlines() {
    for (const BuildingRelation& relation : extract_.building_relations) {
      bool has_outline = false;
      const auto raise = [&](ObjectId id, bool is_part) {
        const auto area = std::lower_bound(extract_.areas.begin(), extract_.areas.end(), id,
                                           [](const Area& one, ObjectId wanted) { return one.id < wanted; });
        if (area == extract_.areas.end() || area->id != id || (is_part && says_height(area->tags))) return;
        add_heights(*area, relation.tags, true);
        has_outline = has_outline || id != relation.id;
      };
      for (const ObjectId id : relation.outlines) raise(id, false);
      if (has_outline) continue;
      for (const ObjectId id : relation.parts) raise(id, true);
    }
    for (Area& area : extract_.areas) {  // a relation may have 100,000 pieces
      std::vector<Tags>& said = area.heights;
      std::sort(said.begin(), said.end(), [](const Tags& a, const Tags& b) { return a.all < b.all; });
      said.erase(std::unique(said.begin(), said.end(), [](const Tags& a, const Tags& b) { return a.all == b.all; }),
                 said.end());
    }
  }

  void add(const Point& point) {
    if (!std::isfinite(point.position.latitude_deg)) {
      ProblemBuilder problem;
      problem.add(Kind::degenerate, "its position is nowhere on the earth");
      extract_.problems.push_back(problem.build(point.id, point.tags, true));
    } else if (selection_.holds(point)) {
      extract_.points.push_back(point);
    } else {
      selection_.leave_out(point);
    }
  }

  /// What a way is to become.
  struct Meaning {
    bool area = false, line = false;
  };

  static Meaning meaning_of(const KeptWay& kept, const Tags& tags, bool absorbed) {
    const bool outline = means_building(tags) || tags.get("area") == "yes";
    Meaning meaning{.area = !absorbed && (kept.closed ? means_area(tags) : outline), .line = means_line(tags)};
    // What is drawn open is a line, but for outlines and for pieces of rings: a park's border.
    if (!kept.closed && !outline && !absorbed) meaning.line = true;
    return meaning;
  }

  void add(const KeptWay& kept) {
    const osmium::Way& way = *kept.way;
    const ObjectId id{ObjectType::way, way.id()};
    const Tags tags = to_tags(way.tags());
    const auto absorbed = multipolygons_.absorbed(way.id());
    const Meaning meaning = meaning_of(kept, tags, absorbed.has_value());
    const bool is_repeated = absorbed && absorbed->reported && means_area(tags);
    if (!selection_.holds(id)) {
      if (!absorbed || meaning.line || is_repeated) selection_.leave_out(way);
      return;
    }
    ProblemBuilder problem;
    problem.add_share(Kind::missing_nodes, kept.missing, way.nodes().size(), "nodes", "not in the file");
    problem.add_share(Kind::missing_nodes, kept.off_earth, way.nodes().size(), "nodes", "nowhere on the earth");
    bool there = meaning.area && add_area(kept, tags, problem);
    there = (meaning.line && add_line(kept, tags, problem)) || there;
    if (absorbed) {
      if (!is_repeated) return;
      problem.add(Kind::repeated_outline, (absorbed->hole ? "it is tagged like " : "it bounds ") + text(absorbed->by) +
                                              (absorbed->hole ? ", whose hole it bounds" : ", which stands for it"));
    }
    if (problem.empty()) return;
    extract_.problems.push_back(problem.build(id, tags, !there));
    if (!there) extract_.problems.back().places = positions(way);
  }

  bool add_area(const KeptWay& kept, const Tags& tags, ProblemBuilder& problem) {
    const osmium::Way& way = *kept.way;
    Assembly assembly;
    const bool incomplete = kept.missing + kept.off_earth > 0;
    if (kept.closed && !incomplete) assembly = assemble(way);
    if (assembly.polygons.empty()) {
      assembly.polygons = raw_polygon(way, incomplete);
      if (assembly.polygons.empty()) {
        problem.add(Kind::degenerate, "its positions bound no area");
        return false;
      }
      const Ring& ring = assembly.polygons.front().outer;
      if (assembly.polygons.front().incomplete) {
        if (!incomplete) problem.add(Kind::degenerate, "its positions bound no area");
      } else if (kept.closed) {
        problem.add(Kind::broken_multipolygon, assembly.problem + "; taken as it is drawn");
      } else {
        problem.add(Kind::open_outline, core::format("it is not closed; a straight side of {:.1f} m closes it",
                                                     distance_m(ring.front(), ring.back())));
      }
    }
    extract_.areas.push_back({{ObjectType::way, way.id()}, tags, std::move(assembly.polygons)});
    return true;
  }

  bool add_line(const KeptWay& kept, const Tags& tags, ProblemBuilder& problem) {
    std::vector<LonLat> points = positions(*kept.way);
    if (points.size() < 2) {
      problem.add(Kind::degenerate, "it has no two different positions");
      return false;
    }
    extract_.lines.push_back({{ObjectType::way, kept.way->id()}, tags, std::move(points)});
    return true;
  }

  const MapObjects& objects_;
  const core::ProgressReporter& progress_;
  Extract extract_;
  Selection selection_;
  Multipolygons multipolygons_;
};

}  // namespace

Extract read_extract(const std::filesystem::path& file, const ReadOptions& options, const Progress& progress) {
  const RegionFilter region(options.region);
  const MapFile map = open_map_file(file);
  core::ProgressReporter reporter(progress, file);
  const MapObjects objects = load_objects(map, options.wanted, reporter);
  if (objects.nodes + objects.ways_in_file + objects.relations_in_file == 0) {
    throw Error(ErrorCode::map_empty,
                std::string("the map is empty: there is no node, way or relation in it") +
                    (objects.remark.empty() ? "" : "; it says: " + objects.remark),
                file.string(), "download or export the map again");
  }
  reporter.begin("assemble areas");
  return ExtractBuilder(objects, region, options, reporter).build();
}

}  // namespace vantage::internal::osm
