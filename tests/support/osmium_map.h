// A map as osmium-tool sees it: its lists and its GeoJSON, read anew here, so that it shares no code with ours.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace vantage::testing {

using TagMap = std::map<std::string, std::string>;

/// The value, or an empty text.
inline std::string tag(const TagMap& tags, const std::string& key) {
  const auto found = tags.find(key);
  return found == tags.end() ? std::string() : found->second;
}

/// Longitude and latitude, degrees; the first position is repeated at the end.
using LonLatRing = std::vector<std::array<double, 2>>;
using LonLatPolygon = std::vector<LonLatRing>;  ///< the outer ring, then the holes

struct ListedObject {
  struct Member {
    std::string id, role;  ///< "way/17", "outer"
  };
  std::string id;  ///< "way/17"
  TagMap tags;
  std::vector<Member> members;  ///< of a relation
  LonLatRing positions;         ///< of a way: of the nodes that are in the file
};

struct ExportedArea {
  TagMap tags;
  std::vector<LonLatPolygon> polygons;
  bool is_mended =
      false;  ///< a way that is not a polygon for osmium-tool: it lacks nodes, is not closed or crosses itself
};

struct OsmiumMap {
  std::vector<ListedObject> tagged;  ///< nodes, ways and relations with a tag building or building:part
  std::map<std::string, ListedObject> relations;
  /// Tagged likewise, by id: the polygons that osmium-tool makes, and other ways of three positions and more, closed.
  std::map<std::string, ExportedArea> areas;
};

/// Fails the running test where osmium-tool does.
OsmiumMap read_with_osmium(const std::filesystem::path& map);

/// building or building:part says yes, in whatever words.
bool says_part(const TagMap& tags);
bool says_building(const TagMap& tags);  ///< and not a part

}  // namespace vantage::testing
