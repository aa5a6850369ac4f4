// Outlines in plan, as maps have them.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace vantage::internal::core {

using Ring = std::vector<Eigen::Vector2d>;  ///< open: the first point is not repeated

/// A polygon with holes: metres in the scene frame. src/maps/city/footprint.h says what clean ones are.
struct Footprint {
  Ring outer;               ///< counter-clockwise
  std::vector<Ring> holes;  ///< clockwise
};

}  // namespace vantage::internal::core
