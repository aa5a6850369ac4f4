// The names of the limits that a request has.
#include "vantage/each_limit.h"

#include <string>
#include <vector>

namespace example {

std::vector<std::string> limits_of(const vantage::Navigation& navigation, const vantage::Sensor& sensor) {
  std::vector<std::string> names;
  const auto add = [&](auto limit, const auto& /*value*/) { names.emplace_back(vantage::name_of(limit)); };
  each_limit(navigation, add);
  each_limit(sensor, add);
  return names;
}

}  // namespace example
