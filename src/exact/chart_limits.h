// Limits on where the camera may be that are cut in the chart, with the volume itself: docs/theory.md, "Limits in the
// chart".
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::exact {

/// In the target's frame, metres. Labels are the caller's.
struct ChartLimits {
  /// Keeps what has normal . x <= at. The normal may have any length.
  struct Side {
    Vec3 normal;
    double at;
    std::uint32_t label;
  };
  /// Takes away what is in a convex mesh, closed and with its facets outwards, that holds the centre: where it reaches
  /// in front of the target at all, it holds all that is near to the centre.
  struct Body {
    Mesh mesh;
    std::uint32_t label;
  };
  /// Takes away what is in a closed mesh with its facets outwards that is star-shaped about the centre, and holds all
  /// that is near to it.
  struct Star {
    Mesh mesh;
    std::vector<std::uint32_t> labels;  ///< per triangle
  };
  /// Metres: how far the view reaches along a direction of unit length, and where `angle` (radians) is wide, along some
  /// that differ from it by that.
  using Reach = std::function<double(const Vec3& direction, double angle)>;
  /// Made when it is known what hides the view, so that it is fine where that is of use.
  using StarMaker = std::function<Star(const Reach&)>;
  std::vector<Side> kept;
  std::vector<Body> removed;
  std::vector<StarMaker> stars;

  bool empty() const { return kept.empty() && removed.empty() && stars.empty(); }
};

}  // namespace vantage::internal::exact
