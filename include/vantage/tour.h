// Tours: one flight that sees every target.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/flight.h"
#include "vantage/geometry.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage {

// ---- What a tour is asked for: the vehicle, where it starts, how it looks

/// How a vehicle moves.
struct TourVehicle {
  enum class Kind {
    multirotor,  ///< flies straight legs, stops and hovers
    fixed_wing,  ///< neither stops nor turns on the spot
  };
  Kind kind = Kind::multirotor;
  double speed_m_s = 8;          ///< along the path; 0.01 to 1000
  double acceleration_m_s2 = 2;  ///< of a multirotor, along the path; 0.001 to 1000
  double turn_radius_m = 40;     ///< of a fixed wing: the smallest radius, in plan; 0.01 to 1e5
  double min_climb_deg = -15;    ///< of a fixed wing: the path's angle to the horizon; > -90, <= -0.1
  double max_climb_deg = 20;     ///< likewise; >= 0.1, < 90
};

/// "multirotor", "fixed_wing".
VANTAGE_API const char* name_of(TourVehicle::Kind kind);

/// Where a tour begins: one of the two.
struct TourHome {
  std::optional<std::array<double, 2>> at_deg = std::nullopt;  ///< latitude and longitude (WGS 84), on the ground
  std::optional<Vec3> position = std::nullopt;                 ///< metres, scene frame, or as MissionFile::crs says
};

inline constexpr double kTourGap = 0.01;  ///< of TourSettings without one

struct TourSettings {
  TourVehicle vehicle;
  std::optional<TourHome> home = std::nullopt;  ///< nothing: the tour begins anywhere
  bool closed = true;  ///< it returns to where it began; without a home in the same direction, too

  /// For so long each target is in view without a break: 0 to 86,400. A shortest tour would only touch the volumes, so
  /// it is not 0 by default. A multirotor hovers where it does not fly through the volume for that long.
  double dwell_s = 2;
  double margin_m = 1;        ///< meanwhile it is at least so deep inside the volume; 0 to 1e4
  bool simultaneous = false;  ///< several targets may be viewed at once; false: one after the other

  double gimbal_rate_deg_s = 30;  ///< at most so fast the camera turns; 0.001 to 36,000
  double clearance_m = 5;         ///< of the whole flight from the whole scene, but for its ground; 0 to 1e4
  double tube_m =
      1;  ///< all of this holds for every position so near to the flight: wind, errors of position; 0 to 100
  /// The search ends where (length - bound) / length is no larger; >= 0, < 1. Nothing: at kTourGap, and nobody minds a
  /// larger one.
  std::optional<double> gap = std::nullopt;
  double time_limit_s = 60;  ///< or after so long; > 0, at most a week
};

/// Throws Error(input) for settings that are out of their range, with the key of a mission file as the place
/// ("tour.vehicle.speed").
VANTAGE_API void check_tour_settings(const TourSettings& settings);

/// Where a vehicle may fly: zones, heights, the distance from obstacles.
class VANTAGE_API Airspace {
 public:
  virtual ~Airspace();

  /// Whether all positions within `deviation_m` of the leg are allowed. "Yes" must be certain. Called often.
  virtual bool allows(const Leg& leg, double deviation_m) const = 0;
  /// What is in the way of a leg that is not allowed, in a few words: "tower east".
  virtual std::string obstacle(const Leg& leg, double deviation_m) const = 0;
  /// No position outside is allowed; may be infinite. Ways round obstacles are sought inside.
  virtual Box bounds() const = 0;
};

/// At least `clearance_m` from all surfaces of a scene but its ground (ObjectKind::ground), which no leg may meet;
/// within all limits of navigation: exactly, as LegDistances and LegLimits tell it (vantage/query.h). A leg with a
/// deviation of more than 2 m is not allowed. The inside of a solid that is wider than the clearance is not told from
/// the outside: no leg leads into it. All this holds for every position within `tube_m` of the leg. Holds on to the
/// scene. Throws Error(input) as check_navigation, and for a clearance or a tube that is negative or not finite.
VANTAGE_API std::shared_ptr<const Airspace> make_airspace(const PreparedScene& scene, double clearance_m,
                                                          const Navigation& navigation = {}, double tube_m = 0);

