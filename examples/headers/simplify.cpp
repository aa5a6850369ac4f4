// A volume with at most 500 facets, all of it inside.
#include "vantage/simplify.h"

namespace example {

vantage::Mesh small(const vantage::Mesh& volume) {
  vantage::SimplifyOptions options;
  options.facets = 500;
  return vantage::simplify_volume(volume, options).mesh;
}

}  // namespace example
