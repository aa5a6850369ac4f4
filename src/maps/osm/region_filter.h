// Which positions a Region holds.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "maps/osm/extract.h"

namespace vantage::internal::osm {

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
  /// Whether some of the straight side between two positions is inside.
  bool meets(LonLat from, LonLat to) const;
  /// Whether a box round positions, level in the plane about the centre, meets the region: nothing that lies within
  /// their hull does where it does not. `turned`: nor does anything within any rectangle about them that has one of
  /// them on each side. Nothing lies round no position.
  bool meets_box_of(const std::vector<LonLat>& positions, bool turned) const;
  /// Whether a ray from the centre to the east crosses the side. The centre lies within rings that it crosses an odd
  /// number of times in all.
  bool is_east_of_centre(LonLat from, LonLat to) const;
  /// From the centre of the circle, or else of the box; 0 where there is no region.
  double distance_m(LonLat position) const;
  double distance_m(LonLat from, LonLat to) const;  ///< to the nearest point of a side

 private:
  /// About the centre, east and north. Degrees of longitude and latitude, which do not break at the date line; near a
  /// pole metres, in the azimuthal equidistant projection.
  std::array<double, 2> in_plane(LonLat position) const;
  LonLat from_plane(const std::array<double, 2>& place) const;
  /// A side in this plane, straight.
  struct Side {
    std::array<double, 2> from{}, along{};
  };
  Side side(LonLat from, LonLat to) const;
  bool cut_to_box(const Side& side, double& begin, double& end) const;
  /// From the centre to the nearest point of the part of a side, from `begin` to `end` of its length.
  double nearest_m(const Side& side, double begin, double end) const;

  struct Circle {
    LonLat centre;
    double radius_m = 0;
  };
  std::optional<Circle> circle_;
  std::optional<std::array<double, 4>> box_;
  LonLat middle_;
  bool polar_ = false;
  std::array<double, 3> centre_{};  ///< the same, metres, earth-centred
};

}  // namespace vantage::internal::osm