/// What is to be seen.
struct TourTarget {
  std::string name;
  Mesh volume;  ///< from its inside the target is seen: closed, outward oriented, of any number of pieces; scene frame
  std::optional<Vec3> look_at = std::nullopt;  ///< where the camera points meanwhile; nothing: turning takes no time
};

struct TourRequest {
  TourSettings settings;                    ///< its home, clearance and tube are not looked at: see below
  std::optional<Vec3> home = std::nullopt;  ///< in the air, where the tour begins; scene frame
  std::vector<TourTarget> targets;
  std::shared_ptr<const Airspace> airspace = {};  ///< nothing: everywhere

  double tube_m = 0;           ///< the camera follows its target from every position so near to the flight; >= 0
  double chord_error_m = 0.1;  ///< of the legs that stand for the curves of a fixed wing
  std::uint64_t seed = 1;
  int rounds = 0;  ///< of the search for the order, for a quick tour; 0: as many as the number of targets asks for
};

/// When a target is in view: in its volume, by the margin at least.
struct TourVisit {
  std::size_t target = 0;                       ///< of the request
  std::size_t first_point = 0, last_point = 0;  ///< of the flight, from one to the other; the same one: hovering there
  double begin_m = 0, end_m = 0;                ///< along the flight
  double dwell_s = 0;                           ///< so long at least
};

/// Why a target is left out.
struct TourProblem {
  enum class Kind {
    no_place,  ///< no position of its volume is allowed, or none was found
    no_way,    ///< no way to it was found
  };
  Kind kind = Kind::no_place;
  std::size_t target = 0;                               ///< that is left out
  std::optional<std::size_t> neighbour = std::nullopt;  ///< the way from or to this target; nothing: home
  std::string obstacle;                                 ///< what stands there
};

struct Tour {
  enum class End {
    done,        ///< the search came to its end
    time_limit,  ///< the best that was found until then
    cancelled,   ///< likewise
  };

  Flight flight;  ///< the last point of a closed one is the first one; empty where no target can be visited
  std::vector<std::size_t> order;  ///< targets, as they are visited; without those of `problems`
  std::vector<TourVisit> visits;   ///< in the order of their beginning
  double length_m = 0;             ///< of the curve itself
  double time_s = 0;  ///< a multirotor rests at each point where it turns or hovers, and speeds up and slows down
                      ///< between at its acceleration; a fixed wing keeps its speed
  std::vector<TourProblem> problems;
  End end = End::done;
};

/// The shortest tour that the search finds; every leg of it is allowed by the airspace, every visit is checked against
/// the volume itself. No bound: how much shorter one could be is another question.
///
/// Multirotor: straight legs. A target is viewed in passing where the leg in its volume takes long enough at full
/// speed, else from a point where the vehicle hovers. Targets are viewed one after the other, unless `simultaneous`.
/// The same point may serve several.
///
/// Fixed wing: legs that stand for Dubins paths in space (vantage/dubins.h); a target is viewed along a straight level
/// stretch, or on full circles where none is long enough.
///
/// Targets that cannot be visited are left out, each with its TourProblem. Deterministic, unless it ends by time or by
/// the caller. Where the callback asks to stop, the best tour so far is returned; Error(cancelled) only before there is
/// one. Throws Error(input), with the name of the target or the setting as the place: for no targets, settings out of
/// range, a volume that is no closed mesh, that has no point as deep as the margin, or, for a fixed wing, no room for
/// the dwell; for a home that is not allowed.
VANTAGE_API Tour plan_tour(const TourRequest& request, const Progress& progress = {});

// ---- The fewest positions to hover at

