// Questions to a mesh that is claimed to bound a solid.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "exact.h"
#include "vantage/geometry.h"

namespace attack {

struct MeshFaults {
  bool bad_index = false;
  std::size_t open_edges = 0;   ///< directed edges, by index, that their opposites do not cancel
  std::size_t flat_facets = 0;  ///< facets whose corners lie on one line; exact
};

MeshFaults faults(const vantage::Mesh& mesh);

enum class Place { inside, outside, on_surface };

/// A closed mesh to ask where points lie. Exact: winding number by the signs of orientations.
class ClosedMesh {
 public:
  explicit ClosedMesh(const vantage::Mesh& mesh);

  Place locate(const Vec3& point) const;

  /// How often the surface turns about the point, outward facets counted as positive. Nothing on the surface.
  std::optional<int> turns(const Vec3& point) const;

  /// Distance to the nearest point of the surface; in doubles.
  double distance(const Vec3& point) const;

  /// Where the ray from `from` along the unit `direction` leaves the mesh for good; 0 where it meets nothing. In
  /// doubles.
  double last_exit(const Vec3& from, const Vec3& direction) const;

  std::size_t size() const { return facets_.size(); }
  Corners corners(std::size_t facet) const;

 private:
  /// Turns of the surface about the point; nothing (kUnclear) where the path to `far` touches an edge.
  int winding(const Vec3& point, const Vec3& far) const;

  std::vector<Vec3> vertices_;
  std::vector<vantage::Triangle> facets_;
  std::vector<vantage::Box> boxes_;
  double extent_ = 0;
};

double distance_to_triangle(const Vec3& point, const Corners& triangle);

}  // namespace attack
