#include "core/facet_polygon.h"

#include <Eigen/Geometry>
#include <array>

#include "vantage/error.h"

namespace vantage::internal::core {

void make_facet_square(const Plane& plane, double range, FacetPolygon& polygon) {
  const double size = plane.norm();
  const Vec3 normal = plane / size, foot = normal / size;
  const Vec3 axis_1 = normal.unitOrthogonal() * (1.01 * range), axis_2 = normal.cross(axis_1);
  polygon.corners.assign(
      {foot - axis_1 - axis_2, foot + axis_1 - axis_2, foot + axis_1 + axis_2, foot - axis_1 + axis_2});
  polygon.makers.assign(4, FacetPolygon::kFar);
}

bool clip_facet(FacetPolygon& polygon, const Vec3& normal, double height, double margin, std::uint32_t maker,
                FacetPolygon& scratch) {
  const std::size_t n = polygon.corners.size();
  constexpr std::size_t kMost = 512;  // a square, cut by the planes of two blockers: about 270 at most
  if (n > kMost)
    throw Error(ErrorCode::internal_defect, "a facet has too many corners", "envelope", "please report this");
  std::array<double, kMost> values;
  bool any_inside = false, any_outside = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double value = normal.dot(polygon.corners[i]) - height;
    values[i] = std::abs(value) <= margin ? 0 : value;
    any_inside |= values[i] > 0;
    any_outside |= values[i] < 0;
  }
  if (!any_outside) return false;
  if (!any_inside) {
    polygon.clear();
    return true;
  }
  scratch.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = i + 1 == n ? 0 : i + 1;
    const double a = values[i], b = values[j];
    if (a >= 0) {
      scratch.corners.push_back(polygon.corners[i]);
      scratch.makers.push_back(a == 0 && b < 0 ? maker : polygon.makers[i]);
    }
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
      scratch.corners.push_back(polygon.corners[i] + (a / (a - b)) * (polygon.corners[j] - polygon.corners[i]));
      scratch.makers.push_back(a > 0 ? maker : polygon.makers[i]);
    }
  }
  std::swap(polygon.corners, scratch.corners);
  std::swap(polygon.makers, scratch.makers);
  return true;
}

}  // namespace vantage::internal::core
