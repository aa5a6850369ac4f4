#include "verify/segment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

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

Meeting meet(const Segment& segment, const FlatTriangle& triangle) {
  if (triangle.normal_length == 0) return {};
  const Vec3 from = segment.from - triangle.corner;
  const double magnitude = from.norm() + segment.length;
  const double longest = triangle.longest;
  const double side_error = kPlaneError * magnitude * longest * longest;
  const double side_from = triangle.normal.dot(from);
  const double side_to = triangle.normal.dot(segment.to - triangle.corner);
  if ((side_from > side_error && side_to > side_error) || (side_from < -side_error && side_to < -side_error)) return {};

  const double gap = side_from - side_to;
  if (std::abs(gap) <= 4 * side_error) return {Contact::unsure, 0, 0, 0};  // runs (almost) in the plane
  Meeting meeting;
  meeting.position = side_from / gap;
  const Vec3 hit = from + meeting.position * segment.direction;
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
  meeting.contact = sides_certain && border > border_error ? Contact::crossing : Contact::unsure;
  meeting.border = border - border_error;
  meeting.turn = gap < 0 ? 1 : -1;
  return meeting;
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
