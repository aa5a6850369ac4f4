// Between 30 and 120 m, and not over a yard.
#include "vantage/navigation.h"

namespace example {

vantage::Navigation limits() {
  vantage::Navigation navigation;
  navigation.altitude = vantage::Navigation::Altitude{30, 120};
  navigation.keep_in.push_back(vantage::Box{{-200, -200, 0}, {200, 200, 150}});
  vantage::Zone yard;
  yard.outer = {{0, 0}, {40, 0}, {40, 25}, {0, 25}};
  yard.name = "yard";
  navigation.keep_out.push_back(yard);
  vantage::check_navigation(navigation);
  return navigation;
}

}  // namespace example
