// Where lines of sight pass what limits are made of.
#pragma once

#include <vector>

#include "query/ground_heights.h"
#include "query/view_ray.h"
#include "vantage/navigation.h"

namespace vantage::internal::query {

/// The planes of a box, which may be infinite.
void add_box_crossings(const Box& box, const ViewRay& line, std::vector<double>& out);

/// The heights of a band, and the ends of the ground.
void add_band_crossings(const AboveGround& band, const GroundHeights& ground, const ViewRay& line,
                        std::vector<double>& out);

}  // namespace vantage::internal::query
