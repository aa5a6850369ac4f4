// Which positions a Region holds.
#pragma once

#include <array>
#include <optional>

#include "osm/extract.h"

namespace vantage::osm {

/// Metres on the WGS 84 ellipsoid: the arc over the chord between two points of it, bent by the earth's mean radius.
/// The radius enters only by the difference of arc and chord, d^3 / 24 R^2, so a mean one does: the error is
/// micrometres at 10 km, millimetres at 100 km, half a percent at the antipodes. No projection is needed; no pole or
/// date line is special.
double distance_m(LonLat a, LonLat b);

class RegionFilter {
 public:
  /// Throws Error(input) for a circle without a radius, a box without an extent, numbers out of range or not finite.
  explicit RegionFilter(const std::optional<Region>& region);

  bool everything() const { return !circle_ && !box_; }
  bool contains(LonLat position) const;
  /// From the centre of the circle, or else of the box; 0 where there is no region.
  double distance_m(LonLat position) const;

 private:
  struct Circle {
    LonLat centre;
    double radius_m = 0;
  };
  std::optional<Circle> circle_;
  std::optional<std::array<double, 4>> box_;
  std::array<double, 3> centre_{};  ///< metres, earth-centred
};

}  // namespace vantage::osm
