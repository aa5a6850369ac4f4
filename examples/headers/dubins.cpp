// How far a fixed wing flies to turn back where it came from.
#include "vantage/dubins.h"

#include <numbers>

namespace example {

double way_back_m() { return vantage::shortest_dubins({0, 0, 0}, {0, 0, std::numbers::pi}, 40).length_m(); }

}  // namespace example
