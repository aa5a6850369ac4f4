#include "maps/city/region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "core/format.h"
#include "maps/city/occluders.h"
#include "maps/osm/longitude_span.h"
#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

using geo::LonLat;
using Bounds = std::array<double, 4>;  // west, south, east, north

constexpr double kMostRadius = 50e3;  // metres: beyond it the frame's distances are no longer good to a decimetre

std::string bounds_text(const Bounds& b) {
  return core::format("latitude {:.5f} to {:.5f}, longitude {:.5f} to {:.5f}", b[1], b[3], b[0], b[2]);
}

/// "underground (2), outline without an area (1)": the three commonest, and how many other reasons there are.
std::string commonest(const std::vector<std::string>& all) {
  constexpr std::size_t kMostReasons = 3;
  std::map<std::string, std::size_t> counts;
  for (const std::string& reason : all) ++counts[reason];
  std::vector<std::pair<std::string, std::size_t>> reasons(counts.begin(), counts.end());
  std::stable_sort(reasons.begin(), reasons.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (std::size_t i = 0; i < std::min(reasons.size(), kMostReasons); ++i) {
    text.append(i == 0 ? "" : ", ").append(reasons[i].first).append(" (");
    text.append(std::to_string(reasons[i].second)).append(")");
  }
  if (reasons.size() > kMostReasons) text += " and " + std::to_string(reasons.size() - kMostReasons) + " other reasons";
  return text;
}

geo::LongitudeRange longitudes(const Bounds& b) { return {b[0], b[2]}; }

bool holds(const Bounds& b, double latitude, double longitude) {
  return longitudes(b).holds(longitude) && b[1] <= latitude && latitude <= b[3];
}

bool overlap(const Bounds& a, const Bounds& b) {
  return longitudes(a).meets(longitudes(b)) && a[1] <= b[3] && b[1] <= a[3];
}

/// The bounds of what lies round a pole, up to the pole.
Bounds with_pole(const Bounds& b) {
  if (longitudes(b).width_deg() <= 180) return b;
  return {-180, b[1] > 0 ? b[1] : -90, 180, b[1] > 0 ? 90 : b[3]};
}

/// Whose ends may lie beyond the antimeridian.
Bounds brought_back(Bounds b) {
  if (b[2] - b[0] >= 360) return {-180, std::max(-90.0, b[1]), 180, std::min(90.0, b[3])};
  if (b[0] < -180) b[0] += 360;
  if (b[2] > 180) b[2] -= 360;
  return {b[0], std::max(-90.0, b[1]), b[2], std::min(90.0, b[3])};
}

/// Half a box round a circle, degrees of longitude and latitude. Rough is enough.
std::array<double, 2> degrees_of(double radius_m, double latitude_deg) {
  constexpr double kMetresPerDegree = 111000;
  const double latitude = radius_m / kMetresPerDegree;
  const double shrink = std::cos(latitude_deg * std::numbers::pi / 180);
  const bool holds_pole = std::abs(latitude_deg) + latitude >= 90;
  return {holds_pole ? 180 : std::min(180.0, latitude / shrink), latitude};
}

/// It only decides whether an error is worth raising early.
Bounds box_round(const std::array<double, 2>& center, double radius_m) {
  const auto [longitude, latitude] = degrees_of(radius_m, center[0]);
  return brought_back({center[1] - longitude, center[0] - latitude, center[1] + longitude, center[0] + latitude});
}

std::optional<osm::Region> checked_circle(const CityRegion& region) {
  const auto [latitude, longitude] = *region.center_deg;
  if (!(std::abs(latitude) <= 90) || !(std::abs(longitude) <= 180)) {
    const bool is_swapped = std::abs(longitude) <= 90 && std::abs(latitude) <= 180;
    throw Error(ErrorCode::not_on_earth,
                core::format("there is no place at latitude {:g}, longitude {:g}", latitude, longitude), "center",
                is_swapped ? "write the latitude first: " + core::format("{:g},{:g}", longitude, latitude)
                           : "give degrees: the latitude from -90 to 90, then the longitude from -180 to 180");
  }
  if (!(region.radius_m > 0) || !(region.radius_m <= kMostRadius)) {
    throw Error(ErrorCode::region_invalid, core::format("a radius of {:g} m is not one to build", region.radius_m),
                "radius", "give metres, more than 0 and at most 50000");
  }
  return osm::Region{{{LonLat{longitude, latitude}, region.radius_m}}, {}};
}

std::optional<osm::Region> checked_box(const Bounds& b) {
  const bool in_range = std::abs(b[0]) <= 180 && std::abs(b[2]) <= 180 && std::abs(b[1]) <= 90 && std::abs(b[3]) <= 90;
  // One across the antimeridian has its west at the higher number: so has one whose ends were mixed up.
  const bool is_reversed = b[0] > b[2] && longitudes(b).width_deg() > 180;
  if (!in_range || is_reversed || b[0] == b[2] || !(b[1] < b[3])) {
    throw Error(ErrorCode::region_invalid, "the box holds nothing: " + bounds_text(b), "bbox",
                "give degrees as west,south,east,north: the lower longitude, the lower latitude, the higher ones");
  }
  const double nearest_equator = b[1] <= 0 && b[3] >= 0 ? 0 : std::min(std::abs(b[1]), std::abs(b[3]));
  // Round a pole a box is as wide as the circle of its lower latitude; else its middle tells enough.
  const double width = longitudes(b).width_deg() > 180
                           ? 2 * (90 - nearest_equator)
                           : longitudes(b).width_deg() * std::cos((b[1] + b[3]) / 2 * std::numbers::pi / 180);
  const double across = std::max(b[3] - b[1], width) * 111.0;
  if (across > 2 * kMostRadius / 1e3) {
    throw Error(ErrorCode::region_invalid, core::format("the box is {:.0f} km across", across), "bbox",
                "give one of at most 100 km");
  }
  return osm::Region{{}, b};
}

/// Calls `visit` with the outlines' positions. Of areas that are built alone: a file may have a coast, a border or a
/// wood that goes on for kilometres.
template <typename Visit>
void for_corners(const osm::Extract& extract, const Visit& visit) {
  for (const osm::Area& area : extract.areas) {
    if (lacks_height(area.tags, Geometry::area)) continue;
    for (const osm::Polygon& polygon : area.polygons) std::for_each(polygon.outer.begin(), polygon.outer.end(), visit);
  }
}

Bounds areas_bounds(const osm::Extract& extract) {
  osm::LongitudeSpan span;
  double south = 90, north = -90;
  for_corners(extract, [&](LonLat at) {
    span.add(at.longitude_deg);
    south = std::min(south, at.latitude_deg);
    north = std::max(north, at.latitude_deg);
  });
  if (span.empty()) return extract.bounds_deg;
  return {span.range().west, south, span.range().east, north};
}

/// The middle of what lies round a pole.
LonLat middle_round_pole(const osm::Extract& extract, double latitude_deg) {
  const geo::LocalFrame frame({0, latitude_deg > 0 ? 90.0 : -90.0});
  Eigen::Vector2d min = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), max = -min;
  for_corners(extract, [&](LonLat at) {
    min = min.cwiseMin(frame.to_local(at));
    max = max.cwiseMax(frame.to_local(at));
  });
  return min.x() <= max.x() ? frame.to_lonlat((min + max) / 2) : frame.origin();
}

}  // namespace

