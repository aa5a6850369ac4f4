#include "depth/seen_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace vantage::internal::depth {
namespace {

/// Twice the largest distance of a corner from the mean plane (Newell's normal): the triangles that were merged into
/// the polygon lie between its corners.
double unevenness(const PreparedScene::Data& data, std::uint32_t polygon) {
  const auto corners = data.corners_of(polygon);
  if (corners.size() <= 3) return 0;
  const Vec3& base = data.vertices[corners[0]];
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += (data.vertices[corners[i]] - base).cross(data.vertices[corners[i + 1]] - base);
  }
  normal.normalize();
  double low = 0, high = 0;
  for (const std::uint32_t corner : corners) {
    const double height = normal.dot(data.vertices[corner] - base);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return 2 * (high - low);
}

}  // namespace

SeenScene::SeenScene(const PreparedScene& scene) : scene_(scene), unevenness_(scene.data().polygon_count()) {
  parallel::for_ranges(unevenness_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double exact = unevenness(data(), static_cast<std::uint32_t>(i));
      unevenness_[i] = exact == 0 ? 0 : std::nextafter(static_cast<float>(exact), 1.0F);
    }
  });
}

ViewedPolygon SeenScene::polygon(std::uint32_t number, const Vec3& eye, std::vector<Vec3>& storage) const {
  // Subtracting the viewpoint and cutting at the borders of a face: a few roundings of the largest coordinate.
  constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
  storage.clear();
  double largest = 0;
  for (const std::uint32_t corner : data().corners_of(number)) {
    storage.push_back(data().vertices[corner] - eye);
    largest = std::max(largest, storage.back().cwiseAbs().maxCoeff());
  }
  return {storage, kRounding * largest + unevenness_[number]};
}

}  // namespace vantage::internal::depth
