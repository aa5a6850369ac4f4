// What preparing a target leaves, for the methods.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "target/point_target.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage {

struct PreparedTarget::Data {
  struct Part {
    TargetFrame given;  ///< without lift
    TargetFrame frame;  ///< as used: raised, and with its origin inside the range of all vertices
    double lift_m = 0;
    bool is_reachable = false;                          ///< some point is within range of all of it
    std::optional<internal::target::PointSides> sides;  ///< of a point
  };

  PreparedScene scene;
  Target target;
  Sensor sensor;
  std::vector<Part> parts;
  std::vector<Warning> notes;
};

}  // namespace vantage
