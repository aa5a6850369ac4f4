// First hits of rays from one point, by Embree 3.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "depth/seen_scene.h"

namespace vantage::internal::depth {

/// The version of Embree: "3.13.5".
std::string ray_caster_version();

/// Casts rays into a scene's polygons. Embree works in single precision relative to the scene's origin: it tells which
/// polygon a ray meets first, and the depth is computed from that polygon's plane in double precision. Safe from many
/// threads.
class RayCaster {
 public:
  /// Keeps `scene` by reference. Cost: O(n log n). Throws Error(input) when there is no memory for its hierarchy.
  explicit RayCaster(const SeenScene& scene);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// Polygons nearer to the viewpoint than this, in metres, must be drawn in another way: rays may start on their wrong
  /// side. `eye` is relative to the scene's origin.
  double near_distance(const Vec3& eye) const;

  /// Inverse depths along the centres of the band's texels; texels without a hit keep 0. `skipped`, sorted: polygons
  /// that are not looked at.
  void cast(const FaceBand& band, const Vec3& eye, double range, std::span<const std::uint32_t> skipped,
            std::span<float> inverse_depths) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage::internal::depth
