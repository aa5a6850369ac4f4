// A flight of two legs, and its length.
#include "vantage/flight.h"

namespace example {

double triangle_m() {
  vantage::Flight flight;
  flight.points = {{.position = {0, 0, 30}}, {.position = {100, 0, 30}}, {.position = {100, 80, 50}, .hold_s = 5}};
  vantage::check_flight_points(flight);
  return vantage::length_m(flight);
}

}  // namespace example