struct FewestTarget {
  std::string name;
  Mesh volume;  ///< from its inside the target is seen: closed, outward oriented, of any number of pieces; scene frame
  /// Whether a position sees the target, by an exact answer; asked of each position that lies in the volume, before it
  /// counts, by one thread at a time. Empty: the volume is believed.
  std::function<bool(const Vec3& position)> sees = {};
  /// Makes a closed mesh that holds every position from which the target is seen (outer_volume, vantage/result.h). It
  /// is called once, where more than one position is needed. Empty: no such mesh is known, and any position may see it.
  std::function<Mesh(const Progress& progress)> outer = {};
  double outer_rounding_m = 0;  ///< positions may lie so far outside of that mesh; >= 0
};

struct FewestRequest {
  std::vector<FewestTarget> targets;
  double margin_m = 1;                            ///< so deep positions lie in the volumes of their targets; > 0
  std::shared_ptr<const Airspace> airspace = {};  ///< in which they lie; nothing: everywhere
  double deviation_m = 0;    ///< all that is so near to a position must be allowed by the airspace, too; >= 0
  double time_limit_s = 60;  ///< of the search; making outer meshes comes on top. > 0
  int threads = 0;           ///< 0: as many as the machine has. The result does not depend on it, but where time ends
};

/// Where to hover. Targets go by their index in the request.
struct HoverPosition {
  Vec3 position = Vec3::Zero();       ///< scene frame, metres
  std::vector<std::size_t> sees;      ///< all targets that are seen from it, as deep in their volumes as the margin
  std::vector<std::size_t> assigned;  ///< of these, those that are viewed from it: each target once
  double depth_m = 0;                 ///< how deep it lies in the volumes of those at least
};

struct FewestPositions {
  enum class End {
    done,        ///< the search came to its end
    time_limit,  ///< the best that was found until then
    cancelled,   ///< likewise
  };
  /// Why so many positions are necessary.
  enum class Reason {
    one,     ///< there is a target
    apart,   ///< the targets in `apart` are so many
    groups,  ///< one less would have to see targets together of which it is known that no position does
  };

  std::vector<HoverPosition> positions;  ///< in the order of their first target
  std::vector<std::size_t> unseen;       ///< targets of which no position was found that the airspace allows
  /// So many positions at least see all targets but the unseen ones, wherever they are: over outer meshes alone, of the
  /// airspace and of the margin it knows nothing. 0 where all are unseen.
  std::size_t necessary = 0;
  Reason reason = Reason::one;
  std::vector<std::size_t> apart;  ///< targets whose outer meshes do not meet: no position sees two of them
  End end = End::done;

  /// Whether it is proved that no fewer do.
  bool is_proved() const { return positions.size() == necessary; }
};

/// Positions that see all targets, as few as the search finds. Each lies as deep in the volumes of its targets as the
/// margin, by SolidIndex, is allowed by the airspace, and sees its targets by their own answer. Of such positions one
/// is taken that lies within 10 % of as deep as is found.
///
/// Candidates are random points in all volumes, and points that groups of volumes have in common, which grow from each
/// target. An exact cover chooses among them. Then the targets are divided into one group less, without any group of
/// which no common point was found, and these groups are searched for one: until there is no such division.
///
/// The lower bound is that of a largest set of targets whose outer meshes do not meet in pairs ("do not meet" is
/// certain: they are farther apart than rounding), raised where larger sets of outer meshes have no common point.
///
/// The same every time, unless it ends by time or by the caller. Where the callback asks to stop, the best so far is
/// returned; Error(cancelled) only before there is an answer. Throws Error(input), with the name of the target as the
/// place: for no targets, a volume that is no closed mesh or has no point as deep as the margin, numbers out of range;
/// and what `sees` and `outer` throw. Cost: seconds for 20 targets.
VANTAGE_API FewestPositions fewest_positions(const FewestRequest& request, const Progress& progress = {});

}  // namespace vantage
