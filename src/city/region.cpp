#include "city/region.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "vantage/error.h"

namespace vantage::city {
namespace {

using geo::LonLat;
using Bounds = std::array<double, 4>;  // west, south, east, north

constexpr double kMostRadius = 50e3;  // metres: beyond it the frame's distances are no longer good to a decimetre

std::string formatted(const char* format, double a, double b) {
  char text[96];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

std::string bounds_text(const Bounds& b) {
  char text[160];
  std::snprintf(text, sizeof text, "latitude %.5f to %.5f, longitude %.5f to %.5f", b[1], b[3], b[0], b[2]);
  return text;
}

/// "underground (2), outline without an area (1)": the three commonest, and how many other reasons there are.
std::string reasons_of(const std::vector<CityRecord>& skipped) {
  constexpr std::size_t kMostReasons = 3;
  std::map<std::string, std::size_t> counts;
  for (const CityRecord& record : skipped) ++counts[record.reason];
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

[[noreturn]] void fail(const std::string& problem, const std::string& where, const std::string& fix) {
  throw Error(ErrorKind::input, problem, where, fix);
}

bool holds(const Bounds& b, double latitude, double longitude) {
  return b[0] <= longitude && longitude <= b[2] && b[1] <= latitude && latitude <= b[3];
}

bool overlap(const Bounds& a, const Bounds& b) { return a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3]; }

/// A box round a circle, degrees. Rough is enough: it only decides whether an error is worth raising early.
Bounds box_round(const std::array<double, 2>& center, double radius_m) {
  constexpr double kMetresPerDegree = 111000;
  const double latitude = radius_m / kMetresPerDegree;
  const double longitude = latitude / std::max(0.01, std::cos(center[0] * M_PI / 180));
  return {center[1] - longitude, center[0] - latitude, center[1] + longitude, center[0] + latitude};
}

std::optional<osm::Region> checked_circle(const CityRegion& region) {
  const auto [latitude, longitude] = *region.center_deg;
  if (!(std::abs(latitude) <= 90) || !(std::abs(longitude) <= 180)) {
    const bool is_swapped = std::abs(longitude) <= 90 && std::abs(latitude) <= 180;
    fail(formatted("there is no place at latitude %g, longitude %g", latitude, longitude), "center",
         is_swapped ? "write the latitude first: " + formatted("%g,%g", longitude, latitude)
                    : "give degrees: the latitude from -90 to 90, then the longitude from -180 to 180");
  }
  if (!(region.radius_m > 0) || !(region.radius_m <= kMostRadius)) {
    fail("a radius of " + formatted("%g m", region.radius_m, 0) + " is not one to build", "radius",
         "give metres, more than 0 and at most 50000");
  }
  return osm::Region{{{LonLat{longitude, latitude}, region.radius_m}}, {}};
}

std::optional<osm::Region> checked_box(const Bounds& b) {
  const bool in_range = std::abs(b[0]) <= 180 && std::abs(b[2]) <= 180 && std::abs(b[1]) <= 90 && std::abs(b[3]) <= 90;
  if (!in_range || !(b[0] < b[2]) || !(b[1] < b[3])) {
    fail("the box holds nothing: " + bounds_text(b), "bbox",
         "give degrees as west,south,east,north: the lower longitude, the lower latitude, the higher ones");
  }
  const double across = std::max(b[3] - b[1], (b[2] - b[0]) * std::cos((b[1] + b[3]) / 2 * M_PI / 180)) * 111.0;
  if (across > 2 * kMostRadius / 1e3) {
    fail("the box is " + formatted("%.0f km across", across, 0), "bbox", "give one of at most 100 km");
  }
  return osm::Region{{}, b};
}

/// Of the areas alone: a file may have a coast or a border that goes on for kilometres.
Bounds areas_bounds(const osm::Extract& extract) {
  Bounds b{180, 90, -180, -90};
  for (const osm::Area& area : extract.areas) {
    for (const osm::Polygon& polygon : area.polygons) {
      for (const LonLat at : polygon.outer) {
        b = {std::min(b[0], at.longitude_deg), std::min(b[1], at.latitude_deg), std::max(b[2], at.longitude_deg),
             std::max(b[3], at.latitude_deg)};
      }
    }
  }
  return b[0] <= b[2] ? b : extract.bounds_deg;
}

}  // namespace

std::optional<osm::Region> checked_region(const CityRegion& region) {
  if (region.center_deg && region.bbox_deg) {
    fail("a centre and a box at once", "center, bbox", "give a centre with a radius, or a box");
  }
  if (!region.center_deg && region.radius_m != 0)
    fail("a radius without a centre", "radius", "give the centre as well");
  if (region.center_deg) return checked_circle(region);
  if (region.bbox_deg) return checked_box(*region.bbox_deg);
  return {};
}

std::optional<osm::Region> with_margin(const std::optional<osm::Region>& region) {
  constexpr double kMargin = 300;  // metres: more than any part lies from the rest of its building
  if (!region) return region;
  osm::Region wider = *region;
  if (wider.circle) wider.circle->second += kMargin;
  if (wider.box_deg) {
    const Bounds& b = *region->box_deg;
    const Bounds south = box_round({b[1], b[0]}, kMargin), north = box_round({b[3], b[2]}, kMargin);
    wider.box_deg = {std::max(-180.0, std::min(south[0], b[0] - (north[2] - b[2]))), std::max(-90.0, south[1]),
                     std::min(180.0, std::max(north[2], b[2] + (b[0] - south[0]))), std::min(90.0, north[3])};
  }
  return wider;
}

void check_overlap(const CityRegion& region, const osm::Extract& extract, const std::filesystem::path& file) {
  const Bounds& known = extract.bounds_deg;
  if (region.center_deg) {
    const auto [latitude, longitude] = *region.center_deg;
    if (overlap(box_round(*region.center_deg, region.radius_m), known)) return;
    fail(formatted("the centre, latitude %g, longitude %g, lies outside the map", latitude, longitude), file.string(),
         holds(known, longitude, latitude)
             ? "latitude and longitude are the wrong way round: write " + formatted("%g,%g", longitude, latitude)
             : "the map holds " + bounds_text(known));
  }
  if (region.bbox_deg && !overlap(*region.bbox_deg, known)) {
    const Bounds& b = *region.bbox_deg;
    fail("the box lies outside the map", file.string(),
         overlap({b[1], b[0], b[3], b[2]}, known)
             ? "latitude and longitude are the wrong way round: write west,south,east,north"
             : "the map holds " + bounds_text(known));
  }
}

void Outside::add(std::size_t more, double nearest) {
  if (more == 0) return;
  nearest_m = objects == 0 ? nearest : std::min(nearest_m, nearest);
  objects += more;
}

void fail_empty(const CityRegion& region, const osm::Extract& extract, const Outside& outside,
                const std::vector<CityRecord>& skipped, const std::filesystem::path& file) {
  if (outside.objects == 0 && skipped.empty()) {
    fail("the map holds no building and nothing else to build", file.string(),
         "give an extract with buildings; it has " + std::to_string(extract.nodes) + " nodes and " +
             std::to_string(extract.ways) + " ways, " + bounds_text(extract.bounds_deg));
  }
  if (outside.objects == 0) {
    fail("nothing that the map holds can be built", file.string(),
         "correct it, or give another one; it is skipped because of: " + reasons_of(skipped));
  }
  fail("there is nothing to build in the area", file.string(),
       "the nearest of " + std::to_string(outside.objects) + " objects is " +
           formatted("%.0f m", outside.nearest_m, 0) +
           (region.center_deg ? " from the centre: give a larger radius, or another centre"
                              : " from the box: give a larger box") +
           "; the map holds " + bounds_text(extract.bounds_deg) +
           (skipped.empty() ? "" : "; skipped in the area or near it: " + reasons_of(skipped)));
}

LonLat frame_origin(const CityRegion& region, const osm::Extract& extract) {
  if (region.center_deg) return {(*region.center_deg)[1], (*region.center_deg)[0]};
  const Bounds b = region.bbox_deg ? *region.bbox_deg : areas_bounds(extract);
  return {(b[0] + b[2]) / 2, (b[1] + b[3]) / 2};
}

}  // namespace vantage::city
