// Bound A of docs/theory.md, "Tours": a search over sequences of cells.
//
// A node of the tree is a sequence of cells; its bound is that of the shortest polyline through their hulls in this
// order. A tour that visits more is not shorter (triangle inequality). If the polyline of a node misses a region, the
// region is inserted at every place; if a point of it lies in the hull of a cell but not in the region, a plane cuts
// the cell. So the children cover the parent, and the least bound of the leaves is one of all tours.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/progress_reporter.h"
#include "flight/tour/cells.h"
#include "flight/tour/touring_program.h"

namespace vantage::internal::flight::tour {

/// All tours that visit every region in some order.
struct TourSpace {
  bool closed = true;
  std::optional<std::size_t> first, last;  ///< of an open tour: the regions where it begins (always given) and ends
  std::vector<double> dwell_m;             ///< of each region: a stretch so long is flown in it alone; 0: none
  double turn_radius_m = 0;  ///< the track over ground curves no tighter, but at points; 0: tours turn on the spot
};

struct InsertionNode {
  enum class Kind { leaf, insert, cut, empty };  // empty: the cell that was cut has nothing on this side
  Kind kind = Kind::leaf;
  std::size_t what = 0;  ///< insert: the region. cut: the stop of the sequence
  CellPlane plane;       ///< cut: first the part above it, then the part below
  std::vector<std::size_t>
      children;  ///< insert: behind each stop, in order (of an open tour with an end not behind it)
  std::vector<Direction> directions;  ///< leaf: of the legs; a stop with a dwell has two points, with a leg between
};

/// The proof: node 0 is the root.
struct InsertionTree {
  std::vector<std::size_t>
      root;  ///< regions: three of a closed tour, or all where there are fewer; else first (and last)
  std::vector<InsertionNode> nodes;
};

struct InsertionOptions {
  double enough_m = 0;  ///< the search ends when nothing shorter is left
  double gap = 0.01;    ///< that is aimed at: how well programs are solved
  double time_limit_s = 60;
  std::size_t most_nodes = 10'000'000;  ///< programs that are solved
};

struct InsertionBound {
  double bound_m = 0;
  InsertionTree tree;
  std::size_t solved = 0, cells = 0;
  bool stopped = false;  ///< by a limit, before enough_m was reached
  /// The orders of the shortest polylines that meet all regions: to be tried. Without first and last.
  std::vector<std::vector<std::size_t>> orders;
};

/// `cells` get more by cutting. Uses the threads of the caller's arena; the same with any number of them, but for where
/// the time ends it. Throws Error(cancelled).
InsertionBound insertion_bound(Cells& cells, const TourSpace& space, const InsertionOptions& options,
                               const core::ProgressReporter& progress);

}  // namespace vantage::internal::flight::tour
