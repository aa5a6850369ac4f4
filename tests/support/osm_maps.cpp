#include "support/osm_maps.h"

#include "core/format.h"
#include "support/internals.h"
#include "support/run_program.h"

namespace vantage::testing {
namespace {

/// Writes an extract object by object.
class Description {
 public:
  void add_head(osm::ObjectId id, const osm::Tags& tags) {
    text_.append("\n").append(osm::text(id));
    for (const auto& [key, value] : tags.all) text_.append(" [").append(key).append("=").append(value).append("]");
  }
  void add(const std::string& word) { text_.append(" ").append(word); }
  void add(double value) { add(std::to_string(value)); }
  void add(const std::vector<osm::LonLat>& positions) {
    for (const osm::LonLat at : positions) {
      add(at.longitude_deg * 1e7);
      add(at.latitude_deg * 1e7);
    }
    add("/");
  }
  void add(const std::string& what, const std::vector<osm::ObjectId>& ids) {
    for (const osm::ObjectId id : ids) {
      add(what);
      add(osm::text(id));
    }
  }
  void add(const osm::Problem& problem) {
    add_head(problem.object, problem.tags);
    add(std::to_string(static_cast<int>(problem.kind)));
    add(problem.what);
    add(problem.lost ? "lost" : "there");
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

std::string osm_node(long id, double lon, double lat, const std::string& inside) {
  return internal::core::format("<node id='{}' version='1' lon='{:.7f}' lat='{:.7f}'>{}</node>\n", id, lon, lat,
                                inside);
}

std::string osm_tag(const std::string& key, const std::string& value) {
  return std::string("<tag k='").append(key).append("' v='").append(value).append("'/>");
}

std::string osm_way(long id, const std::vector<long>& nodes, const std::string& tags) {
  std::string text = "<way id='";
  text.append(std::to_string(id)).append("' version='1'>");
  for (const long node : nodes) text.append("<nd ref='").append(std::to_string(node)).append("'/>");
  return text.append(tags).append("</way>\n");
}

std::string osm_relation(long id, const std::vector<std::string>& members, const std::string& tags) {
  std::string text = "<relation id='";
  text.append(std::to_string(id)).append("' version='1'>");
  for (const std::string& member : members) {
    const std::size_t first = member.find(' '), second = member.find(' ', first + 1);
    text.append("<member type='").append(member, 0, first);
    text.append("' ref='").append(member, first + 1, second - first - 1);
    text.append("' role='").append(member, second + 1).append("'/>");
  }
  return text.append(tags).append("</relation>\n");
}

std::string describe(const osm::Extract& extract, bool file_details) {
  Description text;
  for (const osm::Area& area : extract.areas) {
    text.add_head(area.id, area.tags);
    if (area.partial) text.add("partial");
    for (const osm::Polygon& polygon : area.polygons) {
      text.add("outer");
      text.add(polygon.outer);
      for (const osm::Ring& hole : polygon.holes) text.add(hole);
    }
  }
  for (const osm::Line& line : extract.lines) {
    text.add_head(line.id, line.tags);
    text.add(line.points);
  }
  for (const osm::Point& point : extract.points) {
    text.add_head(point.id, point.tags);
    text.add({point.position});
  }
  for (const osm::BuildingRelation& relation : extract.building_relations) {
    text.add_head(relation.id, relation.tags);
    text.add("outline", relation.outlines);
    text.add("part", relation.parts);
  }
  for (const osm::Problem& problem : extract.problems) text.add(problem);
  text.add("\n");
  for (const double bound : extract.bounds_deg) text.add(bound * 1e7);
  for (const std::size_t count : {extract.nodes, extract.ways, extract.relations, extract.outside}) {
    text.add(std::to_string(count));
  }
  text.add(extract.nearest_outside_m);
  if (file_details) text.add(extract.sorted ? "sorted" : "unsorted");
  if (file_details) text.add(std::to_string(extract.superseded));
  return text.text();
}

bool has_osmium() {
  static const bool there = run_program("/usr/bin/env", {"osmium", "--version"}).exit_code == 0;
  return there;
}

std::string osmium(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "osmium");
  const ProgramRun run = run_program("/usr/bin/env", arguments);
  EXPECT_EQ(run.exit_code, 0) << arguments[1] << ": " << run.err;
  return run.out;
}

}  // namespace vantage::testing
