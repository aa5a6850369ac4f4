// Conservative rasterisation of convex polygons: for every texel whose closed square a polygon meets at all, a bound on
// the polygon's nearest depth over that square.
//
// In the coordinates (u, v, q) = (right / forward, up / forward, 1 / forward) a polygon in front of the viewpoint stays
// a convex planar polygon (Olano & Greer, "Triangle scan conversion using 2D homogeneous coordinates", 1997). What a
// row of texels sees of it is its part between two lines v = const, and the largest q over a texel of that row is read
// off the upper hull of that part in the plane (u, q). So the bound is the true maximum but for rounding, whatever the
// polygon's shape: slivers, polygons seen edge on, polygons that reach behind the viewpoint.
//
// Rounding: a true point lies within `slack` of the polygon that is rasterised, so its u and v are within
// 2 slack / (forward - slack) of those computed, which is affine in q too. The polygon is grown by that margin.
#pragma once

#include <span>
#include <vector>

#include "depth/face_view.h"

namespace vantage::internal::depth {

class ConservativeRaster {
 public:
  /// Draws into rows [row_begin, row_end) of the band: `inverse_depths` holds (row_end - row_begin) * size values, 1/m.
  ConservativeRaster(const FaceBand& band, std::span<float> inverse_depths);

  /// Raises the texels that the polygon meets to at least its nearest inverse depth in them. The corners are what
  /// FaceClip made of it: (right, up, forward).
  void draw(std::span<const Vec3> corners, double slack);

 private:
  /// A corner in (u, v, q); `margin`: how far the true polygon may lie beyond it in u and v.
  struct Corner {
    double u, v, q, margin;
    double left() const { return u - margin; }
    double right() const { return u + margin; }
    double low() const { return v - margin; }
    double high() const { return v + margin; }
  };

  int cell(double coordinate) const;
  void project(std::span<const Vec3> corners, double slack);
  void cut_row(int row);
  void draw_row(int row, const std::vector<Corner>& part);
  void build_hull(const std::vector<Corner>& part);
  void raise(float* row, int first, int last, double inverse_depth) const;

  FaceBand band_;
  std::span<float> texels_;
  std::vector<double> edges_;  ///< of the columns
  std::vector<Corner> polygon_, part_, half_, hull_;
  double rounding_ = 0;  ///< of the interpolated inverse depths of the polygon at hand
};

}  // namespace vantage::internal::depth