std::optional<osm::Region> checked_region(const CityRegion& region) {
  if (region.center_deg && region.bbox_deg) {
    throw Error(ErrorCode::conflicting_keys, "a centre and a box at once", "center, bbox",
                "give a centre with a radius, or a box");
  }
  if (!region.center_deg && region.radius_m != 0)
    throw Error(ErrorCode::missing_key, "a radius without a centre", "radius", "give the centre as well");
  if (region.center_deg) return checked_circle(region);
  if (region.bbox_deg) return checked_box(*region.bbox_deg);
  return {};
}

std::optional<osm::Region> with_margin(const std::optional<osm::Region>& region, double margin_m) {
  if (!region) return region;
  osm::Region wider = *region;
  if (wider.circle) wider.circle->second += margin_m;
  if (wider.box_deg) {
    const Bounds& b = *region->box_deg;
    const auto [south_width, height] = degrees_of(margin_m, b[1]);
    const double width = std::max(south_width, degrees_of(margin_m, b[3])[0]);
    const double east = b[0] <= b[2] ? b[2] : b[2] + 360;
    wider.box_deg = brought_back({b[0] - width, b[1] - height, east + width, b[3] + height});
  }
  return wider;
}

void check_overlap(const CityRegion& region, const osm::Extract& extract, const std::filesystem::path& file) {
  const Bounds known = with_pole(extract.bounds_deg);
  if (region.center_deg) {
    const auto [latitude, longitude] = *region.center_deg;
    if (overlap(box_round(*region.center_deg, region.radius_m), known)) return;
    throw Error(ErrorCode::region_outside,
                core::format("the centre, latitude {:g}, longitude {:g}, lies outside the map", latitude, longitude),
                file.string(),
                holds(known, longitude, latitude) ? "latitude and longitude are the wrong way round: write " +
                                                        core::format("{:g},{:g}", longitude, latitude)
                                                  : "the map holds " + bounds_text(known));
  }
  if (region.bbox_deg && !overlap(*region.bbox_deg, known)) {
    const Bounds& b = *region.bbox_deg;
    throw Error(ErrorCode::region_outside, "the box lies outside the map", file.string(),
                overlap({b[1], b[0], b[3], b[2]}, known)
                    ? "latitude and longitude are the wrong way round: write west,south,east,north"
                    : "the map holds " + bounds_text(known));
  }
}

