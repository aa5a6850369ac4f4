// Plans of QGroundControl: https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/input.h"
#include "flight/plans/json_text.h"
#include "flight/plans/mission_items.h"

namespace vantage::internal::flight::plans {
namespace {

using nlohmann::json;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// A number, or NaN for null; nothing else.
double number_or_nan(const json& value, const std::string& where, const std::string& what) {
  if (value.is_null()) return kNoNumber;
  if (value.is_number()) return value.get<double>();
  PlanSource::fail_at(ErrorCode::not_a_number, where, what + " is not a number", "give a number, or null");
}

double member_or_nan(const json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  return found == object.end() ? kNoNumber : number_or_nan(*found, where, in_quotes(key));
}

int integer_member(const json& object, const char* key, const std::string& where) {
  const double value = member_or_nan(object, key, where);
  if (std::abs(value) < 1e6 && value == std::floor(value)) return static_cast<int>(value);
  PlanSource::fail_at(ErrorCode::plan_syntax, where, std::string("it has no ") + in_quotes(key) + ", an integer",
                      "save the plan anew with the ground station");
}

/// What DO_JUMP calls it; -1: nothing.
long long id_of(const json& item, const std::string& where) {
  const double id = member_or_nan(item, "doJumpId", where);
  return id >= 0 && id < 1e15 && id == std::floor(id) ? std::llround(id) : -1;
}

/// Numbers are flags, too: 0 is false.
bool flag(const json& object, const char* key, bool otherwise, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return otherwise;
  if (found->is_boolean()) return found->get<bool>();
  if (found->is_number()) return found->get<double>() != 0;
  PlanSource::fail_at(ErrorCode::plan_syntax, where, in_quotes(key) + " is neither true nor false", "correct it");
}

class GroundStationPlan {
 public:
  explicit GroundStationPlan(const PlanSource& source) : source_(source) {}

  FlightPlan read(const json& root) {
    plan_.format = PlanFormat::qgroundcontrol;
    plan_.file = source_.name;
    const auto mission = root.find("mission");
    if (mission == root.end() || !mission->is_object()) {
      source_.fail(ErrorCode::plan_empty, "mission", "the plan has no mission", "save it anew with the ground station");
    }
    read_versions(root, *mission);
    read_vehicle(*mission);
    const auto items = mission->find("items");
    if (items == mission->end() || !items->is_array()) {
      source_.fail(ErrorCode::plan_syntax, "mission.items", "it is not an array",
                   "save the plan anew with the ground station");
    }
    for (std::size_t i = 0; i < items->size(); ++i) {
      add((*items)[i], source_.place("item " + std::to_string(i + 1)));
    }
    run_mission(items_, source_, autopilot(*mission), plan_);
    look_for_rally_points(root);
    look_for_fence(root);
    check_plan(plan_, source_);
    return std::move(plan_);
  }

 private:
  void read_versions(const json& root, const json& mission) {
    const auto read = [&](const json& object, const char* what, double known) {
      const double version = member_or_nan(object, "version", source_.place(what));
      if (std::isnan(version) || version == known) return;
      plan_.notes.push_back({WarningCode::plan_assumed, source_.name + ": the version of the " + what + " is " +
                                                            shortest(version) + ", and it is read as one of version " +
                                                            shortest(known)});
    };
    read(root, "plan", 1);
    read(mission, "mission", 2);
  }

  Autopilot autopilot(const json& mission) const {
    constexpr double kArduPilot = 3, kPx4 = 12;  // MAV_AUTOPILOT
    const double type = member_or_nan(mission, "firmwareType", source_.place("mission"));
    return type == kPx4 ? Autopilot::px4 : type == kArduPilot ? Autopilot::ardupilot : Autopilot::unknown;
  }

  void look_for_rally_points(const json& root) {
    const auto rally = root.find("rallyPoints");
    if (rally == root.end() || !rally->is_object()) return;
    const auto points = rally->find("points");
    if (points != rally->end() && points->is_array()) name_rally_points(points->size(), plan_);
  }

  void look_for_fence(const json& root) {
    const auto fence = root.find("geoFence");
    if (fence == root.end() || !fence->is_object()) return;
    const auto has = [&](const char* key) {
      const auto list = fence->find(key);
      return list != fence->end() && list->is_array() && !list->empty();
    };
    if (has("polygons") || has("circles") || has("polygon")) note_fence(plan_);
  }

  void read_vehicle(const json& mission) {
    const std::string where = source_.place("mission");
    const double type = member_or_nan(mission, "vehicleType", where);  // MAV_TYPE
    const auto is_one_of = [&](std::initializer_list<int> types) {
      return std::any_of(types.begin(), types.end(), [&](int other) { return type == other; });
    };
    if (is_one_of({1})) plan_.vehicle = PlanVehicle::fixed_wing;
    if (is_one_of({2, 3, 4, 13, 14, 15, 29, 35})) plan_.vehicle = PlanVehicle::multirotor;
    if (is_one_of({19, 20, 21, 22, 23, 24, 25})) plan_.vehicle = PlanVehicle::vtol;
    const bool hovers = plan_.vehicle == PlanVehicle::multirotor;
    const double speed = member_or_nan(mission, hovers ? "hoverSpeed" : "cruiseSpeed", where);
    if (speed > 0 && std::isfinite(speed)) plan_.speed_m_s = speed;
    const auto home = mission.find("plannedHomePosition");
    if (home == mission.end() || home->is_null()) return;
    PlanPosition position = coordinate(*home, source_.place("plannedHomePosition"));
    position.datum = HeightDatum::sea_level;
    plan_.home = position;
  }

