#include "maps/osm/assembly_plane.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "maps/osm/map_objects.h"

namespace vantage::internal::osm {
namespace {

constexpr double kPolarMap = 85;  // degrees of latitude, from where on a pole's own map is the better one
/// The polar map's degree is so many of the file's, whose longitudes are finer there than its latitudes.
constexpr double kMagnified = 10;
constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr std::int32_t kHalfTurn = 180 * osmium::detail::coordinate_precision;

}  // namespace

AssemblyPlane::AssemblyPlane(const std::vector<const osmium::Way*>& ways) {
  const double infinity = std::numeric_limits<double>::infinity();
  double west = infinity, east = -infinity, south = infinity, north = -infinity;
  const auto for_nodes = [&](const auto& visit) {
    for (const osmium::Way* const way : ways) {
      for (const osmium::NodeRef& node : way->nodes()) {
        if (node.location()) visit(node.location());
      }
    }
  };
  for_nodes([&](osmium::Location at) {
    west = std::min(west, at.lon());
    east = std::max(east, at.lon());
    south = std::min(south, at.lat());
    north = std::max(north, at.lat());
  });
  if (west > east) return;
  if (south >= kPolarMap || north <= -kPolarMap) {
    kind_ = Kind::about_pole;
    hemisphere_ = south > 0 ? 1 : -1;
    for_nodes([&](osmium::Location at) { corners_.emplace_back(to_plane(at), to_lonlat(at)); });
    std::stable_sort(corners_.begin(), corners_.end(),
                     [](const NodePosition& a, const NodePosition& b) { return a.first < b.first; });
  } else if (east - west > 180) {
    kind_ = Kind::turned;
  }
}

osmium::Location AssemblyPlane::to_plane(osmium::Location location) const {
  switch (kind_) {
    case Kind::as_it_is:
      break;
    case Kind::turned:
      return osmium::Location(location.x() > 0 ? location.x() - kHalfTurn : location.x() + kHalfTurn, location.y());
    case Kind::about_pole: {
      const double from_pole = kMagnified * (90 - hemisphere_ * location.lat());
      const double turn = location.lon() * kRadiansPerDegree;
      return osmium::Location(from_pole * std::sin(turn), -hemisphere_ * from_pole * std::cos(turn));
    }
  }
  return location;
}

LonLat AssemblyPlane::from_plane(osmium::Location location) const {
  switch (kind_) {
    case Kind::as_it_is:
      break;
    case Kind::turned: {
      const std::int32_t x = location.x() > 0 ? location.x() - kHalfTurn : location.x() + kHalfTurn;
      return to_lonlat(osmium::Location(x, location.y()));
    }
    case Kind::about_pole: {
      const auto corner =
          std::lower_bound(corners_.begin(), corners_.end(), location,
                           [](const NodePosition& place, osmium::Location at) { return place.first < at; });
      if (corner != corners_.end() && corner->first == location) return corner->second;
      const double x = location.lon_without_check(), y = location.lat_without_check();
      return {std::atan2(x, -hemisphere_ * y) / kRadiansPerDegree, hemisphere_ * (90 - std::hypot(x, y) / kMagnified)};
    }
  }
  return to_lonlat(location);
}

}  // namespace vantage::internal::osm
