// Zones for tests.
#pragma once

#include <string>
#include <utility>

#include "vantage/navigation.h"

namespace vantage::testing {

inline Zone zone_of(Zone::Ring outer, double min_z_m, double max_z_m, std::string name = "z") {
  Zone zone;
  zone.outer = std::move(outer);
  zone.min_z_m = min_z_m;
  zone.max_z_m = max_z_m;
  zone.name = std::move(name);
  return zone;
}

}  // namespace vantage::testing
