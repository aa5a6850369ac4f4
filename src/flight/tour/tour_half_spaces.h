// The shortest way from a to b that touches an intersection of a few half-spaces.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "vantage/geometry.h"

namespace vantage::internal::flight::tour {

/// At most kMost of them: the oldest one goes when one more is added.
class HalfSpaces {
 public:
  static constexpr std::size_t kMost = 10;

  /// inward . x >= offset; `inward` is a unit vector.
  void add(const Vec3& inward, double offset);

  /// The point of them all with the least |a - x| + |x - b|, of the faces, edges and corners where it may be (it is at
  /// one of these, or on the segment ab); nothing where they have nothing in common. Of the points of a segment the one
  /// nearest to its middle.
  std::optional<Vec3> shortest_way(const Vec3& a, const Vec3& b, double smoothing) const;

 private:
  struct Plane {
    Vec3 inward;
    double offset;
  };
  struct Best;

  bool hold(const Vec3& point, double slack) const;
  std::optional<Vec3> on_segment(const Vec3& a, const Vec3& b, double slack) const;

  std::array<Plane, kMost> planes_;
  std::size_t count_ = 0, oldest_ = 0;
};

}  // namespace vantage::internal::flight::tour
