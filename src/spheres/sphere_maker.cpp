#include "spheres/sphere_maker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/stopwatch.h"
#include "options/spheres_options.h"
#include "spheres/sphere_mesh.h"
#include "vantage/error.h"

namespace vantage::internal::spheres {
double range_tolerance(const SpheresOptions& options, double range_m) {
  // Half the diagonal of the widest cell of directions.
  double half_diagonal = std::numbers::sqrt2 / options.cubemap;
  if (options.resolution) {
    const double longitude = 2 * std::numbers::pi / (*options.resolution)[0];
    const double latitude = std::numbers::pi / (*options.resolution)[1];
    half_diagonal = 0.5 * std::hypot(longitude, latitude);
  }
  const double sagitta = 1 - std::cos(std::min(half_diagonal, std::numbers::pi / 2));
  // A joined facet is off its cells by the tolerance of joining, and drawn in by as much.
  const double joined = options.resolution ? 0 : 2 * options.merge;
  return range_m * std::min(sagitta + joined, 1.0);
}

SphereMaker::SphereMaker(depth::DepthRenderer& renderer, const SpheresOptions& options, double range_m,
                         const TargetFrame& frame, bool front_only)
    : renderer_(renderer),
      options_(options),
      range_m_(range_m),
      frame_(frame),
      front_only_(front_only),
      face_size_(options::face_size(options)) {}

StarMesh SphereMaker::tessellated(std::span<const float> inverse_depths) const {
  const CubeMap cube{face_size_, inverse_depths};
  const Vec3* front = front_only_ ? &frame_.normal : nullptr;
  if (options_.sphere == SpheresOptions::Sphere::centers) {
    return options_.resolution ? join_lonlat(cube, *options_.resolution, range_m_)
                               : join_centers(cube, range_m_, options_.merge);
  }
  return options_.resolution ? bound_lonlat(cube, *options_.resolution, range_m_, front)
                             : bound_corners(cube, range_m_, front, options_.merge);
}

void SphereMaker::make(const std::vector<Vec3>& points, const std::function<void(std::size_t, Sphere)>& sink) const {
  std::vector<Vec3> viewpoints;
  for (const Vec3& p : points) viewpoints.push_back(frame_.to_scene(p));
  depth::DepthRequest request;
  request.viewpoints = viewpoints;
  request.face_size = face_size_;
  request.sampling =
      options_.sphere == SpheresOptions::Sphere::centers ? depth::Sampling::centers : depth::Sampling::nearest;
  request.range_m = range_m_;
  Placement placement;
  placement.to_mesh.row(0) = frame_.axis_u;
  placement.to_mesh.row(1) = frame_.axis_v;
  placement.to_mesh.row(2) = frame_.normal;
  placement.front_only = front_only_;
  core::Stopwatch stopwatch;
  renderer_.render(request, [&](std::size_t index, std::span<const float> inverse_depths) {
    const StarMesh star = tessellated(inverse_depths);
    placement.viewpoint = points[index];
    Sphere sphere{placed(star, placement), reach(star, placement), 0};
    sphere.seconds = stopwatch.lap();
    sink(index, std::move(sphere));
    stopwatch.lap();  // what was done with it is not its time
  });
}

}  // namespace vantage::internal::spheres
