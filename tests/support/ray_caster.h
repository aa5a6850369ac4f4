// The obvious way to tell how far one sees from a point: rays against triangles, in double precision. Shares nothing
// with the library.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::testing {

class RayCaster {
 public:
  /// Keeps a copy of the triangles about `centre`, in a tree of boxes.
  RayCaster(const Mesh& mesh, const Vec3& centre);

  /// Distance from the centre to the first triangle along a unit direction, at most `limit`. Triangles nearer than
  /// `ignore` metres are what the centre lies on.
  double first_hit(const Vec3& direction, double limit, double ignore = 0) const;

 private:
  struct Corners {
    Vec3 a, ab, ac;
  };
  struct Node {
    Box box;
    std::uint32_t begin, end, second;  // children: the next node and `second`; 0 for a leaf
  };
  void build(std::uint32_t begin, std::uint32_t end);

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

/// `count` directions spread evenly over the sphere (a Fibonacci lattice).
Vec3 even_direction(std::size_t i, std::size_t count);

/// Volume within r(direction), by `count` even directions.
double radial_volume(const std::function<double(const Vec3& direction)>& radius, std::size_t count);

}  // namespace vantage::testing
