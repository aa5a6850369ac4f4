#include "verify/segment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "verify/tolerances.h"

namespace vantage::internal::verify {

FlatTriangle::FlatTriangle(const Vec3& a, const Vec3& b, const Vec3& c)
    : corner(a), edge1(b - a), edge2(c - a), normal(edge1.cross(edge2)) {
  longest = std::sqrt(std::max({edge1.squaredNorm(), edge2.squaredNorm(), (c - b).squaredNorm()}));
  normal_length = normal.norm();
  if (normal_length <= kThinnest * longest * longest) normal_length = 0;
}

Box FlatTriangle::bounds() const {
  Box box;
  box.extend(corner);
  box.extend(second());
  box.extend(third());
  return box;
}

namespace {

/// From a point of the segment to the nearest point of an edge, for about the nearest one of them (Ericson
/// 2004, 5.1.9).
Vec3 way_to_edge(const Segment& segment, const Vec3& start, const Vec3& edge) {
  const Vec3 offset = segment.from - start;
  const double a = segment.direction.squaredNorm(), e = edge.squaredNorm(), b = segment.direction.dot(edge);
  const double c = segment.direction.dot(offset), f = edge.dot(offset), crossed = a * e - b * b;
  double along = crossed > 0 ? std::clamp((b * f - c * e) / crossed, 0.0, 1.0) : 0.0;
  const double on_edge = e > 0 ? std::clamp((b * along + f) / e, 0.0, 1.0) : 0.0;
  if (a > 0) along = std::clamp((b * on_edge - c) / a, 0.0, 1.0);
  return start + on_edge * edge - segment.at(along);
}

/// Whether a plane between them shows that the two are apart. That is found for needles too, whose own plane rounding
/// leaves open: the plane is across the way from the segment to one of the edges, and need not be exact.
bool are_certainly_apart(const Segment& segment, const FlatTriangle& triangle, double magnitude) {
  const Vec3 from = segment.from - triangle.corner;
  const double error = kApartError * (magnitude + triangle.longest);
  const std::array<std::pair<Vec3, Vec3>, 3> edges = {{{triangle.corner, triangle.edge1},
                                                       {triangle.corner, triangle.edge2},
                                                       {triangle.second(), triangle.edge2 - triangle.edge1}}};
  return std::any_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const Vec3 way = way_to_edge(segment, edge.first, edge.second);
    const double length = way.norm();
    if (!(length > 0)) return false;
    const Vec3 axis = way / length;
    const double nearest = std::min({0.0, axis.dot(triangle.edge1), axis.dot(triangle.edge2)});
    return nearest - (axis.dot(from) + std::max(0.0, axis.dot(segment.direction))) > error;
  });
}

}  // namespace

Intersection intersect(const Segment& segment, const FlatTriangle& triangle) {
  if (triangle.normal_length == 0) return {};
  const Vec3 from = segment.from - triangle.corner;
  const double magnitude = from.norm() + segment.length;
  const double longest = triangle.longest;
  const double side_error = kPlaneError * magnitude * longest * longest;
  const double side_from = triangle.normal.dot(from);
  const double side_to = triangle.normal.dot(segment.to - triangle.corner);
  if ((side_from > side_error && side_to > side_error) || (side_from < -side_error && side_to < -side_error)) return {};

  const double gap = side_from - side_to;
  if (std::abs(gap) <= 4 * side_error) {  // runs (almost) in the plane
    return {are_certainly_apart(segment, triangle, magnitude) ? Contact::none : Contact::unsure, 0, 0, 0};
  }
  Intersection result;
  result.position = side_from / gap;
  const Vec3 hit = from + result.position * segment.direction;
  const double hit_error = segment.length * (4 * side_error / std::abs(gap)) + 8 * kRoundoff * magnitude;

  const double scale = 1 / (triangle.normal_length * triangle.normal_length);
  const double third = triangle.normal.dot(triangle.edge1.cross(hit)) * scale;
  const double second = triangle.normal.dot(hit.cross(triangle.edge2)) * scale;
  const double border = std::min({third, second, 1 - second - third});
  const double thinness = longest * longest / triangle.normal_length;
  const double border_error =
      longest * hit_error / triangle.normal_length + kPlaneError * thinness * (1 + std::abs(second) + std::abs(third));
  if (border < -border_error) return {};

  const bool sides_certain = std::abs(side_from) > side_error && std::abs(side_to) > side_error;
  const bool crosses = sides_certain && border > border_error;
  if (!crosses && are_certainly_apart(segment, triangle, magnitude)) return {};
  result.contact = crosses ? Contact::crossing : Contact::unsure;
  result.border = border - border_error;
  result.turn = gap < 0 ? 1 : -1;
  return result;
}

namespace {

double distance_to_edge(const Vec3& point, const Vec3& start, const Vec3& edge) {
  const double squared = edge.squaredNorm();
  const double along = squared > 0 ? std::clamp(edge.dot(point - start) / squared, 0.0, 1.0) : 0.0;
  return (point - start - along * edge).norm();
}

}  // namespace

double distance(const Vec3& point, const FlatTriangle& triangle) {
  const Vec3 offset = point - triangle.corner;
  if (triangle.normal_length > 0) {
    const double third = triangle.normal.dot(triangle.edge1.cross(offset));
    const double second = triangle.normal.dot(offset.cross(triangle.edge2));
    const double first = triangle.normal_length * triangle.normal_length - second - third;
    if (std::min({first, second, third}) >= 0) return std::abs(triangle.normal.dot(offset)) / triangle.normal_length;
  }
  return std::min({distance_to_edge(point, triangle.corner, triangle.edge1),
                   distance_to_edge(point, triangle.corner, triangle.edge2),
                   distance_to_edge(point, triangle.second(), triangle.edge2 - triangle.edge1)});
}

}  // namespace vantage::internal::verify
