// Terrain as triangles: what stands on it asks for heights.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/progress_reporter.h"
#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::scene {

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
  /// above. Made by terrain::triangulate. Error(cancelled) when told to stop.
  VANTAGE_INTERNAL_API explicit TriangulatedTerrain(Mesh mesh, const core::ProgressReporter& progress = {});

  const Mesh& mesh() const { return mesh_; }
  /// A triangle over a place, and its height there.
  struct Found {
    std::uint32_t triangle;
    double height;
  };
  /// Nothing outside; the border belongs to it. Cost: constant, about a microsecond.
  VANTAGE_INTERNAL_API std::optional<Found> find(const Eigen::Vector2d& at) const;
  std::optional<double> height(const Eigen::Vector2d& at) const {
    const std::optional<Found> found = find(at);
    return found ? std::optional(found->height) : std::nullopt;
  }
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

  std::optional<Found> find(const Eigen::Vector2d& at, const Incline& above) const;  ///< its height above the plane
  int cell_column(double x) const;
  int cell_row(double y) const;
  std::uint32_t cell(int column, int row) const;
  void index_triangles(const core::ProgressReporter& progress);
  void index_vertices(const core::ProgressReporter& progress);
  void widen(Range& range, const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Incline& above) const;

  Mesh mesh_;
  Eigen::Vector2d min_, max_, cells_per_m_;
  int columns_ = 0, rows_ = 0;
  Cells triangles_, vertices_;
};

}  // namespace vantage::internal::scene
