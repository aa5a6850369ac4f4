// Whether a limit of navigation or of the sensor is broken beyond a facet.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prove/view.h"
#include "vantage/navigation.h"
#include "vantage/prove.h"

namespace vantage::internal::prove {

/// A piece of a facet, a convex one: moved to the outside of the volume by the part that the proof allows.
struct MovedPiece {
  std::array<Vec3, 3> corners;  ///< about View::origin
  Vec3 outward = Vec3::Zero();  ///< of the facet; unit length
};

/// A limit with an argument: `breaks` says so only where it is broken in all of a piece.
struct LimitBeyond {
  WitnessKind kind = WitnessKind::navigation;
  std::string name;
  bool begins_once = false;  ///< on every line from the target: what is beyond it stays beyond
  double tolerance = 0;      ///< by so large a part less the limit is taken; 0: as it is given
  std::function<bool(const MovedPiece&)> breaks;
};

struct LimitsBeyond {
  std::vector<LimitBeyond> limits;
  std::vector<std::string> without_argument;  ///< names of limits that are given
};

/// The limits as they are for a part of the target. The references must last.
LimitsBeyond limits_beyond(const Navigation& navigation, const Sensor& sensor, const View& view);

}  // namespace vantage::internal::prove
