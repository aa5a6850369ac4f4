#include "maps/city/object_outlines.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include "maps/city/footprint.h"
#include "maps/city/region.h"
#include "maps/city/structures.h"
#include "maps/osm/extract.h"

namespace vantage::internal::city {
namespace {

struct MapObject {
  osm::Area area;
  std::string name;
  bool is_area = false;
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
    object.is_area = true;
    object.area.partial |= area.partial;
    std::move(area.polygons.begin(), area.polygons.end(), std::back_inserter(object.area.polygons));
  }
  for (const osm::Line& line : extract.lines) {
    if (!line.is_closed() || line.id.type != osm::ObjectType::way) continue;  // a wall round an area is not it
    of(line.id, line.tags).area.polygons.push_back({{line.points.begin(), line.points.end() - 1}, {}});
  }
  return objects;
}

ObjectOutlines outlines_of(const MapObject& object, const geo::LocalFrame& frame) {
  ObjectOutlines found;
  found.is_area = !object.area.polygons.empty();
  Repairs repairs;
  found.outlines = footprints_of(object.area, frame, repairs);
  if (repairs.enclosed || object.area.partial) found.outlines.clear();  // nobody knows where it ends: no target
  found.name = object.name;
  return found;
}

std::vector<NamedOutline> named_outlines(const MapObjects& objects) {
  std::vector<NamedOutline> named;
  for (const auto& [id, object] : objects) {
    if (!object.name.empty()) named.push_back({object.name, osm::text(id), !object.is_area});
  }
  return named;
}

}  // namespace

OutlineFinder find_outlines(const std::filesystem::path& file, const CityRegion& region, const Progress& progress) {
  const auto objects = std::make_shared<const MapObjects>(read_objects(file, region, progress));
  const auto of = [objects](const std::string& object, const geo::LocalFrame& frame) -> std::optional<ObjectOutlines> {
    const auto id = osm::parse_object_id(object);
    if (!id) return std::nullopt;
    const auto known = objects->find(*id);
    return known == objects->end() ? ObjectOutlines{} : outlines_of(known->second, frame);
  };
  return {of, [objects] { return named_outlines(*objects); }};
}

}  // namespace vantage::internal::city
