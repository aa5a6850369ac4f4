#include "osm/region_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vantage/error.h"

namespace vantage::osm {
namespace {

constexpr double kSemiMajor = 6378137.0;             // metres, WGS 84
constexpr double kFlattening = 1.0 / 298.257223563;  // WGS 84
constexpr double kMeanRadius = 6371008.8;            // metres, (2a + b) / 3
constexpr double kShortestDegree = 110574.0;         // metres of latitude, at the equator: the shortest on WGS 84
constexpr double kDegree = std::numbers::pi / 180;

/// Earth-centred, metres: of a point on the ellipsoid.
std::array<double, 3> on_ellipsoid(LonLat position) {
  constexpr double kEccentricity2 = kFlattening * (2 - kFlattening);
  const double latitude = position.latitude_deg * kDegree, longitude = position.longitude_deg * kDegree;
  const double sine = std::sin(latitude), cosine = std::cos(latitude);
  const double normal = kSemiMajor / std::sqrt(1 - kEccentricity2 * sine * sine);
  return {normal * cosine * std::cos(longitude), normal * cosine * std::sin(longitude),
          normal * (1 - kEccentricity2) * sine};
}

double arc(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double chord = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  return 2 * kMeanRadius * std::asin(std::min(1.0, chord / (2 * kMeanRadius)));
}

bool is_on_earth(LonLat position) {
  return std::abs(position.latitude_deg) <= 90 && std::abs(position.longitude_deg) <= 180;  // false for NaN
}

[[noreturn]] void fail(std::string problem, std::string fix) {
  throw Error(ErrorKind::input, std::move(problem), "the region", std::move(fix));
}

}  // namespace

double distance_m(LonLat a, LonLat b) { return arc(on_ellipsoid(a), on_ellipsoid(b)); }

RegionFilter::RegionFilter(const std::optional<Region>& region) {
  if (!region) return;
  LonLat centre;
  if (region->box_deg) {
    const auto& [west, south, east, north] = *region->box_deg;
    if (!is_on_earth({west, south}) || !is_on_earth({east, north})) {
      fail("the box is not on the earth", "give west, south, east, north in degrees");
    }
    if (!(south < north) || west == east) fail("the box has no extent", "give west, south, east, north in degrees");
    box_ = region->box_deg;
    const double width = west < east ? east - west : east - west + 360;
    centre = {std::remainder(west + width / 2, 360), (south + north) / 2};
  }
  if (region->circle) {
    circle_ = Circle{region->circle->first, region->circle->second};
    if (!is_on_earth(circle_->centre)) fail("the centre is not on the earth", "give its degrees");
    if (!(circle_->radius_m > 0) || !std::isfinite(circle_->radius_m)) {
      fail("the radius is not above zero", "give it in metres");
    }
    centre = circle_->centre;
  }
  centre_ = on_ellipsoid(centre);
}

bool RegionFilter::contains(LonLat position) const {
  if (box_) {
    const auto& [west, south, east, north] = *box_;
    if (position.latitude_deg < south || position.latitude_deg > north) return false;
    const bool from_west = position.longitude_deg >= west, to_east = position.longitude_deg <= east;
    // A box whose west is east of its east lies over the date line.
    if (west < east ? !(from_west && to_east) : !(from_west || to_east)) return false;
  }
  if (!circle_) return true;
  if (std::abs(position.latitude_deg - circle_->centre.latitude_deg) * kShortestDegree > circle_->radius_m)
    return false;
  return distance_m(position) <= circle_->radius_m;
}

double RegionFilter::distance_m(LonLat position) const {
  return everything() ? 0 : arc(on_ellipsoid(position), centre_);
}

}  // namespace vantage::osm
