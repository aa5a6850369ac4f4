// The sensor's limits as labelled solids.
#pragma once

#include "sensor/viewed.h"
#include "solid/regions.h"
#include "vantage/sensor.h"

namespace vantage::internal::solid {

/// Adds what the limits besides the range keep and forbid. Curved surfaces are made of facets on the safe side: they
/// take away more, by what docs/camera.md says, never less. `bounds`: of the volume, scene frame.
void add_sensor_regions(const sensor::Viewed& viewed, const Sensor& sensor, const Box& bounds, Regions& regions);

}  // namespace vantage::internal::solid
