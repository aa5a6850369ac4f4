// A closed surface about a viewpoint, met once by every ray from it.
#pragma once

#include <cstdint>
#include <vector>

#include "solid/csg.h"
#include "vantage/geometry.h"

namespace vantage::internal::spheres {

/// What a facet of a sphere stands for; also the labels of the solids.
enum SphereLabel : std::uint32_t { kScene = 0, kRange = 1, kTargetPlane = 2 };

/// How the mesh's frame lies in the scene frame, whose axes the cube map has.
struct Placement {
  Eigen::Matrix3d to_mesh = Eigen::Matrix3d::Identity();  ///< rotation: scene axes to the mesh's
  Vec3 viewpoint = Vec3::Zero();                          ///< in the mesh's frame
  bool front_only = false;  ///< keep only what lies above the viewpoint: the half-space z >= viewpoint.z of that frame
};

struct StarMesh {
  std::vector<Vec3> rays;  ///< vertices relative to the viewpoint, scene axes; none is zero
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> at_range;  ///< per vertex: the range ends the ray, not the scene
};

/// The mesh in its place. A facet is kRange where the range ends the rays of all its corners, else kScene. With
/// `front_only` facets that cross the plane z = viewpoint.z are cut, and a fan about the viewpoint (kTargetPlane, every
/// z the same) closes the solid. Cost: linear; sorting the facets that cross the plane.
solid::LabelledMesh placed(const StarMesh& star, const Placement& placement);

/// How far the mesh goes from the viewpoint; with `front_only` how high above the plane.
double reach(const StarMesh& star, const Placement& placement);

}  // namespace vantage::internal::spheres
