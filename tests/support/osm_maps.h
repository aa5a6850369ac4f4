// OpenStreetMap files for tests: written by hand, and looked at by osmium-tool, which shares no code of ours.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "maps/osm/extract.h"
#include "support/internals.h"
#include "support/temporary_directory.h"
#include "vantage/error.h"

namespace vantage::testing {

/// An OSM XML file around `content`.
inline std::string osm_xml(const std::string& content) {
  return "<?xml version='1.0' encoding='UTF-8'?>\n<osm version='0.6' generator='hand'>\n" + content + "</osm>\n";
}

std::string osm_node(long id, double lon, double lat, const std::string& inside = "");
std::string osm_tag(const std::string& key, const std::string& value);
std::string osm_way(long id, const std::vector<long>& nodes, const std::string& tags = "");
/// `members`: "way 5 outer", "relation 7 part".
std::string osm_relation(long id, const std::vector<std::string>& members, const std::string& tags);

inline osm::Tags tagged(std::initializer_list<std::pair<std::string, std::string>> all) { return osm::Tags{all}; }

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
std::string describe(const osm::Extract& extract, bool file_details = true);

/// Whether osmium-tool is there.
bool has_osmium();

/// What osmium-tool prints; fails the test where it fails.
std::string osmium(std::vector<std::string> arguments);

}  // namespace vantage::testing

/// Skips the running test, with a message, where osmium-tool is not installed.
#define VANTAGE_REQUIRE_OSMIUM() \
  if (!vantage::testing::has_osmium()) GTEST_SKIP() << "needs osmium-tool: the package osmium-tool"
