#include "exact/vertex_snapper.h"

#include <bit>
#include <cmath>

namespace vantage::internal::exact {
namespace {

constexpr std::uint32_t kNone = ~0u;
constexpr double kLow = 1e-3;     // over the horizon
constexpr double kBucket = 4096;  // snapping distances; so large that a point seldom needs a look into a second bucket

}  // namespace

VertexSnapper::VertexSnapper(std::size_t expected, double snap) : snap_(snap), bucket_(kBucket * snap) {
  points_.reserve(expected);
  next_.reserve(expected);
  heads_.assign(std::bit_ceil(2 * expected + 16), kNone);
}

std::size_t VertexSnapper::slot_of(std::int64_t x, std::int64_t y) const {
  std::uint64_t h =
      static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ull + static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4full;
  h ^= h >> 29;
  return (h * 0xbf58476d1ce4e5b9ull >> 20) & (heads_.size() - 1);
}

std::uint32_t VertexSnapper::find(std::int64_t x, std::int64_t y, const OctahedralPoint& point) const {
  for (std::uint32_t i = heads_[slot_of(x, y)]; i != kNone; i = next_[i])
    if ((points_[i] - point).cwiseAbs().maxCoeff() <= snap_) return i;
  return kNone;
}

std::uint32_t VertexSnapper::add(OctahedralPoint point) {
  const double sum = std::abs(point.x()) + std::abs(point.y());
  for (const int axis : {0, 1}) {
    if (std::abs(point[axis]) > snap_) continue;
    point[axis] = 0;
    // Near the horizon at the same height over it: another one is far off the steep planes that meet there.
    if (sum > 1 - kLow) point[1 - axis] = std::copysign(sum, point[1 - axis]);
  }
  const bool horizon = sum >= 1 - snap_;
  if (horizon) point /= sum;
  const std::int64_t x0 = bucket_of(point.x() - snap_), x1 = bucket_of(point.x() + snap_);
  const std::int64_t y0 = bucket_of(point.y() - snap_), y1 = bucket_of(point.y() + snap_);
  for (std::int64_t x = x0; x <= x1; ++x) {
    for (std::int64_t y = y0; y <= y1; ++y)
      if (const std::uint32_t found = find(x, y, point); found != kNone) return found;
  }
  if (2 * points_.size() > heads_.size()) grow();
  const std::size_t slot = slot_of(bucket_of(point.x()), bucket_of(point.y()));
  points_.push_back(point);
  horizon_.push_back(horizon);
  next_.push_back(heads_[slot]);
  heads_[slot] = static_cast<std::uint32_t>(points_.size() - 1);
  return heads_[slot];
}

void VertexSnapper::grow() {
  heads_.assign(2 * heads_.size(), kNone);
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const std::size_t slot = slot_of(bucket_of(points_[i].x()), bucket_of(points_[i].y()));
    next_[i] = heads_[slot];
    heads_[slot] = i;
  }
}

}  // namespace vantage::internal::exact
