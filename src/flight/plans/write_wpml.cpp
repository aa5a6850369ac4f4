// WPML, the plans of DJI: https://developer.dji.com/doc/cloud-api-tutorial/en/api-reference/dji-wpml/overview.html.
// waylines.wpml is what the aircraft flies, template.kml what its ground station shows.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "flight/plans/plan_writer.h"
#include "io/write_zip.h"
#include "vantage/error.h"

namespace vantage::internal::flight::plans {
namespace {

constexpr int kAngleDecimals = 2, kPlaceDecimals = 11, kHeightDecimals = 6, kSpeedDecimals = 3;
constexpr double kLeastClimbM = 1.2;  ///< as the format states

std::string element(const char* name, const std::string& content) {
  return std::string("<wpml:").append(name).append(">").append(content).append("</wpml:").append(name).append(">");
}
std::string element(const char* name, int number) { return element(name, std::to_string(number)); }

/// What of a target's name fits in the name of a photo's file: "_Hotel_Lux".
std::string in_file_name(const std::string& name) {
  constexpr std::size_t kMost = 24;
  std::string result;
  for (const char c : name.substr(0, kMost)) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (is_plain || result.empty() || result.back() != '_') result += is_plain ? c : '_';
  }
  return name.empty() ? name : "_" + result;
}

class WaylineWriter {
 public:
  explicit WaylineWriter(const FlightOut& flight)
      : writer_(flight, PlanFormat::wpml, {HeightDatum::home, HeightDatum::ellipsoid, HeightDatum::sea_level}),
        points_(writer_.points()) {
    check();
  }

  std::string archive() const {
    return io::zipped({{"wpmz/template.kml", document(true)}, {"wpmz/waylines.wpml", document(false)}});
  }

 private:
  const DjiAircraft& aircraft() const { return *writer_.flight().aircraft; }

  void check() const {
    const auto fail = [this](ErrorCode code, const std::string& problem, const std::string& fix) {
      throw Error(code, problem, writer_.place(), fix);
    };
    if (!writer_.flight().aircraft) {
      fail(
          ErrorCode::missing_key, "a plan of DJI names its aircraft",
          "give with --aircraft (aircraft in Python) the numbers of its type in DJI's documents: 77,0 is the Mavic 3E");
    }
    const auto is_at_first = [this](const OutPoint& point) { return point.position == points_.front().position; };
    if (std::all_of(points_.begin(), points_.end(), is_at_first)) {
      fail(ErrorCode::value_unsupported, "a plan of DJI has two waypoints at least", "write another format");
    }
    constexpr double kMostM = 1500, kMostMetresPerSecond = 15;  // as the format states
    if (!(aircraft().takeoff_height_m >= kLeastClimbM && aircraft().takeoff_height_m <= kMostM)) {
      fail(ErrorCode::value_out_of_range, "the height to climb to at first is out of range", "give 1.2 to 1500 m");
    }
    if (!(takeoff_height_m() >= kLeastClimbM)) {
      fail(ErrorCode::value_unsupported,
           "aircraft of DJI climb to at least 1.2 m above the home at first, and no more than " +
               decimal(takeoff_height_m(), kSpeedDecimals) + " m are allowed there",
           "move the home to where there is more room above it, or write another format");
    }
    for (const OutPoint& point : points_) {
      if (std::isnan(point.speed_m_s)) {
        fail(ErrorCode::missing_key, "a plan of DJI states the speed", "give the speed of the flight");
      }
      if (point.speed_m_s > kMostMetresPerSecond) {
        fail(ErrorCode::value_out_of_range, "the aircraft of DJI fly at 15 m/s at most", "give a lower speed");
      }
      if ((point.action.photo || point.action.video) && !aircraft().payload) {
        fail(ErrorCode::missing_key, "photos and videos need the type of the camera",
             "give its number in DJI's documents as the third of --aircraft: 77,0,66 is the Mavic 3E");
      }
    }
  }

  double takeoff_height_m() const {
    constexpr double kThousand = 1000, kRounding = 1e-6;
    const double asked_m = aircraft().takeoff_height_m;
    const double allowed_m = writer_.flight().highest_takeoff_m.value_or(asked_m);
    return std::min(asked_m, std::floor(allowed_m * kThousand + kRounding) / kThousand);
  }

