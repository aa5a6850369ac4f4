#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/progress_reporter.h"
#include "vantage/scene.h"

namespace vantage::internal::terrain {

/// How posts without a height get one.
struct VoidFilling {
  MissingPolicy missing = MissingPolicy::block;
  std::optional<double> height_m = std::nullopt;  ///< where it is known: HeightOptions::void_m
  std::array<double, 2> post_m = {1, 1};          ///< from one column, and from one row, to the next
};

/// Posts without a height that touch each other, also across corners.
struct VoidRegion {
  enum class Filled { from_rim, from_neighbours, as_given };
  std::size_t posts = 0;
  int first_column = 0, first_row = 0, last_column = 0, last_row = 0;
  Filled filled = Filled::from_neighbours;
  float lowest_m = 0, highest_m = 0;  ///< of what they were filled with
  std::size_t others = 0;             ///< so many smaller ones are told with it; its columns and rows hold these, too
};

struct Voids {
  std::size_t posts = 0;
  std::vector<VoidRegion> regions;  ///< the largest, at most kMostVoidRegions
  /// The least that the heights may be, in the order of posts; empty where they are the heights everywhere.
  std::vector<float> lowest_m;
};

inline constexpr double kNarrowVoid_m = 20;
inline constexpr std::size_t kMostVoidRegions = 10'000;

/// Gives each height that is not a number one. What stands there is not known.
///
/// MissingPolicy::block: a region that is nowhere wider than kNarrowVoid_m takes the highest post of its rim, where
/// that is within kNarrowVoid_m of the post (and up to twice as far); `lowest_m` the lowest one. (Width: twice the
/// distance to the rim, less a post. It counts as up to a twelfth more along diagonals.) A height that is given lies
/// between the two or widens them. Wider regions take the height that is given, or else what their neighbours say.
/// Other policies: the height that is given, or else what the neighbours say.
///
/// What the neighbours say is the mean of the nearest values in eight directions (along rows, columns and diagonals),
/// weighted by the inverse of their distance in posts; where none of the eight meets a value, filled ones count in
/// another round. `heights`: row by row. Fills none when there is no value at all. Cost: linear in the posts, per
/// round. Throws Error(cancelled).
Voids fill_voids(std::vector<float>& heights, int columns, int rows, const VoidFilling& filling,
                 const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::terrain
