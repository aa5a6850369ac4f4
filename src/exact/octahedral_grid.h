// A regular grid over the octahedral map for the parts of the boundary that are range sphere.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "exact/octahedral_map.h"
#include "target/range_region.h"

namespace vantage::internal::exact {

/// Lines at |a| = line(i), i = 0..n, so spaced that the widest cells are about equal in angle. The horizon |a| + |b| =
/// 1 runs through the nodes with |i| + |j| = n, so cells are squares, or halves of squares at the horizon.
class OctahedralGrid {
 public:
  /// Fine enough that the triangles on the range sphere lie at most `tolerance` inside it.
  /// Throws Error(input) when that would take more cells than can be handled.
  OctahedralGrid(const target::RangeRegion& region, double tolerance);

  enum State : std::uint8_t {
    unknown,
    mixed,    ///< a crease on the range sphere passes through
    range,    ///< nothing but range sphere
    blocked,  ///< nothing but blockers
  };

  int size() const { return n_; }
  double line(int i) const { return i < 0 ? -lines_[-i] : lines_[i]; }
  OctahedralPoint node(int i, int j) const { return {line(i), line(j)}; }

  /// Row j has the cells -row_width <= i < row_width.
  int row_width(int j) const { return n_ - ring(j); }
  bool has_cell(int i, int j) const { return ring(i) + ring(j) < n_; }
  bool at_horizon(int i, int j) const { return ring(i) + ring(j) == n_ - 1; }

  /// Lines on the four sides of a cell: a0 and b0 are the ones nearer to the axes.
  struct Corners {
    int a0, a1, b0, b1;
  };
  static Corners corners(int i, int j) {
    return {i >= 0 ? i : i + 1, i >= 0 ? i + 1 : i, j >= 0 ? j : j + 1, j >= 0 ? j + 1 : j};
  }

  /// Cell (i, j) lies between the lines i and i + 1, j and j + 1; -n <= i, j < n.
  State state(int i, int j) const { return static_cast<State>(states_[index(i, j)]); }
  bool is_range(int i, int j) const { return has_cell(i, j) && state(i, j) == range; }

  /// The line at or below a coordinate.
  int locate(double coordinate) const;

  /// Marks the cells that a segment may touch as mixed, with its ends moved by up to `snap`.
  void mark(const OctahedralPoint& from, const OctahedralPoint& to, double snap);

  /// Whether the two triangles of some cell that a segment may touch, with its ends moved by up to `snap`, lie farther
  /// than the tolerance inside the region that the grid was made for. Where they do not, no crease between its balls
  /// is needed: its gauge is convex, so triangles that pass over one are still inside.
  bool is_coarse(const target::RangeRegion& region, const OctahedralPoint& from, const OctahedralPoint& to,
                 double snap);

  /// Marks the cells within `reach` of a point along either axis as mixed.
  void mark_square(const OctahedralPoint& middle, double reach);

  /// Settles the cells that no crease touches: `is_range_at` is asked once for each connected run of them.
  void settle(const std::function<bool(const OctahedralPoint&)>& is_range_at);

  /// Cells begin <= i < end of one row.
  struct Run {
    int begin, end;
  };

  /// The cells of row j in the state `range`, from left to right; any j. Once settled.
  std::span<const Run> range_runs(int j) const {
    if (j < -n_ || j >= n_) return {};
    return {runs_.data() + first_run_[j + n_], runs_.data() + first_run_[j + n_ + 1]};
  }

  /// The cells (i, j) in the state `mixed`, row by row. Once settled.
  const std::vector<std::pair<int, int>>& mixed_cells() const { return mixed_cells_; }

 private:
  template <typename Visit>
  void for_cells_on(const OctahedralPoint& from, const OctahedralPoint& to, double snap, const Visit& visit) const;
  bool is_coarse_cell(const target::RangeRegion& region, int i, int j) const;
  static int ring(int i) { return i >= 0 ? i : -1 - i; }
  void settle_row(int j, const std::function<bool(const OctahedralPoint&)>& is_range_at);
  void list_row(int j);
  OctahedralPoint inside(int i, int j) const;
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j + n_) * (2 * n_) + static_cast<std::size_t>(i + n_);
  }

  enum Fineness : std::uint8_t { not_measured, coarse, fine };

  int n_;
  double tolerance_;
  std::vector<double> lines_;
  std::vector<int> starts_;                      ///< per k: the line at or below k / (starts_.size() - 1)
  std::vector<std::uint8_t> states_, fineness_;  // per cell
  std::vector<Run> runs_;
  std::vector<std::uint32_t> first_run_;  // per row
  std::vector<std::pair<int, int>> mixed_cells_;
};

}  // namespace vantage::internal::exact
