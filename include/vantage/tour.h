// Tours: one flight that sees every target.
#pragma once

#include <cstddef>
#include <cstdint>
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
#include "vantage/tour_settings.h"

namespace vantage {

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
/// the outside: no leg leads into it. Holds on to the scene. Throws Error(input) as check_navigation, and for a
/// clearance that is negative or not finite.
VANTAGE_API std::shared_ptr<const Airspace> make_airspace(const PreparedScene& scene, double clearance_m,
                                                          const Navigation& navigation = {});

/// What is to be seen.
struct TourTarget {
  std::string name;
  Mesh volume;  ///< from its inside the target is seen: closed, outward oriented, of any number of pieces; scene frame
  std::optional<Vec3> look_at = std::nullopt;  ///< where the camera points meanwhile; nothing: turning takes no time
};

struct TourRequest {
  TourSettings settings;                    ///< its home and clearance are not looked at: see below
  std::optional<Vec3> home = std::nullopt;  ///< in the air, where the tour begins; scene frame
  std::vector<TourTarget> targets;
  std::shared_ptr<const Airspace> airspace = {};  ///< nothing: everywhere

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

}  // namespace vantage
