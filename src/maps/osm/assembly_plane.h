// Where areas are assembled: libosmium joins rings in the plane of longitude and latitude, which tears what lies across
// the antimeridian apart, and makes a line of what lies round a pole.
#pragma once

#include <osmium/osm/location.hpp>
#include <osmium/osm/way.hpp>
#include <utility>
#include <vector>

#include "maps/osm/extract.h"

namespace vantage::internal::osm {

/// A plane in which the ways of one object hang together: longitude and latitude; the same turned by half a circle,
/// where the ways reach across the antimeridian; for ways near a pole, a map with the pole in its middle.
class AssemblyPlane {
 public:
  explicit AssemblyPlane(const std::vector<const osmium::Way*>& ways);

  /// Whether coordinates differ from longitude and latitude.
  bool moves() const { return kind_ != Kind::as_it_is; }
  osmium::Location to_plane(osmium::Location location) const;
  /// The position of a place: of one that to_plane gave, the very position that it came from; of others to about the
  /// unit of the file.
  LonLat from_plane(osmium::Location location) const;

 private:
  enum class Kind { as_it_is, turned, about_pole };
  using NodePosition = std::pair<osmium::Location, LonLat>;

  Kind kind_ = Kind::as_it_is;
  double hemisphere_ = 1;              ///< -1: about the south pole
  std::vector<NodePosition> corners_;  ///< about a pole: of all nodes, by place in the plane
};

}  // namespace vantage::internal::osm
