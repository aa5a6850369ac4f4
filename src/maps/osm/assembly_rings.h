// Rings in the plane of assembly: joined from lines, and how often they go round what lies in them.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <osmium/osm/location.hpp>
#include <utility>
#include <vector>

#include "core/progress_reporter.h"

namespace vantage::internal::osm {

using NodeLocations = std::vector<osmium::Location>;

/// Twice the area that a ring of the plane is wound round, counter-clockwise; about its first position.
double twice_signed_area(const NodeLocations& ring);

/// Whether not all places lie on one line. (The area would not tell: a figure of eight may be wound round none.)
bool has_corner(const NodeLocations& places);

/// Why some rings are not what the even-odd rule makes of them, and where.
struct RingFault {
  const char* what = "";  ///< for people: "its outer rings overlap"
  osmium::Location at;
};

/// Lines joined end to end, each once. Where more than two end in a place there is more than one way to join them: what
/// any ring that they make goes round, one of these does, too.
class Chains {
 public:
  explicit Chains(std::vector<NodeLocations> lines);

  const std::vector<NodeLocations>& rings() const { return rings_; }  ///< the first place is not repeated
  const NodeLocations& loose() const { return loose_; }               ///< the places of all that closes nowhere
  /// Whether some place that a ring goes round is outside by the even-odd rule, where there is more than one way to
  /// join the lines. For lines that meet in their corners only, or share whole sides.
  std::optional<RingFault> fault() const;

 private:
  struct Step {
    std::size_t line = 0;  ///< by which the tree of lines comes to a place
    osmium::Location from;
    std::size_t depth = 0;
  };
  using Tree = std::map<osmium::Location, Step>;

  void join_from(std::size_t first);
  void close(std::size_t line, const Tree& tree);
  bool add_ring(NodeLocations ring);

  std::vector<NodeLocations> lines_;
  std::map<osmium::Location, std::vector<std::size_t>> ending_;  ///< open lines, by both of their ends
  std::vector<bool> is_joined_, is_in_ring_;                     ///< of each line
  bool is_ambiguous_ = false;
  std::size_t places_ = 0;  ///< in rings that are joined so far
  std::vector<NodeLocations> rings_;
  NodeLocations loose_;
};

/// Nothing where every place in an odd number of the rings lies in an outer one and in no hole, and every other one in
/// no outer ring or in a hole that shares no side with an outer ring. For rings that meet in their corners only, or
/// share whole sides. One that touches itself bounds all that it is wound round. Cost: O(n log n).
std::optional<RingFault> ring_fault(const std::vector<NodeLocations>& outer, const std::vector<NodeLocations>& inner);

/// The pairs of a ring of `a` and one of `b` whose boxes meet, in their order. Sweeps along the longer side of all.
/// None where they, or the places of `b` in them, are more than drawing explains.
using RingPairs = std::vector<std::pair<std::size_t, std::size_t>>;
RingPairs meeting_boxes(const std::vector<NodeLocations>& a, const std::vector<NodeLocations>& b,
                        const core::ProgressReporter& progress);

/// Without rings that another one repeats, from whichever place and whichever way round.
std::vector<NodeLocations> each_once(const std::vector<NodeLocations>& rings);

}  // namespace vantage::internal::osm
