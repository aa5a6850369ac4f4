// The best places to hover at or to circle on, to look at a target.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/flight.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage {

// ---- What a position is worth as a place to look at a target from: where it lies, how to aim, how well it sees

/// A position and the view from it. What is not known has no value.
struct ViewDescription {
  Vec3 position = Vec3::Zero();  ///< scene frame, metres
  /// WGS 84; of a scene that says where on the earth it lies.
  std::optional<double> longitude_deg = std::nullopt, latitude_deg = std::nullopt;
  std::optional<double> above_ground_m = std::nullopt;  ///< over the highest ground straight above or below
  std::optional<double> above_sea_m = std::nullopt;     ///< over mean sea level, where sea_level_m() knows it

  double yaw_deg = 0;    ///< of the camera: clockwise from +y of the scene (north), in [0, 360)
  double pitch_deg = 0;  ///< 0 is level, -90 straight down
  /// Whether they are those to the target's centre. Else the mount does not allow these, or they leave a part of the
  /// target out of the picture: the given ones have all of it in, with the most room at its edges, where any do.
  bool is_centred = true;

  double distance_m = 0;                               ///< to the target's centre
  std::optional<double> pixel_m = std::nullopt;        ///< on the target, the largest: see ViewDescriber
  std::optional<double> incidence_deg = std::nullopt;  ///< between a normal and the line to the position, the largest
  std::optional<double> obstacle_distance_m = std::nullopt;  ///< to the nearest obstacle of the scene
  std::string obstacle = {};                                 ///< its display_name; may be empty
};

/// Describes positions for the target of a mission. Cheap to copy (a shared handle); any number of threads may use one.
///
/// The target's centre is that of its smallest enclosing circle; of a target in parts, and of several targets, the
/// middle of the box of all corners. The size of a pixel and the incidence are the worst over all points of the target;
/// where one of several targets is enough (Mission::views), of the one that has the best. The size of a pixel is that
/// of the mission's PixelLimit::Kind, or else PixelLimit::Kind::worst, and needs a camera whose pixels are known.
/// Targets count as given: the lift, 2 mm at most, is left out.
///
/// Obstacles are all objects but the ground, as with Clearance; where a scene has nothing else, all of it.
class VANTAGE_API ViewDescriber {
 public:
  /// Cost: O(n log n) in the scene's triangles. Throws Error(input) for a mission of several volumes (see one_volume).
  explicit ViewDescriber(const Mission& mission);
  /// The same for a mission in the same scene, with the same ground: what was made of these is shared. Cost: small.
  ViewDescriber(const Mission& mission, const ViewDescriber& other);

  /// Distances are right to some 1e-15 of the scene's size. Throws Error(input) for a point that is not finite. Cost:
  /// some microseconds.
  ViewDescription describe(const Vec3& position) const;

  struct Data;
  const Data& data() const { return *data_; }  ///< for searches

 private:
  std::shared_ptr<const Data> data_;
};

// ---- Standpoints: the best places of a volume to hover at and look at its target

/// What a standpoint is the best at.
enum class StandpointKind {
  deepest,         ///< farthest from the volume's boundary: `value` is that distance, metres
  nearest,         ///< nearest to the target's centre: that distance, metres
  finest_pixel,    ///< the largest pixel on the target is the smallest: its size, metres
  best_incidence,  ///< most face-on: the largest angle between a normal and the line of sight is the smallest: degrees
  farthest,        ///< farthest from obstacles: that distance, metres
};

/// "deepest", "nearest", "finest_pixel", "best_incidence", "farthest".
VANTAGE_API const char* name_of(StandpointKind kind);

struct Standpoint {
  StandpointKind kind = StandpointKind::deepest;
  ViewDescription view;
  double margin_m = 0;  ///< how far it is from the volume's boundary: at least this, less by rounding alone
  double value = 0;     ///< of what it is the best at: see StandpointKind
  /// No position of the volume that keeps the margin, and StandpointOptions::tolerance_m more, has a better value.
  double bound = 0;
};

