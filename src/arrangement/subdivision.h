// The parts into which edges and meetings divide facets, told by their borders, without a coordinate.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "arrangement/lines.h"

namespace vantage::internal::arrangement {

/// Edges and meetings are cut into pieces at the nodes that lie on them. Each piece has half-edges: one for each facet
/// that it bounds or divides, and side of it. A half-edge has a part of a facet to its left; those round one part, or
/// round one of its holes, follow each other (Muller and Preparata, Finding the intersection of two convex polyhedra,
/// 1978).
///
/// Of a piece of an edge: 0 in the facet that has the edge from `from` to `to`, 1 in the other one. Of a piece of a
/// meeting: in a, with what lies in b's operand to its left, and 1 with what lies outside; 2 and 3 likewise in b.
class Subdivision {
 public:
  /// nullopt where a half-edge that should follow another does not exist: the meetings contradict each other.
  static std::optional<Subdivision> of(const Soup& soup, const Meetings& meetings, const Lines& lines);

  std::size_t size() const { return next_.size(); }
  std::uint32_t next(std::uint32_t half) const { return next_[half]; }
  std::uint32_t head(std::uint32_t half) const { return head_[half]; }  ///< node
  /// Edges first, then meetings.
  std::uint32_t line(std::uint32_t half) const { return line_[half]; }
  std::uint32_t facet(std::uint32_t half) const { return facet_[half]; }
  bool is_of_meeting(std::uint32_t half) const { return half >= first_of_meetings_; }
  /// Of a meeting: with the part on the other side.
  std::uint32_t twin(std::uint32_t half) const { return half ^ 1u; }

  std::uint32_t first_of_edge(std::size_t edge) const { return first_of_line_[edge]; }
  std::uint32_t first_of_meetings() const { return first_of_meetings_; }

  /// Nodes: the points of all meshes, then crossings, then triple points.
  std::size_t nodes() const { return nodes_; }

 private:
  Subdivision() = default;

  std::vector<std::uint32_t> first_of_line_;
  std::vector<std::uint32_t> next_, head_, line_, facet_;
  std::uint32_t first_of_meetings_ = 0;
  std::size_t nodes_ = 0;

  friend class SubdivisionBuilder;
};

}  // namespace vantage::internal::arrangement
