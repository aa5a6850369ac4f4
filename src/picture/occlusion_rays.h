// What of the scene stands between a picture's subject and its viewer.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "picture/draw_list.h"
#include "vantage/geometry.h"

namespace vantage::internal::picture {

/// Rays against the scene's triangles, in single precision: good enough for where to stand, and for nothing else.
class OcclusionRays {
 public:
  /// Throws Error(cancelled).
  OcclusionRays(const Mesh& mesh, const Vec3& origin, const core::ProgressReporter& progress = {});
  ~OcclusionRays();
  OcclusionRays(const OcclusionRays&) = delete;
  OcclusionRays& operator=(const OcclusionRays&) = delete;

  /// Calls `visit` with each triangle between `point` and a viewer in direction `towards` (to infinity) or, as a
  /// difference of points, at its end. Stops when `visit` returns false.
  void each_hit(const Vec3& point, const Vec3& towards, bool to_infinity,
                const std::function<bool(std::uint32_t triangle)>& visit) const;

 private:
  struct Rays;
  std::unique_ptr<Rays> rays_;
  Vec3 origin_;
};

/// Degrees round from the east from where, at this elevation, the scene hides least of the target and the volume; of
/// equals the one nearest to `preferred`.
double best_azimuth(const OcclusionRays& occlusion_rays, const PictureExtent& extent, const std::vector<Vec3>& target,
                    double elevation_deg, double preferred, const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::picture
