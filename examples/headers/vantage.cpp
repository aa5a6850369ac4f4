// All of the public API.
#include "vantage/vantage.h"

namespace example {

bool has_facets(const vantage::Volume& volume) { return !volume.empty(); }

}  // namespace example
