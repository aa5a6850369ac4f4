// Whether the scene's ground reaches under a target that is laid on it, and what to do where it does not.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "vantage/mission.h"

namespace vantage::internal::app {

/// A rectangle in plan, scene frame.
struct PlanBox {
  Eigen::Vector2d min, max;
};

/// Terrain is built as far as the map has something to build, and a little farther: thrown where that is not enough.
struct TerrainTooSmall {
  double missing_m = 0;
};

/// The ground of a map, or the surface that is all of a raster; nothing without one.
std::optional<std::uint32_t> ground_object(const Scene& scene);

/// Extends flat ground, which goes on as it is wherever nothing is known, to hold `wanted`, and returns a warning that
/// says so; nothing where it is large enough. Throws TerrainTooSmall of a map with terrain; Error(input) where the
/// ground is another one, and where a place given in degrees is farther from it than max_range: most likely a slip.
std::optional<Warning> make_room(Mission& mission, const PlanBox& wanted);

/// Throws Error(input): the target, or a place of it, is off the ground, and how to get more of that.
[[noreturn]] void fail_off_ground(const Mission& mission, const std::string& problem);

}  // namespace vantage::internal::app
