#include "maps/terrain/fill_voids.h"

#include <array>
#include <cmath>
#include <numbers>

namespace vantage::internal::terrain {
namespace {

/// The nearest value in some direction; distance 0: none yet.
struct Nearest {
  float value = 0, distance = 0;
};

/// What a post passes on to the next one in a direction whose posts are `step` apart.
Nearest passed_on(float height, const Nearest& nearest, float step) {
  if (!std::isnan(height)) return {height, step};
  return {nearest.value, nearest.distance > 0 ? nearest.distance + step : 0};
}

struct Mean {
  double sum = 0, weight = 0;

  void add(const Nearest& nearest) {
    if (nearest.distance <= 0) return;
    sum += static_cast<double>(nearest.value) / nearest.distance;
    weight += 1.0 / nearest.distance;
  }
};

/// Looks in four of the eight directions, along the row and to the three posts of the row before; `backward` sweeps
/// from the last post to the first, which gives the other four. Adds to one mean for each void, in the order of posts.
void sweep(const std::vector<float>& heights, int columns, int rows, bool backward, std::vector<Mean>& means) {
  const auto width = static_cast<std::size_t>(columns), count = heights.size();
  const auto diagonal = static_cast<float>(std::numbers::sqrt2);
  // Per column, as seen from the row that is being swept: along the column, and along the two diagonals.
  std::vector<std::array<Nearest, 3>> seen(width), next(width);
  std::size_t voids = 0;
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows); ++row) {
    Nearest along;
    next.assign(width, {});
    for (std::size_t column = 0; column < width; ++column) {
      const std::size_t place = row * width + column;
      const float height = heights[backward ? count - 1 - place : place];
      if (std::isnan(height)) {
        Mean& mean = means[backward ? means.size() - 1 - voids : voids];
        ++voids;
        mean.add(along);
        for (const Nearest& nearest : seen[column]) mean.add(nearest);
      }
      along = passed_on(height, along, 1);
      next[column][0] = passed_on(height, seen[column][0], 1);
      if (column + 1 < width) next[column + 1][1] = passed_on(height, seen[column][1], diagonal);
      if (column > 0) next[column - 1][2] = passed_on(height, seen[column][2], diagonal);
    }
    seen.swap(next);
  }
}

}  // namespace

std::size_t fill_voids(std::vector<float>& heights, int columns, int rows) {
  std::size_t replaced = 0;
  for (;;) {
    std::size_t voids = 0;
    for (const float height : heights) voids += std::isnan(height) ? 1 : 0;
    if (voids == 0 || voids == heights.size()) return replaced;
    std::vector<Mean> means(voids);
    sweep(heights, columns, rows, false, means);
    sweep(heights, columns, rows, true, means);
    std::size_t next = 0;
    for (float& height : heights) {
      if (!std::isnan(height)) continue;
      const Mean& mean = means[next++];
      if (mean.weight <= 0) continue;
      height = static_cast<float>(mean.sum / mean.weight);
      ++replaced;
    }
  }
}

}  // namespace vantage::internal::terrain
