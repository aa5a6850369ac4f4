// A field of shares in boxes of 5 m, from depth images.
#include "vantage/fraction.h"

namespace example {

std::vector<double> shares(const vantage::PreparedTarget& target) {
  const vantage::VoxelGrid grid{.low = {-50, -50, 0}, .step_m = 5, .count = {20, 20, 10}};
  return vantage::estimate_fraction_field(target, grid).field.shares;
}

}  // namespace example
