// The tour of a mission: its plan for a ground station, and the proof of how short it can be.
#include "vantage/mission_tour.h"

namespace example {

void plan(const vantage::Mission& mission) {
  const vantage::MissionTour tour = vantage::plan_mission_tour(mission);
  vantage::write_flight_plan(vantage::plan_of_tour(tour, mission), "tour.plan");
  vantage::write_tour_certificate(tour, "tour.cert");
}

}  // namespace example
