#include "sensor/rise.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace vantage::internal::sensor {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostLeast = 6;

/// The planes that are least at a place, but for rounding; a few of them where there are many.
class LeastPlanes {
 public:
  LeastPlanes(std::span<const Plane2> planes, const Vector2d& place) {
    slopes_.fill(Vector2d::Zero());
    constexpr double kRounding = 1e-12;
    double largest = 0;
    for (const Plane2& plane : planes) {
      height_ = std::min(height_, plane.at(place));
      largest = std::max(largest, std::abs(plane.value));
    }
    for (const Plane2& plane : planes) {
      if (count_ < kMostLeast && plane.at(place) <= height_ + kRounding * largest) slopes_[count_++] = plane.slope;
    }
  }

  double height() const { return height_; }

  /// The way up that is steepest: the shortest vector in the convex hull of the slopes (Wolfe 1976). `stays`: of each
  /// variable, whether it must not change. Zero at the top.
  Vector2d uphill(const std::array<bool, 2>& stays) const {
    std::array<Vector2d, kMostLeast> slopes = slopes_;
    for (std::size_t i = 0; i < count_; ++i) {
      for (Eigen::Index axis = 0; axis < 2; ++axis) {
        if (stays[static_cast<std::size_t>(axis)]) slopes[i][axis] = 0;
      }
    }
    Vector2d best = slopes[0];
    double steepest = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      steepest = std::max(steepest, slopes[i].squaredNorm());
      for (std::size_t k = 0; k < i; ++k) {
        const Vector2d across = slopes[k] - slopes[i];
        const double length = across.squaredNorm();
        const double part = length > 0 ? std::clamp(-slopes[i].dot(across) / length, 0.0, 1.0) : 0;
        const Vector2d nearest = slopes[i] + part * across;
        if (nearest.squaredNorm() < best.squaredNorm()) best = nearest;
      }
      if (slopes[i].squaredNorm() < best.squaredNorm()) best = slopes[i];
    }
    constexpr double kFlat = 1e-10;
    for (std::size_t i = 0; i < count_; ++i) {
      if (slopes[i].dot(best) < best.squaredNorm() - kFlat * steepest) return Vector2d::Zero();
    }
    return best;
  }

 private:
  double height_ = std::numeric_limits<double>::infinity();
  std::array<Vector2d, kMostLeast> slopes_;
  std::size_t count_ = 0;
};

/// Those that can be the least somewhere within reach.
std::vector<Plane2> low_planes(std::span<const Plane2> planes, double reach) {
  double most = std::numeric_limits<double>::infinity();  // that the least of them can be
  for (const Plane2& plane : planes) most = std::min(most, plane.value + reach * plane.slope.lpNorm<1>());
  std::vector<Plane2> low;
  low.reserve(planes.size());
  for (const Plane2& plane : planes) {
    if (plane.value - reach * plane.slope.lpNorm<1>() <= most) low.push_back(plane);
  }
  return low;
}

}  // namespace

Vector2d rise(std::span<const Plane2> all, const Room& room) {
  constexpr int kMostRidges = 12;
  const std::vector<Plane2> planes = low_planes(all, room.reach);
  const Vector2d min = room.min.cwiseMax(-room.reach), max = room.max.cwiseMin(room.reach);
  Vector2d place = Vector2d::Zero();
  for (int ridge = 0; ridge < kMostRidges; ++ridge) {
    const LeastPlanes least(planes, place);
    std::array<bool, 2> stays{};
    Vector2d way = least.uphill(stays);
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const bool is_at_end = (way[axis] > 0 && place[axis] >= max[axis]) || (way[axis] < 0 && place[axis] <= min[axis]);
      if (!is_at_end) continue;
      stays[static_cast<std::size_t>(axis)] = true;
      way = least.uphill(stays);
    }
    const double rate = way.squaredNorm();
    if (!(rate > 0)) break;
    double far = std::numeric_limits<double>::infinity();
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      if (way[axis] > 0) far = std::min(far, (max[axis] - place[axis]) / way[axis]);
      if (way[axis] < 0) far = std::min(far, (min[axis] - place[axis]) / way[axis]);
    }
    for (const Plane2& plane : planes) {
      const double slower = rate - plane.slope.dot(way);
      if (slower > 1e-9 * rate) far = std::min(far, (plane.at(place) - least.height()) / slower);
    }
    place = (place + far * way).cwiseMax(min).cwiseMin(max);
  }
  return place;
}

}  // namespace vantage::internal::sensor
