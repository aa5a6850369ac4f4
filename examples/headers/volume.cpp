// All positions from which a target is seen, below 60 m, as a file.
#include "vantage/volume.h"

namespace example {

double write(const vantage::PreparedTarget& target) {
  vantage::Navigation navigation;
  navigation.altitude = vantage::Navigation::Altitude{0, 60};
  const vantage::Volume volume = vantage::compute_volume(target, navigation);
  vantage::write_volume(volume, "volume.ply");
  return vantage::measure(volume.mesh).volume_m3;
}

}  // namespace example
