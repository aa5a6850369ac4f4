// The section `tour` of a mission file.
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

#include "request/description.h"
#include "vantage/tour.h"

namespace vantage::internal::request {

inline constexpr std::array kVehicleKinds = {
    Choice<TourVehicle::Kind>{TourVehicle::Kind::multirotor, "multirotor"},
    Choice<TourVehicle::Kind>{TourVehicle::Kind::fixed_wing, "fixed_wing"},
};

template <>
inline constexpr std::string_view kSection<TourSettings> = "tour";

// The bounds are what nothing that flies exceeds by far: beyond them a slip of the pen is more likely, and times and
// lengths overflow.
template <typename Settings, typename Visit>
requires std::is_same_v<std::remove_const_t<Settings>, TourSettings>
void describe(Settings& settings, Visit& visit) {
  auto& [vehicle, home, closed, dwell_s, margin_m, simultaneous, gimbal_rate_deg_s, clearance_m, tube_m, gap,
         time_limit_s] = settings;
  auto& [kind, speed_m_s, acceleration_m_s2, turn_radius_m, min_climb_deg, max_climb_deg] = vehicle;

  visit.choice({.path = "vehicle.kind",
                .says = "`multirotor`: flies straight legs, stops and hovers; `fixed_wing`: neither stops nor turns on "
                        "the spot",
                .without = "`multirotor`, without `vehicle`",
                .is_required = true,
                .form = "write 'kind: multirotor' or 'kind: fixed_wing'"},
               kind, kVehicleKinds);
  const Only multirotor = {kind == TourVehicle::Kind::multirotor, "fixed_wing"};
  const Only fixed_wing = {kind == TourVehicle::Kind::fixed_wing, "multirotor"};
  visit.number({"vehicle.speed", "along the path"}, speed_m_s,
               {0.01, 1000, Unit::metres_per_second, "give metres per second"}, Only{});
  visit.number({"vehicle.acceleration", "of a multirotor, along the path"}, acceleration_m_s2,
               {0.001, 1000, Unit::metres_per_second_squared, "give metres per second, per second"}, multirotor);
  visit.number({"vehicle.turn_radius", "of a fixed wing, the smallest radius in plan"}, turn_radius_m,
               {0.01, 1e5, Unit::metres, "give metres"}, fixed_wing);
  constexpr std::string_view kClimb = "give degrees, the steepest descent and the steepest climb: [-15, 20]";
  visit.pair({.path = "vehicle.climb",
              .says = "of a fixed wing, the steepest descent and the steepest climb, each 0.1 or steeper",
              .form = "write the steepest descent and the steepest climb, degrees: [-15, 20]"},
             min_climb_deg, {-90, -0.1, Unit::degrees, kClimb, "", Bounds::Ends::without_least}, max_climb_deg,
             {0.1, 90, Unit::degrees, kClimb, "", Bounds::Ends::without_most}, fixed_wing);

  visit.home({.path = "home",
              .says = "where the flight begins",
              .more = "Two numbers are latitude and longitude (WGS 84) of a place on the ground, as in `center`; three "
                      "are x, y, z, as `crs` says.",
              .without = "none; the flight begins anywhere",
              .form = "write [latitude, longitude] in degrees, for a place on the ground, or [x, y, z]"},
             home);
  visit.flag({"closed", "whether the flight ends where it began",
              "Without a home it then is flown round and round: a fixed wing ends in the direction in which it began. "
              "With `false` it ends at the last target: its plan returns to no home, and the vehicle [stays in the air "
              "there](flight-plans.md#where-a-plan-begins-and-ends) until the pilot acts."},
             closed);

  visit.number({"view.dwell", "for so long each target is in view without a break"}, dwell_s,
               {0, 86'400, Unit::seconds, "give seconds", "a day"}, Only{});
  visit.number({"view.margin", "meanwhile the vehicle is at least so deep inside the target's volume"}, margin_m,
               {0, 1e4, Unit::metres, "give metres"}, Only{});
  visit.flag({"view.simultaneous", "whether several targets may be viewed at the same time"}, simultaneous);
  visit.number({"gimbal.rate", "the camera turns at most so fast"}, gimbal_rate_deg_s,
               {0.001, 36'000, Unit::degrees_per_second, "give degrees per second"}, Only{});
  visit.number({"clearance", "of the whole flight from the scene, but for its ground"}, clearance_m,
               {0, 1e4, Unit::metres, "give metres"}, Only{});
  visit.number(
      {"tube", "all this holds for every position so near to the flight",
       "That is what `vantage check --tube` asks for: for wind, errors of position, and the radius at which an "
       "autopilot accepts a waypoint."},
      tube_m, {0, 100, Unit::metres, "give metres"}, Only{});
  visit.number({.path = "gap",
                .says = "the search for a shorter flight ends when (length \u2212 bound) / length is no larger",
                .more = "Where it is given, a larger one ends in [exit code](command-line.md#exit-codes) 4.",
                .without = "0.01"},
               gap, {0, 1, Unit::none, "give a share: 0.01 is one per cent", "", Bounds::Ends::without_most}, Only{});
  visit.number({"time_limit", "or after so long",
                "The search for the bound may take as long again. Preparing the scene and the volumes is not counted, "
                "and a first flight is found all the same."},
               time_limit_s, {0, 604'800, Unit::seconds, "give seconds", "a week", Bounds::Ends::without_least},
               Only{});
}

}  // namespace vantage::internal::request
