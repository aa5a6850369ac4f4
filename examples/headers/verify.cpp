// Whether rays find anything wrong in a volume.
#include "vantage/verify.h"

namespace example {

bool is_right(const vantage::Scene& scene, const vantage::Target& target, const vantage::Mesh& volume) {
  vantage::Sensor sensor;
  sensor.max_range_m = 100;
  return vantage::verify_volume(scene, target, sensor, {}, volume, {.points = 1000}).is_right();
}

}  // namespace example
