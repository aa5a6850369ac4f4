#include "query/line_crossings.h"

#include <cmath>

namespace vantage::internal::query {

void add_box_crossings(const Box& box, const ViewRay& line, std::vector<double>& out) {
  for (int axis = 0; axis < 3; ++axis) {
    if (line.direction[axis] == 0) continue;
    out.push_back((box.min[axis] - line.origin[axis]) / line.direction[axis]);
    out.push_back((box.max[axis] - line.origin[axis]) / line.direction[axis]);
  }
}

void add_band_crossings(const AboveGround& band, const GroundHeights& ground, const ViewRay& line,
                        std::vector<double>& out) {
  for (const double above_m : {band.min_m, band.max_m}) {
    // If the height is infinite, the ends of the ground are left: any finite one has them too.
    ground.add_crossings(line.origin, line.direction, line.reach, std::isfinite(above_m) ? above_m : 0, out);
  }
}

}  // namespace vantage::internal::query
