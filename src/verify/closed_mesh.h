// A closed mesh as a set of points: is a point inside, and how far is it from the surface?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/volume.h"
#include "verify/box_index.h"
#include "verify/segment.h"

namespace vantage::internal::verify {

/// What the edges of a mesh tell, with vertices in one place taken for one.
struct Topology {
  bool closed = false;    ///< every edge has an even number of triangles (two, but where pieces touch)
  bool oriented = false;  ///< as many of them run it forwards as backwards
  std::size_t flat = 0;   ///< triangles without area, or with two corners in one place; the latter are left out above
  long euler = 0;         ///< V - E + F; by indices, where they make a surface of two triangles to an edge
  OpenEdges open_edges;   ///< those with an odd number of triangles
};

/// Throws Error(input) for a mesh that has no triangles, an index out of range or a coordinate that is not finite.
/// `name` is for messages.
Topology topology_of(const Mesh& mesh, const std::string& name);

class ClosedMesh {
 public:
  /// `origin` becomes the local origin of all queries. `name` is for messages. Throws Error(input) for a mesh that has
  /// no triangles, is not closed, has an index out of range or a coordinate that is not finite.
  ClosedMesh(const Mesh& mesh, const Vec3& origin, const std::string& name);

  const Topology& topology() const { return topology_; }
  const std::vector<FlatTriangle>& triangles() const { return triangles_; }  ///< local
  const Box& bounds() const { return bounds_; }                              ///< local

  /// Whether the local point is inside: crossings are counted along a ray in a fixed direction, and along another where
  /// one of the crossings is not certain. Nothing: on the surface, as far as can be told. An oriented mesh contains
  /// what it winds round; one that is not contains what an odd number of its triangles separates from infinity.
  std::optional<bool> contains(const Vec3& point) const;

  /// From the local point to the nearest point of the surface, metres.
  double distance_to_surface(const Vec3& point) const;

 private:
  std::optional<bool> contains_along(const Vec3& point, const Vec3& direction) const;

  Topology topology_;
  std::vector<FlatTriangle> triangles_;
  Box bounds_;
  double diagonal_ = 0;
  std::optional<BoxIndex> index_;  ///< always there; made last, when the size is known
};

}  // namespace vantage::internal::verify