struct StandpointOptions {
  /// How deep inside the volume they are at least; >= 0. NaN: 1 m, but in a volume that is nowhere 4 m deep a quarter
  /// of its greatest depth.
  double margin_m = std::numeric_limits<double>::quiet_NaN();
  /// How far values may be from the best, and how far positions from where the margin ends; > 0. NaN: 0.1 m, but no
  /// more than a thousandth of the volume's extent and half of the margin. Pixels are right to 0.5 %, angles to
  /// 0.1 degrees.
  double tolerance_m = std::numeric_limits<double>::quiet_NaN();
  std::size_t most_boxes = 200000;  ///< of a search; one that comes to it ends with a looser `bound`
  int threads = 0;                  ///< 0: as many as the machine has. The result does not depend on it
};

struct Standpoints {
  std::vector<Standpoint> found;   ///< at most one of each kind, in their order
  double margin_m = 0;             ///< that they keep
  std::string reason;              ///< why there are none; else empty
  std::vector<std::string> notes;  ///< of kinds without an answer, searches that were cut short, the gimbal's reach
};

/// The standpoints in the volume of a mission, which has one volume (see one_volume). `volume`: what run_mission makes
/// of it. Every standpoint is inside the volume's mesh, as deep as it says, and inside by the exact ViewsQuery too.
///
/// Each is the best of all positions, to the stated tolerance, by branch and bound over boxes: the depth and the
/// distances are 1-Lipschitz functions, so a box around a position holds nothing better than its value and half of the
/// box's diagonal. Volumes in several pieces are one. Where several positions are equally good, the same one is found
/// every time.
///
/// Without a camera of known pixels there is no finest pixel, in an empty scene no farthest one, and without a front
/// no incidence: `notes` say so.
///
/// Throws Error(input) for options out of range, a mission of several volumes, and a mesh that is not closed;
/// Error(cancelled). Cost: 0.1 to 2 s, more where many positions are nearly as good, as in long prisms.
VANTAGE_API Standpoints find_standpoints(const Mission& mission, const Volume& volume, const PreparedScene& scene,
                                         const ViewDescriber& describer, const StandpointOptions& options = {},
                                         const Progress& progress = {});

/// Standpoints of one target for json_text.
struct NamedStandpoints {
  std::string target;
  Standpoints standpoints;
};

/// {"targets": [{"target", "margin_m", "reason", "notes", "standpoints": [...]}]}. What is not known is null.
VANTAGE_API std::string json_text(const std::vector<NamedStandpoints>& targets);

// ---- Orbits: level closed curves to circle on while a target stays in view

/// What an orbit is the best at.
enum class OrbitKind {
  widest,        ///< the largest radius of the turns: `value` is it, metres
  deepest,       ///< farthest from the volume's boundary everywhere: that distance, metres
  finest_pixel,  ///< the largest pixel on the target, all the way round, is the smallest: its size, metres
};

/// "widest", "deepest", "finest_pixel".
VANTAGE_API const char* name_of(OrbitKind kind);

/// Where the centre may be, in plan.
enum class OrbitCentre {
  around_target,  ///< anywhere, if the target's centre lies within the orbit or on it
  over_target,    ///< over or under the target's centre
  anywhere,       ///< beside the target too, as before a wall
};

/// "around_target", "over_target", "anywhere".
VANTAGE_API const char* name_of(OrbitCentre centre);

/// A circle, or a racetrack: two half circles and two straights. Level.
struct Orbit {
  OrbitKind kind = OrbitKind::deepest;
  Vec3 centre = Vec3::Zero();  ///< scene frame, metres; z is the height of the orbit
  double radius_m = 0;         ///< of the turns
  double straight_m = 0;       ///< length of each straight; 0 for a circle
  double heading_deg = 0;      ///< of the straights, clockwise from +y (north), in [0, 180); 0 for a circle
  bool clockwise = true;       ///< seen from above

  double margin_m = 0;  ///< every point of it is at least so deep inside the volume
  double value = 0;     ///< of what it is the best at: see OrbitKind
  /// No orbit that is asked for and keeps the margin, and OrbitOptions::tolerance_m more, has a better value.
  double bound = 0;

  double length_m = 0;  ///< once round
  /// The centre as a position: its place on the earth and its heights. Its view is that from the centre.
  ViewDescription place;
  double min_pitch_deg = 0, max_pitch_deg = 0;         ///< of the camera that looks at the target's centre, all round
  double min_distance_m = 0, max_distance_m = 0;       ///< to the target's centre
  std::optional<double> pixel_m = std::nullopt;        ///< the largest all round: ViewDescription::pixel_m
  std::optional<double> incidence_deg = std::nullopt;  ///< likewise
  std::optional<double> obstacle_distance_m = std::nullopt;  ///< the smallest all round; a few centimetres less
  std::string obstacle = {};                                 ///< that one
};

