// What divides facets: edges and meetings, and what lies on them, in order.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arrangement/meetings.h"

namespace vantage::internal::arrangement {

/// Where three facets of different meshes pass through each other.
struct TriplePoint {
  std::array<std::uint32_t, 3> facets;    ///< a < b < c
  std::array<std::uint32_t, 3> meetings;  ///< of a and b, of a and c, of b and c
  bool is_positive;                       ///< the determinant of the outward normals, in that order
  double along;                           ///< part of the meeting of a and b, from its begin
};

/// Numbers for each of many lists, one after the other.
class Lists {
 public:
  /// `pairs`: list and item; the items of a list keep their order.
  Lists(std::size_t lists, std::span<const std::pair<std::uint32_t, std::uint32_t>> pairs);

  std::span<std::uint32_t> operator[](std::size_t list) {
    return {items_.data() + first_[list], first_[list + 1] - first_[list]};
  }
  std::span<const std::uint32_t> operator[](std::size_t list) const {
    return {items_.data() + first_[list], first_[list + 1] - first_[list]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> items_;
};

struct Lines {
  std::vector<TriplePoint> triples;  ///< ascending by facets
  Lists on_edges;                    ///< per edge: crossings, from its `from` to its `to`
  Lists on_meetings;                 ///< per meeting: triple points, from its begin to its end
};

/// nullopt where 106 digits do not tell an order. Throws Error(cancelled), and Error(work_too_large): each triple point
/// counts as a facet. Cost: O(k) for k pairs of
/// meetings on one facet that overlap along its longest axis.
std::optional<Lines> find_lines(const Soup& soup, const Meetings& meetings, const core::ProgressReporter& progress);

}  // namespace vantage::internal::arrangement
