// A number that must be one.
#include "vantage/error.h"

namespace example {

double checked(double height_m) {
  if (height_m > 0) return height_m;
  throw vantage::Error(vantage::ErrorCode::value_out_of_range, "the height is not above 0", "height", "give metres");
}

}  // namespace example
