// What a plan does not say, or leaves to the vehicle.
#include <string>
#include <vector>

#include "flight/plans/geofence.h"
#include "flight/plans/plan_writer.h"
#include "vantage/flight.h"

namespace vantage {
namespace {

/// An autopilot flies it as it is written.
bool is_of_autopilot(PlanFormat format) {
  return format == PlanFormat::qgroundcontrol || format == PlanFormat::waypoints || format == PlanFormat::wpml;
}

/// A fixed wing never climbs straight up.
bool is_above_home(const FlightOut& flight, std::size_t point) {
  constexpr double kSameM = 1e-3;
  const bool is_circle = !flight.actions.empty() && flight.actions[point].loiter_radius_m != 0;
  if (!flight.home || is_circle || flight.vehicle == PlanVehicle::fixed_wing) return false;
  return (flight.flight.points[point].position - *flight.home).head<2>().norm() <= kSameM;
}

std::string note_of_ways(const FlightOut& flight) {
  const bool comes = flight.takes_off && !is_above_home(flight, 0);
  const bool goes = flight.returns_home && !is_above_home(flight, flight.flight.points.size() - 1);
  if (!comes && !goes) return {};
  const char* const to = "from the home to the first point";
  const char* const back = "from the last point back to the home";
  return std::string(comes && goes ? "the ways " : "the way ") + (comes ? to : "") + (comes && goes ? ", and " : "") +
         (goes ? back : "") + (comes && goes ? ", are" : " is") +
         " not planned, and nothing keeps clear of buildings and limits there: check the plan";
}

std::string note_of_end(const FlightOut& flight) {
  if (flight.returns_home) return {};
  if (flight.vehicle == PlanVehicle::fixed_wing) {
    return "the plan ends in the air, and circles about its last point are not planned: take over there; ArduPilot "
           "flies straight to the home then";
  }
  return "the plan ends in the air: the vehicle hovers at the last point until the pilot takes over";
}

/// What a geofence cannot state.
void add_notes_of_fence(const FlightOut& flight, std::vector<std::string>& notes) {
  internal::flight::plans::Geofence fence;
  try {
    fence = internal::flight::plans::geofence_of(flight);
  } catch (const Error&) {
    return;  // what cannot be written
  }
  if (!fence.empty()) {
    notes.emplace_back(
        "the plan's geofence has the mission's zones without their heights, and no other limit of the mission");
  }
  if (fence.stay_in.size() > 1) {
    notes.emplace_back(
        "the geofence has several zones to stay in: set FENCE_OPTIONS of ArduPilot so that one is enough");
  }
  if (fence.left_out.empty()) return;
  std::string names;
  for (const std::string& name : fence.left_out) names += (names.empty() ? "" : ", ") + name;
  notes.push_back("the plan's geofence lacks " + names + ": seen from above, the flight or its home would break it");
}

}  // namespace

std::vector<std::string> plan_notes(const FlightOut& flight, PlanFormat format) {
  const std::size_t count = flight.flight.points.size();
  if (count == 0 || (!flight.actions.empty() && flight.actions.size() != count)) return {};  // what cannot be written
  std::vector<std::string> notes;
  if (format == PlanFormat::kml) {
    const std::size_t drawn = internal::flight::plans::drawn_in_kml(flight);
    if (drawn < flight.volumes.size()) {
      notes.push_back("of " + std::to_string(flight.volumes.size()) + " volumes the first " + std::to_string(drawn) +
                      " are drawn: with more the file would be too large to be read; raise 'exact.tolerance'");
    }
  }
  if (format == PlanFormat::qgroundcontrol) add_notes_of_fence(flight, notes);
  if (is_of_autopilot(format)) {
    for (const std::string& text : {note_of_ways(flight), note_of_end(flight)}) {
      if (!text.empty()) notes.push_back(text);
    }
  } else if (flight.takes_off || flight.returns_home) {
    notes.push_back(std::string(name_of(format)) +
                    " has no takeoff and no return to the home: the plan begins and ends in the air");
  }
  return notes;
}

}  // namespace vantage
