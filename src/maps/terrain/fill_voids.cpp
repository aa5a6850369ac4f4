#include "maps/terrain/fill_voids.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

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

void fill_from_neighbours(std::vector<float>& heights, int columns, int rows) {
  for (;;) {
    const auto voids = static_cast<std::size_t>(
        std::count_if(heights.begin(), heights.end(), [](float height) { return std::isnan(height); }));
    if (voids == 0) return;
    std::vector<Mean> means(voids);
    sweep(heights, columns, rows, false, means);
    sweep(heights, columns, rows, true, means);
    std::size_t next = 0;
    for (float& height : heights) {
      if (!std::isnan(height)) continue;
      const Mean& mean = means[next++];
      if (mean.weight > 0) height = static_cast<float>(mean.sum / mean.weight);
    }
  }
}

class VoidFiller {
 public:
  VoidFiller(std::vector<float>& heights, int columns, int rows, const VoidFilling& filling,
             const core::ProgressReporter& progress)
      : stored_(heights), heights_(heights), columns_(columns), rows_(rows), filling_(filling), progress_(progress) {}

  Voids fill() {
    fill_from_neighbours(heights_, columns_, rows_);
    if (filling_.missing == MissingPolicy::block) measure_distances();
    const auto count = static_cast<std::uint32_t>(stored_.size());
    seen_.assign(count, false);
    for (std::uint32_t post = 0; post < count; ++post) {
      if (!seen_[post] && std::isnan(stored_[post])) fill_region(post);
    }
    keep_largest();
    return std::move(voids_);
  }

 private:
  struct Rim {
    float lowest = std::numeric_limits<float>::infinity(), highest = -std::numeric_limits<float>::infinity();

    void add(const Rim& other) {
      lowest = std::min(lowest, other.lowest);
      highest = std::max(highest, other.highest);
    }
  };
  using Tile = std::pair<int, int>;

  int column_of(std::uint32_t post) const { return static_cast<int>(post % static_cast<std::uint32_t>(columns_)); }
  int row_of(std::uint32_t post) const { return static_cast<int>(post / static_cast<std::uint32_t>(columns_)); }

