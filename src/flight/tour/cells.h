// The regions of a tour about a common origin, and the parts that planes cut them into.
//
// A cell is what of a region lies on the one side of some planes. Its hull is that of the region's triangles, clipped:
// a corner of the hull of a closed set that a half-space clips lies on the set's boundary, or it would be between two
// others in the plane. So no solids need be cut.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/triangle_tree.h"
#include "flight/tour/hull.h"
#include "flight/tour/outer_region.h"
#include "vantage/geometry.h"

namespace vantage::internal::flight::tour {

/// The points x with normal . x >= offset, in the scene frame; turned round where `lower`.
struct CellPlane {
  std::array<std::int8_t, 3> normal = {};  ///< of -1, 0 and 1
  double offset = 0;
  bool lower = false;
};

struct Cell {
  std::size_t region = 0;
  std::optional<std::size_t> parent;               ///< a cell
  CellPlane plane;                                 ///< that cuts it from its parent
  std::vector<std::vector<Vec3>> polygons;         ///< convex; about the origin
  std::unique_ptr<Hull> hull;                      ///< none where the cell is empty
  std::vector<std::array<std::size_t, 2>> halves;  ///< pairs of cells that cover it
};

/// Cells live as long as it does, and keep their numbers. The first ones are the regions.
class Cells {
 public:
  explicit Cells(std::span<const OuterRegion> regions);

  const Cell& operator[](std::size_t cell) const { return *cells_[cell]; }
  std::size_t size() const { return cells_.size(); }
  std::size_t region_count() const { return shapes_.size(); }
  /// Keeps a half-space that a program needed.
  void learn(std::size_t cell, const HalfSpace& half_space) { cells_[cell]->hull->add(half_space); }
  /// Whole metres; subtracted from all points.
  const Vec3& origin() const { return origin_; }

  /// About the origin, to the region itself, not its hull; 0 inside.
  double distance_m(std::size_t region, const Vec3& point) const;
  bool meets_segment(std::size_t region, const Vec3& from, const Vec3& to) const;

  /// Three regions between which it is far, points among them before all others; all of them where there are fewer.
  /// Cost: cubic.
  std::vector<std::size_t> three_far_apart() const;

  /// Two cells that together cover `cell`, and of which, if that can be had, neither hull holds `point` (about the
  /// origin). Either may be empty.
  std::array<std::size_t, 2> halves(std::size_t cell, const Vec3& point);

 private:
  struct Shape {
    Mesh mesh;
    std::unique_ptr<core::TriangleTree> tree;
  };
  std::unique_ptr<Cell> cut(std::size_t cell, const CellPlane& plane) const;
  double distance_to_halves(const std::array<const Cell*, 2>& halves, const Vec3& point) const;

  Vec3 origin_ = Vec3::Zero();
  double reach_m_ = 0;
  std::vector<Shape> shapes_;
  std::vector<std::unique_ptr<Cell>> cells_;
};

}  // namespace vantage::internal::flight::tour
