// Convex polygons in one plane, cut by each other.
#pragma once

#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::scene {

/// Convex polygons in a plane, counter-clockwise seen from its normal, which overlap only along their sides.
using PlanePieces = std::vector<std::vector<Vec3>>;

/// Takes a convex polygon away; it is given in the plane too, either turn. Corners that stay keep every bit; new ones
/// are rounded to doubles. What is narrower than `sliver` metres goes: the pieces may shrink by so much, no more.
void subtract(PlanePieces& pieces, const std::vector<Vec3>& taken, const Vec3& normal, double sliver);

/// Cuts in two, along the line through `a` and `b`, each piece that the segment between them passes through. Nothing is
/// lost but slivers, as above.
void split_along(PlanePieces& pieces, const Vec3& a, const Vec3& b, const Vec3& normal, double sliver);

/// Whether a polygon is nowhere wider than `sliver`.
bool is_sliver(const std::vector<Vec3>& polygon, double sliver);

/// Joins pieces that share a whole side, to `slack` metres, where the outcome is convex. Cost: the square of the pieces
/// at least; of more than 256 none are joined.
void join_convex(PlanePieces& pieces, const Vec3& normal, double slack);

/// As parts of targets: of at most 64 corners; no two corners nearer to each other than 2e-9 of the extent, of which
/// one is left out; without pieces that are narrower than that.
PlanePieces usable(const PlanePieces& pieces);

double area_of(const std::vector<Vec3>& polygon);  ///< square metres

/// The pieces in connected groups: two are connected that share a length of their sides, to `slack` metres. In the
/// order of the first of each.
std::vector<PlanePieces> connected(const PlanePieces& pieces, double slack);

/// The distance from `point` to the nearest point of a convex polygon.
double distance_to(const std::vector<Vec3>& polygon, const Vec3& normal, const Vec3& point);

}  // namespace vantage::internal::scene