  /// [latitude, longitude, height].
  static PlanPosition coordinate(const json& list, const std::string& where) {
    if (!list.is_array() || list.size() < 2) {
      PlanSource::fail_at(ErrorCode::plan_syntax, where, "it is not [latitude, longitude, height]", "correct it");
    }
    PlanPosition position;
    position.horizontal = checked_lonlat(number_or_nan(list[1], where, "the longitude"),
                                         number_or_nan(list[0], where, "the latitude"), where);
    if (list.size() > 2) position.height_m = number_or_nan(list[2], where, "the height");
    return position;
  }

  void add(const json& item, const std::string& where) {
    if (!item.is_object()) PlanSource::fail_at(ErrorCode::plan_syntax, where, "it is not an object", "correct it");
    const std::string type = item.value("type", json()).is_string() ? item["type"].get<std::string>() : "";
    if (type == "SimpleItem" || type == "missionItem") return add_simple(item, where);
    if (type == "ComplexItem") return add_complex(item, where);
    PlanSource::fail_at(ErrorCode::plan_syntax, where, "its type is neither \"SimpleItem\" nor \"ComplexItem\"",
                        "save the plan anew with the ground station");
  }

  MissionItem& new_mission_item() {
    check_count(items_.size() + 1, source_);
    return items_.emplace_back();
  }

  void add_simple(const json& item, const std::string& where) {
    MissionItem& added = new_mission_item();
    added.place = where;
    added.command = integer_member(item, "command", where);
    added.frame = integer_member(item, "frame", where);
    const auto parameters = item.find("params");
    if (parameters == item.end() || !parameters->is_array() || parameters->size() != 7) {
      PlanSource::fail_at(ErrorCode::plan_syntax, where, "it does not have seven \"params\"",
                          "save the plan anew with QGroundControl 3.3 or later");
    }
    for (std::size_t i = 0; i < 7; ++i) {
      added.parameters[i] = number_or_nan((*parameters)[i], where, "params[" + std::to_string(i) + "]");
    }
    added.id = id_of(item, where);
    added.goes_on = flag(item, "autoContinue", true, where);
    take_height(item, added);
  }

  /// Above terrain the ground station computes the height above sea level from its own; null where it has none.
  static void take_height(const json& item, MissionItem& added) {
    const std::string mode = mode_of(item, added.place);
    const double stated = member_or_nan(item, "Altitude", added.place);
    if (mode == "CalcAboveTerrain") {
      const double above_sea = member_or_nan(item, "AMSLAltAboveTerrain", added.place);
      if (std::isnan(added.parameters[6])) added.parameters[6] = above_sea;
      check_same_height(added, "AMSLAltAboveTerrain", above_sea);
      added.above_ground_m = stated;
    } else {
      check_same_height(added, "Altitude", stated);
    }
    const int frame = added.frame;
    const bool is_relative = frame == kGlobalRelative || frame == kGlobalRelativeInt,
               is_absolute = frame == kGlobal || frame == kGlobalInt,
               is_terrain = frame == kGlobalTerrain || frame == kGlobalTerrainInt;
    const bool contradicts = (mode == "Relative" && !is_relative) || (mode == "Absolute" && !is_absolute) ||
                             (mode == "CalcAboveTerrain" && !is_absolute) || (mode == "TerrainFrame" && !is_terrain);
    if (std::isnan(stated) || frame == kMission || !contradicts) return;
    PlanSource::fail_at(ErrorCode::conflicting_keys, added.place,
                        "its height is measured from two levels: the frame is " + std::to_string(frame) +
                            ", and the AltitudeMode " + mode,
                        "open the plan in the ground station, set the height anew, and save it");
  }

  /// A name, or its number.
  static std::string mode_of(const json& item, const std::string& where) {
    const auto mode = item.find("AltitudeMode");
    if (mode == item.end()) return {};
    if (mode->is_string()) return printable(mode->get<std::string>());
    const double number = number_or_nan(*mode, where, in_quotes("AltitudeMode"));
    if (number == 1) return "Relative";
    if (number == 2) return "Absolute";
    if (number == 3) return "CalcAboveTerrain";
    return number == 4 ? "TerrainFrame" : "";
  }

  /// The vehicle is given params[6], and the ground station shows the other one. Which is meant, nobody knows.
  static void check_same_height(const MissionItem& item, const char* key, double stated_m) {
    constexpr double kSameM = 0.1;
    if (std::isnan(stated_m) || std::isnan(item.parameters[6])) return;
    if (std::abs(item.parameters[6] - stated_m) <= kSameM) return;
    PlanSource::fail_at(ErrorCode::conflicting_keys, item.place,
                        "it has two heights: params[6] is " + shortest(item.parameters[6]) + ", and " + in_quotes(key) +
                            " " + shortest(stated_m),
                        "open the plan in the ground station, set the height anew, and save it");
  }

