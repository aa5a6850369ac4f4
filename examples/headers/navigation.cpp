// Between 30 and 120 m, and not over a yard.
#include "vantage/navigation.h"

namespace example {

vantage::Navigation limits() {
  vantage::Navigation navigation;
  navigation.altitude = vantage::Navigation::Altitude{30, 120};
  navigation.keep_out_zones.push_back({.outer = {{0, 0}, {40, 0}, {40, 25}, {0, 25}}, .holes = {}, .name = "yard"});
  vantage::check_navigation(navigation);
  return navigation;
}

}  // namespace example
