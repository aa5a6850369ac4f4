// A polyhedron round the ball, at each corner.
#include <algorithm>

#include "core/portable_math.h"
#include "solid/convex_body.h"
#include "solid/convex_hull.h"
#include "solid/numerics.h"
#include "solid/sensor_region_builder.h"

namespace vantage::internal::solid {

template <>
void add_regions<Limit::min_range>(const double& min_range_m, const sensor::ViewedPart& part,
                                   SensorRegionBuilder& builder) {
  const SphereMesh sphere = make_sphere_for(numerics::kMinRangeShare);
  const double radius = min_range_m / portable::cos(sphere.cover);
  double extent = 0;
  for (const Vec3& corner : part.corners) extent = std::max(extent, 2 * (corner - part.centre).norm());
  std::vector<Vec3> points;
  for (const Vec3& direction : sphere.mesh.vertices) {
    // Its vertices matter at those corners only that lie farthest in nearly their directions.
    const double least = most_along(part.corners, direction) - 2 * sphere.cover * extent;
    for (const Vec3& corner : part.corners) {
      if (corner.dot(direction) >= least) points.push_back(corner + radius * direction);
    }
  }
  Mesh mesh = convex_hull(points);
  grow_to_hold(mesh, part.centre, [&](const Vec3& direction) {
    return most_along(part.corners, direction) + min_range_m * direction.norm();
  });
  builder.forbid("min_range", mesh);
}

}  // namespace vantage::internal::solid
