// The version, for the preprocessor and of the library that was loaded. CMakeLists.txt reads it from here.
#pragma once

#include "vantage/export.h"

#define VANTAGE_VERSION_MAJOR 0
#define VANTAGE_VERSION_MINOR 1
#define VANTAGE_VERSION_PATCH 0
#define VANTAGE_VERSION "0.1.0"

namespace vantage {

/// VANTAGE_VERSION of the library that the program runs with; until 1.0 a library of another minor version does not
/// fit.
VANTAGE_API const char* version();

}  // namespace vantage
