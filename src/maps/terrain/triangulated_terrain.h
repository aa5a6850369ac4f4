// Terrain as triangles: what stands on it asks for heights.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geo/local_frame.h"
#include "maps/terrain/height_grid.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"

namespace vantage::internal::terrain {

/// A plane: z = slope . (x, y) + level_m.
struct Incline {
  Eigen::Vector2d slope;
  double level_m = 0;

  double at(const Eigen::Vector2d& p) const { return slope.dot(p) + level_m; }
};

/// A piecewise linear terrain over a rectangle of a local frame. Any number of threads may ask at once.
class TriangulatedTerrain {
 public:
  /// Triangles that span the rectangle [min, max] of their vertices; none overlap, all counter-clockwise seen from
  /// above. Made by `triangulate`.
  VANTAGE_INTERNAL_API explicit TriangulatedTerrain(Mesh mesh);

  const Mesh& mesh() const { return mesh_; }
  /// Nothing outside; the border belongs to it. Cost: constant, about a microsecond.
  VANTAGE_INTERNAL_API std::optional<double> height(const Eigen::Vector2d& at) const;
  /// The lowest and the highest height, measured from `above`, over a polygon (its boundary and inside), exactly but
  /// for rounding: they are reached at a corner, at a vertex of the terrain inside, or where a side crosses an edge of
  /// the terrain. Nothing where the polygon sticks out of the surface, or has no corner. `ring`: open, either turn; may
  /// cross itself (inside is then what is wound round an odd number of times). Cost: linear in the triangles that its
  /// sides cross, and in the vertices in its bounding box times its corners.
  struct Range {
    double lowest, highest;
  };
  VANTAGE_INTERNAL_API std::optional<Range> range(const std::vector<Eigen::Vector2d>& ring,
                                                  const Incline& above = {Eigen::Vector2d::Zero(), 0}) const;

 private:
  /// Lists of things by cell of a regular grid, one after the other.
  struct Cells {
    std::vector<std::uint32_t> first;  ///< per cell, where its list begins; one more at the end
    std::vector<std::uint32_t> items;
  };

  std::optional<double> height(const Eigen::Vector2d& at, const Incline& above) const;
  int cell_column(double x) const;
  int cell_row(double y) const;
  std::uint32_t cell(int column, int row) const;
  void index_triangles();
  void index_vertices();
  void widen(Range& range, const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Incline& above) const;

  Mesh mesh_;
  Eigen::Vector2d min_, max_, cells_per_m_;
  int columns_ = 0, rows_ = 0;
  Cells triangles_, vertices_;
};

/// A triangulated irregular network of the part of the grid over the rectangle [min, max] of the frame, in metres,
/// which it covers exactly. Along its border the grid is bilinear. Between posts its cells have straight sides, and are
/// folded along the diagonal that is higher in the middle: what is there is not known, and the higher ground hides
/// more.
struct Triangulation {
  TriangulatedTerrain surface;
  double largest_error_m = 0;  ///< vertical, measured at all posts in the window and where its border crosses the grid
  std::size_t posts = 0;       ///< posts in the window
};

/// Posts are inserted greedily, worst first, into a Delaunay triangulation (Garland and Heckbert, "Fast polygonal
/// approximation of terrains and height fields", 1995, algorithm IV) until none differs by more than `max_error_m`
/// (>= 0; 0 keeps every post that is not in the plane of its neighbours). Nor does the middle of a side or of a higher
/// diagonal, in cells away from the border: whatever the frame, it is the same ground. Posts within 1 cm of the border
/// count as on it. Throws Error(input) for a rectangle without an area or one that the grid does not cover;
/// Error(cancelled). Cost: about n log n in the posts, see docs/terrain.md.
Triangulation triangulate(const HeightGrid& grid, const geo::LocalFrame& frame, const Eigen::Vector2d& min,
                          const Eigen::Vector2d& max, double max_error_m, const Progress& progress = {});

}  // namespace vantage::internal::terrain
