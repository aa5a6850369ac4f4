// The commands of MAVLink missions (https://mavlink.io/en/messages/common.html, "MAV_CMD"), as QGroundControl's plans
// and tables of waypoints hold them, made into the items of a plan.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "flight/plans/plan_source.h"

namespace vantage::internal::flight::plans {

/// MAV_CMD.
enum MissionCommand : int {
  kNavWaypoint = 16,
  kNavLoiterUnlimited = 17,
  kNavLoiterTurns = 18,
  kNavLoiterTime = 19,
  kNavReturn = 20,
  kNavLand = 21,
  kNavTakeoff = 22,
  kNavLoiterToAltitude = 31,
  kDoOrbit = 34,
  kNavArc = 36,
  kNavRoi = 80,
  kNavSpline = 82,
  kNavVtolTakeoff = 84,
  kNavVtolLand = 85,
  kNavDelay = 93,
  kLastOfNavigation = 95,  ///< MAV_CMD_NAV_LAST
  kConditionYaw = 115,
  kDoJump = 177,
  kDoChangeSpeed = 178,
  kDoSetHome = 179,
  kDoSetParameter = 180,
  kDoReturnPathStart = 188,
  kDoLandStart = 189,
  kDoSetRoiLocation = 195,
  kDoSetRoiNone = 197,
  kDoSetRoi = 201,
  kDoMountControl = 205,
  kArmDisarm = 400,
  kDoGimbalPitchYaw = 1000,
  kImageStart = 2000,
  kVideoStart = 2500,
  kVideoStop = 2501,
  kFencePolygonIn = 5001,
  kFenceCircleOut = 5004,  ///< the last one of a fence
  kRallyPoint = 5100,
};

/// MAV_FRAME. Those with INT have the same positions in units of 1e-7 degrees, in messages; files have degrees.
enum MissionFrame : int {
  kGlobal = 0,
  kMission = 2,  ///< no position
  kGlobalRelative = 3,
  kGlobalInt = 5,
  kGlobalRelativeInt = 6,
  kGlobalTerrain = 10,
  kGlobalTerrainInt = 11,
};

struct MissionItem {
  int command = 0, frame = kMission;
  std::array<double, 7> parameters{};  ///< NaN: not given
  /// For a height that QGroundControl computes from its terrain: that above ground, where its height above sea level is
  /// missing.
  double above_ground_m = std::numeric_limits<double>::quiet_NaN();
  long long id = -1;    ///< what DO_JUMP names; below 0: none
  bool goes_on = true;  ///< autoContinue, which ArduPilot ignores
  std::string place;
};

enum class Autopilot { unknown, px4, ardupilot };

/// Runs the mission from its first item to its last, jumps followed, into `plan`, whose format, vehicle and home are
/// set. Throws Error(input) with the item's place.
void run_mission(const std::vector<MissionItem>& mission, const PlanSource& source, Autopilot autopilot,
                 FlightPlan& plan);

/// Names the first return, if there is one, as not judged.
void name_returns(const std::string& why, FlightPlan& plan);

/// Autopilots return to the nearest rally point instead of the home, if their settings say so: a plan that returns is
/// not judged.
void name_rally_points(std::size_t count, FlightPlan& plan);

/// That the plan has a fence: a flight is judged by the zones of its mission alone.
void note_fence(FlightPlan& plan);

/// Whether an item has a position: both 0 is "here", as autopilots take it.
bool is_given(double latitude, double longitude);

/// Commands that move no vehicle: conditions, cameras, servos, fences, engines that start, markers, gates.
bool moves_nothing(const MissionItem& item);

/// Of a command that moves the vehicle where the plan does not say, or in a way that is not followed here; else null.
const char* name_of_mover(int command);

/// Whether the command does something else than to fly straight to a waypoint, as those of navigation do.
bool is_of_movement(int command);

/// Where an item is, if its frame is one of the earth. Throws Error(input) for one that is not.
PlanPosition position_of(const MissionItem& item);

}  // namespace vantage::internal::flight::plans
