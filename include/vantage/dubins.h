// Dubins paths: the shortest curves of a vehicle that cannot turn tighter than a radius, in the plane and in space.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage {

/// A place in the plane and the direction of motion there.
struct PlanePose {
  double x_m = 0, y_m = 0;
  double heading_rad = 0;  ///< from the x axis, counter-clockwise; any turn of it
};

/// The three pieces of a path: L turns left, R right, S goes straight.
enum class DubinsWord : std::uint8_t { lsl, rsr, lsr, rsl, rlr, lrl };

/// "LSL", ...
VANTAGE_API const char* name_of(DubinsWord word);

/// A path of two arcs and a line, or of three arcs.
struct VANTAGE_API DubinsPath {
  PlanePose from;
  double radius_m = 1;
  DubinsWord word = DubinsWord::lsl;
  std::array<double, 3> pieces_m = {0, 0, 0};  ///< lengths of the pieces; >= 0

  double length_m() const { return pieces_m[0] + pieces_m[1] + pieces_m[2]; }
  /// Where it is after `distance_m`, clamped to the path.
  PlanePose at(double distance_m) const;
  /// Left 1, right -1, straight 0.
  int turn_of(std::size_t piece) const;
};

/// The shortest path between two poses (L. E. Dubins, "On curves of minimal length with a constraint on average
/// curvature", 1957; words as in A. M. Shkel and V. Lumelsky, "Classification of the Dubins set", 2001). All six words
/// are tried; of equal ones the first counts. There is always one.
///
/// Rounding: the path ends within 1e-9 of (radius + distance) from the pose that is asked for, plus four roundings of
/// the largest coordinate. An arc that is shorter than a full turn by 1e-10 rad or less is taken for none: such a loop
/// comes from rounding alone. Throws Error(input) for a pose that is not finite and a radius that is not positive.
VANTAGE_API DubinsPath shortest_dubins(const PlanePose& from, const PlanePose& to, double radius_m);

/// The shortest path of one word, where it has one.
VANTAGE_API std::optional<DubinsPath> dubins_of_word(DubinsWord word, const PlanePose& from, const PlanePose& to,
                                                     double radius_m);

/// A place in space and the direction of motion there.
struct SpacePose {
  Vec3 position = Vec3::Zero();  ///< scene frame, metres
  double heading_rad = 0;        ///< from the x axis, counter-clockwise seen from above
  double climb_rad = 0;          ///< of the path above the horizon
};

/// What a fixed-wing vehicle can do.
struct WingLimits {
  double turn_radius_m = 40;                           ///< smallest radius of curvature, in space; > 0
  double lowest_climb_rad = 0, highest_climb_rad = 0;  ///< of the path, -pi/2 < lowest <= 0 <= highest < pi/2
};

/// A path in space: what it looks like from above, and its height along that.
struct VANTAGE_API DubinsAirplanePath {
  DubinsPath above;    ///< x, y
  DubinsPath profile;  ///< "x" is the distance along `above`, "y" the height z, "heading" the climb

  /// In space, metres.
  double length_m() const { return profile.length_m(); }
  SpacePose at(double distance_m) const;
  /// At most so far apart along the path that the chords between them keep within `chord_error_m` of it; both ends are
  /// among them. A path of curvature at most k lies within k s^2 / 8 of the chord of a piece of length s.
  std::vector<double> stations(double chord_error_m) const;
};

/// A short path whose curvature in space is at most 1 / turn_radius_m and whose climb stays within the limits: the
/// decoupled construction of P. Vana, A. Alves Neto, J. Faigl and D. G. Macharet, "Minimal 3D Dubins path with bounded
/// curvature and pitch angle", ICRA 2020. A path of radius r_h seen from above and a profile of radius r_v, with
/// 1/r_h^2 + 1/r_v^2 = 1/r^2; r_h is found by a local search. Where wider arcs do not give the length that a climb
/// needs, or full turns at the start do so sooner, there are full turns: the paper has none. Not the shortest one for
/// sure. Between poses of one height and no climb it is the plane's shortest path.
///
/// Nothing where nothing fits, as for a climb at an end that is outside the limits. Throws as shortest_dubins, and
/// Error(input) for limits of the climb that are none. Deterministic. Cost: some 50 paths in the plane, or 100.
VANTAGE_API std::optional<DubinsAirplanePath> dubins_airplane(const SpacePose& from, const SpacePose& to,
                                                              const WingLimits& limits);

}  // namespace vantage