  void add_complex(const json& item, const std::string& where) {
    const json kind = item.value("complexItemType", json());
    const std::string name = kind.is_string() ? kind.get<std::string>() : "";
    const bool is_landing = name == "fwLandingPattern" || name == "vtolLandingPattern";
    if (is_landing) return add_landing(item, where);
    const auto style = item.find("TransectStyleComplexItem");
    const json* stored = style != item.end() && style->is_object() ? &*style : &item;
    const auto items = stored->find("Items");
    if (items != stored->end() && items->is_array() && !items->empty()) {
      for (std::size_t i = 0; i < items->size(); ++i) {
        const std::string place =
            std::string(where).append(" (").append(name).append("), item ").append(std::to_string(i + 1));
        if (!(*items)[i].is_object())
          PlanSource::fail_at(ErrorCode::plan_syntax, place, "it is not an object", "correct it");
        add_simple((*items)[i], place);
      }
      return;
    }
    if (add_transects(*stored, where + " (" + name + ")")) return;
    PlanSource::fail_at(
        ErrorCode::value_unsupported, where,
        "its items are not stored in the plan: it is " + (name.empty() ? "a complex item" : "a " + in_quotes(name)),
        "save the plan with a QGroundControl that stores them, or download it from the vehicle after uploading it");
  }

  /// The points that a survey shows on the map, at the distance to the surface that it states.
  bool add_transects(const json& style, const std::string& where) {
    const auto points = style.find("VisualTransectPoints");
    const auto camera = style.find("CameraCalc");
    if (points == style.end() || !points->is_array() || points->empty()) return false;
    if (camera == style.end() || !camera->is_object()) return false;
    const double height = member_or_nan(*camera, "DistanceToSurface", where);
    const double mode = member_or_nan(*camera, "DistanceMode", where);  // 1: above home, 2: above sea level
    const bool is_relative = flag(*camera, "DistanceToSurfaceRelative", false, where) || mode == 1;
    const bool is_known = is_relative || mode == 2 || camera->contains("DistanceToSurfaceRelative");
    if (flag(style, "FollowTerrain", false, where) || std::isnan(height) || !is_known || mode > 2) return false;
    for (std::size_t i = 0; i < points->size(); ++i) {
      MissionItem& added = new_mission_item();
      added.place = where + ", point " + std::to_string(i + 1);
      added.command = kNavWaypoint;
      added.frame = is_relative ? kGlobalRelative : kGlobal;
      added.id = -1;
      const PlanPosition position = coordinate((*points)[i], added.place);
      added.parameters = {0, 0, 0, kNoNumber, position.horizontal.y(), position.horizontal.x(), height};
    }
    return true;
  }

  /// DO_LAND_START, as the ground station sends it, a circle down to the height of the approach, and a slope to the
  /// place of landing.
  void add_landing(const json& item, const std::string& where) {
    MissionItem& start = new_mission_item();
    start.place = where;
    start.command = kDoLandStart;
    start.id = id_of(item, where);
    const bool is_relative = flag(item, "altitudesAreRelative", true, where);
    // `relative`: in version 1 each of the two heights has a flag of its own.
    const auto add_at = [&](std::initializer_list<const char*> keys, const char* relative, int command, double radius) {
      for (const char* key : keys) {
        const auto found = item.find(key);
        if (found == item.end()) continue;
        const PlanPosition position = coordinate(*found, where + ", " + key);
        MissionItem& added = new_mission_item();
        added.place = where;
        added.command = command;
        added.frame = flag(item, relative, is_relative, where) ? kGlobalRelative : kGlobal;
        added.parameters = {
            0, radius, 0, kNoNumber, position.horizontal.y(), position.horizontal.x(), position.height_m};
        return;
      }
      PlanSource::fail_at(ErrorCode::plan_syntax, where, std::string("it has no ") + in_quotes(*keys.begin()),
                          "save the plan anew with the ground station");
    };
    const double stated = member_or_nan(item, "loiterRadius", where);
    const double radius = std::isnan(stated) ? 0 : stated;  // 0: that of the vehicle
    const bool clockwise = flag(item, "loiterClockwise", true, where);
    const bool circles = flag(item, "useLoiterToAlt", true, where);
    add_at({"landingApproachCoordinate", "finalApproachCoordinate", "loiterCoordinate"}, "loiterAltitudeRelative",
           circles ? kNavLoiterToAltitude : kNavWaypoint, circles ? (clockwise ? radius : -radius) : 0);
    add_at({"landCoordinate"}, "landAltitudeRelative", kNavLand, 0);
  }

  const PlanSource& source_;
  FlightPlan plan_;
  std::vector<MissionItem> items_;
};

}  // namespace

FlightPlan read_qgroundcontrol(const json& root, const PlanSource& source) {
  return GroundStationPlan(source).read(root);
}

}  // namespace vantage::internal::flight::plans
