// All limits of a mission, for a page that has controls for some of them only.
#pragma once

#include <string>
#include <vector>

#include "vantage/mission.h"

namespace vantage::live {

/// A limit in words: "Clearance", "5 m from all that is not ground".
struct LimitLine {
  std::string name, text;
};

/// Every limit of sensor and navigation that the mission has, in the order in which docs/mission-file.md describes
/// them.
std::vector<LimitLine> limit_lines(const Mission& mission);

/// A zone as it is drawn: what is without bounds ends a little beyond the scene and the range.
struct DrawnZone {
  bool is_kept_out = false;
  std::string name;
  std::vector<Zone::Ring> rings;  ///< the outline, then its holes
  double low_m = 0, high_m = 0;   ///< scene z
};

/// The zones with polygons, and the boxes to stay in. Over terrain, heights above the ground are drawn from its lowest
/// to its highest point.
std::vector<DrawnZone> drawn_zones(const Mission& mission);

}  // namespace vantage::live
