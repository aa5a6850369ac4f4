// Bound B of docs/theory.md, "Tours": by pairs of neighbours.
//
// For any vectors u_ij = -u_ji with |u_ij| <= 1 the length of a tour is at least the sum over its regions i of
// cost_i(j, k) = min over v in W_i of (u_ij + u_ik) . v, with j and k the neighbours of i. The least such sum over all
// tours is a travelling salesman problem with costs of pairs. For any numbers p_ij, d_i and s_S >= 0 of sets S of
// regions it is at least
//   sum over i of min over j, k of (cost_i(j, k) - p_ij - p_ik)  +  2 sum d_i + 2 sum s_S
//   + sum over edges ij of min(0, p_ij + p_ji - d_i - d_j - sum of the s_S that ij leaves),
// as a tour has two edges at each region, and leaves each set twice at least. A linear program finds good numbers; they
// need not be trusted.
//
// An open tour is closed by a region "anywhere", whose vectors are 0 and which must stand beside the first (and last)
// one. Where edges are fixed, in or out, the bound is over tours with these edges; fixing an edge both ways covers all
// tours. Vectors that point along a tour bound this one well, others less: where the program's solution is another
// tour, new vectors are taken along that.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/progress_reporter.h"
#include "flight/tour/cells.h"
#include "flight/tour/insertion_bound.h"
#include "flight/tour/touring_program.h"

namespace vantage::internal::flight::tour {

/// Numbers for tours in which some edges are fixed.
struct PairsDuals {
  std::vector<std::vector<double>> of_edge_at;                      ///< p_ij
  std::vector<double> of_region;                                    ///< d_i
  std::vector<std::pair<double, std::vector<std::size_t>>> of_set;  ///< s_S
};

struct PairsNode {
  /// Not a leaf: this edge is fixed below, in the tour in the first child, out of it in the second.
  std::optional<std::array<std::size_t, 2>> edge;
  std::size_t vectors = 0;  ///< of a leaf: which
  PairsDuals duals;         ///< of a leaf
};

/// The proof. The regions are those of the space, and "anywhere" behind them for open tours.
struct PairsProof {
  Vec3 origin = Vec3::Zero();                                ///< whole metres; subtracted from all points
  std::vector<std::vector<std::vector<Direction>>> vectors;  ///< u_ij at [which][i][j], j < i; u_ji is its opposite
  std::vector<PairsNode> nodes;                              ///< in preorder
};

struct PairsOptions {
  double enough_m = 0;  ///< the search ends when nothing shorter is left
  double worth_m = 0;   ///< nothing is branched where the first bound is less
  double time_limit_s = 60;
  std::size_t most_nodes = 2'000;
};

struct PairsBound {
  double bound_m = 0;
  PairsProof proof;
  std::size_t nodes = 0, columns = 0;
  /// The orders of tours that the program suggests: to be tried. Without first and last.
  std::vector<std::vector<std::size_t>> orders;
};

/// Whether this build has a solver of linear programs (VANTAGE_WITH_HIGHS).
bool has_pairs_bound();

/// For five regions or more. `order`: of a tour that is known, without first and last, or empty. `anchors`: without
/// one, of each region the point where a tour is expected, about the origin of the cells. Throws Error(cancelled).
PairsBound pairs_bound(const Cells& cells, const TourSpace& space, const std::vector<Vec3>& anchors,
                       const std::vector<std::size_t>& order, const PairsOptions& options,
                       const core::ProgressReporter& progress);

}  // namespace vantage::internal::flight::tour
