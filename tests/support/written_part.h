// Parts of files that tests compare, and write anew when they are asked to.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "support/places.h"

namespace vantage::testing {

inline bool is_written_anew() { return std::getenv("VANTAGE_UPDATE_GOLDEN") != nullptr; }

inline std::string content_of(const std::filesystem::path& file) {
  std::ostringstream content;
  content << std::ifstream(file).rdbuf();
  return content.str();
}

/// What lies between two lines of a file. It is written anew with VANTAGE_UPDATE_GOLDEN=1.
inline void expect_between(const std::string& file_name, const std::string& begin, const std::string& end,
                           const std::string& expected) {
  const std::filesystem::path file = source_folder() / file_name;
  std::string text = content_of(file);
  const std::size_t at = text.find(begin);
  ASSERT_NE(at, std::string::npos) << begin;
  const std::size_t from = at + begin.size(), to = text.find(end, from);
  ASSERT_NE(to, std::string::npos) << begin;
  if (is_written_anew()) {
    std::ofstream(file) << text.replace(from, to - from, expected);
    return;
  }
  EXPECT_EQ(text.substr(from, to - from), expected) << "run it with VANTAGE_UPDATE_GOLDEN=1";
}

}  // namespace vantage::testing
