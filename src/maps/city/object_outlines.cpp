#include "maps/city/object_outlines.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include "maps/city/region.h"
#include "maps/osm/extract.h"

namespace vantage::internal::city {
namespace {

bool is_closed(const osm::Line& line) {
  const geo::LonLat &first = line.points.front(), &last = line.points.back();
  return line.points.size() > 3 && first.longitude_deg == last.longitude_deg && first.latitude_deg == last.latitude_deg;
}

Ring projected(const osm::Ring& ring, const geo::LocalFrame& frame) {
  Ring result;
  for (const geo::LonLat& position : ring) result.push_back(frame.to_local(position));
  return result;
}

struct MapObject {
  std::vector<osm::Polygon> polygons;
  std::string name;
};

using MapObjects = std::map<osm::ObjectId, MapObject>;

MapObjects read_objects(const std::filesystem::path& file, const CityRegion& region, const Progress& progress) {
  osm::ReadOptions options;
  options.region = checked_region(region);
  osm::Extract extract = osm::read_extract(file, options, progress);
  MapObjects objects;
  const auto of = [&](osm::ObjectId id, const osm::Tags& tags) -> MapObject& {
    MapObject& object = objects[id];
    if (object.name.empty()) object.name = tags.get("name");
    return object;
  };
  for (osm::Area& area : extract.areas) {
    MapObject& object = of(area.id, area.tags);
    std::move(area.polygons.begin(), area.polygons.end(), std::back_inserter(object.polygons));
  }
  for (const osm::Line& line : extract.lines) {
    if (!is_closed(line)) continue;
    of(line.id, line.tags).polygons.push_back({{line.points.begin(), line.points.end() - 1}, {}});
  }
  return objects;
}

}  // namespace

OutlineFinder find_outlines(const std::filesystem::path& file, const CityRegion& region, const Progress& progress) {
  const auto objects = std::make_shared<const MapObjects>(read_objects(file, region, progress));
  return [objects](const std::string& object, const geo::LocalFrame& frame) -> std::optional<ObjectOutlines> {
    const auto id = osm::parse_object_id(object);
    if (!id) return std::nullopt;
    ObjectOutlines found;
    const auto known = objects->find(*id);
    if (known == objects->end()) return found;
    std::vector<Footprint> rough;
    for (const osm::Polygon& polygon : known->second.polygons) {
      Footprint footprint{projected(polygon.outer, frame), {}};
      for (const osm::Ring& hole : polygon.holes) footprint.holes.push_back(projected(hole, frame));
      rough.push_back(std::move(footprint));
    }
    found.is_area = !rough.empty();
    Repairs repairs;
    found.outlines = clean(rough, repairs);
    found.name = known->second.name;
    return found;
  };
}

}  // namespace vantage::internal::city
