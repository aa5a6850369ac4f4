// Areas on the ground of polygons in degrees, by the plainest means.
#pragma once

#include <vector>

#include "support/osmium_map.h"

namespace vantage::testing {

/// Metres east and north of a point: equirectangular, with the radii of curvature of WGS 84 there.
class PlainFrame {
 public:
  PlainFrame(double longitude_deg, double latitude_deg);
  std::array<double, 2> operator()(const std::array<double, 2>& lonlat) const;

 private:
  double longitude_, latitude_, metres_east_, metres_north_;  // the latter two in one degree
};

using PlainRing = std::vector<std::array<double, 2>>;
using PlainPolygons = std::vector<std::vector<PlainRing>>;

/// About the polygons' first corner, or in a frame that is given.
PlainFrame frame_about(const std::vector<LonLatPolygon>& polygons);
PlainPolygons in_metres(const std::vector<LonLatPolygon>& polygons, const PlainFrame& frame);

/// Outer rings less their holes, by the shoelace formula; m2.
double plain_area(const PlainPolygons& polygons);

/// How much of `outline` the union of the others covers, m2: measured along `kScanLines` lines.
double covered_area(const PlainPolygons& outline, const std::vector<PlainPolygons>& covering);
constexpr int kScanLines = 2000;

/// West, south, east, north; degrees.
std::array<double, 4> bounds_of(const std::vector<LonLatPolygon>& polygons);

}  // namespace vantage::testing
