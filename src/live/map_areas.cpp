#include "live/map_areas.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vantage/error.h"
#include "vantage/georeference.h"

namespace vantage::live {
namespace {

bool is_building(const MapArea& area) {
  return std::any_of(area.tags.begin(), area.tags.end(),
                     [](const auto& tag) { return tag.first == "building" || tag.first == "building:part"; });
}

/// Whether a ray to the east crosses the ring an odd number of times. Longitudes are taken from the point's, so that
/// the antimeridian is a place as any other.
bool is_in(const AreaPolygon::Ring& ring, const Eigen::Vector2d& at) {
  bool inside = false;
  for (std::size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++) {
    const double x = std::remainder(ring[i][0] - at.x(), 360), y = ring[i][1] - at.y();
    const double x0 = std::remainder(ring[before][0] - at.x(), 360), y0 = ring[before][1] - at.y();
    if ((y > 0) != (y0 > 0) && x0 + (x - x0) * y0 / (y0 - y) > 0) inside = !inside;
  }
  return inside;
}

bool is_in(const AreaPolygon& polygon, const Eigen::Vector2d& at) {
  return is_in(polygon.outer, at) && std::none_of(polygon.holes.begin(), polygon.holes.end(),
                                                  [&](const AreaPolygon::Ring& hole) { return is_in(hole, at); });
}

std::vector<MapArea> areas_of(const SceneSource& source, const Progress& progress) {
  AreaFilter filter;
  filter.region = source.city.region;
  std::vector<MapArea> areas = read_areas(source.file, filter, progress);
  std::erase_if(areas, is_building);
  std::stable_sort(areas.begin(), areas.end(),
                   [](const MapArea& a, const MapArea& b) { return a.area_m2 < b.area_m2; });
  return areas;
}

}  // namespace

const MapArea* MapAreas::at(const Eigen::Vector2d& position, const SceneSource& source, const Scene& scene,
                            const Progress& progress) {
  if (source.kind != SceneSource::Kind::map || !scene.georeference) {
    throw Error(ErrorCode::not_applicable, "only maps have areas", "", "draw a target on the ground");
  }
  if (!areas_) areas_ = areas_of(source, progress);
  const Eigen::Vector2d place = positions_in_crs(*scene.georeference, "EPSG:4326", {&position, 1}).front();
  for (const MapArea& area : *areas_) {
    if (std::any_of(area.polygons.begin(), area.polygons.end(), [&](const AreaPolygon& p) { return is_in(p, place); }))
      return &area;
  }
  return nullptr;
}

}  // namespace vantage::live
