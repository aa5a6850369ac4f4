#include "vantage/version.h"

namespace vantage {

const char* version() { return VANTAGE_VERSION; }

}  // namespace vantage
