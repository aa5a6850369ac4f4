// Points of the octahedral map that differ by rounding become one vertex.
#pragma once

#include <cstdint>
#include <vector>

#include "exact/octahedral_map.h"

namespace vantage::internal::exact {

/// Gives points indices; a point within `snap` of an earlier one gets that one's index. Coordinates that close
/// to an axis are put on it, and points that close to the horizon |a| + |b| = 1 are on the horizon.
class VertexSnapper {
 public:
  VertexSnapper(std::size_t expected, double snap);

  std::uint32_t add(OctahedralPoint point);

  const std::vector<OctahedralPoint>& points() const { return points_; }
  bool on_horizon(std::uint32_t index) const { return horizon_[index]; }

 private:
  std::uint32_t find(std::int64_t x, std::int64_t y, const OctahedralPoint& point) const;
  std::size_t slot_of(std::int64_t x, std::int64_t y) const;
  std::int64_t bucket_of(double coordinate) const {
    return static_cast<std::int64_t>(std::floor(coordinate / bucket_));
  }
  void grow();

  double snap_, bucket_;
  std::vector<OctahedralPoint> points_;
  std::vector<bool> horizon_;
  std::vector<std::uint32_t> next_;   // the next vertex in the same bucket
  std::vector<std::uint32_t> heads_;  // hash table of buckets
};

}  // namespace vantage::internal::exact
