// OpenStreetMap files for tests: written by hand, and looked at by osmium-tool, which shares no code of ours.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "osm/extract.h"
#include "support/run_program.h"
#include "support/temporary_directory.h"
#include "vantage/error.h"

namespace vantage::testing {

/// An OSM XML file around `content`.
inline std::string osm_xml(const std::string& content) {
  return "<?xml version='1.0' encoding='UTF-8'?>\n<osm version='0.6' generator='hand'>\n" + content + "</osm>\n";
}

inline std::string osm_node(long id, double lon, double lat, const std::string& inside = "") {
  return "<node id='" + std::to_string(id) + "' version='1' lon='" + std::to_string(lon) + "' lat='" +
         std::to_string(lat) + "'>" + inside + "</node>\n";
}

inline std::string osm_tag(const std::string& key, const std::string& value) {
  return "<tag k='" + key + "' v='" + value + "'/>";
}

inline std::string osm_way(long id, const std::vector<long>& nodes, const std::string& tags = "") {
  std::string text = "<way id='" + std::to_string(id) + "' version='1'>";
  for (const long node : nodes) text += "<nd ref='" + std::to_string(node) + "'/>";
  return text + tags + "</way>\n";
}

/// `members`: "way 5 outer", "relation 7 part".
inline std::string osm_relation(long id, const std::vector<std::string>& members, const std::string& tags) {
  std::string text = "<relation id='" + std::to_string(id) + "' version='1'>";
  for (const std::string& member : members) {
    const std::size_t first = member.find(' '), second = member.find(' ', first + 1);
    text += "<member type='" + member.substr(0, first) + "' ref='" + member.substr(first + 1, second - first - 1) +
            "' role='" + member.substr(second + 1) + "'/>";
  }
  return text + tags + "</relation>\n";
}

/// Nodes `first`, `first` + 1, ... on the corners of a square, counter-clockwise from the lower left one.
inline std::string osm_square(long first, double west, double south, double size) {
  return osm_node(first, west, south) + osm_node(first + 1, west + size, south) +
         osm_node(first + 2, west + size, south + size) + osm_node(first + 3, west, south + size);
}

inline std::vector<long> osm_ring(long first) { return {first, first + 1, first + 2, first + 3, first}; }

inline osm::Extract extract_of(const std::string& content, const osm::ReadOptions& options = {}) {
  const TemporaryDirectory directory;
  write_bytes(directory / "map.osm", osm_xml(content));
  return osm::read_extract(directory / "map.osm", options);
}

/// Fails unless reading throws Error(input) with these texts in it.
inline void expect_map_error(const std::filesystem::path& file, const std::string& problem, const std::string& where) {
  try {
    osm::read_extract(file);
    ADD_FAILURE() << file << " was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(error.problem().find(problem), std::string::npos) << error.what();
    EXPECT_NE(error.where().find(where), std::string::npos) << error.what();
    EXPECT_FALSE(error.fix().empty()) << error.what();
  }
}

template <class Object>
const Object* find_object(const std::vector<Object>& list, osm::ObjectId id) {
  const auto found = std::find_if(list.begin(), list.end(), [id](const Object& one) { return one.id == id; });
  return found == list.end() ? nullptr : &*found;
}

inline const osm::Problem* find_problem(const osm::Extract& extract, osm::ObjectId id) {
  const auto found = std::find_if(extract.problems.begin(), extract.problems.end(),
                                  [id](const osm::Problem& problem) { return problem.object == id; });
  return found == extract.problems.end() ? nullptr : &*found;
}

inline osm::ObjectId way_id(std::int64_t id) { return {osm::ObjectType::way, id}; }
inline osm::ObjectId relation_id(std::int64_t id) { return {osm::ObjectType::relation, id}; }

/// Twice the area, counter-clockwise, in square degrees.
inline double doubled_area(const osm::Ring& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const osm::LonLat a = ring[i], b = ring[(i + 1) % ring.size()], o = ring[0];
    sum += (a.longitude_deg - o.longitude_deg) * (b.latitude_deg - o.latitude_deg) -
           (b.longitude_deg - o.longitude_deg) * (a.latitude_deg - o.latitude_deg);
  }
  return sum;
}

/// All that an extract holds, as text: equal for equal extracts. `file_details`: also what is known of the file itself.
inline std::string describe(const osm::Extract& extract, bool file_details = true) {
  std::string text;
  const auto number = [&text](double value) { text += std::to_string(value * 1e7) + " "; };
  const auto ring = [&](const std::vector<osm::LonLat>& positions) {
    for (const osm::LonLat position : positions) number(position.longitude_deg), number(position.latitude_deg);
    text += "/ ";
  };
  const auto head = [&text](osm::ObjectId id, const osm::Tags& tags) {
    text += "\n" + osm::text(id);
    for (const auto& [key, value] : tags.all) text += " [" + key + "=" + value + "]";
    text += " ";
  };
  for (const osm::Area& area : extract.areas) {
    head(area.id, area.tags);
    for (const osm::Polygon& polygon : area.polygons) {
      text += "outer ";
      ring(polygon.outer);
      for (const osm::Ring& hole : polygon.holes) ring(hole);
    }
  }
  for (const osm::Line& line : extract.lines) head(line.id, line.tags), ring(line.points);
  for (const osm::Point& point : extract.points) head(point.id, point.tags), ring({point.position});
  for (const osm::BuildingRelation& relation : extract.building_relations) {
    head(relation.id, relation.tags);
    for (const osm::ObjectId id : relation.outlines) text += "outline " + osm::text(id) + " ";
    for (const osm::ObjectId id : relation.parts) text += "part " + osm::text(id) + " ";
  }
  for (const osm::Problem& problem : extract.problems) {
    head(problem.object, problem.tags);
    text += std::to_string(static_cast<int>(problem.kind)) + " " + problem.what + (problem.lost ? " lost" : "");
  }
  text += "\n";
  for (const double bound : extract.bounds_deg) number(bound);
  for (const std::size_t count : {extract.nodes, extract.ways, extract.relations, extract.outside}) number(count);
  number(extract.nearest_outside_m);
  if (file_details) text += extract.sorted ? "sorted " : "unsorted ", number(extract.superseded);
  return text;
}

/// Whether osmium-tool is there.
inline bool has_osmium() {
  static const bool there = run_program("/usr/bin/env", {"osmium", "--version"}).exit_code == 0;
  return there;
}

/// What osmium-tool prints; fails the test where it fails.
inline std::string osmium(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "osmium");
  const ProgramRun run = run_program("/usr/bin/env", arguments);
  EXPECT_EQ(run.exit_code, 0) << arguments[1] << ": " << run.err;
  return run.out;
}

}  // namespace vantage::testing

/// Skips the running test, with a message, where osmium-tool is not installed.
#define VANTAGE_REQUIRE_OSMIUM() \
  if (!vantage::testing::has_osmium()) GTEST_SKIP() << "needs osmium-tool: the package osmium-tool"
