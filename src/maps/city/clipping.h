// Booleans of polygons on the grid, and lines widened to polygons. The only file that sees Clipper is clipping.cpp.
#pragma once

#include <vector>

#include "maps/city/grid_polygon.h"

namespace vantage::internal::city {

enum class ClipOperation { unite, subtract, intersect };
enum class FillRule { even_odd, non_zero };

/// Collects rings, then clips them. The rings must live until then.
class Clipping {
 public:
  void add(const GridRing& ring) { subject_.push_back(&ring); }
  void add(const std::vector<GridPolygon>& polygons) { add(polygons, subject_); }
  void add_clip(const std::vector<GridPolygon>& polygons) { add(polygons, clip_); }

  /// Sides of the result may cross where rounding to the grid moved them; `settled` sees to that.
  std::vector<GridPolygon> run(ClipOperation operation, FillRule rule) const;
  /// The same in the finest units there are, at any cost.
  std::vector<GridPolygon> run_fine(ClipOperation operation, FillRule rule) const;

 private:
  using Rings = std::vector<const GridRing*>;

  static void add(const std::vector<GridPolygon>& polygons, Rings& rings);

  Rings subject_, clip_;
};

/// Clips until no side crosses another, and tidies. Inside is what lies in an odd number of the rings. Where rounding
/// goes on and on, polygons that touch stay as they are, and may overlap by a unit.
std::vector<GridPolygon> settled(std::vector<GridPolygon> polygons);

/// The outlines of a line of that width, in units of the grid: see widen().
std::vector<GridRing> widened(const GridRing& line, bool closed, double width);

}  // namespace vantage::internal::city
