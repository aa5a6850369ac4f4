// A shop window, seen from the side from which its corners run counter-clockwise.
#include "vantage/target.h"

namespace example {

vantage::PreparedTarget window(const vantage::PreparedScene& scene) {
  const vantage::Target target = vantage::Target::polygon({{0, 0, 1}, {4, 0, 1}, {4, 0, 3}, {0, 0, 3}});
  return {scene, target, {.max_range_m = 80}};
}

}  // namespace example
