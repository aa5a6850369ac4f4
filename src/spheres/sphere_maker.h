// Visibility spheres of points: depth images, tessellated.
#pragma once

#include <functional>
#include <vector>

#include "depth/depth.h"
#include "solid/csg.h"
#include "spheres/star_mesh.h"
#include "vantage/spheres.h"
#include "vantage/target.h"

namespace vantage::internal::spheres {

struct Sphere {
  solid::LabelledMesh mesh;  ///< in the maker's frame; labels are SphereLabel
  double reach_m = 0;        ///< how far it goes from the viewpoint; if it is cut, how high above the plane
  double seconds = 0;        ///< rendering and tessellation
};

/// The greatest distance at which facets on the range sphere lie inside it.
double range_tolerance(const SpheresOptions& options, double range_m);

class SphereMaker {
 public:
  /// Meshes are in the axes of `frame` and about its origin; with `front_only` cut to its z >= 0, for viewpoints that
  /// lie in its plane. Keeps references to the renderer. The options are checked already.
  SphereMaker(depth::DepthRenderer& renderer, const SpheresOptions& options, double range_m, const TargetFrame& frame,
              bool front_only);

  double range_m() const { return range_m_; }

  /// Called with the spheres in the order of the points. Points in the frame. Throws as DepthRenderer::render does.
  void make(const std::vector<Vec3>& points, const std::function<void(std::size_t, Sphere)>& sink) const;

 private:
  StarMesh tessellated(std::span<const float> inverse_depths) const;

  depth::DepthRenderer& renderer_;
  SpheresOptions options_;
  double range_m_;
  TargetFrame frame_;
  bool front_only_;
  int face_size_;
};

}  // namespace vantage::internal::spheres
