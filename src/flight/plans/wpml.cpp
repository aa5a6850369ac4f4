// WPML, the plans of DJI: https://developer.dji.com/doc/cloud-api-tutorial/en/api-reference/dji-wpml/overview.html.
// waylines.wpml is what the aircraft flies; template.kml is what a person has drawn, and is read where it is alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/input.h"
#include "core/text.h"
#include "flight/plans/kml.h"

namespace vantage::internal::flight::plans {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

XmlTree::Node document_of(const XmlTree& xml) { return xml.child(xml.root(), "Document"); }

class Waylines {
 public:
  Waylines(const XmlTree& xml, const PlanSource& source) : xml_(xml), source_(source) {}

  FlightPlan read() {
    plan_.format = PlanFormat::wpml;
    plan_.file = source_.name;
    plan_.vehicle = PlanVehicle::multirotor;
    const XmlTree::Node document = document_of(xml_);
    const XmlTree::Node config = child(document, "missionConfig");
    read_home(config);
    for (XmlTree::Node node = xml_.first_child(document); node != XmlTree::kNone; node = xml_.next(node)) {
      if (xml_.name(node) == "Folder") add_folder(node);
    }
    check_all_read(document);
    take_tracks(std::move(tracks_), "wayline", "waylines", source_, plan_);
    if (!plan_.items.empty()) add_ends(config);
    name_unknown_actions(document);
    if (curves_ > 0) {
      plan_.not_judged.push_back(
          first_curve_ + ": it is flown through in a curve of the aircraft's own, which the plan does not hold" +
          (curves_ > 1 ? "; likewise " + core::count_text(curves_ - 1, "waypoint", "waypoints") + " more" : ""));
    }
    check_plan(plan_, source_);
    return std::move(plan_);
  }

 private:
  /// The one of that name. Nobody knows which of several counts.
  XmlTree::Node child(XmlTree::Node parent, std::string_view name) const {
    if (parent == XmlTree::kNone) return XmlTree::kNone;
    const XmlTree::Node node = xml_.child(parent, name);
    for (XmlTree::Node next = node; next != XmlTree::kNone;) {
      next = xml_.next(next);
      if (next == XmlTree::kNone || xml_.name(next) != name) continue;
      source_.fail(ErrorCode::value_unsupported, line_of(xml_, next), "there is a second " + std::string(name),
                   "leave one of the two out");
    }
    return node;
  }
  double number(XmlTree::Node parent, const char* name) const {
    const XmlTree::Node node = child(parent, name);
    return node == XmlTree::kNone || xml_.text(node).empty() ? kNoValue : number_of(xml_, node, source_);
  }
  std::string_view word(XmlTree::Node parent, const char* name) const {
    const XmlTree::Node node = child(parent, name);
    return node == XmlTree::kNone ? std::string_view() : xml_.text(node);
  }

  /// A waypoint in another place, or without a position of its own, would not be flown to.
  void check_all_read(XmlTree::Node document) const {
    std::size_t read = 0;
    xml_.walk(document, [&](XmlTree::Node node) {
      if (xml_.name(node) != "Placemark") return true;
      if (read < placemarks_.size() && placemarks_[read] == node) {
        ++read;
        return true;
      }
      source_.fail(
          ErrorCode::value_unsupported, line_of(xml_, node),
          "the waypoint is not one of a wayline: it lies outside of its folder, or its position is not a Point "
          "directly in it",
          "write it as the plans of DJI have it, or leave it out");
    });
  }

  /// Of the actions those that leave the vehicle where it is.
  void name_unknown_actions(XmlTree::Node document) {
    constexpr std::array<std::string_view, 16> kKnown = {
        "hover",     "rotateYaw",     "gimbalRotate",     "gimbalEvenlyRotate",
        "takePhoto", "startRecord",   "stopRecord",       "focus",
        "zoom",      "customDirName", "orientedShoot",    "accurateShoot",
        "panoShot",  "setFocusType",  "recordPointCloud", "megaphone"};
    xml_.walk(document, [&](XmlTree::Node node) {
      const std::string_view name = xml_.text(node);
      if (xml_.name(node) == "actionActuatorFunc" && std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end()) {
        not_judged_.name(source_.place(line_of(xml_, node)),
                         "the action " + in_quotes(name) + " is not known here, and may move the vehicle");
      }
      return true;
    });
  }

  /// "latitude,longitude,height", the height above the ellipsoid.
  void read_home(XmlTree::Node config) {
    const XmlTree::Node node = child(config, "takeOffRefPoint");
    if (node == XmlTree::kNone || xml_.text(node).empty()) return;
    const std::string where = source_.place(line_of(xml_, node));
    const std::vector<double> numbers = numbers_of(xml_.text(node), ',', 2, 3, where);
    PlanPosition home;
    home.horizontal = checked_lonlat(numbers[1], numbers[0], where);
    home.datum = HeightDatum::ellipsoid;
    if (numbers.size() > 2) home.height_m = numbers[2];
    plan_.home = home;
  }

