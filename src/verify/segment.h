// Segments, triangles and where they meet, in double precision with a bound on the rounding error.
#pragma once

#include "vantage/geometry.h"

namespace vantage::internal::verify {

struct Segment {
  Segment(const Vec3& from_point, const Vec3& to_point)
      : from(from_point), to(to_point), direction(to_point - from_point), length(direction.norm()) {}

  Vec3 at(double fraction) const { return from + fraction * direction; }

  Vec3 from, to, direction;
  double length;
};

/// A triangle with what every test of it needs. Coordinates are metres about the check's local origin.
struct FlatTriangle {
  FlatTriangle(const Vec3& a, const Vec3& b, const Vec3& c);

  Vec3 second() const { return corner + edge1; }
  Vec3 third() const { return corner + edge2; }
  Box bounds() const;

  Vec3 corner, edge1, edge2;
  Vec3 normal;           ///< edge1 x edge2: twice the area, not normalised
  double longest;        ///< longest edge
  double normal_length;  ///< 0 for a triangle too thin to have a normal (kThinnest)
};

enum class Contact {
  none,     ///< the segment and the triangle are certainly apart
  unsure,   ///< rounding leaves it open: an end on the plane, a segment in the plane, a hit on the border
  crossing  ///< the segment certainly passes from one side to the other through the triangle's interior
};

struct Intersection {
  Contact contact = Contact::none;
  double position = 0;  ///< fraction of the segment at which it meets the plane; for unsure and crossing
  double border = 0;    ///< smallest barycentric coordinate of the hit less its rounding error; for crossing
  int turn = 0;         ///< +1: the segment runs along the normal, -1: against it; for crossing
};

Intersection intersect(const Segment& segment, const FlatTriangle& triangle);

/// Distance from a point to the nearest point of the (closed) triangle, in metres.
double distance(const Vec3& point, const FlatTriangle& triangle);

}  // namespace vantage::internal::verify
