#include "maps/osm/region_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "vantage/error.h"

namespace vantage::internal::osm {
namespace {

constexpr double kSemiMajor = 6378137.0;                         // metres, WGS 84
constexpr double kFlattening = 1.0 / 298.257223563;              // WGS 84
constexpr double kMeanRadius = 6371008.8;                        // metres, (2a + b) / 3
constexpr double kPolarRadius = kSemiMajor / (1 - kFlattening);  // metres, of the earth's curvature at its poles
constexpr double kShortestDegree = 110574.0;  // metres of latitude, at the equator: the shortest on WGS 84
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kPolar = 85;  // degrees of latitude, from where on meridians run together too fast to be a plane's

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

[[noreturn]] void fail(ErrorCode code, std::string problem, std::string fix) {
  throw Error(code, std::move(problem), "the region", std::move(fix));
}

using Plane = std::array<double, 2>;

Plane at(const Plane& from, const Plane& along, double part) {
  return {from[0] + part * along[0], from[1] + part * along[1]};
}

}  // namespace

double distance_m(LonLat a, LonLat b) { return arc(on_ellipsoid(a), on_ellipsoid(b)); }

RegionFilter::RegionFilter(const std::optional<Region>& region) {
  if (!region) return;
  LonLat centre;
  if (region->box_deg) {
    const auto& [west, south, east, north] = *region->box_deg;
    if (!is_on_earth({west, south}) || !is_on_earth({east, north})) {
      fail(ErrorCode::not_on_earth, "the box is not on the earth", "give west, south, east, north in degrees");
    }
    if (!(south < north) || west == east)
      fail(ErrorCode::region_invalid, "the box has no extent", "give west, south, east, north in degrees");
    box_ = region->box_deg;
    const double width = west < east ? east - west : east - west + 360;
    centre = {std::remainder(west + width / 2, 360), (south + north) / 2};
  }
  if (region->circle) {
    circle_ = Circle{region->circle->first, region->circle->second};
    if (!is_on_earth(circle_->centre))
      fail(ErrorCode::not_on_earth, "the centre is not on the earth", "give its degrees");
    if (!(circle_->radius_m > 0) || !std::isfinite(circle_->radius_m)) {
      fail(ErrorCode::region_invalid, "the radius is not above zero", "give it in metres");
    }
    centre = circle_->centre;
  }
  middle_ = centre;
  centre_ = on_ellipsoid(centre);
  polar_ = std::abs(centre.latitude_deg) >= kPolar;
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

std::array<double, 2> RegionFilter::in_plane(LonLat position) const {
  if (!polar_) {
    return {std::remainder(position.longitude_deg - middle_.longitude_deg, 360),
            position.latitude_deg - middle_.latitude_deg};
  }
  const double latitude = middle_.latitude_deg * kDegree, longitude = middle_.longitude_deg * kDegree;
  std::array<double, 3> away = on_ellipsoid(position);
  for (std::size_t axis = 0; axis < 3; ++axis) away[axis] -= centre_[axis];
  const double outward = std::cos(longitude) * away[0] + std::sin(longitude) * away[1];
  const double east = -std::sin(longitude) * away[0] + std::cos(longitude) * away[1];
  const double north = std::cos(latitude) * away[2] - std::sin(latitude) * outward;
  const double flat = std::hypot(east, north);
  const double stretch = flat > 0 ? distance_m(position) / flat : 1;
  return {stretch * east, stretch * north};
}

LonLat RegionFilter::from_plane(const std::array<double, 2>& place) const {
  if (!polar_) {
    return {std::remainder(middle_.longitude_deg + place[0], 360), middle_.latitude_deg + place[1]};
  }
  // On a sphere that is bent as the earth is at its poles: right to metres in 100 km.
  const double distance = std::hypot(place[0], place[1]) / kPolarRadius, azimuth = std::atan2(place[0], place[1]);
  const double latitude = middle_.latitude_deg * kDegree;
  const double sine = std::clamp(
      std::sin(latitude) * std::cos(distance) + std::cos(latitude) * std::sin(distance) * std::cos(azimuth), -1.0, 1.0);
  const double turn = std::atan2(std::sin(azimuth) * std::sin(distance) * std::cos(latitude),
                                 std::cos(distance) - std::sin(latitude) * sine);
  return {std::remainder(middle_.longitude_deg + turn / kDegree, 360), std::asin(sine) / kDegree};
}

RegionFilter::Side RegionFilter::side(LonLat from, LonLat to) const {
  const Plane first = in_plane(from);
  if (polar_) {
    const Plane last = in_plane(to);
    return {first, {last[0] - first[0], last[1] - first[1]}};
  }
  return {first, {std::remainder(to.longitude_deg - from.longitude_deg, 360), to.latitude_deg - from.latitude_deg}};
}

double RegionFilter::nearest_m(const Side& side, double begin, double end) const {
  // A degree of longitude is shorter by the cosine: enough to find the place, whose distance is then measured.
  const double shrink = polar_ ? 1 : std::cos(middle_.latitude_deg * kDegree);
  const double x = shrink * side.from[0], y = side.from[1], dx = shrink * side.along[0], dy = side.along[1];
  const double square = dx * dx + dy * dy;
  const Plane place =
      at(side.from, side.along, square > 0 ? std::clamp(-(x * dx + y * dy) / square, begin, end) : begin);
  return polar_ ? std::hypot(place[0], place[1]) : distance_m(from_plane(place));
}

/// The part of a side that lies in the box; false when there is none. Y.-D. Liang and B. A. Barsky, 1984.
bool RegionFilter::cut_to_box(const Side& side, double& begin, double& end) const {
  const auto& [west, south, east, north] = *box_;
  const double low_x = std::remainder(west - middle_.longitude_deg, 360);
  const std::array<double, 2> low = {low_x, south - middle_.latitude_deg};
  const std::array<double, 2> size = {west < east ? east - west : east - west + 360, north - south};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double before = low[axis] - side.from[axis], after = before + size[axis], along = side.along[axis];
    if (along == 0 && (before > 0 || after < 0)) return false;
    if (along == 0) continue;
    begin = std::max(begin, std::min(before / along, after / along));
    end = std::min(end, std::max(before / along, after / along));
  }
  return begin <= end;
}

bool RegionFilter::meets(LonLat from, LonLat to) const {
  if (everything() || contains(from) || contains(to)) return true;
  const Side whole = side(from, to);
  if (polar_ && box_) {  // whose sides are curves in the plane, and the side one in the box
    constexpr int kSteps = 64;
    for (int i = 1; i < kSteps; ++i) {
      if (contains(from_plane(at(whole.from, whole.along, static_cast<double>(i) / kSteps)))) return true;
    }
    return false;
  }
  double begin = 0, end = 1;
  if (box_ && !cut_to_box(whole, begin, end)) return false;
  return !circle_ || nearest_m(whole, begin, end) <= circle_->radius_m;
}

bool RegionFilter::meets_box_of(const std::vector<LonLat>& positions, bool turned) const {
  if (everything()) return true;
  if (positions.empty()) return false;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Plane low = {kFar, kFar}, high = {-kFar, -kFar};
  for (const LonLat position : positions) {
    const Plane place = in_plane(position);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], place[axis]);
      high[axis] = std::max(high[axis], place[axis]);
    }
  }
  if (turned) {
    // A corner of the rectangle lies on the circle over two of the positions (Thales): on one axis it is beyond both by
    // no more than half of what they are apart on the other.
    const double shrink = polar_ ? 1 : std::cos(middle_.latitude_deg * kDegree);
    const double more = std::max(shrink * (high[0] - low[0]), high[1] - low[1]) / 2;
    low = {low[0] - more / shrink, low[1] - more};
    high = {high[0] + more / shrink, high[1] + more};
  }
  const bool holds_centre = low[0] <= 0 && low[1] <= 0 && high[0] >= 0 && high[1] >= 0;
  if (holds_centre || (!polar_ && high[0] - low[0] >= 180)) return true;  // a longer side would go round the other way
  const std::array<LonLat, 4> corners = {from_plane(low), from_plane({high[0], low[1]}), from_plane(high),
                                         from_plane({low[0], high[1]})};
  for (std::size_t i = 0; i < 4; ++i) {
    if (meets(corners[i], corners[(i + 1) % 4])) return true;
  }
  return false;
}

bool RegionFilter::is_east_of_centre(LonLat from, LonLat to) const {
  const Side whole = side(from, to);
  const double end = whole.from[1] + whole.along[1];
  if ((whole.from[1] > 0) == (end > 0)) return false;
  return whole.from[0] - whole.from[1] / whole.along[1] * whole.along[0] > 0;
}

double RegionFilter::distance_m(LonLat position) const {
  return everything() ? 0 : arc(on_ellipsoid(position), centre_);
}

double RegionFilter::distance_m(LonLat from, LonLat to) const { return nearest_m(side(from, to), 0, 1); }

}  // namespace vantage::internal::osm
