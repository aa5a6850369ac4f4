// One scene with a target to see, as drawn or as read from a mission.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vantage/navigation.h"
#include "vantage/scene.h"
#include "vantage/sensor.h"
#include "vantage/target.h"

namespace attack {

struct Case {
  std::uint64_t seed = 0;  ///< of the judge's own draws
  std::string kind;        ///< "walls, canopy"
  double scale = 1;        ///< size of the target, about, metres
  vantage::Scene scene;
  std::vector<vantage::Target> parts;  ///< one or more
  double range = 0;
  double tolerance = 0;
  vantage::Sensor sensor;  ///< its limits but for the range; of a single part, without a camera
  vantage::Navigation navigation;
};

}  // namespace attack
