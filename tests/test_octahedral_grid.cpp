// Which cells of the grid a crease on the range sphere passes through: a cell that is left out is over-claimed.
#include <gtest/gtest.h>

#include "exact/octahedral_grid.h"
#include "support/random.h"

namespace vantage::testing {
namespace {

using internal::exact::OctahedralGrid;
using internal::exact::OctahedralPoint;
using internal::target::RangeRegion;

constexpr double kSnap = 1e-10;

OctahedralGrid make_grid() { return OctahedralGrid(RangeRegion({{-3, -2}, {4, -1}, {0, 3}}, 100), 0.02); }

bool is_mixed_at(const OctahedralGrid& grid, const OctahedralPoint& p) {
  const int i = grid.locate(p.x()), j = grid.locate(p.y());
  return !grid.has_cell(i, j) || grid.state(i, j) == OctahedralGrid::mixed;
}

int mixed_count(const OctahedralGrid& grid) {
  int count = 0;
  for (int j = -grid.size(); j < grid.size(); ++j)
    for (int i = -grid.row_width(j); i < grid.row_width(j); ++i) count += grid.state(i, j) == OctahedralGrid::mixed;
  return count;
}

OctahedralPoint draw_point(Random& random) {
  for (;;) {
    OctahedralPoint p(random.uniform(-1, 1), random.uniform(-1, 1));
    if (p.lpNorm<1>() <= 1) return p;
  }
}

// Steep, level, slanted and tiny ones, and such that end on lines of the grid.
OctahedralPoint draw_end(Random& random, const OctahedralGrid& grid, const OctahedralPoint& from) {
  OctahedralPoint to = from + std::pow(10, random.uniform(-12, 0)) * (draw_point(random) - from);
  if (random.chance(0.2)) to.x() = grid.line(grid.locate(to.x()));
  if (random.chance(0.2)) to.y() = grid.line(grid.locate(to.y()));
  if (random.chance(0.1)) to.x() = from.x();
  if (random.chance(0.1)) to.y() = from.y() + random.uniform(-1e-9, 1e-9);
  return to;
}

TEST(OctahedralGrid, MarksAllCellsThatASegmentMayTouch) {
  Random random(11);
  for (int k = 0; k < 500; ++k) {
    OctahedralGrid grid = make_grid();
    const OctahedralPoint from = draw_point(random), to = draw_end(random, grid, from);
    grid.mark(from, to, kSnap);
    for (int sample = 0; sample <= 2000; ++sample) {
      const OctahedralPoint moved(random.uniform(-kSnap, kSnap), random.uniform(-kSnap, kSnap));
      const OctahedralPoint p = from + sample / 2000.0 * (to - from) + moved;
      ASSERT_TRUE(is_mixed_at(grid, p)) << "from " << from.transpose() << " to " << to.transpose() << " at "
                                        << p.transpose();
    }
  }
}

// Each of them costs triangles of the slow kind.
TEST(OctahedralGrid, LeavesCellsBesideASlantedSegmentAlone) {
  Random random(12);
  for (int k = 0; k < 100; ++k) {
    OctahedralGrid grid = make_grid();
    const OctahedralPoint from = draw_point(random), to = draw_point(random);
    grid.mark(from, to, kSnap);
    const int columns = std::abs(grid.locate(to.x()) - grid.locate(from.x()));
    const int rows = std::abs(grid.locate(to.y()) - grid.locate(from.y()));
    EXPECT_LE(mixed_count(grid), columns + rows + 1);
  }
}

TEST(OctahedralGrid, MarksASquare) {
  OctahedralGrid grid = make_grid();
  const OctahedralPoint middle(0.31, -0.22);
  const double reach = 3.0 / grid.size();
  grid.mark_square(middle, reach);
  for (const double x : {-reach, 0.0, reach})
    for (const double y : {-reach, 0.0, reach}) EXPECT_TRUE(is_mixed_at(grid, middle + OctahedralPoint(x, y)));
  EXPECT_FALSE(is_mixed_at(grid, middle + OctahedralPoint(2 * reach, 0)));
}

}  // namespace
}  // namespace vantage::testing
