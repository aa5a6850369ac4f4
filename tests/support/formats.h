// Names of files, one for each format that volumes and scenes are written in, and read from.
#pragma once

#include <string>
#include <vector>

#include "common/output.h"

namespace vantage::testing {

/// "v.ply", "v.obj" and so on for "v".
inline std::vector<std::string> in_each_format(const std::string& stem) {
  std::vector<std::string> names;
  for (const std::string& word : mesh_format_words()) names.emplace_back(stem + '.').append(word);
  return names;
}

}  // namespace vantage::testing