  /// What the aircraft flies by: heights above the ellipsoid, or above the home.
  HeightDatum flown() const {
    return writer_.heights() == HeightDatum::home ? HeightDatum::home : HeightDatum::ellipsoid;
  }

  std::string document(bool is_template) const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
           "xmlns:wpml=\"http://www.dji.com/wpmz/1.0.2\">\n<Document>\n" +
           (is_template ? element("author", "vantage") + "\n" : "") + config() + "<Folder>\n" +
           (is_template ? template_head() : wayline_head()) + placemarks(is_template) +
           "</Folder>\n</Document>\n</kml>\n";
  }

  std::string config() const {
    const DjiAircraft& type = aircraft();
    std::string text = "<wpml:missionConfig>\n" + element("flyToWaylineMode", "safely") +
                       element("finishAction", writer_.flight().returns_home ? "goHome" : "noAction") +
                       element("exitOnRCLost", "executeLostAction") + element("executeRCLostAction", "goBack") +
                       element("takeOffSecurityHeight", decimal(takeoff_height_m(), kSpeedDecimals));
    if (writer_.flight().home && writer_.knows(HeightDatum::ellipsoid)) {
      const Eigen::Vector2d home = writer_.lonlat(writer_.home());
      text += element("takeOffRefPoint",
                      decimal(home.y(), kPlaceDecimals) + "," + decimal(home.x(), kPlaceDecimals) + "," +
                          decimal(writer_.height(writer_.home(), HeightDatum::ellipsoid), kHeightDecimals));
    }
    text +=
        element("globalTransitionalSpeed", decimal(points_.front().speed_m_s, kSpeedDecimals)) +
        element("droneInfo", element("droneEnumValue", type.drone) + element("droneSubEnumValue", type.drone_sub_type));
    if (type.payload) {
      text += element("payloadInfo", element("payloadEnumValue", *type.payload) + element("payloadPositionIndex", 0));
    }
    return text + "\n</wpml:missionConfig>\n";
  }

  std::string speed() const { return element("autoFlightSpeed", decimal(points_[1].speed_m_s, kSpeedDecimals)) + "\n"; }

  std::string wayline_head() const {
    return element("templateId", 0) +
           element("executeHeightMode", flown() == HeightDatum::home ? "relativeToStartPoint" : "WGS84") +
           element("waylineId", 0) + speed();
  }

  std::string template_head() const {
    const char* const mode = writer_.heights() == HeightDatum::home        ? "relativeToStartPoint"
                             : writer_.heights() == HeightDatum::sea_level ? "EGM96"
                                                                           : "WGS84";
    return element("templateType", "waypoint") + element("templateId", 0) +
           element("waylineCoordinateSysParam", element("coordinateMode", "WGS84") + element("heightMode", mode)) +
           speed() + element("gimbalPitchMode", "manual") +
           element("globalWaypointHeadingParam", element("waypointHeadingMode", "followWayline")) +
           element("globalWaypointTurnMode", "toPointAndStopWithDiscontinuityCurvature") +
           element("globalUseStraightLine", 1) + "\n";
  }

