// The volume by the method of spheres, on the CPU.
#include "vantage/spheres.h"

namespace example {

vantage::Volume by_spheres(const vantage::PreparedTarget& target) {
  vantage::SpheresOptions options;
  options.cubemap = 100;
  options.device.kind = vantage::DeviceChoice::Kind::cpu;
  return vantage::compute_visibility_spheres(target, options);
}

}  // namespace example
