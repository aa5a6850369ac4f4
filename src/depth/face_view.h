// A horizontal band of one cube face as a pyramid with its apex at the viewpoint: which boxes reach into it, and convex
// polygons clipped to it (Sutherland & Hodgman 1974).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/bvh.h"
#include "core/walk_bvh.h"
#include "depth/depth.h"

namespace vantage::internal::depth {

/// Surfaces nearer than this to the viewpoint, along a face's forward, touch it and hide nothing: metres. Ten times
/// what preparing a scene may move a surface by (1e-9 m).
inline constexpr double kTouching = 1e-8;

/// Rows [row_begin, row_end) of a face of size x size texels.
struct FaceBand {
  int face = 0;
  int size = 1;
  int row_begin = 0, row_end = 1;

  /// Lower bound of column or row i, of -1 to 1 across the face.
  double edge(int i) const { return 2.0 * i / size - 1; }
  double centre(int i) const { return (2.0 * i + 1) / size - 1; }
};

/// A convex polygon as the viewpoint sees it.
struct ViewedPolygon {
  std::span<const Vec3> corners;  ///< relative to the viewpoint, axes of the scene, in order
  double slack = 0;               ///< no point of the true polygon is farther than this from the given one, metres
};

/// The part of a polygon inside a band: corners as (right, up, forward), all in front of the viewpoint.
class FaceClip {
 public:
  explicit FaceClip(const FaceBand& band);

  const FaceBand& band() const { return band_; }

  /// Whether a box (relative to the viewpoint) may reach into the band. Errs on the side of yes.
  bool may_meet(const Vec3& centre, const Vec3& half) const;

  /// The corners of what lies within the band grown by twice the slack, beyond kTouching; empty when there is nothing.
  /// Valid until the next call.
  std::span<const Vec3> clip(const ViewedPolygon& polygon);

 private:
  FaceBand band_;
  CubeFace axes_;
  std::vector<Vec3> points_, next_;
};

/// Calls visit(polygon) for every polygon of the leaves that reach into the band and within `range` of the viewpoint.
/// `eye` is relative to the scene's origin.
template <typename Visit>
void for_each_polygon(const core::Bvh& bvh, const Vec3& eye, double range, const FaceClip& clip, const Visit& visit) {
  const double reach = range * (1 + 1e-12);
  const auto is_seen = [&](const core::BvhNode& node) {
    Vec3 centre, half;
    double square = 0;
    for (int a = 0; a < 3; ++a) {
      const double low = node.bounds.min[a] - eye[a], high = node.bounds.max[a] - eye[a];
      centre[a] = 0.5 * (low + high);
      half[a] = 0.5 * (high - low);
      const double gap = low > 0 ? low : high < 0 ? -high : 0;
      square += gap * gap;
    }
    return square <= reach * reach && clip.may_meet(centre, half);
  };
  // The nearer child first: what it covers spares work on what lies behind.
  const auto distance = [&](const core::Bounds& b) {
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
      const double offset = 0.5 * (double{b.min[a]} + double{b.max[a]}) - eye[a];
      sum += offset * offset;
    }
    return sum;
  };
  core::walk_nearer_first(bvh, distance, is_seen, visit);
}

}  // namespace vantage::internal::depth
