#include "geo/on_globe.h"

namespace vantage::internal::geo {
namespace {

/// As src/tiles/place.cpp writes it.
bool is_tangent(const Georeference& georeference) {
  return georeference.source_crs == kEarthCentred && georeference.vertical == kEllipsoidalHeight;
}

}  // namespace

OnGlobe::OnGlobe(const Georeference& georeference) : map_({georeference.longitude_deg, georeference.latitude_deg}) {
  if (is_tangent(georeference)) tangent_.emplace(map_.origin());
}

Geodetic OnGlobe::to_geodetic(const Vec3& scene) const {
  if (tangent_ && scene.allFinite()) return from_ecef(tangent_->to_earth(scene));
  return {map_.to_lonlat(scene.head<2>()), scene.z()};  // throws for what is not finite
}

Vec3 OnGlobe::to_scene(const Geodetic& place) const {
  const Eigen::Vector2d at = map_.to_local(place.place);  // throws for what is no place
  if (tangent_) return tangent_->to_local(to_ecef(place));
  return {at.x(), at.y(), place.height_m};
}

Eigen::Vector2d OnGlobe::at_z(LonLat place, double z_m) const {
  Eigen::Vector2d at = map_.to_local(place);
  if (!tangent_ || at.norm() > kFarthestNormalM) return at;
  const Vec3 foot = tangent_->to_local(to_ecef({place, 0}));
  const Vec3 up = tangent_->to_local(to_ecef({place, 1000})) - foot;  // along the normal, which is straight
  return (foot + up * ((z_m - foot.z()) / up.z())).head<2>();
}

Eigen::Vector2d OnGlobe::on_surface(LonLat place, const SurfaceZ& surface) const {
  Eigen::Vector2d at = at_z(place, 0);
  if (!tangent_) return at;
  // Each step divides what is off by R / d or more, 600 at 10 km: 1e-10 is left of the 14 m of a height of 9 km.
  constexpr int kSteps = 4;
  for (int i = 0; i < kSteps; ++i) at = at_z(place, surface(at).value_or(0));
  return at;
}

Vec3 OnGlobe::to_earth(const Vec3& scene) const {
  return tangent_ ? tangent_->to_earth(scene) : to_ecef(to_geodetic(scene));
}

bool move_origin(std::vector<Vec3>& points, const Georeference& from, const Georeference& to) {
  const OnGlobe old_frame(from), new_frame(to);
  const bool is_same_place = from.latitude_deg == to.latitude_deg && from.longitude_deg == to.longitude_deg;
  if (is_same_place && old_frame.is_cartesian() == new_frame.is_cartesian()) return false;
  for (Vec3& point : points) point = new_frame.to_scene(old_frame.to_geodetic(point));
  return true;
}

}  // namespace vantage::internal::geo
