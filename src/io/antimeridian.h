// Polygons that cross the antimeridian, cut there: maps draw a side from 179.9 to -179.9 degrees around the globe (RFC
// 7946, section 3.1.9; longitudes of KML are -180 to 180).
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "geo/ellipsoid.h"
#include "vantage/geometry.h"

namespace vantage::internal::io {

/// From the scene frame to the globe; longitudes in -180 to 180.
using GlobePlace = std::function<geo::Geodetic(const Vec3& scene)>;

/// A corner of a polygon.
struct GlobeCorner {
  Vec3 scene;
  geo::Geodetic at;
};
using GlobeRing = std::vector<GlobeCorner>;
using GlobePolygon = std::vector<GlobeRing>;  ///< the outer ring, and holes

/// Whether the side between two longitudes is shorter across the antimeridian.
inline bool crosses_antimeridian(double from_deg, double to_deg) { return std::abs(from_deg - to_deg) > 180; }

/// Where the side from `a` to `b`, which crosses it, meets the antimeridian: the longitude is 180, and may as well be
/// -180.
GlobeCorner at_antimeridian(const Vec3& a, const Vec3& b, const GlobePlace& place);

/// The parts of a flat polygon of the scene frame on either side of the antimeridian, as the RFC demands: the same way
/// round, with 180 or -180 along the cut. One part, as it is, where it does not cross. Rings do not cross each other,
/// and are smaller than a scene can be. Throws Error(value_unsupported) for one about a pole.
std::vector<GlobePolygon> cut_at_antimeridian(const std::vector<std::vector<Vec3>>& rings, const GlobePlace& place);

}  // namespace vantage::internal::io
