// What a flight sees, how near to what it comes, and which limits it breaks: exactly, for any flight.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/flight.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/sensor.h"

namespace vantage {

/// A plan in the frame of the mission's scene: locate_flight with what the mission knows where `options` leave it open:
/// the place of its scene, its ground and its sea level, and the home of its tour where the plan has none. Throws as
/// locate_flight does.
VANTAGE_API LocatedPlan locate_flight(const Mission& mission, const FlightPlan& plan, LocateOptions options = {});

/// What a flight must keep besides the limits of the mission, and how it is flown.
struct FlightCheckOptions {
  /// All is said for every position within this distance of the flight: acceptance radius, wind, position error; >= 0.
  /// Flight::chord_error_m is added to it.
  double tube_radius_m = 0;
  /// Of legs whose points state none, metres per second. Without it that of the mission's tour, if it has one.
  std::optional<double> speed_m_s = std::nullopt;
  /// Each target must be seen for so long without a break. Without it the dwell of the mission's tour; 0: at all.
  std::optional<double> dwell_s = std::nullopt;
  /// The smallest distance from the scene, but for its ground. Without it that of the mission's tour; 0: none.
  std::optional<double> clearance_m = std::nullopt;
  /// So fast the camera can turn: for the dwell without a break, a target must be seen while the line of sight to its
  /// centre turns no faster. Without it that of the mission's tour; nothing: as fast as it takes.
  std::optional<double> gimbal_rate_deg_s = std::nullopt;
  /// The mission's scene, where it is prepared already. Without it that is done anew.
  std::optional<PreparedScene> prepared = {};
};

/// A stretch of a flight.
struct FlightSpan {
  double begin_m = 0, end_m = 0;  ///< along the flight, from its first point
  double begin_s = 0,
         end_s = 0;  ///< since its beginning, with what it stays at the points; NaN where a speed is missing
  Vec3 begin = Vec3::Zero(), end = Vec3::Zero();  ///< scene frame

  double length_m() const { return end_m - begin_m; }
  double duration_s() const { return end_s - begin_s; }
};

/// Why all of a target is not seen, and where.
struct NotSeen {
  enum class Kind {
    hidden,        ///< by an object of the scene, or it enters the zone of a link
    out_of_range,  ///< farther than the range
    behind,        ///< not in front of the target
    limit,         ///< a limit of the sensor
    outside,       ///< of a target that is a volume
  };
  Kind kind = Kind::hidden;
  std::string name;               ///< of the object, or of the limit as PointAnswer::outside_of has it; else empty
  std::vector<FlightSpan> spans;  ///< sorted; apart

  VANTAGE_API double length_m() const;  ///< of all spans
};

/// "hidden", "out_of_range", "behind", "limit", "outside".
VANTAGE_API const char* name_of(NotSeen::Kind kind);

/// How the camera must look to keep a target's centre, along one stretch.
struct GimbalUse {
  double min_pitch_deg = 0, max_pitch_deg = 0;  ///< 0 level, -90 straight down
  double begin_yaw_deg = 0, end_yaw_deg = 0;    ///< clockwise from north
  double rate_deg_s = 0;                        ///< the fastest turn of the line of sight; NaN where a speed is missing
};

/// One target along the flight.
struct TargetCheck {
  std::string name;
  bool is_volume = false;                ///< then `seen` is where the flight is inside it, and there is no gimbal
  Vec3 centre = Vec3::Zero();            ///< scene frame
  std::vector<std::vector<Vec3>> parts;  ///< the corners of its convex polygons, scene frame
  std::vector<FlightSpan> seen;          ///< all of it is seen, within all limits of the sensor; sorted, apart
  std::optional<std::size_t> longest;    ///< of `seen`: the longest in time, or in length where times are not known
  std::vector<NotSeen> not_seen;         ///< the longest first
  std::optional<GimbalUse> gimbal;       ///< along the longest stretch
  std::optional<FlightSpan> followed;    ///< where a rate of the gimbal is asked: the longest stretch in time on which
                                         ///< all is seen and the line of sight to the centre turns no faster
};

/// A link of the mission along the flight: the line of sight from its point to the vehicle, and the zone of a radio
/// link where the mission asks for one.
struct LinkCheck {
  std::string name;
  Vec3 point = Vec3::Zero();                         ///< where it begins; scene frame
  std::optional<double> max_range_m = std::nullopt;  ///< nothing: as far as it is free
  std::optional<RadioLink> radio = std::nullopt;     ///< nothing: the line of sight alone
  std::vector<FlightSpan> linked;                    ///< in range, and nothing is in the way; sorted, apart
  std::vector<FlightSpan> lost;                      ///< all else; sorted, apart
  std::vector<NotSeen> reasons;                      ///< why it is lost; the longest first
  double farthest_m = 0;                             ///< from the point, of any position of the tube
  double farthest_at_m = 0;                          ///< along the flight
  Vec3 farthest_at = Vec3::Zero();                   ///< of the flight, scene frame

