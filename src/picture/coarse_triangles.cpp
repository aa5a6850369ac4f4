#include "picture/coarse_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "core/parallel.h"

namespace vantage::internal::picture {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// The cells that hold vertices, numbered as they come, and the mean place of the vertices in each.
class Cells {
 public:
  Cells(float cell, std::size_t vertices) : cell_(cell) { number_.reserve(vertices / 8); }

  std::uint32_t add(const Eigen::Vector3f& place) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      constexpr std::int64_t kMiddle = 1 << 20;  // cells each way, which wrap round far beyond any picture
      const auto at = static_cast<std::int64_t>(std::floor(place[axis] / cell_)) + kMiddle;
      key = key << 21 | (static_cast<std::uint64_t>(at) & 0x1fffff);
    }
    const auto [entry, is_new] = number_.try_emplace(key, static_cast<std::uint32_t>(sums_.size()));
    if (is_new) sums_.push_back(Eigen::Vector4d::Zero());
    sums_[entry->second] += Eigen::Vector4d(place.x(), place.y(), place.z(), 1);
    return entry->second;
  }

  Eigen::Vector3f mean(std::uint32_t number) const {
    return (sums_[number].head<3>() / sums_[number].w()).cast<float>();
  }

 private:
  float cell_;
  std::unordered_map<std::uint64_t, std::uint32_t> number_;
  std::vector<Eigen::Vector4d> sums_;
};

}  // namespace

std::vector<Eigen::Vector3f> coarse_triangles(const std::vector<DrawVertex>& triangles, float cell,
                                              const core::ProgressReporter& progress) {
  Cells cells(cell, triangles.size());
  std::vector<Corners> kept;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    progress.tick();
    Corners corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = cells.add(triangles[i + k].position);
    std::sort(corners.begin(), corners.end());
    if (corners[0] != corners[1] && corners[1] != corners[2]) kept.push_back(corners);
  }
  parallel::sort(kept, std::less<>(), progress);  // equal ones are the same either way
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  std::vector<Eigen::Vector3f> result;
  result.reserve(3 * kept.size());
  for (const Corners& corners : kept) {
    for (const std::uint32_t corner : corners) result.push_back(cells.mean(corner));
  }
  return result;
}

}  // namespace vantage::internal::picture
