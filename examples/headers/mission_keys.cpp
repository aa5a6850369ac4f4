// The names and units of the keys in a section of mission files.
#include "vantage/mission_keys.h"

namespace example {

std::string keys_of(const std::string& section) {
  std::string text;
  for (const vantage::MissionKey& key : vantage::mission_keys()) {
    if (key.section == section) text += key.path + (key.unit.empty() ? "\n" : " (" + key.unit + ")\n");
  }
  return text;
}

}  // namespace example