  template <typename Visit>
  void each_neighbour(std::uint32_t post, const Visit& visit) const {
    const int column = column_of(post), row = row_of(post);
    for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y) {
      for (int x = std::max(0, column - 1); x <= std::min(columns_ - 1, column + 1); ++x) {
        const auto other =
            static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(columns_) + static_cast<std::uint32_t>(x);
        if (other != post) visit(other, std::hypot((x - column) * filling_.post_m[0], (y - row) * filling_.post_m[1]));
      }
    }
  }

  /// From each void to the nearest value, metres, along rows, columns and diagonals.
  void measure_distances() {
    distance_m_.assign(stored_.size(), 0);
    const auto count = static_cast<std::uint32_t>(stored_.size());
    for (std::uint32_t post = 0; post < count; ++post) {
      if (std::isnan(stored_[post])) distance_m_[post] = std::numeric_limits<float>::infinity();
    }
    const auto shorten = [&](std::uint32_t post) {
      progress_.tick();
      if (distance_m_[post] == 0) return;
      each_neighbour(post, [&](std::uint32_t other, double step) {
        distance_m_[post] = std::min(distance_m_[post], distance_m_[other] + static_cast<float>(step));
      });
    };
    for (std::uint32_t post = 0; post < count; ++post) shorten(post);
    for (std::uint32_t post = count; post > 0; --post) shorten(post - 1);
  }

  /// All voids that hang together with one, the values round them, and how wide they are.
  void find_region(std::uint32_t first) {
    posts_.assign(1, first);
    seen_[first] = true;
    for (std::size_t i = 0; i < posts_.size(); ++i) {
      progress_.tick();
      each_neighbour(posts_[i], [&](std::uint32_t other, double) {
        if (!std::isnan(stored_[other]) || seen_[other]) return;
        seen_[other] = true;
        posts_.push_back(other);
      });
    }
  }

  bool is_narrow() const {
    if (filling_.missing != MissingPolicy::block) return false;
    const auto farthest = std::max_element(posts_.begin(), posts_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return distance_m_[a] < distance_m_[b];
    });
    const double step = std::min(filling_.post_m[0], filling_.post_m[1]);
    return 2 * static_cast<double>(distance_m_[*farthest]) - step <= kNarrowVoid_m * (1 + 1e-5);
  }

  Tile tile_of(std::uint32_t post) const {
    return {static_cast<int>(column_of(post) * filling_.post_m[0] / kNarrowVoid_m),
            static_cast<int>(row_of(post) * filling_.post_m[1] / kNarrowVoid_m)};
  }

  /// The rim of the region by tiles as wide as a void may be: that of the nine round a post holds all that is so near.
  void fill_from_rim() {
    std::map<Tile, Rim> rims;
    for (const std::uint32_t post : posts_) {
      progress_.tick();
      each_neighbour(post, [&](std::uint32_t other, double) {
        const float height = stored_[other];
        if (!std::isnan(height)) rims[tile_of(other)].add({height, height});
      });
    }
    std::map<Tile, Rim> near;
    for (const std::uint32_t post : posts_) {
      progress_.tick();
      const Tile tile = tile_of(post);
      const auto [entry, is_new] = near.try_emplace(tile);
      for (int dx = -1; is_new && dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          const auto rim = rims.find({tile.first + dx, tile.second + dy});
          if (rim != rims.end()) entry->second.add(rim->second);
        }
      }
      Rim range = entry->second;
      if (filling_.height_m) {
        const auto given = static_cast<float>(*filling_.height_m);
        range.add({given, given});
      }
      set(post, range.lowest, range.highest);
    }
  }

  void set(std::uint32_t post, float lowest, float highest) {
    if (lowest < highest && voids_.lowest_m.empty()) voids_.lowest_m = heights_;
    heights_[post] = highest;
    if (!voids_.lowest_m.empty()) voids_.lowest_m[post] = lowest;
  }

  void fill_region(std::uint32_t first) {
    find_region(first);
    VoidRegion region{.posts = posts_.size(),
                      .first_column = columns_,
                      .first_row = rows_,
                      .lowest_m = std::numeric_limits<float>::infinity(),
                      .highest_m = -std::numeric_limits<float>::infinity()};
    if (is_narrow()) {
      region.filled = VoidRegion::Filled::from_rim;
      fill_from_rim();
    } else if (filling_.height_m) {
      region.filled = VoidRegion::Filled::as_given;
      const auto given = static_cast<float>(*filling_.height_m);
      for (const std::uint32_t post : posts_) set(post, given, given);
    }
    for (const std::uint32_t post : posts_) {
      region.first_column = std::min(region.first_column, column_of(post));
      region.last_column = std::max(region.last_column, column_of(post));
      region.first_row = std::min(region.first_row, row_of(post));
      region.last_row = std::max(region.last_row, row_of(post));
      region.lowest_m = std::min(region.lowest_m, voids_.lowest_m.empty() ? heights_[post] : voids_.lowest_m[post]);
      region.highest_m = std::max(region.highest_m, heights_[post]);
    }
    voids_.posts += region.posts;
    voids_.regions.push_back(region);
  }

  void keep_largest() {
    std::vector<VoidRegion>& regions = voids_.regions;
    if (regions.size() <= kMostVoidRegions) return;
    std::stable_sort(regions.begin(), regions.end(),
                     [](const VoidRegion& a, const VoidRegion& b) { return a.posts > b.posts; });
    VoidRegion& last = regions[kMostVoidRegions - 1];
    for (std::size_t i = kMostVoidRegions; i < regions.size(); ++i) {
      const VoidRegion& other = regions[i];
      ++last.others;
      last.posts += other.posts;
      last.first_column = std::min(last.first_column, other.first_column);
      last.first_row = std::min(last.first_row, other.first_row);
      last.last_column = std::max(last.last_column, other.last_column);
      last.last_row = std::max(last.last_row, other.last_row);
      last.lowest_m = std::min(last.lowest_m, other.lowest_m);
      last.highest_m = std::max(last.highest_m, other.highest_m);
    }
    regions.resize(kMostVoidRegions);
  }

  const std::vector<float> stored_;
  std::vector<float>& heights_;
  int columns_, rows_;
  const VoidFilling& filling_;
  const core::ProgressReporter& progress_;
  Voids voids_;
  std::vector<float> distance_m_;
  std::vector<bool> seen_;
  std::vector<std::uint32_t> posts_;  // of the region at hand
};

}  // namespace

Voids fill_voids(std::vector<float>& heights, int columns, int rows, const VoidFilling& filling,
                 const core::ProgressReporter& progress) {
  const auto voids = std::count_if(heights.begin(), heights.end(), [](float height) { return std::isnan(height); });
  if (voids == 0 || static_cast<std::size_t>(voids) == heights.size()) return {};
  return VoidFiller(heights, columns, rows, filling, progress).fill();
}

}  // namespace vantage::internal::terrain
