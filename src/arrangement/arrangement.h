// Unions, intersections, differences and shares of any number of closed meshes at once.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "arrangement/soup.h"

namespace vantage::internal::arrangement {

/// A part of a facet, with holes.
struct Part {
  std::uint32_t operand, triangle;  ///< that it is a part of
  Vec3 normal;                      ///< of any length; outward
  std::uint32_t first_ring, rings;  ///< of a surface
};

/// What bounds a solid.
struct Surface {
  std::vector<Vec3> points;
  std::vector<Part> parts;
  /// Points round each ring: counter-clockwise, seen from outside, round a part, clockwise round its holes. Each piece
  /// of a ring has two parts, which run along it in opposite directions.
  std::vector<std::vector<std::uint32_t>> rings;
  /// Each point lies no farther than this from the planes of the facets that meet there, and from what they have in
  /// common where they do not meet at a small angle. Corners of operands are where they were given; no point lies
  /// outside of all operands' bounds, and what lies on a facet across an axis has its coordinate.
  double epsilon_m = 0;
};

/// The points that operands hold whose weights are at least `least` together: 1 or more. n of n weights of 1 are an
/// intersection, 1 a union. All operands but the first are moved a little, see Surface::epsilon_m and Soup.
///
/// Every facet meets those of all other meshes once. What is left of a facet is one part, however many meshes divide
/// it: where both sides of a meeting are kept there is no piece of it.
///
/// nullopt where three attempts, each with operands moved four times as far, have left in doubt how things lie (work
/// that they have counted stays counted), and where a mesh is not closed as Operand asks, or bounds no solid. The sum
/// of the weights must be below 2^62. Throws Error(cancelled), and Error(work_too_large): each facet counts once, and
/// so do each pair of facets that meet, and each three of them. The same on every machine, and with any number of
/// threads.
std::optional<Surface> weighing_at_least(std::span<const Operand> operands, std::uint64_t least,
                                         const core::ProgressReporter& progress);

}  // namespace vantage::internal::arrangement
