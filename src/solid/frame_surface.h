// Where a camera on a gimbal is too near to take in all of a target.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "sensor/aim.h"
#include "vantage/geometry.h"

namespace vantage::internal::solid {

struct FrameView {
  std::vector<Vec3> corners;  ///< of the target, about a point c in their convex hull
  std::optional<Vec3> front;  ///< viewpoints lie on this side of the plane through c; none: all round
  Pinhole camera;
  Mount mount;
  double reach = 0;  ///< metres: no viewpoint farther from c matters
  /// The same along a direction of unit length and some that differ from it by an angle, radians; metres, 0 for none.
  /// It is not needed to be safe: it tells where a surface that lies farther out takes nothing away. None: `reach`.
  std::function<double(const Vec3& direction, double angle)> reach_along = {};
  double least = 0;     ///< metres: nor one nearer than this
  double share = 5e-3;  ///< the surface may lie so much farther out than it has to, of the distance, but where ..
  std::size_t most_facets = 7500;  ///< .. that takes more facets than about these
};

/// A closed mesh, star-shaped about c: no viewpoint outside of it, on the front and within reach, has the target only
/// partly in every picture that the mount allows. It may hold viewpoints that have.
struct FrameSurface {
  Mesh mesh;                   ///< about c
  std::vector<bool> by_mount;  ///< per triangle: the mount's pitch is the reason, not the picture's size
  double least_distance = 0;   ///< metres from c, of all directions looked at: where a camera can first take it all in
};

/// docs/theory.md, "Limits of the sensor", has the argument. Cost: in proportion to the facets, about a microsecond for
/// each corner of the target.
FrameSurface make_frame_surface(const FrameView& view);

}  // namespace vantage::internal::solid
