// Flights: where a vehicle goes, in the scene frame; and the plans of ground stations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"
#include "vantage/ground.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/query.h"

namespace vantage {

/// Where legs meet.
struct FlightPoint {
  Vec3 position = Vec3::Zero();                                 ///< scene frame, metres
  double hold_s = 0;                                            ///< for so long it stays there; >= 0
  double speed_m_s = std::numeric_limits<double>::quiet_NaN();  ///< of the leg that ends here; NaN: not stated
  std::string place = {};  ///< in the plan that it came from, for messages: "survey.plan: item 3"; may be empty
  /// The leg that ends here is one of several ways, and which of them the vehicle flies is not known: limits, links and
  /// clearances are judged on it, what is seen from it does not count, and it has no length and takes no time.
  bool is_other_way = false;
};

/// A flight along straight legs, from each point to the next one.
struct Flight {
  std::vector<FlightPoint> points;
  double chord_error_m = 0;  ///< the legs lie at most so far from the curves that they stand for
  /// What is flown besides the legs, a sentence each: FlightPlan::not_judged. No check passes such a flight.
  std::vector<std::string> not_judged = {};

  /// One less than there are points, or none.
  std::size_t leg_count() const { return points.empty() ? 0 : points.size() - 1; }
  Leg leg(std::size_t index) const { return {points[index].position, points[index + 1].position}; }
};

/// Of all legs but other ways, metres.
VANTAGE_API double length_m(const Flight& flight);

/// Throws Error(input) for a flight without points, and with the point's place for a position, a hold or a speed that
/// is not finite (a speed may be NaN), a hold below 0 and a speed that is not positive.
VANTAGE_API void check_flight_points(const Flight& flight);

// ---- Plans of ground stations: read, located in a scene, written

/// What a height is measured from.
enum class HeightDatum {
  scene_z,    ///< z of the scene frame
  sea_level,  ///< mean sea level, as maps and autopilots have it (a geoid: EGM96, EGM2008, a national one)
  ellipsoid,  ///< the WGS 84 ellipsoid
  ground,     ///< the ground below
  home,       ///< the place where the vehicle takes off
  unknown,    ///< the plan does not say
};

/// "sea level"; for messages.
VANTAGE_API const char* name_of(HeightDatum datum);

enum class PlanFormat {
  qgroundcontrol,  ///< .plan, JSON: the mission of QGroundControl
  waypoints,       ///< .waypoints, "QGC WPL 110": Mission Planner, QGroundControl, MAVProxy
  kml,             ///< .kml, .kmz: lines, tracks, or else points
  wpml,            ///< .kmz of DJI: wpmz/waylines.wpml, wpmz/template.kml
  gpx,             ///< .gpx: a track, a route, or else waypoints
  geojson,         ///< .geojson: lines, or else points
  csv,             ///< a table with a header
  czml,            ///< .czml, written alone: Cesium shows it, with times
};

/// "KML"; for messages.
VANTAGE_API const char* name_of(PlanFormat format);

// ---- reading ----

/// A place as a plan states it.
struct PlanPosition {
  /// Longitude and latitude (WGS 84, degrees); x and y of the scene frame where FlightPlan::is_in_scene_frame.
  Eigen::Vector2d horizontal = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  double height_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not given
  HeightDatum datum = HeightDatum::unknown;
};

enum class PlanItemKind {
  waypoint,
  takeoff,      ///< the position may be missing: the home
  loiter,       ///< a circle about the position, if `turns` is not 0; else a stay
  land,         ///< the place where it lands; it comes there at the height before, and goes down to the ground
  return_home,  ///< the position is missing: the home; its height, if there is one, is the least on the way, above it
};

/// How the vehicle comes to a waypoint; behind a takeoff also in other ways than straight.
enum class PlanWay {
  straight,
  level,   ///< at the higher one of the two heights: it takes off to that, or comes down above the waypoint
  levels,  ///< the same, or at the lower one of the two
  either,  ///< straight; where the waypoint is the lower one some vehicles come level, and then down
};

/// A step of a plan, jumps followed.
struct PlanItem {
  PlanItemKind kind = PlanItemKind::waypoint;
  PlanPosition position;
  /// The leg that ends here keeps its height above the ground between the one before, which then is above ground too,
  /// and this one: it follows the terrain. Else legs are straight.
  bool follows_ground = false;
  double hold_s = 0;                                            ///< for so long it stays
  double speed_m_s = std::numeric_limits<double>::quiet_NaN();  ///< of the leg that ends here; NaN: not stated
  std::optional<double> yaw_deg;                                ///< of the vehicle, clockwise from north
  std::optional<double> gimbal_yaw_deg;                         ///< clockwise, from north or from the vehicle's nose
  bool gimbal_yaw_from_north = false;                           ///< which of the two
  std::optional<double> gimbal_pitch_deg;                       ///< 0 level, -90 straight down
  std::optional<PlanPosition> look_at;  ///< what the camera is turned to; instead of yaw and pitch
  double acceptance_radius_m = 0;       ///< the item counts as reached so near; 0: not stated
  double loiter_radius_m = 0;           ///< > 0: clockwise seen from above; < 0: the other way; 0 (-0): of its own
  double turns = 0;                     ///< of a loiter; then it stays for `hold_s` where they end
  bool is_timed = false;                ///< of a loiter with turns: it circles for `hold_s` instead, and does not stay
  /// Of a loiter with turns: a multirotor stays in its centre instead, and the plan does not say which vehicle flies
  /// it.
  bool may_stay = false;
  bool is_climb = false;  ///< of a loiter: it comes there at the height before, and circles until it has its own
  /// Of a waypoint that it comes to on an arc from the position before: the angle that the arc turns by, above 0
  /// clockwise seen from above. 0: on a straight leg.
  double arc_deg = 0;
  bool is_spline = false;  ///< of a waypoint that it comes to on a spline of ArduPilot's Copter
  /// So far before the position the vehicle leaves the leg, and so far behind it it is on the next one, on an arc that
  /// touches both. 0: it goes to the position.
  double cut_m = 0;
  PlanWay way = PlanWay::straight;
  std::string place;  ///< "survey.plan: item 3"; for messages
};

enum class PlanVehicle { unknown, multirotor, fixed_wing, vtol };

struct FlightPlan {
  PlanFormat format = PlanFormat::csv;
  std::string file;                ///< as it was named; for messages
  bool is_in_scene_frame = false;  ///< of a table with x, y and z
  PlanVehicle vehicle = PlanVehicle::unknown;
  /// Where the vehicle takes off, if the plan says so.
  std::optional<PlanPosition> home;
  /// Of legs whose items state none; NaN: the plan has none. Of QGroundControl: that of its estimates of time.
  double speed_m_s = std::numeric_limits<double>::quiet_NaN();
  std::vector<PlanItem> items;  ///< one or more
  std::vector<Warning> notes;   ///< what was left out, joined or taken for granted
  /// What moves the vehicle, or may, and is not in `items`: a sentence each, with its place in the file.
  std::vector<std::string> not_judged;
};

/// No larger file is read, and no more is unpacked of one.
inline constexpr std::uintmax_t kMostPlanBytes = 64'000'000;
/// So many items may a plan have, jumps followed.
inline constexpr std::size_t kMostPlanItems = 200'000;

struct ReadPlanOptions {
  /// Of several tracks, lines or routes the one of this name; or its number, from 1, where none has the name. Empty:
  /// all of them are flown one after the other, and a note says so.
  std::string track;
  Progress progress;
};

/// Reads a plan of one of the formats above. The format is told by the content alone, whatever
/// the name of the file.
///
/// QGroundControl and waypoints: the commands of MAVLink NAV_WAYPOINT, SPLINE, ARC, LOITER_UNLIM, LOITER_TURNS,
/// LOITER_TIME, LOITER_TO_ALT, RETURN_TO_LAUNCH, LAND, TAKEOFF, VTOL_TAKEOFF, VTOL_LAND, DELAY, DO_ORBIT, DO_JUMP
/// (followed), DO_CHANGE_SPEED, DO_SET_ROI and its kin, DO_MOUNT_CONTROL, DO_GIMBAL_MANAGER_PITCHYAW,
/// CONDITION_YAW. Commands that move nothing are passed over. Others that move the vehicle, and unknown ones with a
/// position, are in FlightPlan::not_judged; unknown ones without a position are counted in a note. Surveys and corridor
/// scans are read as the items or the transect points that they store; a structure scan, which stores none, is refused.
///
/// Heights: QGroundControl and waypoints as the frame of each item says; KML as altitudeMode says, and unknown where it
/// says that they do not count; WPML as executeHeightMode or heightMode says; GPX above mean sea level, GeoJSON above
/// the ellipsoid (RFC 7946); tables as the names of columns say (docs/flight-plans.md), else unknown.
///
/// KML, GPX and GeoJSON: "hold_s", "speed_m_s", "yaw_deg" and "gimbal_pitch_deg" of points count, in KML and GeoJSON
/// where a point says with "point" at which position of the one line it lies.
///
/// Throws Error(input) with the line, the item or the place in the file: plan_syntax for what is none of the formats or
/// breaks its rules, plan_empty for a plan without positions, value_unsupported for what cannot be followed,
/// not_on_earth, value_out_of_range, unknown_choice for a track that is not there, file_too_large. Error(cancelled).
/// Memory: at most some 40 times the file's size.
VANTAGE_API FlightPlan read_flight_plan(const std::filesystem::path& file, const ReadPlanOptions& options = {});

/// The same of the bytes of a file. `name`: its name, for messages.
VANTAGE_API FlightPlan parse_flight_plan(std::string_view bytes, const std::string& name,
                                         const ReadPlanOptions& options = {});

// ---- locating ----

/// Where the levels lie that heights are measured from. They are never guessed.
struct HeightLevels {
  /// z of the mean sea level in the scene. Without it: 0 where Georeference::vertical names a level other than the
  /// ground, the ellipsoid or a file's own.
  std::optional<double> sea_level_z_m;
  /// How high the mean sea level lies above the ellipsoid there (the undulation of the geoid). One number for the whole
  /// scene: it changes by up to some centimetres per kilometre, in mountains by decimetres.
  std::optional<double> undulation_m;
};

struct LocateOptions {
  std::optional<Georeference> georeference;  ///< of the scene; a plan in longitudes and latitudes needs it
  HeightLevels levels;
  /// Of the scene: for heights above ground, and for the height of the home. Must outlive the call.
  const Ground* ground = nullptr;
  /// Where the vehicle takes off: longitude and latitude, or x and y for a plan in the scene frame. Without it the
  /// plan's.
  std::optional<Eigen::Vector2d> home;
  /// z of the home in the scene. Without it that of `ground` at the home, or else what the plan says.
  std::optional<double> home_z_m;
  /// What heights of an unknown datum are measured from.
  std::optional<HeightDatum> unknown_heights;
  /// The same height for all items that have none, above `unknown_heights`.
  std::optional<double> missing_height_m;
  /// Above the home, of the way back to it: the vehicle climbs to it first, if it is lower. Without it the way back is
  /// flown at the height of the last item, and a note says so.
  std::optional<double> return_height_m;
  /// Of a loiter whose plan leaves its radius to a fixed-wing vehicle.
  std::optional<double> loiter_radius_m;
  /// With the climb from the home's ground and the descent to it: these touch the ground. Those at other places always
  /// are in the flight.
  bool with_ground_legs = false;
  double chord_error_m = 0.05;   ///< so far may legs lie from the curves that they stand for; > 0
  double ground_error_m = 0.25;  ///< so much may a leg that follows the ground be too high or too low; > 0
  double farthest_m = 50e3;      ///< from the origin of the scene; a plan that goes farther is one of another place
  Progress progress;             ///< asked whether to go on
};

/// No more points are made of a plan.
inline constexpr std::size_t kMostFlightPoints = 1'000'000;

struct LocatedPlan {
  Flight flight;
  std::vector<std::size_t> items;  ///< for each point of the flight, the item that it is of, or on the way to
  std::optional<Vec3> home;        ///< scene frame; z is that of the ground there
  std::vector<Warning> notes;      ///< of locating alone
};

/// A plan in the frame of a scene.
///
/// Between geographic positions a leg is the geodesic, as in the local frames of autopilots (a rhumb line, which a map
/// in Mercator's projection shows straight, is off by length^2 tan(latitude) / (8 R): 2 cm at 1 km and 50 degrees). It
/// is cut until its parts lie within `chord_error_m` of it. Circles and cut corners are chords within that error. Legs
/// that follow the ground are cut where the ground bends, so that their height is within `ground_error_m` of what is
/// asked everywhere, with `ground` taken as exact and its highest piece where several lie over each other.
/// Flight::chord_error_m is a bound of what the legs miss: of circles and cut corners, and of legs that follow the
/// ground, what was allowed. Positions are exact to 15 nm (scene_position).
///
/// A loiter is entered at the point of the circle that is nearest, and left where its turns end. What may be no
/// multirotor flies all of the circle, and may leave it elsewhere: straight away from its centre, along a tangent, or
/// where it came. Where there are several ways all of them are in the flight, there and back
/// (FlightPoint::is_other_way).
///
/// Throws Error(input) with the item's place: not_georeferenced, too_far_away, height_unknown (with what to give),
/// ground_missing, missing_key where a home or a radius is needed, work_too_large beyond kMostFlightPoints.
/// Error(cancelled). Cost: linear in the points; for legs that follow the ground also in its triangles.
VANTAGE_API LocatedPlan locate_flight(const FlightPlan& plan, const LocateOptions& options);

// ---- writing ----

/// What is done at a point of a flight.
struct FlightAction {
  std::optional<double> yaw_deg;           ///< of the vehicle, clockwise from north
  std::optional<double> gimbal_pitch_deg;  ///< 0 level, -90 straight down
  std::optional<Vec3> look_at;             ///< scene frame: the camera is turned there; instead of yaw and pitch
  bool photo = false;                      ///< takes one, after FlightPoint::hold_s
  bool video = false;                      ///< records while it stays
  double loiter_radius_m = 0;              ///< not 0: circles about the point; > 0: clockwise seen from above
  double turns = 1;                        ///< of the circle; > 0
  std::string sees;                        ///< the name of what is seen from there; may be empty
};

/// The type of an aircraft of DJI, as its own documents number it ("Product Support" of the Cloud API): 77 and 0 for
/// the Mavic 3E, 67 and 1 for the M30T.
struct DjiAircraft {
  int drone = 0, drone_sub_type = 0;
  std::optional<int> payload;    ///< its camera; photos and videos need it
  double takeoff_height_m = 20;  ///< to which it climbs first, above the home: 1.2 to 1500; FlightOut may lower it
};

/// A closed mesh and its name, to be drawn beside the flight.
struct NamedVolume {
  std::string name;
  Mesh mesh;  ///< scene frame, metres
};

/// What a flight is to see, and when it sees it.
struct SeenTarget {
  std::string name;
  /// Of its convex polygons the corners, or a point; scene frame. None of a volume to fly through.
  std::vector<std::vector<Vec3>> parts;
  std::vector<std::array<double, 2>> seen_s;  ///< from when to when, seconds since the flight began; sorted, apart
};

/// When a flight begins unless something else is asked for: 2026-01-01T00:00:00Z, in seconds since 1970-01-01 UTC.
inline constexpr double kFlightStartUnixS = 1767225600;

struct FlightOut {
  Flight flight;
  std::vector<FlightAction> actions;  ///< one for each point, or none at all
  std::string name = "flight";
  std::optional<Georeference> georeference;  ///< of the scene; all but CSV with `scene_z` need it
  HeightLevels levels;
  /// How heights are stated: sea_level, ellipsoid or home; scene_z in CSV alone. Without it the one that the format
  /// knows: KML and GPX have heights above sea level, GeoJSON and CZML above the ellipsoid. The others need it: .plan
  /// and .waypoints sea_level or home, WPML any of the three (the aircraft then flies above the ellipsoid or the home).
  std::optional<HeightDatum> heights;
  /// The ground at the place of takeoff, scene frame.
  std::optional<Vec3> home;
  PlanVehicle vehicle = PlanVehicle::multirotor;
  double speed_m_s = std::numeric_limits<double>::quiet_NaN();  ///< where points state none; NaN: not stated
  bool takes_off = true, returns_home = true;  ///< with the items for it; GPX, CSV and GeoJSON have none
  std::optional<DjiAircraft> aircraft;         ///< WPML needs it
  /// No higher above the home may the vehicle climb at takeoff; nothing: any height. WPML, which climbs at first, keeps
  /// to it.
  std::optional<double> highest_takeoff_m;
  std::vector<NamedVolume> volumes;  ///< KML draws them
  /// To stay in and out of; of QGroundControl, whose geofence has no heights. One to stay out of is left out where the
  /// flight or its home lies in it, seen from above.
  std::vector<Zone> keep_in = {}, keep_out = {};
  double chord_error_m = 0.05;              ///< of circles
  std::vector<SeenTarget> targets = {};     ///< CZML draws them
  double start_unix_s = kFlightStartUnixS;  ///< of CZML: seconds since 1970-01-01 UTC; of the years 1 to 9999
};

/// The format that a name stands for: .plan, .waypoints, .kml, .kmz (wpml), .gpx, .geojson, .csv, .czml. Throws
/// Error(output_format_unknown).
VANTAGE_API PlanFormat plan_format_of(const std::filesystem::path& file);

/// The bytes of a plan. Longitudes and latitudes are rounded to 1e-11 degrees, heights to a micrometre: a position
/// moves by at most 1 micrometre. Autopilots round again when a plan is uploaded: MAVLink has 1e-7 degrees (6 mm) and
/// single precision for heights (0.03 mm below 1 km).
///
/// Circles are chords within `chord_error_m`. Where the camera is turned to something, .plan and .waypoints hold a
/// region of interest, and the other formats the angles. Stays are rounded up to a thousandth of a second, in .plan and
/// .waypoints to a second. KML, GPX and GeoJSON hold what is done at a point by name
/// (docs/flight-plans.md), and are read back with it.
///
/// CZML has the position at every moment: each leg at its speed, without speeding up and braking, as check_flight has
/// it; and the targets, in another colour while they are seen. Legs of more than 200 m have positions between their
/// ends, so that the vehicle is within 1 mm of the leg where the program that shows it draws straight lines.
///
/// Throws Error(input): height_unknown where a level is needed that is not known, not_georeferenced, missing_key for
/// heights, a home, a speed or an aircraft that the format needs, value_unsupported for heights that it cannot state
/// and for a highest takeoff that is too low for the format, array_sizes_differ, value_out_of_range and
/// coordinate_not_finite for actions, and what check_flight_points throws.
VANTAGE_API std::string flight_plan_bytes(const FlightOut& flight, PlanFormat format);

/// What to know before relying on a plan: what it does not hold of the flight, and where the vehicle flies ways that
/// are not of the flight. A sentence each, without a full stop. Throws nothing.
VANTAGE_API std::vector<std::string> plan_notes(const FlightOut& flight, PlanFormat format);

/// Writes it as AtomicFile does; the format is that of the name.
VANTAGE_API void write_flight_plan(const FlightOut& flight, const std::filesystem::path& file);

}  // namespace vantage
