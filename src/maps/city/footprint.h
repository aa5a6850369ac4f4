// Outlines in the plane: cleaned, so that every later step may trust them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "app/providers/maps.h"
#include "core/footprint.h"

namespace vantage::internal::city {

using Vec2 = Eigen::Vector2d;
using core::Ring;

/// A simple polygon with holes, every coordinate a multiple of kGrid (so that buildings that share a node share a
/// point). Rings do not cross themselves or each other; they may touch in single points, which `make_solid` sees to. No
/// ring has fewer than 3 points, repeated points or points in the middle of a straight side closer to it than kGrid
/// (but where sides would cross without them).
using core::Footprint;

constexpr double kGrid = 1.0 / 8192;  ///< metres: far below what OpenStreetMap stores (1e-7 degrees: 11 mm)

double area_m2(const Footprint& footprint);  ///< holes taken off
double area_m2(const std::vector<Footprint>& footprints);

/// What was done to an outline to make it simple.
struct Repairs {
  bool self_crossing = false;  ///< it crossed itself: inside is all that it is wound round
  bool nesting = false;        ///< holes that cross, touch along a side, overlap or lie outside: filled
  bool tangled = false;        ///< it crosses itself more than a thousand times: dropped
  bool enclosed = false;       ///< the smallest rectangle round it stands in: footprints_of
  bool thin = false;           ///< of one of its rings, too thin to build, the smallest rectangle stands in
  bool beyond = false;         ///< not finite, or larger than 100 km: dropped
  bool any() const { return self_crossing || nesting || tangled || enclosed || thin || beyond; }
  std::size_t slivers = 0;  ///< pieces narrower than 1 cm or smaller than 0.01 m2 that were dropped
};

/// Rounds to the grid, removes spikes and repeated points, resolves crossings. Empty when nothing with an area is left.
std::vector<Footprint> clean(const std::vector<Footprint>& rough, Repairs& repairs);

/// Set operations on the footprints of an object; those of others that lie elsewhere cost nothing. Slivers are left out
/// as in `clean`; `slivers` gets how many more there were.
std::vector<Footprint> subtract(const std::vector<Footprint>& from, const std::vector<Footprint>& what);
std::vector<Footprint> intersect(const std::vector<Footprint>& a, const std::vector<Footprint>& b,
                                 std::size_t* slivers = nullptr);

/// A wall of this width along a line: joints mitred (very sharp ones cut off), ends cut straight. `closed`: a ring.
/// Empty for a line without a length. Where the line crosses itself or runs close to itself, what is shut in is a hole;
/// of one that crosses itself more than a thousand times each side is a footprint, and these overlap.
std::vector<Footprint> widen(const std::vector<Vec2>& line, bool closed, double width_m);

/// Convex pieces that cover a footprint and overlap only along their sides: few of them, none narrower than need be
/// (triangulated, then joined while convex: Hertel and Mehlhorn, 1983). One when the footprint is convex without holes.
std::vector<Ring> convex_pieces(const Footprint& footprint);

using app::ConvexArea;
using app::Outlines;

/// The convex_pieces of footprints; rough ones are cleaned first, which may leave nothing.
std::vector<ConvexArea> convex_areas(const std::vector<Footprint>& footprints, Outlines state);

}  // namespace vantage::internal::city
