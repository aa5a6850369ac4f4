#include "exact/range_cells.h"

#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

class Cutter {
 public:
  Cutter(ConstraintGraph& graph, const OctahedralGrid& grid, const target::RangeRegion& range)
      : graph_(graph), grid_(grid), range_(range) {}

  RangeCells run() {
    const int n = grid_.size();
    std::size_t count = 0;
    for (int j = -n; j < n; ++j)
      for (const OctahedralGrid::Run& run : grid_.range_runs(j)) count += static_cast<std::size_t>(run.end - run.begin);
    cells_.triangles.reserve(2 * count);
    cells_.vertices.reserve(graph_.points().size() + count + 4 * static_cast<std::size_t>(n));
    cells_.vertices.resize(graph_.points().size());
    for (int j = -n; j < n; ++j) {
      for (const OctahedralGrid::Run& run : grid_.range_runs(j))
        for (int i = run.begin; i < run.end; ++i) cut(i, j);
    }
    return std::move(cells_);
  }

 private:
  void cut(int i, int j) {
    // The diagonal from (a1, b0) to (a0, b1) is the short one in space.
    const OctahedralGrid::Corners c = OctahedralGrid::corners(i, j);
    const bool mirrored = (i >= 0) != (j >= 0);
    const std::uint32_t p = vertex_at(c.a1, c.b0), q = vertex_at(c.a0, c.b1);
    add(vertex_at(c.a0, c.b0), p, q, mirrored);
    if (!grid_.at_horizon(i, j)) {
      add(p, vertex_at(c.a1, c.b1), q, mirrored);
    } else {
      cells_.base.push_back(mirrored ? ConstraintGraph::Edge{q, p} : ConstraintGraph::Edge{p, q});
    }
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool mirrored) {
    cells_.triangles.push_back(mirrored ? Triangle{a, c, b} : Triangle{a, b, c});
  }

  std::uint32_t vertex_at(int i, int j) {
    std::uint32_t& slot = graph_.node(i, j);
    if (slot == ConstraintGraph::kNone) {
      slot = static_cast<std::uint32_t>(cells_.vertices.size());
      Vec3 direction = to_direction(grid_.node(i, j));
      if (std::abs(i) + std::abs(j) == grid_.size()) direction.z() = 0;
      cells_.vertices.push_back(direction * ((1 - numerics::kShrink) / range_.gauge(direction, ball_)));
    }
    return slot;
  }

  ConstraintGraph& graph_;
  const OctahedralGrid& grid_;
  const target::RangeRegion& range_;
  std::size_t ball_ = 0;
  RangeCells cells_;
};

}  // namespace

RangeCells cut_range_cells(ConstraintGraph& graph, const OctahedralGrid& grid, const target::RangeRegion& range) {
  return Cutter(graph, grid, range).run();
}

}  // namespace vantage::internal::exact
