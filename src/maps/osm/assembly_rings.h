// Rings in the plane of assembly: joined from lines, and how often they go round what lies in them.
#pragma once

#include <cstddef>
#include <optional>
#include <osmium/osm/location.hpp>
#include <set>
#include <tuple>
#include <vector>

namespace vantage::internal::osm {

using NodeLocations = std::vector<osmium::Location>;

/// Twice the area that a ring of the plane is wound round, counter-clockwise; about its first position.
double twice_signed_area(const NodeLocations& ring);

/// Whether not all places lie on one line. (The area would not tell: a figure of eight may be wound round none.)
bool has_corner(const NodeLocations& places);

/// Lines joined end to end. Where several go on, not with one that runs back along the last; where they come to an end
/// of a line again, they have closed a ring.
class Chains {
 public:
  explicit Chains(std::vector<NodeLocations> lines);

  const std::vector<NodeLocations>& rings() const { return rings_; }  ///< the first place is not repeated
  const NodeLocations& loose() const { return loose_; }               ///< the places of all that closes nowhere

 private:
  using End = std::tuple<osmium::Location, std::size_t, std::size_t>;  // where, of which kind and which line

  NodeLocations take(std::size_t line, osmium::Location from);
  std::optional<std::size_t> next_at(osmium::Location place, std::size_t kind) const;
  void join_from(std::size_t first);
  void add_ring(NodeLocations ring);

  std::vector<NodeLocations> lines_;
  std::vector<std::size_t> kinds_;  ///< of lines: the same for those with the same places
  std::set<End> ends_;              ///< of lines that are not used yet
  std::vector<NodeLocations> rings_;
  NodeLocations loose_;
};

/// Why some rings are not what the even-odd rule makes of them, and where.
struct RingFault {
  const char* what = "";  ///< for people: "its outer rings overlap"
  osmium::Location at;
};

/// Nothing where every place in an odd number of the rings lies in an outer one and in no hole, and every other one in
/// no outer ring or in a hole that shares no side with an outer ring. For rings that meet in their corners only, or
/// share whole sides. One that touches itself bounds all that it is wound round. Cost: O(n log n).
std::optional<RingFault> ring_fault(const std::vector<NodeLocations>& outer, const std::vector<NodeLocations>& inner);

}  // namespace vantage::internal::osm
