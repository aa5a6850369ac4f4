// A regular grid over the chart for the parts of the boundary that are range sphere.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "exact/chart.h"
#include "exact/range_region.h"

namespace vantage::exact {

/// Lines at |a| = line(i), i = 0..n, so spaced that the cells are about equal in angle. The horizon |a| + |b| = 1 runs
/// through the nodes with |i| + |j| = n, so cells are squares, or halves of squares at the horizon.
class ChartGrid {
 public:
  /// Fine enough that the triangles on the range sphere lie at most `tolerance` inside it.
  /// Throws Error(input) when that would take more cells than can be handled.
  ChartGrid(const RangeRegion& range, double tolerance);

  enum State : std::uint8_t {
    unknown,
    mixed,    ///< a crease on the range sphere passes through
    range,    ///< nothing but range sphere
    blocked,  ///< nothing but blockers
  };

  int size() const { return n_; }
  double line(int i) const { return i < 0 ? -lines_[-i] : lines_[i]; }
  ChartPoint node(int i, int j) const { return {line(i), line(j)}; }
  static bool inside(int i, int j, int n) { return (i >= 0 ? i : -1 - i) + (j >= 0 ? j : -1 - j) < n; }
  bool has_cell(int i, int j) const { return i >= -n_ && i < n_ && j >= -n_ && j < n_ && inside(i, j, n_); }

  /// Cell (i, j) lies between the lines i and i + 1, j and j + 1; -n <= i, j < n.
  State state(int i, int j) const { return State(states_[index(i, j)]); }
  bool is_range(int i, int j) const { return has_cell(i, j) && state(i, j) == range; }

  /// The line at or below a coordinate.
  int locate(double coordinate) const;

  /// Marks the cells that a short segment may touch as mixed.
  void mark(const ChartPoint& from, const ChartPoint& to);

  /// Settles the cells that no crease touches: `is_range_at` is asked once for each connected run of them.
  void settle(const std::function<bool(const ChartPoint&)>& is_range_at);

 private:
  std::size_t index(int i, int j) const { return std::size_t(j + n_) * (2 * n_) + std::size_t(i + n_); }

  int n_;
  std::vector<double> lines_;
  std::vector<std::uint8_t> states_;
};

}  // namespace vantage::exact
