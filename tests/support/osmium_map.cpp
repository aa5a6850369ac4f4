#include "support/osmium_map.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "support/osm_maps.h"
#include "support/temporary_directory.h"

namespace vantage::testing {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// OPL writes what would be mistaken as %hex%. What is not ASCII matters to no test here.
std::string unescaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t end = text[i] == '%' ? text.find('%', i + 1) : std::string::npos;
    if (end == std::string::npos) {
      result += text[i];
      continue;
    }
    const unsigned long code = std::stoul(text.substr(i + 1, end - i - 1), nullptr, 16);
    result += code < 128 ? static_cast<char>(code) : '?';
    i = end;
  }
  return result;
}

std::string long_id(const std::string& opl) {
  std::string id = opl[0] == 'n' ? "node/" : opl[0] == 'w' ? "way/" : "relation/";
  return id.append(opl, 1);
}

/// "n17x24.95y60.17": where the node is, if the file says so.
void add_position(const std::string& node, LonLatRing& positions) {
  const std::size_t x = node.find('x'), y = node.find('y');
  if (x == std::string::npos || y == std::string::npos || y == x + 1) return;
  const std::array<double, 2> at = {std::stod(node.substr(x + 1)), std::stod(node.substr(y + 1))};
  if (positions.empty() || positions.back() != at) positions.push_back(at);
}

/// A line of OPL: https://osmcode.org/opl-file-format/
ListedObject parse_opl(const std::string& line) {
  const std::vector<std::string> fields = split(line, ' ');
  ListedObject object{long_id(fields[0]), {}, {}, {}};
  for (const std::string& field : fields) {
    const std::vector<std::string> list = split(field.substr(1), ',');
    for (const std::string& one : list) {
      const std::size_t equals = one.find('='), at = one.find('@');
      if (field.front() == 'T') object.tags[unescaped(one.substr(0, equals))] = unescaped(one.substr(equals + 1));
      if (field.front() == 'M') object.members.push_back({long_id(one.substr(0, at)), unescaped(one.substr(at + 1))});
      if (field.front() == 'N') add_position(one, object.positions);
    }
  }
  return object;
}

std::vector<ListedObject> listed(const std::filesystem::path& map, const std::vector<std::string>& filter) {
  std::vector<std::string> arguments = {"tags-filter", "-R", "-f",        "opl,locations_on_ways=true",
                                        "-o",          "-",  map.string()};
  arguments.insert(arguments.end(), filter.begin(), filter.end());
  std::vector<ListedObject> objects;
  for (const std::string& line : split(osmium(arguments), '\n')) objects.push_back(parse_opl(line));
  return objects;
}

/// The building polygons that osmium-tool exports.
std::map<std::string, ExportedArea> exported_areas(const std::filesystem::path& map) {
  std::map<std::string, ExportedArea> areas;
  const std::string text = osmium({"export", "-f", "geojsonseq", "-x", "print_record_separator=false",
                                   "--geometry-types=polygon", "--add-unique-id=type_id", map.string()});
  for (const std::string& line : split(text, '\n')) {
    if (line.find("\"building") == std::string::npos) continue;
    const nlohmann::json feature = nlohmann::json::parse(line);
    ExportedArea area;
    for (const auto& [key, value] : feature["properties"].items()) {
      area.tags[key] = value.is_string() ? value.get<std::string>() : value.dump();
    }
    if (!says_building(area.tags) && !says_part(area.tags)) continue;
    area.polygons = feature["geometry"]["coordinates"].get<std::vector<LonLatPolygon>>();
    // "a17": areas of ways have even ids, those of relations odd ones.
    const long long id = std::stoll(feature["id"].get<std::string>().substr(1));
    areas[std::string(id % 2 == 0 ? "way/" : "relation/").append(std::to_string(id / 2))] = std::move(area);
  }
  return areas;
}

/// Ways that are not polygons for osmium-tool, closed by a straight side.
void add_mended(OsmiumMap& map) {
  for (const ListedObject& object : map.tagged) {
    const bool is_wanted = says_building(object.tags) || says_part(object.tags);
    if (!is_wanted || object.positions.size() < 3 || map.areas.contains(object.id)) continue;
    LonLatRing ring = object.positions;
    if (ring.front() != ring.back()) ring.push_back(ring.front());
    if (ring.size() >= 4) map.areas[object.id] = {object.tags, {{std::move(ring)}}, true};
  }
}

}  // namespace

bool says_part(const TagMap& tags) {
  const std::string part = tag(tags, "building:part");
  return !part.empty() && part != "no";
}

bool says_building(const TagMap& tags) {
  const std::string building = tag(tags, "building");
  return !building.empty() && building != "no" && !says_part(tags);
}

OsmiumMap read_with_osmium(const std::filesystem::path& unsorted) {
  const TemporaryDirectory directory;
  const std::filesystem::path map = directory / "sorted.osm.pbf";  // it exports nothing else
  osmium({"sort", "-o", map.string(), unsorted.string()});
  const std::filesystem::path located = directory / "located.osm.pbf";
  osmium({"add-locations-to-ways", "-n", "--ignore-missing-nodes", "-o", located.string(), map.string()});
  OsmiumMap result;
  result.tagged = listed(located, {"nwr/building", "nwr/building:part"});
  for (ListedObject& relation : listed(map, {"r/type"})) {
    std::string id = relation.id;
    result.relations[id] = std::move(relation);
  }
  result.areas = exported_areas(map);
  add_mended(result);
  return result;
}

}  // namespace vantage::testing
