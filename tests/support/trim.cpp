#include "support/trim.h"

#include <Eigen/Geometry>

#include "support/internals.h"
#include "support/solids.h"

namespace vantage::testing {

solid::Solid trim(const solid::Solid& solid, const Vec3& normal, double offset, std::uint32_t label) {
  if (solid.empty()) return solid;
  // The half-space as a box in the frame (u, v, normal) that reaches well past the solid on the other five sides, so
  // that only the face at `offset` can cut it.
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  const Box bounds = solid.bounds();
  const Vec3 centre = (bounds.min + bounds.max) / 2;
  const double reach = (bounds.max - bounds.min).norm();
  const double depth = normal.dot(centre) - reach;
  if (offset <= depth) return {};
  if (offset >= normal.dot(centre) + reach) return solid;
  const Vec3 middle(u.dot(centre), v.dot(centre), 0);
  solid::LabelledMesh half_space{make_box_mesh(Vec3(middle.x() - reach, middle.y() - reach, depth),
                                               Vec3(middle.x() + reach, middle.y() + reach, offset)),
                                 {}};
  half_space.labels.assign(half_space.mesh.triangles.size(), label);
  for (Vec3& corner : half_space.mesh.vertices) corner = u * corner.x() + v * corner.y() + normal * corner.z();
  return solid::intersect(solid, solid::Solid(half_space, "half-space"));
}

}  // namespace vantage::testing