  std::string placemarks(bool is_template) const {
    std::string text;
    int index = 0;
    for (std::size_t i = 0, next = 0; i < points_.size(); i = next, ++index) {
      const OutPoint& point = points_[i];
      // Waypoints in one place are none that it flies between: what is done there belongs to the first.
      for (next = i + 1; next < points_.size() && points_[next].position == point.position;) ++next;
      const Eigen::Vector2d at = writer_.lonlat(point.position);
      // The speed of a waypoint is that of the leg that begins there.
      const double speed_m_s = points_[std::min(next, points_.size() - 1)].speed_m_s;
      text += "<Placemark><Point><coordinates>" + decimal(at.x(), kPlaceDecimals) + "," +
              decimal(at.y(), kPlaceDecimals) + "</coordinates></Point>" + element("index", index);
      const std::string flown_height = decimal(writer_.height(point.position, flown()), kHeightDecimals);
      if (is_template) {
        text += element("useGlobalHeight", 0) + element("ellipsoidHeight", flown_height) +
                element("height", decimal(writer_.height(point.position), kHeightDecimals)) +
                element("useGlobalSpeed", 0);
      } else {
        text += element("executeHeight", flown_height);
      }
      text += element("waypointSpeed", decimal(speed_m_s, kSpeedDecimals));
      if (is_template) text += element("useGlobalHeadingParam", 0) + element("useGlobalTurnParam", 0);
      text += heading(point) +
              element("waypointTurnParam", element("waypointTurnMode", "toPointAndStopWithDiscontinuityCurvature") +
                                               element("waypointTurnDampingDist", 0)) +
              element("useStraightLine", 1) +
              actions({points_.begin() + static_cast<std::ptrdiff_t>(i),
                       points_.begin() + static_cast<std::ptrdiff_t>(next)},
                      index) +
              "</Placemark>\n";
    }
    return text;
  }

  static std::string heading(const OutPoint& point) {
    const auto yaw = camera_angles(point).yaw_deg;
    return element("waypointHeadingParam",
                   element("waypointHeadingMode", yaw ? "smoothTransition" : "followWayline") +
                       element("waypointHeadingAngle", decimal(yaw.value_or(0), kAngleDecimals)) +
                       element("waypointPoiPoint", "0.000000,0.000000,0.000000") +
                       element("waypointHeadingAngleEnable", yaw ? 1 : 0) +
                       element("waypointHeadingPathMode", "followBadArc"));
  }

  /// `points`: in one place, one after the other.
  static std::string actions(std::span<const OutPoint> points, int index) {
    std::vector<std::string> all;
    for (const OutPoint& point : points) add_actions(point, &point != &points.front(), index, all);
    if (all.empty()) return {};
    std::string group = element("actionGroupId", index) + element("actionGroupStartIndex", index) +
                        element("actionGroupEndIndex", index) + element("actionGroupMode", "sequence") +
                        element("actionTrigger", element("actionTriggerType", "reachPoint"));
    for (const std::string& action : all) group += action;
    return element("actionGroup", group);
  }

  static void add_actions(const OutPoint& point, bool turns, int index, std::vector<std::string>& all) {
    const auto add = [&](const char* what, const std::string& how) {
      all.push_back(element("action", element("actionId", static_cast<int>(all.size())) +
                                          element("actionActuatorFunc", what) +
                                          element("actionActuatorFuncParam", how)));
    };
    const std::string payload = element("payloadPositionIndex", 0);
    if (const auto yaw = camera_angles(point).yaw_deg; yaw && turns) {
      add("rotateYaw",
          element("aircraftHeading", decimal(*yaw, kAngleDecimals)) + element("aircraftPathMode", "counterClockwise"));
    }
    if (const auto pitch = camera_angles(point).pitch_deg) {
      add("gimbalRotate", element("gimbalHeadingYawBase", "aircraft") + element("gimbalRotateMode", "absoluteAngle") +
                              element("gimbalPitchRotateEnable", 1) +
                              element("gimbalPitchRotateAngle", decimal(*pitch, kAngleDecimals)) +
                              element("gimbalRollRotateEnable", 0) + element("gimbalRollRotateAngle", 0) +
                              element("gimbalYawRotateEnable", 0) + element("gimbalYawRotateAngle", 0) +
                              element("gimbalRotateTimeEnable", 0) + element("gimbalRotateTime", 0) + payload);
    }
    const std::string file =
        element("fileSuffix", "point" + std::to_string(index + 1) + in_file_name(point.action.sees)) + payload;
    if (point.action.video) add("startRecord", file);
    if (point.hold_s > 0) add("hover", element("hoverTime", hold_text(point.hold_s)));
    if (point.action.video) add("stopRecord", payload);
    if (point.action.photo) add("takePhoto", file);
  }

  PlanWriter writer_;
  std::vector<OutPoint> points_;
};

}  // namespace

std::string write_wpml(const FlightOut& flight) { return WaylineWriter(flight).archive(); }

}  // namespace vantage::internal::flight::plans
