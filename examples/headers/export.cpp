// A function that a library of one's own exports as those of vantage do.
#include "vantage/export.h"

namespace example {

VANTAGE_API int answer();
int answer() { return 42; }

}  // namespace example
