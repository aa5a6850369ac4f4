// The obvious way to tell whether a point sees a target: a loop over all triangles. Slow; shares nothing with the
// library.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage::testing {

enum class Visibility {
  clear,    ///< nothing on the open segment
  hidden,   ///< a triangle's interior is crossed, well away from its border
  grazing,  ///< neither: something is touched, or nearly (relative to its size: 1e-7)
};

/// A loop over the triangles of one mesh, for one convex polygon. All coordinates in the frame of the mesh.
class Oracle {
 public:
  /// Copies what it needs. `polygon`: planar, in order; `normal`: towards the side that is looked at.
  Oracle(const Mesh& mesh, std::vector<Vec3> polygon, const Vec3& normal);

  /// What lies between a viewpoint and a target point. Hits lower than 1 mm over the polygon (1 mm margin) are the
  /// surface that the target lies on and do not count.
  Visibility look(const Vec3& viewpoint, const Vec3& target_point) const;

  /// Whether none of the polygon's vertices, 5 points an edge and `samples` random points inside is hidden.
  bool sees_all(const Vec3& viewpoint, int samples, std::uint64_t seed = 1) const;

 private:
  bool on_surface(const Vec3& hit) const;

  struct Corners {
    Vec3 a, ab, ac;
  };
  std::vector<Corners> triangles_;  ///< about `origin_`
  std::vector<Vec3> polygon_;       ///< likewise
  Vec3 origin_, normal_;
};

/// As above, for a scene; the polygon's front is the side from which its vertices run counter-clockwise.
bool sees_all(const Scene& scene, const std::vector<Vec3>& polygon, const Vec3& viewpoint, int samples);

}  // namespace vantage::testing
