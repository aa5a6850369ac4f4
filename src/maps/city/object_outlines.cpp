#include "maps/city/object_outlines.h"

#include <utility>

#include "maps/city/region.h"
#include "maps/osm/extract.h"

namespace vantage::internal::city {
namespace {

bool is_closed(const osm::Line& line) {
  const geo::LonLat &first = line.points.front(), &last = line.points.back();
  return line.points.size() > 3 && first.longitude_deg == last.longitude_deg && first.latitude_deg == last.latitude_deg;
}

/// The polygons of an object of the map: an area, or any closed way.
std::vector<osm::Polygon> polygons_of(const osm::Extract& extract, osm::ObjectId id) {
  std::vector<osm::Polygon> polygons;
  for (const osm::Area& area : extract.areas) {
    if (area.id != id) continue;
    polygons.insert(polygons.end(), area.polygons.begin(), area.polygons.end());
  }
  for (const osm::Line& line : extract.lines) {
    if (line.id == id && is_closed(line)) polygons.push_back({{line.points.begin(), line.points.end() - 1}, {}});
  }
  return polygons;
}

Ring projected(const osm::Ring& ring, const geo::LocalFrame& frame) {
  Ring result;
  for (const geo::LonLat& position : ring) result.push_back(frame.to_local(position));
  return result;
}

/// Of an object of the map: "Zuccotti Park"; empty where it has none.
std::string name_of(const osm::Extract& extract, osm::ObjectId id) {
  for (const osm::Area& area : extract.areas) {
    if (area.id == id && area.tags.has("name")) return std::string(area.tags.get("name"));
  }
  for (const osm::Line& line : extract.lines) {
    if (line.id == id && line.tags.has("name")) return std::string(line.tags.get("name"));
  }
  return {};
}

}  // namespace

std::optional<ObjectOutlines> outlines_of_object(const std::filesystem::path& file, const CityRegion& region,
                                                 const std::string& object, const geo::LocalFrame& frame,
                                                 const Progress& progress) {
  const auto id = osm::parse_object_id(object);
  if (!id) return std::nullopt;
  osm::ReadOptions options;
  options.region = checked_region(region);
  const osm::Extract extract = osm::read_extract(file, options, progress);
  std::vector<Footprint> rough;
  for (const osm::Polygon& polygon : polygons_of(extract, *id)) {
    Footprint footprint{projected(polygon.outer, frame), {}};
    for (const osm::Ring& hole : polygon.holes) footprint.holes.push_back(projected(hole, frame));
    rough.push_back(std::move(footprint));
  }
  ObjectOutlines found;
  found.is_area = !rough.empty();
  Repairs repairs;
  found.outlines = clean(rough, repairs);
  found.name = name_of(extract, *id);
  return found;
}

}  // namespace vantage::internal::city
