// Questions to a mesh that is claimed to bound a solid.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "exact.h"
#include "vantage/geometry.h"

namespace attack {

/// What is wrong with the mesh as a closed, oriented one, by index; empty when nothing is: an index out of range, a
/// directed edge that its opposite does not cancel, a facet whose corners lie on one line (exact).
std::vector<std::string> faults(const vantage::Mesh& mesh);

enum class Place { inside, outside, on_surface };

/// A closed mesh to ask where points lie. Exact: winding number by the signs of orientations.
class ClosedMesh {
 public:
  explicit ClosedMesh(const vantage::Mesh& mesh);

  Place locate(const Vec3& point) const;

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

}  // namespace attack
