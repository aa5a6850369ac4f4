// The scene's triangles as the check sees them: what lies on the segment from a viewpoint to a target point.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/scene.h"
#include "verify/box_index.h"
#include "verify/segment.h"
#include "verify/target_view.h"
#include "verify/view_pyramid.h"

namespace vantage::internal::verify {

class Occluders {
 public:
  /// Takes the triangles that can meet a segment of at most `max_range` metres in front of the target. The view is kept
  /// by reference. Throws Error(input) for an index out of range or a coordinate that is not finite.
  Occluders(const Scene& scene, const TargetView& view, double max_range);

  /// A shadow ray: whether the scene crosses the open segment from a viewpoint to a target point (both local). Embree
  /// brings the candidates, each is tested in double precision. Not counted: touching, a segment in a triangle's plane,
  /// a hit within rounding or kGrazing of a triangle's border, a hit at either end, the surface that the target lies
  /// on. That of a point is not crossed: it hides the point from all that is behind it.
  bool hide(const Vec3& viewpoint, const Vec3& target_point) const;

  /// Shoots shadow rays at the parts of scene triangles between the viewpoint and the target until one is blocked; its
  /// target point. Adds the rays to `rays`.
  std::optional<Vec3> find_hidden(const Vec3& viewpoint, std::size_t& rays) const;

  /// What a viewpoint in front of a target with an area sees of it: the shadows of all triangles are taken away.
  struct SeenPart {
    double area_m2 = 0;
    std::optional<Vec3> hidden = {};  ///< a point in the largest shadow, if there is one
  };
  SeenPart seen_part(const Vec3& viewpoint) const;

  /// Number, in the scene, of the triangle that crosses the segment nearest to the viewpoint. Plain loop: for messages.
  std::optional<std::size_t> first_hit(const Vec3& viewpoint, const Vec3& target_point) const;

  std::size_t size() const { return triangles_.size(); }

 private:
  /// A triangle that a point lies on.
  struct TouchedTriangle {
    Vec3 outward;          ///< normal on the target's front
    std::uint32_t number;  ///< in the scene
    bool is_edge;          ///< the point lies on its border: over a ridge one sees past it
  };
  /// One that the point lies in, or one of those at whose borders it lies, if the viewpoint is behind them all.
  const TouchedTriangle* hiding_touched(const Vec3& viewpoint) const;
  const std::vector<std::uint32_t>& candidates_in(const ViewPyramid& pyramid) const;
  void add_if_touched(const FlatTriangle& triangle, std::uint32_t number);

  /// Position of the hit on the segment; nothing where the triangle does not hide.
  std::optional<double> hit(const Segment& segment, const FlatTriangle& triangle) const;

  const TargetView& view_;
  std::vector<FlatTriangle> triangles_;
  std::vector<std::uint32_t> number_;  ///< in the scene
  std::vector<TouchedTriangle> touched_;
  std::optional<BoxIndex> index_;  ///< always there; made last, when the triangles are known
};

}  // namespace vantage::internal::verify
