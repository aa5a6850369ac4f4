// Where facets of different meshes pass through each other.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "arrangement/soup.h"

namespace vantage::internal::arrangement {

/// What coordinates are off by that are computed without losing digits, in parts of the largest one, with room.
constexpr double kPlaceRounding = 0x1p-48;

/// Where an edge passes through a facet of another mesh.
struct Crossing {
  std::uint32_t edge, facet;
  double along;            ///< part of the edge, from its `from`
  double along_off_by;     ///< that part is no farther off
  Vec3 place;              ///< rounded
  double off_by_m;         ///< no coordinate of that place is farther off
  core::Bounded from, to;  ///< heights of the edge's ends beyond the facet
  /// The meetings of the facet with the edge's two facets, and whether each of them begins here.
  std::array<std::uint32_t, 2> meetings{kNone, kNone};
  std::array<bool, 2> is_begin{};
};

/// Two facets pass through each other along a straight line. It begins where the second facet's operand lies to the
/// left of it, for one who stands on the first one.
struct Meeting {
  std::uint32_t a, b;                 ///< facets, a < b
  std::array<std::uint32_t, 2> ends;  ///< crossings: where it begins, and where it ends
};

struct Meetings {
  std::vector<Meeting> meetings;    ///< ascending by a, then b
  std::vector<Crossing> crossings;  ///< ascending by edge, then facet
};

/// All of them. Exact: nullopt where something only touches, so that it is unknown what passes through what. Throws
/// Error(cancelled), and Error(work_too_large): each meeting counts as a facet. Cost: O((n + k) log n) for k pairs
/// of facets whose boxes overlap.
std::optional<Meetings> find_meetings(const Soup& soup, const core::ProgressReporter& progress);

}  // namespace vantage::internal::arrangement
