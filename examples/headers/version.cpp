// Whether the library that was loaded is the one that this was compiled for.
#include "vantage/version.h"

#include <string>

namespace example {

bool is_the_same() { return std::string(vantage::version()) == VANTAGE_VERSION; }

}  // namespace example
