// Lower bounds of tours: no tour that visits all regions is shorter (docs/theory.md, "Tours").
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flight/tour/insertion_bound.h"
#include "flight/tour/outer_region.h"
#include "flight/tour/pairs_bound.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"

namespace vantage::internal::flight::tour {

/// What is to be visited, in any order. Scene frame, metres.
struct BoundProblem {
  std::vector<OuterRegion> regions;  ///< at least one
  /// In each region a stretch of this length is flown (speed times dwell), and no stretch serves two regions: only for
  /// targets that are viewed one at a time. Empty: 0.
  std::vector<double> dwell_m;
  /// For a fixed wing: the track over ground curves no tighter, but where the tour begins and ends. 0: it turns on the
  /// spot.
  double turn_radius_m = 0;
  bool closed = true;          ///< ends where it begins
  std::optional<Vec3> start;   ///< home. An open tour needs one
  std::optional<Vec3> finish;  ///< of an open tour: where it ends; else anywhere
};

/// A tour that is known: its length is when to stop, its points are where the bound of pairs is tight.
struct Incumbent {
  std::vector<std::size_t> order;  ///< of all regions
  std::vector<Vec3> points;        ///< in that order, in the regions; start and finish are not among them
  double length_m = std::numeric_limits<double>::infinity();  ///< of the tour, which may go round obstacles
};

struct BoundOptions {
  double gap = 0.01;  ///< (length - bound) / length at which to stop
  double time_limit_s = 60;
  std::size_t most_nodes = 10'000'000;  ///< of the search: a limit that does not depend on the machine
  bool by_insertion = true, by_pairs = true;
  int threads = 0;  ///< at most so many; 0: all
};

enum class BoundKind { insertion, pairs };

/// "insertion", "pairs".
const char* name_of(BoundKind kind);

struct TourBound {
  double length_m = 0;                         ///< the bound
  BoundKind kind = BoundKind::insertion;       ///< that gave it
  std::optional<double> insertion_m, pairs_m;  ///< both, where they were computed: the second one first, see below
  double gap = 0;                              ///< (incumbent - bound) / incumbent; 1 without one
  bool gap_reached = false;
  std::variant<InsertionTree, PairsProof> proof;
  std::vector<OuterRegion> regions;              ///< of the proof: those of the problem, then start and finish
  TourSpace space;                               ///< likewise
  std::vector<std::vector<std::size_t>> orders;  ///< that the bounds suggest; they may be better than the incumbent's
  std::vector<std::string> ignored;              ///< what makes tours longer, and the bound does not know
};

/// The larger one of both bounds: by pairs first, which is fast and good where regions are small and far apart; then,
/// if that does not reach the gap, by insertion, which is good where they are large and overlap. Deterministic but for
/// where the time limit ends it; most_nodes ends it deterministically. Throws Error(input) for a problem without
/// regions, an open tour without a start, arrays of other lengths, numbers that are not finite; Error(cancelled); and
/// Error(internal) where the bound is above the incumbent's length by more than rounding, or a point of it lies outside
/// of its region: then a region is too small, and no bound is to be had.
TourBound bound_tour(const BoundProblem& problem, const Incumbent& incumbent = {}, const BoundOptions& options = {},
                     const Progress& progress = {});

}  // namespace vantage::internal::flight::tour
