// Where the real inputs lie: $VANTAGE_SHARED, or else `shared` beside the project's folder. They are not part of the
// project.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/places.h"

namespace vantage::testing {

/// Path of a file below `shared/data`. May not exist: see VANTAGE_REQUIRE_SHARED.
inline std::filesystem::path shared_data(const std::string& file) {
  const char* set = std::getenv("VANTAGE_SHARED");
  const std::filesystem::path shared = set ? set : source_folder() / ".." / "shared";
  return shared / "data" / file;
}

}  // namespace vantage::testing

/// Skips the running test, with a message, when a real input is absent.
#define VANTAGE_REQUIRE_SHARED(file)                                                          \
  if (!std::filesystem::exists(vantage::testing::shared_data(file)))                          \
  GTEST_SKIP() << "needs " << vantage::testing::shared_data(file).lexically_normal().string() \
               << ": set VANTAGE_SHARED to the folder that holds data/"
