// Plans of QGroundControl, and tables of waypoints: missions of MAVLink.
// https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html, https://mavlink.io/en/file_formats/
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "flight/plans/geofence.h"
#include "flight/plans/mission_items.h"
#include "flight/plans/plan_writer.h"
#include "vantage/error.h"

namespace vantage::internal::flight::plans {
namespace {

using nlohmann::json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct OutItem {
  int command = 0, frame = kMission;
  std::array<double, 7> parameters{};  ///< NaN: null
};

class Mission {
 public:
  explicit Mission(const PlanWriter& writer)
      : writer_(writer), frame_(writer.heights() == HeightDatum::home ? kGlobalRelative : kGlobal) {}

  std::vector<OutItem> items() {
    const std::vector<OutPoint> points = writer_.points();
    if (writer_.flight().takes_off) take_off(points.front());
    for (const OutPoint& point : points) add(point);
    if (look_at_) add({kDoSetRoiNone, kMission, {}});
    if (writer_.flight().returns_home) add({kNavReturn, kMission, {}});
    return items_;
  }

 private:
  void add(const OutItem& item) { items_.push_back(item); }

  void add_at(int command, const std::array<double, 4>& first, const Vec3& place, double height) {
    const Eigen::Vector2d at = writer_.lonlat(place);
    add({command, frame_, {first[0], first[1], first[2], first[3], at.y(), at.x(), height}});
  }

  /// A multirotor climbs above the home to the height of the first point; a fixed wing climbs on the way to it.
  void take_off(const OutPoint& first) {
    const bool is_fixed_wing = writer_.flight().vehicle == PlanVehicle::fixed_wing;
    const int command = writer_.flight().vehicle == PlanVehicle::vtol ? kNavVtolTakeoff : kNavTakeoff;
    constexpr double kClimbDeg = 15;
    add_at(command, {is_fixed_wing ? kClimbDeg : 0, 0, 0, kNone}, is_fixed_wing ? first.position : writer_.home(),
           writer_.height(first.position));
  }

  void add(const OutPoint& point) {
    if (!std::isnan(point.speed_m_s) && point.speed_m_s != speed_m_s_) {
      constexpr double kOverGround = 1, kAsBefore = -1;
      add({kDoChangeSpeed, kMission, {kOverGround, point.speed_m_s, kAsBefore}});
      speed_m_s_ = point.speed_m_s;
    }
    turn_camera(point.action);
    const FlightAction& action = point.action;
    // ArduPilot stores whole seconds. A video must run while it stays: it stays after it has begun.
    constexpr double kRoundingS = 1e-9;
    const double hold_s = std::ceil(point.hold_s - kRoundingS);
    add_at(kNavWaypoint, {action.video ? 0 : hold_s, 0, 0, action.yaw_deg.value_or(kNone)}, point.position,
           writer_.height(point.position));
    if (action.video) add({kVideoStart, kMission, {}});
    if (action.video && hold_s > 0) add({kNavDelay, kMission, {hold_s, -1, -1, -1}});  // no time of day
    if (action.video) add({kVideoStop, kMission, {}});
    if (action.photo) add({kImageStart, kMission, {0, 0, 1}});  // one
  }

  void turn_camera(const FlightAction& action) {
    if (action.look_at) {
      if (look_at_ == action.look_at) return;
      add_at(kDoSetRoiLocation, {}, *action.look_at, writer_.height(*action.look_at));
      look_at_ = action.look_at;
      pitch_deg_.reset();
      return;
    }
    if (look_at_) add({kDoSetRoiNone, kMission, {}});
    look_at_.reset();
    if (!action.gimbal_pitch_deg || pitch_deg_ == action.gimbal_pitch_deg) return;
    constexpr double kTargeting = 2;  // MAV_MOUNT_MODE_MAVLINK_TARGETING
    add({kDoMountControl, kMission, {*action.gimbal_pitch_deg, 0, 0, 0, 0, 0, kTargeting}});
    pitch_deg_ = action.gimbal_pitch_deg;
  }

