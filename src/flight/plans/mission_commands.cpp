// Which commands of MAVLink missions move a vehicle, and where their items are.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "flight/plans/mission_items.h"

namespace vantage::internal::flight::plans {
namespace {

/// Commands that move the vehicle where the plan does not say, or in a way that is not followed here, also without a
/// position; and their names.
struct Mover {
  int command;
  const char* name;
};
constexpr Mover kMovers[] = {{23, "NAV_LAND_LOCAL"},
                             {24, "NAV_TAKEOFF_LOCAL"},
                             {25, "NAV_FOLLOW"},
                             {30, "NAV_CONTINUE_AND_CHANGE_ALT"},
                             {32, "DO_FOLLOW"},
                             {33, "DO_FOLLOW_REPOSITION"},
                             {35, "DO_FIGURE_EIGHT"},
                             {81, "NAV_PATHPLANNING"},
                             {83, "NAV_ALTITUDE_WAIT"},
                             {92, "NAV_GUIDED_ENABLE"},
                             {94, "NAV_PAYLOAD_PLACE"},
                             {113, "CONDITION_CHANGE_ALT"},
                             {176, "DO_SET_MODE"},
                             {185, "DO_FLIGHTTERMINATION"},
                             {186, "DO_CHANGE_ALTITUDE"},
                             {190, "DO_RALLY_LAND"},
                             {191, "DO_GO_AROUND"},
                             {192, "DO_REPOSITION"},
                             {193, "DO_PAUSE_CONTINUE"},
                             {208, "DO_PARACHUTE"},
                             {210, "DO_INVERTED_FLIGHT"},
                             {212, "DO_AUTOTUNE_ENABLE"},
                             {213, "NAV_SET_YAW_SPEED"},
                             {218, "DO_AUX_FUNCTION"},
                             {223, "DO_ENGINE_CONTROL"},
                             {224, "DO_SET_MISSION_CURRENT"},
                             {246, "PREFLIGHT_REBOOT_SHUTDOWN"},
                             {252, "OVERRIDE_GOTO"},
                             {262, "DO_SET_STANDARD_MODE"},
                             {300, "MISSION_START"},
                             {420, "INJECT_FAILURE"},
                             {601, "DO_JUMP_TAG"},
                             {611, "DO_SET_GLOBAL_ORIGIN"},
                             {3000, "DO_VTOL_TRANSITION"},
                             {4001, "GUIDED_SUBMODE_CIRCLE"},
                             {5300, "DO_SET_SAFETY_SWITCH_STATE"},
                             {42702, "NAV_SCRIPT_TIME"},
                             {43001, "GUIDED_CHANGE_ALTITUDE"},
                             {43002, "GUIDED_CHANGE_HEADING"},
                             {42703, "NAV_ATTITUDE_TIME"}};

}  // namespace

bool moves_nothing(const MissionItem& item) {
  const double first = item.parameters[0];
  switch (item.command) {
    case 92:   // NAV_GUIDED_ENABLE
    case 212:  // DO_AUTOTUNE_ENABLE
      return first == 0;
    case 208:  // DO_PARACHUTE, without its release
      return first >= 0 && first < 2;
    case 223:  // DO_ENGINE_CONTROL: starts
      return first == 1;
    default:
      break;
  }
  constexpr std::array kCommands = {112,  114,  181,  182,   183,   184,   187,   194,   196,   198,  200,  202,
                                    203,  204,  206,  207,   209,   211,   214,   215,   220,   221,  222,  240,
                                    241,  247,  530,  531,   532,   533,   534,   600,   2000,  2001, 2003, 2500,
                                    2501, 2502, 2503, 2510,  2511,  2520,  4000,  4501,  5000,  5001, 5002, 5003,
                                    5004, 5005, 5100, 31005, 31006, 31007, 31008, 31009, 42600, 42700};
  return std::find(kCommands.begin(), kCommands.end(), item.command) != kCommands.end();
}

const char* name_of_mover(int command) {
  const auto* const mover =
      std::find_if(std::begin(kMovers), std::end(kMovers), [&](const Mover& one) { return one.command == command; });
  return mover == std::end(kMovers) ? nullptr : mover->name;
}

bool is_of_movement(int command) {
  return (command > kNavWaypoint && command <= kLastOfNavigation) || name_of_mover(command);
}

bool is_given(double latitude, double longitude) {
  if (std::isnan(latitude) || std::isnan(longitude)) return false;
  return latitude != 0 || longitude != 0;  // both 0: "here", as autopilots take it
}

PlanPosition position_of(const MissionItem& item) {
  const double latitude = item.parameters[4], longitude = item.parameters[5];
  PlanPosition position;
  if (item.frame == kMission && !is_given(latitude, longitude)) return position;
  position.height_m = item.parameters[6];
  switch (item.frame) {
    case kGlobal:
    case kGlobalInt:
      position.datum = HeightDatum::sea_level;
      if (std::isnan(position.height_m) && !std::isnan(item.above_ground_m)) {
        position.height_m = item.above_ground_m;
        position.datum = HeightDatum::ground;
      }
      break;
    case kGlobalRelative:
    case kGlobalRelativeInt:
      position.datum = HeightDatum::home;
      break;
    case kGlobalTerrain:
    case kGlobalTerrainInt:
      position.datum = HeightDatum::ground;
      break;
    default:
      PlanSource::fail_at(ErrorCode::value_unsupported, item.place,
                          "its frame, " + std::to_string(item.frame) + ", is not one of the earth",
                          "give positions in frame 0 (heights above sea level), 3 (above home) or 10 (above terrain)");
  }
  if (!is_given(latitude, longitude)) return position;
  const bool is_scaled =
      item.frame == kGlobalInt || item.frame == kGlobalRelativeInt || item.frame == kGlobalTerrainInt;
  const double unit = is_scaled && (std::abs(latitude) > 180 || std::abs(longitude) > 180) ? 1e-7 : 1;
  position.horizontal = checked_lonlat(longitude * unit, latitude * unit, item.place);
  return position;
}

}  // namespace vantage::internal::flight::plans