void check_complete(const osm::Extract& extract, const std::filesystem::path& file) {
  if (extract.remark.empty()) return;
  throw Error(ErrorCode::scene_incomplete, "the map says that it is not complete: " + extract.remark, file.string(),
              "ask for it again: with a longer time limit, or in smaller parts; or read what is there of it: "
              "scene.partial: true (--partial)");
}

bool reaches_into(const osm::RegionFilter& region, const std::vector<Footprint>& built, const geo::LocalFrame& frame) {
  if (region.everything()) return true;
  const auto is_touched = [&](const Footprint& footprint) {
    bool found = false, round_centre = false;
    const auto take = [&](const Ring& ring) {
      LonLat from = frame.to_lonlat(ring.back());
      for (const Vec2& corner : ring) {
        const LonLat to = frame.to_lonlat(corner);
        found = found || region.meets(from, to);
        round_centre ^= region.is_east_of_centre(from, to);
        from = to;
      }
    };
    take(footprint.outer);
    std::for_each(footprint.holes.begin(), footprint.holes.end(), take);
    return found || round_centre;
  };
  return std::any_of(built.begin(), built.end(), is_touched);
}

void Outside::add(std::size_t more, double nearest) {
  if (more == 0) return;
  nearest_m = objects == 0 ? nearest : std::min(nearest_m, nearest);
  objects += more;
}

void fail_empty(const CityRegion& region, const osm::Extract& extract, const Outside& outside,
                const std::vector<std::string>& reasons, const std::filesystem::path& file) {
  if (outside.objects == 0 && reasons.empty()) {
    throw Error(ErrorCode::map_empty, "the map holds no building and nothing else to build", file.string(),
                "give an extract with buildings; it has " + std::to_string(extract.nodes) + " nodes and " +
                    std::to_string(extract.ways) + " ways, " + bounds_text(extract.bounds_deg));
  }
  if (outside.objects == 0) {
    throw Error(ErrorCode::map_empty, "nothing that the map holds can be built", file.string(),
                "correct it, or give another one; what it holds: " + commonest(reasons));
  }
  throw Error(ErrorCode::region_empty, "there is nothing to build in the area", file.string(),
              "the nearest of " + std::to_string(outside.objects) + " objects is " +
                  core::format("{:.0f} m", outside.nearest_m) +
                  (region.center_deg ? " from the centre: give a larger radius, or another centre"
                                     : " from the box: give a larger box") +
                  "; the map holds " + bounds_text(extract.bounds_deg) +
                  (reasons.empty() ? "" : "; not built in the area or near it: " + commonest(reasons)));
}

LonLat frame_origin(const CityRegion& region, const osm::Extract& extract) {
  if (region.center_deg) return {(*region.center_deg)[1], (*region.center_deg)[0]};
  const Bounds b = region.bbox_deg ? *region.bbox_deg : areas_bounds(extract);
  const double latitude = (b[1] + b[3]) / 2;
  const bool is_round_pole = longitudes(b).width_deg() > 180;
  if (is_round_pole && region.bbox_deg) return {0, latitude > 0 ? 90.0 : -90.0};
  if (is_round_pole) return middle_round_pole(extract, latitude);
  return {longitudes(b).middle_deg(), latitude};
}

}  // namespace vantage::internal::city
