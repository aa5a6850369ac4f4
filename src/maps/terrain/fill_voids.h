#pragma once

#include <cstddef>
#include <vector>

namespace vantage::internal::terrain {

/// Replaces each value that is not a number by the mean of the nearest values in eight directions (along rows, columns
/// and diagonals), weighted by the inverse of their distance in posts; where none of the eight meets a value, filled
/// ones count in another round. `heights`: row by row. Returns how many were replaced; none when there is no value at
/// all. Cost: linear in the posts, per round.
std::size_t fill_voids(std::vector<float>& heights, int columns, int rows);

}  // namespace vantage::internal::terrain
