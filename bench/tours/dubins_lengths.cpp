// Reads rows "x0 y0 heading0 x1 y1 heading1 radius" and prints the length of the shortest Dubins path of each, with all
// digits, for bench/tours/dubins.py.
#include <cstdio>
#include <iostream>

#include "vantage/dubins.h"

int main() {
  vantage::PlanePose from, to;
  double radius = 1;
  while (std::cin >> from.x_m >> from.y_m >> from.heading_rad >> to.x_m >> to.y_m >> to.heading_rad >> radius) {
    std::printf("%.17g\n", vantage::shortest_dubins(from, to, radius).length_m());
  }
  return 0;
}
