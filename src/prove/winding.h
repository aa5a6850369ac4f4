// How often a closed surface winds round a point.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// Which way a segment passes through a triangle, decided exactly: 1 outward, -1 inward, 0 where it does not; nothing
/// where it meets the outline, or an end lies in the triangle's plane. A triangle without area is not there.
std::optional<int> passage(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle);

/// Counted along rays that are nearly upright, so that few boxes lie on one. Add every triangle, then ask.
class Winding {
 public:
  static constexpr std::size_t kRays = 4;
  static const std::array<Vec3, kRays>& ways();

  /// `box`: holds the whole surface.
  Winding(const Vec3& point, const Box& box);

  void add(const std::array<Vec3, 3>& corners);

  /// Exact, of the numbers as they are. Nothing where the point lies on a triangle, or where all rays meet edges; or
  /// where a triangle is as near as `unsure_m`: the surface that the numbers were rounded from may then lie on the
  /// other side of the point.
  std::optional<int> turns(double unsure_m) const;

 private:
  struct Ray {
    Vec3 end = Vec3::Zero(), low = Vec3::Zero(), high = Vec3::Zero();
    int turns = 0;
    bool is_known = true;
  };
  Vec3 point_;
  std::array<Ray, kRays> rays_;
  double nearest_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace vantage::internal::prove
