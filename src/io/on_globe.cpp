#include "io/on_globe.h"

namespace vantage::internal::io {
namespace {

/// As src/tiles/place.cpp writes it.
bool is_tangent(const Georeference& georeference) {
  return georeference.source_crs == geo::kEarthCentred && georeference.vertical == geo::kEllipsoidalHeight;
}

}  // namespace

OnGlobe::OnGlobe(const Georeference& georeference) : map_({georeference.longitude_deg, georeference.latitude_deg}) {
  if (is_tangent(georeference)) tangent_.emplace(map_.origin());
}

geo::Geodetic OnGlobe::to_geodetic(const Vec3& scene) const {
  if (tangent_) return geo::from_ecef(tangent_->to_earth(scene));
  return {map_.to_lonlat(scene.head<2>()), scene.z()};
}

Vec3 OnGlobe::to_scene(const geo::Geodetic& place) const {
  if (tangent_) return tangent_->to_local(geo::to_ecef(place));
  const Eigen::Vector2d at = map_.to_local(place.place);
  return {at.x(), at.y(), place.height_m};
}

Vec3 OnGlobe::to_earth(const Vec3& scene) const {
  return tangent_ ? tangent_->to_earth(scene) : geo::to_ecef(to_geodetic(scene));
}

}  // namespace vantage::internal::io