  bool holds() const { return lost.empty(); }
};

/// A limit of navigation that the flight breaks.
struct BrokenLimit {
  std::string name;               ///< as PointAnswer::outside_of has it
  std::vector<FlightSpan> spans;  ///< sorted; apart
  double worst = 0;               ///< by how much, at worst; infinite where no number tells it
  std::string unit = "m";         ///< of `worst`: "m" or "degrees"
  double worst_at_m = 0;          ///< along the flight
  Vec3 worst_at = Vec3::Zero();   ///< scene frame
};

/// Where the flight is nearest to the scene, but for its ground.
struct NearestPass {
  double distance_m = std::numeric_limits<double>::infinity();  ///< less the tube's radius; not below 0
  double at_m = 0;                                              ///< along the flight
  Vec3 position = Vec3::Zero();                                 ///< of the flight, scene frame
  Vec3 point = Vec3::Zero();                                    ///< of the scene
  std::string object = {};                                      ///< empty: there is nothing to come near to
};

struct FlightCheck {
  double length_m = 0;
  double duration_s = 0;             ///< NaN where a speed is missing
  double tube_radius_m = 0;          ///< with the flight's chord error
  std::vector<double> point_at_m;    ///< of each point of the flight: how far along it
  std::vector<double> arrival_s;     ///< likewise; NaN where a speed is missing
  std::vector<double> departure_s;   ///< likewise, after what it stays there
  std::vector<Vec3> positions;       ///< of the points of the flight, scene frame
  std::vector<TargetCheck> targets;  ///< of the mission, in its order
  std::vector<LinkCheck> links;      ///< likewise
  std::vector<BrokenLimit> broken;   ///< of navigation
  NearestPass nearest;
  std::vector<std::string> failures;  ///< what is required and does not hold, a sentence each
  /// Flight::not_judged: what is flown besides. Then failures may be of legs that are not flown so.
  std::vector<std::string> not_judged;
  std::vector<std::string> notes;  ///< what to know before relying on it, a sentence each; with Mission::notes

  bool passes() const { return failures.empty() && not_judged.empty(); }
};

/// Judges a flight by what a mission asks: each of its targets (one for each volume, volume_count) must be seen whole
/// within the limits of the sensor, for the dwell without a break; and the flight must keep navigation's limits, the
/// clearance and Mission::links everywhere. A target that is a volume (Target::volume) is seen where the flight, with
/// all of the tube, is inside it: exactly, and shorter by what rounding may do, never longer. It needs a volume of its
/// own, as with Combine::each.
///
/// Whatever is asked, it may not meet an object of the scene that is not ground, or lie inside of a solid (a winding
/// number above 1/2 of an object or a connected piece, or -1, and something above it; `nearest` is then 0), nor may its
/// middle be below the ground (a BrokenLimit "ground"): by more than 1 m within 20 m of its ends and on upright legs,
/// by more than 1 mm elsewhere. Ground is what ground_of(Mission) and ground_of(Scene) have.
///
/// Exact along straight legs: LegViews, LegLimits and LegDistances (vantage/query.h), which err on the safe side.
/// With a tube of radius R, what is said holds for every position within R of the flight, but for the yaw of the
/// camera.
///
/// Threads: those of the caller's arena. Throws Error(input) as check_flight_points, prepare_views and LegViews do, for
/// an option that is negative or not finite, and where a dwell or a rate is asked of a flight without speeds;
/// Error(cancelled). Cost: for each leg and target what of the scene lies between them.
VANTAGE_API FlightCheck check_flight(const Mission& mission, const Flight& flight,
                                     const FlightCheckOptions& options = {}, const Progress& progress = {});

/// The targets, and when they are seen; FlightOut::targets. Nothing of when where a speed is missing.
VANTAGE_API std::vector<SeenTarget> seen_targets(const FlightCheck& check);

/// JSON (UTF-8, indented, a newline at the end) of all of it; lengths in metres, what is not known or infinite is null.
/// With longitudes and latitudes where `georeference` is given.
VANTAGE_API std::string json_text(const FlightCheck& check, const Georeference* georeference = nullptr);

/// A table, a row for each stretch: target, state ("seen", "hidden", "out_of_range", "behind", "limit", "outside"; of a
/// link, whose name stands for the target, "linked", "link_hidden", "link_out_of_range"; "broken"), what (object or
/// limit), begin_m, end_m, begin_s, end_s, and the coordinates of both ends. Of the state "not_judged", what is the
/// sentence, and the fields after it are empty.
VANTAGE_API std::string csv_text(const FlightCheck& check);

}  // namespace vantage
