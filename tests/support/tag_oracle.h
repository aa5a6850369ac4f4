// How high a building is by its tags, worked out anew from the documentation of read_form and BuildingDefaults: what
// the tags leave open is a range here.
#pragma once

#include <optional>
#include <string>

#include "support/osmium_map.h"

namespace vantage::testing {

/// Metres; `list`: "12 m", "40 ft", "5'11\"", "5;5.5" (the largest).
std::optional<double> length_of(const std::string& list);
std::optional<double> number_of(const std::string& list);

struct ExpectedHeights {
  struct Range {
    double least = 0, most = 0;
    bool holds(double value) const {
      return value >= least - 0.01 - 0.01 * least && value <= most + 0.01 + 0.01 * most;
    }
  };
  Range bottom, top;    ///< above the ground of the building
  std::string because;  ///< where the tags do not simply say it: why
  bool stands = false;  ///< on the ground
};

/// `outline`: the tags of the building that a part lies in.
ExpectedHeights expected_heights(const TagMap& tags, const TagMap* outline);

}  // namespace vantage::testing
