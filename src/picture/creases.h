// The edges of a volume that a drawing shows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/progress_reporter.h"
#include "picture/view.h"
#include "vantage/geometry.h"

namespace vantage::internal::picture {

/// Pixels of a crease in a picture of 1600 x 1200.
inline double crease_width(double strength) { return 1.2 + 0.7 * strength; }
inline double crease_opacity(double strength) { return 0.85 * strength; }

struct Crease {
  Vec3 a, b;
  double strength = 0;     ///< 0 (not to be seen) to 1
  bool is_border = false;  ///< between facets of different kind, or the rim of a hole
};

/// Edges where facets of different kind meet, at full strength; edges where facets meet at an angle, stronger the
/// sharper; and contours, where a facet that faces the viewer meets one that does not. `kind_of`: per triangle, or
/// empty. The facets of a curved face are not told apart, nor are facets too thin for their normal to mean anything.
/// Cost: O(n log n).
std::vector<Crease> find_creases(const Mesh& mesh, std::span<const std::uint8_t> kind_of, const Vec3& eye,
                                 const Vec3& back, bool perspective, const core::ProgressReporter& progress = {});

/// Fades creases where there are so many that a picture would be all lines: of what may be inked of a place the borders
/// get theirs first, then the long and sharp ones, and what is left fades out; creases outside of the picture are left
/// out. Where lines are sparse all stay as they are. `unit`: pixels of the picture for one of a picture of 1600 x 1200.
/// Cost: O(n log n), and in proportion to the lengths in pixels.
std::vector<Crease> thin_out(const std::vector<Crease>& creases, const View& view, double unit,
                             const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::picture
