// What a limit on turning adds to a bound: docs/theory.md, "Tours".
//
// Let the track over ground curve no tighter than a circle of radius r. A leg with a vector u, of length 1 at most, is
// no shorter than its progress along u. If the track heads at an angle t from u, each metre of it is longer than its
// progress by |u_h| (1 - cos t), where u_h is the level part of u. To turn by t takes r t metres or more, which costs
// |u_h| r (t - sin t). At the stop between two legs with vectors u and v, let t be the angle between u_h and v_h: the
// angles of the track to both are t or more together. That costs least if both are t / 2, so
// 2 r min(|u_h|, |v_h|) (t / 2 - sin(t / 2)) at least.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "flight/tour/touring_program.h"

namespace vantage::internal::flight::tour {

/// At a stop whose legs have these vectors, in metres, rounded down. `before_m`, `behind_m`: so long at least is the
/// track over ground between this stop and the ones beside it; each stop has one half of it to turn in. `radius_m`: 0
/// for a vehicle that turns on the spot.
double turning_part(const Direction& before, const Direction& behind, double before_m, double behind_m,
                    double radius_m);

/// How far `to` is at least from `from`, along what of the vector is level: rounded down, 0 or more.
double level_distance_m(const Hull& from, const Hull& to, const Direction& direction);

/// A bound for a whole sequence: it may be added to touring_bound of the same vectors, if all points are among its
/// stops. At points, where a flight begins and ends, it may head in another direction.
double turning_bound(const TouringProgram& program, std::span<const Direction> directions, double radius_m);

/// Vectors for which both together are larger, if such are found: where a tour hardly turns at a stop, the vectors of a
/// program without it leave more room to turn at the others. `directions` are those of the program's solution.
/// `enough_m`: ends as soon as the bound is so large; or when `is_late` says so, with what was found till then.
std::vector<Direction> straightened(const TouringProgram& program, std::vector<Direction> directions, double radius_m,
                                    const TouringOptions& options, const std::function<bool()>& is_late = {});

}  // namespace vantage::internal::flight::tour
