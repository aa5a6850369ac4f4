// For how long a plan of a ground station has the first target of a mission in view.
#include "vantage/flight_check.h"

namespace example {

double seen_s(const vantage::Mission& mission, const char* plan) {
  const vantage::LocatedPlan located = vantage::locate_flight(mission, vantage::read_flight_plan(plan));
  double seen = 0;
  for (const vantage::FlightSpan& span : vantage::check_flight(mission, located.flight).targets.at(0).seen) {
    seen += span.duration_s();
  }
  return seen;
}

}  // namespace example
