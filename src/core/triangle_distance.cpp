#include "core/triangle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::internal::core {
namespace {

double squared_distance_to_edge(const Vec3& point, const Vec3& start, const Vec3& end) {
  const Vec3 edge = end - start;
  const double length = edge.squaredNorm();
  const double along = length > 0 ? std::clamp(edge.dot(point - start) / length, 0.0, 1.0) : 0.0;
  return (point - start - along * edge).squaredNorm();
}

}  // namespace

double squared_distance_to_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double of_edges = std::min({squared_distance_to_edge(point, a, b), squared_distance_to_edge(point, b, c),
                                    squared_distance_to_edge(point, c, a)});
  const Vec3 normal = (b - a).cross(c - a);
  const auto left_of = [&](const Vec3& from, const Vec3& to) {
    return normal.dot((to - from).cross(point - from)) >= 0;
  };
  if (!(normal.squaredNorm() > 0 && left_of(a, b) && left_of(b, c) && left_of(c, a))) return of_edges;
  const double height = normal.dot(point - a);
  // The normal of a sliver may be off by any angle. But no point of a triangle is farther from its edges than the
  // radius of the circle in it, half its width at most.
  constexpr double kRounding = 32 * std::numeric_limits<double>::epsilon();
  const double longest = std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  const double least = std::sqrt(of_edges) - normal.norm() / (2 * longest) - kRounding * longest;
  return std::min(of_edges, std::max(height * height / normal.squaredNorm(), least > 0 ? least * least : 0.0));
}

}  // namespace vantage::internal::core