  struct Heights {
    HeightDatum datum = HeightDatum::unknown;
    bool follows_ground = false;
    bool is_template = false;
    double global_m = kNoValue;
  };

  Heights heights_of(XmlTree::Node folder) const {
    Heights heights;
    XmlTree::Node mode = child(folder, "executeHeightMode");
    if (mode == XmlTree::kNone) {
      heights.is_template = true;
      const std::string_view kind = word(folder, "templateType");
      if (!kind.empty() && kind != "waypoint") {
        source_.fail(ErrorCode::value_unsupported, line_of(xml_, folder),
                     "a template of the type " + in_quotes(kind) + " does not say where the aircraft flies",
                     "give the KMZ file with wpmz/waylines.wpml, as DJI Pilot 2 and FlightHub 2 export it");
      }
      const XmlTree::Node system = child(folder, "waylineCoordinateSysParam");
      mode = system == XmlTree::kNone ? XmlTree::kNone : child(system, "heightMode");
      heights.global_m = number(folder, "globalHeight");
    }
    const std::string_view name = mode == XmlTree::kNone ? std::string_view() : xml_.text(mode);
    heights.follows_ground = name == "realTimeFollowSurface";
    if (name == "WGS84") heights.datum = HeightDatum::ellipsoid;
    if (name == "EGM96") heights.datum = HeightDatum::sea_level;
    if (name == "relativeToStartPoint") heights.datum = HeightDatum::home;
    if (name == "aboveGroundLevel" || heights.follows_ground) heights.datum = HeightDatum::ground;
    return heights;
  }

  void add_folder(XmlTree::Node folder) {
    PlanTrack track;
    track.place = line_of(xml_, folder);
    track.name = std::string(word(folder, "waylineId"));
    const double id = number(folder, "waylineId");
    if (id < last_wayline_) {
      source_.fail(ErrorCode::value_unsupported, line_of(xml_, folder),
                   "the waylines are not in the order of their 'waylineId'", "write them in the order of the flight");
    }
    if (!std::isnan(id)) last_wayline_ = id;
    if (word(folder, "caliFlightEnable") == "1") {
      not_judged_.name(source_.place(track.place), "the aircraft flies a calibration first (caliFlightEnable)");
    }
    const Heights heights = heights_of(folder);
    const double folder_speed = number(folder, "autoFlightSpeed");
    const std::string_view folder_turn = word(folder, "globalWaypointTurnMode");
    const std::string_view type = word(folder, "waylineType");
    if (!type.empty() && type != "waypoint") {
      not_judged_.name(source_.place(track.place),
                       "it is a wayline of the type " + in_quotes(type) + ", which is not followed here");
    }
    std::string turns;        // what is not known of the turn at the last waypoint, if there is another behind it
    double speed = kNoValue;  // of the leg to come: that of the waypoint before
    double last_index = kNoValue;
    camera_ = {};
    for (XmlTree::Node node = xml_.first_child(folder); node != XmlTree::kNone; node = xml_.next(node)) {
      source_.progress.tick();
      if (xml_.name(node) != "Placemark" || child(node, "Point") == XmlTree::kNone) continue;
      placemarks_.push_back(node);
      const double index = number(node, "index");
      if (index < last_index) {
        source_.fail(ErrorCode::value_unsupported, line_of(xml_, node),
                     "the waypoints are not in the order of their 'index'", "write them in the order of the flight");
      }
      if (!std::isnan(index)) last_index = index;
      PlanItem& item = new_item(track, total_,
                                line_of(xml_, node) + ", waypoint " + std::to_string(track.items.size() + 1), source_);
      read_position(node, heights, item);
      item.follows_ground = heights.follows_ground && track.items.size() > 1;
      item.speed_m_s = speed;
      const double own_speed = word(node, "useGlobalSpeed") == "1" ? kNoValue : number(node, "waypointSpeed");
      speed = own_speed > 0 ? own_speed : folder_speed > 0 ? folder_speed : kNoValue;
      if (!turns.empty()) not_judged_.name(track.items[track.items.size() - 2].place, turns);
      turns = read_turn(node, folder_turn, item);
      if (track.items.size() == 1) turns.clear();
      read_camera(node, item);
    }
    if (track.items.empty()) return;
    track.items.front().cut_m = track.items.back().cut_m = 0;  // a wayline is not turned at its ends
    tracks_.push_back(std::move(track));
  }

