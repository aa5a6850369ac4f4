// The part of a radio link's first Fresnel zone that must be free: docs/theory.md, "Radio links".
#pragma once

#include "vantage/sensor.h"

namespace vantage::internal::target {

/// How much longer than the straight way the way over a point of the zone is at most, in metres. The zone's radius with
/// wavelength l is sqrt(l d1 d2 / (d1 + d2)), so a share c of it belongs to c * c * l / 2.
inline double zone_excess_m(const RadioLink& link) {
  constexpr double kMetresTimesGigahertz = 0.299792458;  // the speed of light
  return 0.5 * link.clear * link.clear * kMetresTimesGigahertz / link.frequency_ghz;
}

}  // namespace vantage::internal::target
