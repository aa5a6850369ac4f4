// Simple 3D Buildings: tags -> heights and a roof. https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "osm/extract.h"
#include "vantage/city.h"

namespace vantage::city {

enum class RoofShape {
  flat,
  gabled,
  hipped,
  half_hipped,
  pyramidal,
  skillion,
  gambrel,
  mansard,
  dome,
  onion,
  cone,
  round,
  saltbox
};

/// One solid over a footprint. Heights are metres above the ground of the building it belongs to.
struct BuildingForm {
  double bottom_m = 0;  ///< min_height: 0 stands on the ground
  double top_m = 0;     ///< of the roof's highest point; > bottom_m
  double roof_m = 0;    ///< of this the roof's part, 0 <= roof_m <= top_m - bottom_m
  RoofShape roof = RoofShape::flat;
  std::optional<double> roof_direction_deg;  ///< compass: where the roof's main face falls to; across the ridge
  bool roof_across = false;                  ///< roof:orientation=across: the ridge runs along the shorter side
};

/// What was not as it should be in an object's tags; each kind is counted in the report.
struct TagRemark {
  std::string kind;  ///< "height that is no length", "unknown roof shape", "min_height not below height", …
  std::string what;  ///< "height=concrete: taken as untagged"
};

/// "48.5", "48.5 m", "48,5m", "160 ft", "160'", "5'11\"", "0.2 km", "5;5.5" (the largest counts: what hides more);
/// nothing for what is no length. Metres; may be negative.
std::optional<double> parse_length_m(std::string_view text);
/// "3", "2.5", "2;3" (the largest); nothing for what is no number of levels.
std::optional<double> parse_levels(std::string_view text);
/// Degrees clockwise from north: "45", "45°", "NE", "north"; nothing else.
std::optional<double> parse_direction_deg(std::string_view text);

/// Heights and roof of a building or a part. `outline`: the tags of the building that a part lies in, for what the part
/// does not say itself (nothing is inherited but building, the kind that defaults go by). Never fails: nonsense is
/// remarked on and taken as untagged.
BuildingForm read_form(const osm::Tags& tags, const osm::Tags* outline, const BuildingDefaults& defaults,
                       std::vector<TagRemark>& remarks);

}  // namespace vantage::city