  void read_position(XmlTree::Node placemark, const Heights& heights, PlanItem& item) {
    const XmlTree::Node point = child(placemark, "Point");
    const std::vector<double> numbers = numbers_of(word(point, "coordinates"), ',', 2, 3, item.place);
    item.position.horizontal = checked_lonlat(numbers[0], numbers[1], item.place);
    item.position.datum = heights.datum;
    if (!heights.is_template) {
      item.position.height_m = number(placemark, "executeHeight");
    } else if (word(placemark, "useGlobalHeight") == "1") {
      item.position.height_m = heights.global_m;
      if (heights.datum != HeightDatum::home) {
        not_judged_.name(item.place,
                         "its height is the globalHeight of a template, which is above the place of takeoff: give the "
                         "KMZ file with wpmz/waylines.wpml");
      }
    } else {
      item.position.height_m =
          number(placemark, heights.datum == HeightDatum::ellipsoid ? "ellipsoidHeight" : "height");
    }
  }

  /// What is not known of how it turns before the waypoint.
  std::string read_turn(XmlTree::Node placemark, std::string_view folder_turn, PlanItem& item) {
    const XmlTree::Node turn = child(placemark, "waypointTurnParam");
    const bool is_global = turn == XmlTree::kNone || word(placemark, "useGlobalTurnParam") == "1";
    const std::string_view mode = is_global ? folder_turn : word(turn, "waypointTurnMode");
    const bool is_straight = word(placemark, "useStraightLine") == "1";
    if (mode == "coordinateTurn") {
      const double distance = number(turn, "waypointTurnDampingDist");
      item.cut_m = distance > 0 ? distance : 0;
      return distance > 0 ? "" : "it is turned before, and the plan does not say how far (waypointTurnDampingDist)";
    }
    if (mode == "toPointAndPassWithContinuityCurvature" && is_straight) {
      return "it is turned before, in a curve of the aircraft's own: let the aircraft stop there, or give it a "
             "coordinateTurn";
    }
    const bool is_curve = mode.find("ContinuityCurvature") != std::string_view::npos;  // not "Discontinuity..."
    if (is_curve && !is_straight && ++curves_ == 1) first_curve_ = item.place;
    if (!is_curve && !mode.empty() && mode != "toPointAndStopWithDiscontinuityCurvature") {
      not_judged_.name(item.place, "how it is turned there is not known here: " + in_quotes(mode));
    }
    return {};
  }

  /// What an action has set stays so.
  struct Camera {
    std::optional<double> yaw_deg, gimbal_yaw_deg, gimbal_pitch_deg;
    bool from_north = false;
  };

  void read_camera(XmlTree::Node placemark, PlanItem& item) {
    const auto given = [](double angle) { return std::isnan(angle) ? std::nullopt : std::optional(angle); };
    const XmlTree::Node heading = child(placemark, "waypointHeadingParam");
    const std::string_view mode = word(heading, "waypointHeadingMode");
    if (mode == "smoothTransition" || mode == "fixed") camera_.yaw_deg = given(number(heading, "waypointHeadingAngle"));
    for (XmlTree::Node group = xml_.first_child(placemark); group != XmlTree::kNone; group = xml_.next(group)) {
      if (xml_.name(group) != "actionGroup") continue;
      const XmlTree::Node trigger = child(group, "actionTrigger");
      if (word(trigger, "actionTriggerType") != "reachPoint") continue;
      for (XmlTree::Node action = xml_.first_child(group); action != XmlTree::kNone; action = xml_.next(action)) {
        if (xml_.name(action) == "action") act(action, item);
      }
    }
    item.yaw_deg = camera_.yaw_deg;
    item.gimbal_yaw_deg = camera_.gimbal_yaw_deg;
    item.gimbal_yaw_from_north = camera_.from_north;
    // What an action says counts: writers put a 0 into the parameter where they mean nothing.
    const XmlTree::Node gimbal = child(placemark, "waypointGimbalHeadingParam");
    item.gimbal_pitch_deg =
        camera_.gimbal_pitch_deg ? camera_.gimbal_pitch_deg : given(number(gimbal, "waypointGimbalPitchAngle"));
  }

  void act(XmlTree::Node action, PlanItem& item) {
    const std::string_view what = word(action, "actionActuatorFunc");
    const XmlTree::Node how = child(action, "actionActuatorFuncParam");
    if (what == "hover") {
      const double time_s = number(how, "hoverTime");
      if (!std::isnan(time_s)) item.hold_s += time_s;
    }
    if (what == "rotateYaw") {
      const double yaw = number(how, "aircraftHeading");
      if (!std::isnan(yaw)) camera_.yaw_deg = yaw;
    }
    if (what != "gimbalRotate" || word(how, "gimbalRotateMode") == "relativeAngle") return;
    const double pitch = number(how, "gimbalPitchRotateAngle"), yaw = number(how, "gimbalYawRotateAngle");
    if (word(how, "gimbalPitchRotateEnable") == "1" && !std::isnan(pitch)) camera_.gimbal_pitch_deg = pitch;
    if (word(how, "gimbalYawRotateEnable") == "1" && !std::isnan(yaw)) {
      camera_.gimbal_yaw_deg = yaw;
      camera_.from_north = word(how, "gimbalHeadingYawBase") == "north";
    }
  }