  const PlanWriter& writer_;
  int frame_;
  std::vector<OutItem> items_;
  double speed_m_s_ = kNone;
  std::optional<Vec3> look_at_;
  std::optional<double> pitch_deg_;
};

json number_or_null(double number) { return std::isnan(number) ? json() : json(number); }

int mav_type(PlanVehicle vehicle) {
  switch (vehicle) {
    case PlanVehicle::fixed_wing:
      return 1;
    case PlanVehicle::vtol:
      return 22;
    default:
      return 2;
  }
}

json json_of(const OutItem& item, int number) {
  json object{{"type", "SimpleItem"},
              {"autoContinue", true},
              {"command", item.command},
              {"frame", item.frame},
              {"doJumpId", number}};
  json parameters = json::array();
  for (const double parameter : item.parameters) parameters.push_back(number_or_null(parameter));
  object["params"] = std::move(parameters);
  if (item.frame != kMission) {  // the three of them together
    constexpr int kRelative = 1, kAbsolute = 2;
    object["AMSLAltAboveTerrain"] = nullptr;
    object["Altitude"] = item.parameters[6];
    object["AltitudeMode"] = item.frame == kGlobalRelative ? kRelative : kAbsolute;
  }
  return object;
}

json polygons_json(const PlanWriter& writer, const Geofence& fence) {
  json polygons = json::array();
  const auto add = [&](const std::vector<Zone::Ring>& rings, bool inclusion) {
    for (const Zone::Ring& ring : rings) {
      json corners = json::array();
      for (const Eigen::Vector2d& corner : ring) {
        const double height = writer.flight().flight.points.front().position.z();
        const Eigen::Vector2d at = writer.lonlat({corner.x(), corner.y(), height});
        corners.push_back({at.y(), at.x()});
      }
      polygons.push_back({{"inclusion", inclusion}, {"polygon", std::move(corners)}, {"version", 1}});
    }
  };
  add(fence.stay_in, true);
  add(fence.stay_out, false);
  return polygons;
}

}  // namespace

std::string write_qgroundcontrol(const FlightOut& flight) {
  const PlanWriter writer(flight, PlanFormat::qgroundcontrol, {HeightDatum::home, HeightDatum::sea_level});
  json items = json::array();
  for (const OutItem& item : Mission(writer).items())
    items.push_back(json_of(item, static_cast<int>(items.size()) + 1));
  const Eigen::Vector2d home = writer.lonlat(writer.home());
  // The ground station looks it up where it is not known.
  const double home_height =
      writer.knows(HeightDatum::sea_level) ? writer.height(writer.home(), HeightDatum::sea_level) : kNone;
  constexpr int kPx4 = 12;
  constexpr double kUsualCruise = 15, kUsualHover = 5;  // of the ground station; they serve its estimates of time
  const bool has_speed = !std::isnan(flight.speed_m_s);
  const json mission{{"version", 2},
                     {"firmwareType", kPx4},
                     {"vehicleType", mav_type(flight.vehicle)},
                     {"globalPlanAltitudeMode", writer.heights() == HeightDatum::home ? 1 : 2},
                     {"cruiseSpeed", has_speed ? flight.speed_m_s : kUsualCruise},
                     {"hoverSpeed", has_speed ? flight.speed_m_s : kUsualHover},
                     {"plannedHomePosition", {home.y(), home.x(), number_or_null(home_height)}},
                     {"items", std::move(items)}};
  const json none = json::array();
  const json plan{
      {"fileType", "Plan"},
      {"version", 1},
      {"groundStation", "vantage"},
      {"mission", mission},
      {"geoFence", {{"version", 2}, {"circles", none}, {"polygons", polygons_json(writer, geofence_of(flight))}}},
      {"rallyPoints", {{"version", 2}, {"points", none}}}};
  return plan.dump(4) + "\n";
}

std::string write_waypoints(const FlightOut& flight) {
  const PlanWriter writer(flight, PlanFormat::waypoints, {HeightDatum::home, HeightDatum::sea_level});
  std::vector<OutItem> items = Mission(writer).items();
  const Eigen::Vector2d home = writer.lonlat(writer.home());
  items.insert(
      items.begin(),
      {kNavWaypoint, kGlobal, {0, 0, 0, 0, home.y(), home.x(), writer.height(writer.home(), HeightDatum::sea_level)}});
  std::string table = "QGC WPL 110\n";
  constexpr int kDecimals = 11;
  for (std::size_t i = 0; i < items.size(); ++i) {
    table += std::to_string(i) + "\t" + (i == 0 ? "1" : "0") + "\t" + std::to_string(items[i].frame) + "\t" +
             std::to_string(items[i].command);
    for (const double parameter : items[i].parameters) {
      table += "\t" + decimal(std::isnan(parameter) ? 0 : parameter, kDecimals);
    }
    table += "\t1\n";
  }
  return table;
}

}  // namespace vantage::internal::flight::plans
