// A camera that hangs straight down, and is not nearer than 10 m.
#include "vantage/sensor.h"

namespace example {

vantage::Sensor downward() {
  vantage::Sensor sensor;
  sensor.min_range_m = 10;
  sensor.max_range_m = 120;
  sensor.camera = vantage::pinhole_of_fov(60, 40);
  sensor.mount = {.min_pitch_deg = -90, .max_pitch_deg = -90};
  vantage::check_sensor(sensor);
  return sensor;
}

}  // namespace example