struct OrbitOptions {
  double least_radius_m = 40;  ///< of the turns: the vehicle's; > 0
  double most_radius_m = std::numeric_limits<double>::infinity();
  OrbitCentre centre = OrbitCentre::around_target;
  /// How deep inside the volume all of an orbit is at least; >= 0. NaN: 1 m, but where no orbit keeps 4 m a quarter of
  /// the largest margin; none is looked for that keeps less than half of the tolerance.
  double margin_m = std::numeric_limits<double>::quiet_NaN();
  /// How far radii and margins may be from the best; > 0. NaN: 1 m, but no more than a hundredth of the volume's
  /// extent, an eighth of its height and, once the margin is known, half of that. Pixels are right to 2 %.
  double tolerance_m = std::numeric_limits<double>::quiet_NaN();
  bool racetracks = true;          ///< look for one where no circle fits
  bool clockwise = true;           ///< of what is found
  std::size_t most_boxes = 20000;  ///< of a search; one that comes to it ends with a looser `bound`
  int threads = 0;                 ///< 0: as many as the machine has. The result does not depend on it
};

struct Orbits {
  std::vector<Orbit> found;        ///< circles, at most one of each kind, in their order; or one racetrack, the deepest
  double margin_m = 0;             ///< that they keep
  std::string reason;              ///< why there is no circle; else empty
  std::vector<std::string> notes;  ///< of kinds without an answer, searches that were cut short, the gimbal's reach
};

/// Orbits in the volume of a mission, which has one volume (see one_volume). `volume`: what run_mission makes of it.
///
/// Every orbit is inside the volume's mesh: its chords, which are less than a millimetre from it, keep the margin from
/// all facets, that error and rounding added. Places all round it are asked of the exact ViewsQuery besides.
///
/// Each circle is the best of all heights, centres and radii, to the stated tolerance, by branch and bound: the margin
/// of a circle changes by no more than its centre is moved and its radius changes. For a racetrack length and heading
/// of the straights are searched too; there the bound may stay loose, and where none is found a `reason` says whether
/// that is proved.
///
/// Throws Error(input) for options out of range, a mission of several volumes, and a mesh that is not closed;
/// Error(cancelled). Cost: seconds; a racetrack takes more.
VANTAGE_API Orbits find_orbits(const Mission& mission, const Volume& volume, const PreparedScene& scene,
                               const ViewDescriber& describer, const OrbitOptions& options = {},
                               const Progress& progress = {});

/// Once round, from the northernmost point of the circle, or an end of a straight, and back to it. The corners lie on
/// the orbit, and the chords at most Flight::chord_error_m from it, inside: that is `chord_error_m` > 0, or the margin
/// where that is less and not 0. So the flight is in the volume as the orbit is. Throws Error(input) for an orbit
/// without a radius, numbers that are not finite, and an error that is not positive.
VANTAGE_API Flight flight_of(const Orbit& orbit, double chord_error_m = 0.1);

/// The orbit as a plan for ground stations: a circle is one loiter, flown once, which formats without loiters state as
/// chords; a racetrack is its legs. The camera is turned to the target's centre, where its mount allows that. Heights
/// are above the mission's home, where there is one and the format knows such heights; the ways from there to the orbit
/// and back are not planned (plan_notes); speed and vehicle are those of MissionFile::tour. Of a scene without a place
/// on the earth it is x, y and z of the scene frame, which a table (CSV) alone can state: else throws
/// Error(not_georeferenced). Throws as flight_of.
VANTAGE_API FlightOut plan_of_orbit(const Orbit& orbit, const Mission& mission, PlanFormat format);

/// Orbits of one target for json_text.
struct NamedOrbits {
  std::string target;
  Orbits orbits;
};

/// {"targets": [{"target", "margin_m", "reason", "notes", "orbits": [...]}]}. What is not known is null.
VANTAGE_API std::string json_text(const std::vector<NamedOrbits>& targets);

}  // namespace vantage
