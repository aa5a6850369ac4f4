// What the balls that touch the target's plane in its corners have in common is convex.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/enclosing_circle.h"
#include "solid/numerics.h"
#include "solid/sensor_region_builder.h"
#include "solid/star_surface.h"

namespace vantage::internal::solid {

template <>
void add_regions<Limit::pixel>(const PixelLimit& pixel, const sensor::ViewedPart& part, SensorRegionBuilder& builder) {
  const double radius = pixel.size_m * *builder.sensor().camera->focal_px / 2;
  // In the plane of their centres, which are the corners moved along the normal, no point lies deeper in all of them
  // than the one from which the farthest is nearest.
  const Vec3 u = any_across(*part.normal), v = part.normal->cross(u);
  std::vector<Eigen::Vector2d> centres;
  for (const Vec3& corner : part.corners) centres.emplace_back(u.dot(corner), v.dot(corner));
  const core::Circle circle = core::smallest_enclosing_circle(centres);
  if (!(circle.radius < (1 - numerics::kLeastDistance) * radius)) return builder.keep("pixel", Solid());
  const double height = part.normal->dot(part.centre) + radius;
  const Vec3 inside = circle.centre.x() * u + circle.centre.y() * v + height * *part.normal;
  Mesh mesh = star_inside(
      [&](const Vec3& direction) {
        double reach = std::numeric_limits<double>::infinity();
        for (const Vec3& corner : part.corners) {
          const Vec3 from = inside - corner - radius * *part.normal;
          const double along = direction.dot(from);
          reach = std::min(reach, std::sqrt(along * along + radius * radius - from.squaredNorm()) - along);
        }
        return (1 - numerics::kInward) * reach;
      },
      numerics::kPixelShare);
  for (Vec3& vertex : mesh.vertices) vertex += inside;
  builder.keep("pixel", builder.solid_of(mesh, "pixel"));
}

}  // namespace vantage::internal::solid
