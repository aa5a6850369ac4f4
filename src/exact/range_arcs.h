// Arcs on the range sphere: circles cut down to the range region, and made into polylines.
#pragma once

#include <cstddef>
#include <vector>

#include "exact/circle_arcs.h"
#include "exact/envelope.h"
#include "exact/octahedral_grid.h"
#include "target/range_region.h"

namespace vantage::internal::exact {

/// Pieces of an edge shorter than this, in metres, are rounding.
double shortest_piece(const target::RangeRegion& range);

/// Keeps, of from -> to (parameters 0 to 1), what is inside the region.
void keep_in_range(const target::RangeRegion& range, const Vec3& from, const Vec3& to, IntervalSet& shown);

/// Keeps, of arcs on the sphere of one ball, what is inside the others but `also`: there, being inside another ball is
/// being on one side of the plane half way between the centres.
void keep_in_balls(const target::RangeRegion& range, std::size_t ball, std::size_t also, CircleArcs& arcs);

/// Appends a polyline for each arc that is no shorter than `shortest`, in metres.
void add_arcs(const SpaceCircle& circle, CircleArcs& arcs, double shortest, const CurveSampling& sampling,
              std::vector<Skeleton::Curve>& out);

/// Appends the creases where two balls of the range region meet, in sight, as far as `grid` is too coarse for them.
void trace_range_creases(const BlockerSet& blockers, const DirectionTree& tree, const target::RangeRegion& range,
                         const CurveSampling& sampling, OctahedralGrid& grid, std::vector<Skeleton::Curve>& out);

}  // namespace vantage::internal::exact
