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
  static const SphereMesh sphere = make_sphere_for(numerics::kMinRangeShare);
  const double radius = min_range_m / portable::cos(sphere.cover);
  double extent = 0;
  for (const Vec3& corner : part.corners) extent = std::max(extent, 2 * (corner - part.centre).norm());
  // Directions of a facet's corners lie within `cover` of its normal. So these are all corners of facets that reach in
  // front of the part.
  const auto may_matter = [&](const Vec3& direction) {
    return !part.normal || part.normal->dot(direction) >= -2 * sphere.cover;
  };
  std::vector<Vec3> points;
  for (const Vec3& direction : sphere.mesh.vertices) {
    if (!may_matter(direction)) continue;
    // Its vertices matter at those corners only that lie farthest in nearly their directions.
    const double least = most_along(part.corners, direction) - 2 * sphere.cover * extent;
    for (const Vec3& corner : part.corners) {
      if (corner.dot(direction) >= least) points.push_back(corner + radius * direction);
    }
  }
  Mesh mesh = convex_hull(points);
  const auto is_in_front = [&](const Triangle& facet) {
    return !part.normal || std::any_of(facet.begin(), facet.end(), [&](std::uint32_t v) {
      return part.normal->dot(mesh.vertices[v] - part.centre) > 0;
    });
  };
  const auto most = [&](const Vec3& direction) {
    return most_along(part.corners, direction) + min_range_m * direction.norm();
  };
  grow_to_hold(mesh, part.centre, most, is_in_front);
  builder.forbid("min_range", mesh);
}

}  // namespace vantage::internal::solid
