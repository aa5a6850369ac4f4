// The shortest polyline that meets convex hulls in a given order, and a bound of its length that needs no trust in how
// it was found (docs/theory.md, "Tours").
//
// For any vectors |u_k| <= 1 on the legs, sum |x_(k+1) - x_k| >= sum u_k . (x_(k+1) - x_k)
// = sum (u_(k-1) - u_k) . x_k >= sum min over the points v of hull k of (u_(k-1) - u_k) . v. A leg that counts as
// at_least_m, even where it is shorter, adds at_least_m (1 - |u_k|).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "flight/tour/hull.h"
#include "vantage/geometry.h"

namespace vantage::internal::flight::tour {

/// A vector of length 1 at most, exactly: three whole numbers times 2^-30, so that files hold it exactly and
/// differences of two are exact as doubles. Rounding to it costs a bound some 4e-9 of the legs' lengths and of the
/// hulls' sizes.
using Direction = std::array<std::int32_t, 3>;
constexpr int kDirectionBits = 30;

/// Rounded towards zero; longer vectors are shortened first.
Direction direction_of(const Vec3& vector);
Vec3 vector_of(const Direction& direction);

/// The points in order. Closed: the last leg leads back to the first one.
struct TouringProgram {
  std::vector<const Hull*> hulls;
  std::vector<double> at_least_m;  ///< of each leg; empty: 0
  bool closed = true;

  std::size_t leg_count() const { return closed ? (hulls.size() > 1 ? hulls.size() : 0) : hulls.size() - 1; }
  double at_least(std::size_t leg) const { return at_least_m.empty() ? 0 : at_least_m[leg]; }
};

struct TouringSolution {
  std::vector<Vec3> points;           ///< nearly in the hulls
  std::vector<Direction> directions;  ///< of the legs
  double bound_m = 0;                 ///< touring_bound of these
  /// That were needed beside those of the hulls, and of which hull of the program: for Hull::add.
  std::vector<std::pair<std::size_t, HalfSpace>> half_spaces;
};

/// A part of the size of all hulls together (the diagonal of their box): however small TouringOptions::in_hull is,
/// points may lie so far outside of the hulls. Barriers need an inside, so that flat hulls are made half as thick: a
/// point of one may lie a quarter of this off it.
constexpr double kOutsideOfSize = 2e-6;

struct TouringOptions {
  double gap = 1e-6;      ///< of the length; where the search for points stops
  double in_hull = 1e-4;  ///< points may lie so far outside of the hulls, of the length, or kOutsideOfSize
  int most_rounds = 8;    ///< of adding half-spaces
  double enough_m = std::numeric_limits<double>::infinity();  ///< stops as soon as the bound is so large
};

/// By Newton's method with logarithmic barriers (Boyd and Vandenberghe, "Convex Optimization", 2004, chapter 11), over
/// half-spaces round the hulls, to which more are added where a point lies outside. Whatever it returns, bound_m holds.
/// The points should lie about the origin.
TouringSolution solve_touring(const TouringProgram& program, const TouringOptions& options = {});

/// No polyline that meets the hulls in this order is shorter. What rounding may add is subtracted: for coordinates of
/// size R and m points less than (4 m + 40) 2^-53 times the sum of R over the points; and 2 Hull::moved_m() of each.
double touring_bound(const TouringProgram& program, std::span<const Direction> directions);

/// The same of a program whose legs count as they are, put together of what each point gives to it: where a stop is
/// inserted, that changes at three points alone. `before`, `behind`: of the legs at the point; null: none.
double touring_part(const Hull& hull, const Direction* before, const Direction* behind);
/// `reach_m`, `moved_m`: sums of those of the hulls.
double touring_bound_of(std::span<const double> parts, double reach_m, double moved_m);

/// The length of a polyline through these points.
double touring_length(const TouringProgram& program, std::span<const Vec3> points);

}  // namespace vantage::internal::flight::tour
