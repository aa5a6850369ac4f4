// Whether a volume is proved, without any sample.
#include "vantage/prove.h"

namespace example {

bool is_proved(const vantage::Scene& scene, const vantage::Target& target, const vantage::Mesh& volume) {
  vantage::Sensor sensor;
  sensor.max_range_m = 100;
  return vantage::prove_volume(scene, target, sensor, {}, volume).verdict() == vantage::ProofVerdict::proved;
}

}  // namespace example
