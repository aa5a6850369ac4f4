// The nearest points of two triangles.
#pragma once

#include <array>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

using Corners3 = std::array<Vec3, 3>;  ///< of a triangle

struct NearestPoints {
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
  double distance = 0;
};

/// The points are on the triangles to a few roundings of the coordinates, also where these are as narrow as a line, or
/// a point, but for `unsure_over`. Where edges are parallel but for a part s of their length L, from about 1e-7 down,
/// there may be nearer points: by (s L)^2 over the distance.
NearestPoints nearest_points(const Corners3& a, const Corners3& b);

/// No two points of the triangles are nearer to each other: `nearest` less what it may miss.
double surely_apart_by(const NearestPoints& nearest, const Corners3& a, const Corners3& b);

/// Not less than the distance of a point from a triangle, but for the rounding of coordinates: that from a place on it.
double at_most_from(const Corners3& triangle, const Vec3& point);

/// How far a point at that distance may be from the place straight below it on the triangle, besides what was found:
/// the narrower one is, the more its normal is turned by rounding.
double unsure_over(const Corners3& triangle, double distance);

/// Between two boxes; 0 where they meet.
double distance_of_boxes(const Box& a, const Box& b);

Box box_of(const Corners3& corners);

}  // namespace vantage::internal::prove