  /// The way to the first waypoint, where the place of takeoff is known, and what comes after the last.
  void add_ends(XmlTree::Node config) {
    const double transit = number(config, "globalTransitionalSpeed");
    if (transit > 0) plan_.items.front().speed_m_s = transit;
    const std::string_view finish = word(config, "finishAction");
    PlanItem last = plan_.items.back();
    last.hold_s = last.cut_m = 0;
    last.place = source_.place("finishAction");
    last.speed_m_s = transit > 0 ? transit : kNoValue;
    if (finish == "goHome") {
      last.kind = PlanItemKind::return_home;
      last.position = {};
      last.position.height_m = number(config, "globalRTHHeight");
      last.follows_ground = false;
      plan_.items.push_back(last);
    } else if (finish == "autoLand") {
      last.kind = PlanItemKind::land;
      last.position = {last.position.horizontal, 0, HeightDatum::ground};
      last.follows_ground = false;
      plan_.items.push_back(last);
    } else if (finish == "gotoFirstWaypoint") {
      last.position = plan_.items.front().position;
      plan_.items.push_back(last);
    } else if (finish != "noAction") {
      not_judged_.name(last.place, "what the vehicle does at the end is not known here: " + in_quotes(finish));
    }
    const XmlTree::Node reroute = child(config, "autoRerouteInfo");
    if (word(reroute, "missionAutoRerouteMode") == "1" || word(reroute, "transitionalAutoRerouteMode") == "1") {
      not_judged_.name(source_.place("autoRerouteInfo"),
                       "the aircraft may fly round obstacles, on ways of its own: turn that off");
    }
    add_takeoff(config);
  }

  /// Where the file does not say it, the place may be known to who locates the plan.
  void add_takeoff(XmlTree::Node config) {
    constexpr double kMatrice300 = 60, kMatrice350 = 89;
    const double security = number(config, "takeOffSecurityHeight");
    if (std::isnan(security)) return;
    const std::string_view mode = word(config, "flyToWaylineMode");
    const double drone = number(child(config, "droneInfo"), "droneEnumValue");
    const bool is_300 = drone == kMatrice300 || drone == kMatrice350, is_safe = mode == "safely";
    if (!(security > 0)) {
      not_judged_.name(source_.place("takeOffSecurityHeight"),
                       "how high the aircraft climbs before it flies to the first waypoint is not said");
    } else if (!is_safe && (mode != "pointToPoint" || is_300)) {
      not_judged_.name(source_.place("flyToWaylineMode"),
                       "how the aircraft flies to the first waypoint is not known here: " + in_quotes(mode));
    }
    PlanItem takeoff;
    takeoff.kind = PlanItemKind::takeoff;
    takeoff.place = source_.place("takeOffRefPoint");
    takeoff.position.height_m = std::max(security, 0.0);
    takeoff.position.datum = HeightDatum::home;
    if (plan_.home) takeoff.position.horizontal = plan_.home->horizontal;
    plan_.items.front().way = !is_safe ? PlanWay::either : is_300 ? PlanWay::levels : PlanWay::level;
    plan_.items.front().cut_m = 0;  // it is not turned before the first waypoint
    plan_.items.insert(plan_.items.begin(), takeoff);
  }

  const XmlTree& xml_;
  const PlanSource& source_;
  FlightPlan plan_;
  NotJudged not_judged_{source_.name, plan_.not_judged};
  std::vector<PlanTrack> tracks_;
  std::vector<XmlTree::Node> placemarks_;  ///< that were read, in the order of the file
  Camera camera_;
  std::string first_curve_;
  std::size_t curves_ = 0, total_ = 0;
  double last_wayline_ = kNoValue;
};

}  // namespace

bool is_wpml(const XmlTree& xml) {
  const XmlTree::Node document = document_of(xml);
  if (xml.name(xml.root()) != "kml" || document == XmlTree::kNone) return false;
  if (xml.child(document, "missionConfig") != XmlTree::kNone) return true;
  const XmlTree::Node folder = xml.child(document, "Folder");
  return folder != XmlTree::kNone && (xml.child(folder, "executeHeightMode") != XmlTree::kNone ||
                                      xml.child(folder, "templateType") != XmlTree::kNone);
}

FlightPlan read_wpml(const XmlTree& xml, const PlanSource& source) { return Waylines(xml, source).read(); }

}  // namespace vantage::internal::flight::plans
