#include "depth/center_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::internal::depth {
namespace {

// Neighbours overlap by this much in u, so that rounding leaves no crack between them.
constexpr double kSeam = 1e-12;

struct Crossing {
  double u, q;
};

/// Where the border of the polygon, in (u, v, q) = (right / forward, up / forward, 1 / forward), crosses a line of
/// constant v: leftmost and rightmost. False when it does not.
bool cross_row(std::span<const Vec3> corners, double v, Crossing& left, Crossing& right) {
  left.u = std::numeric_limits<double>::infinity();
  right.u = -left.u;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& a = corners[i];
    const Vec3& b = corners[i + 1 == corners.size() ? 0 : i + 1];
    const double at_a = a.y() - v * a.z(), at_b = b.y() - v * b.z();
    if ((at_a < 0) == (at_b < 0)) continue;
    const Vec3 p = a + at_a / (at_a - at_b) * (b - a);
    const Crossing crossing{p.x() / p.z(), 1 / p.z()};
    if (crossing.u < left.u) left = crossing;
    if (crossing.u > right.u) right = crossing;
  }
  return left.u <= right.u;
}

}  // namespace

void draw_at_centers(const FaceBand& band, std::span<const Vec3> corners, std::span<float> inverse_depths) {
  if (corners.empty()) return;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& p : corners) {
    low = std::min(low, p.y() / p.z());
    high = std::max(high, p.y() / p.z());
  }
  // First texel whose centre is not before a coordinate, and last one whose centre is not after it.
  const auto place = [&](double coordinate) { return (std::clamp(coordinate, -2.0, 2.0) + 1) * 0.5 * band.size - 0.5; };
  const auto first_from = [&](double coordinate) { return static_cast<int>(std::ceil(place(coordinate))); };
  const auto last_to = [&](double coordinate) { return static_cast<int>(std::floor(place(coordinate))); };
  const double step = 2.0 / band.size;
  const int last_row = std::min(last_to(high + kSeam), band.row_end - 1);
  for (int row = std::max(first_from(low - kSeam), band.row_begin); row <= last_row; ++row) {
    Crossing left{}, right{};
    if (!cross_row(corners, band.centre(row), left, right)) continue;
    float* texels = inverse_depths.data() + static_cast<std::size_t>(row - band.row_begin) * band.size;
    const double slope = right.u > left.u ? (right.q - left.q) / (right.u - left.u) : 0;
    const double least = std::min(left.q, right.q), most = std::max(left.q, right.q);
    const int first = std::max(first_from(left.u - kSeam), 0), last = std::min(last_to(right.u + kSeam), band.size - 1);
    const double start = left.q + slope * (band.centre(first) - left.u);
    for (int i = first; i <= last; ++i) {
      const double q = std::min(std::max(start + slope * (step * (i - first)), least), most);
      texels[i] = std::max(texels[i], static_cast<float>(q));
    }
  }
}

}  // namespace vantage::internal::depth
