#include "support/places.h"

namespace vantage::testing {

std::filesystem::path source_folder() { return VANTAGE_SOURCE_DIR; }

std::filesystem::path program_file() { return VANTAGE_CLI; }

}  // namespace vantage::testing
