// How deep points lie in a closed mesh: for searches that ask very often.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/triangle_tree.h"
#include "flight/segment_distance.h"
#include "vantage/geometry.h"

namespace vantage::internal::flight {

/// A closed, outward-oriented mesh about an origin in its middle. Any number of threads may ask at once. Its surface is
/// a 1-Lipschitz function's zero: depths of two points differ by no more than the points are apart.
class SolidDepth {
 public:
  /// Throws as SolidIndex for a mesh that is not closed. Not of an empty mesh. Cost: O(n log n), and tens of thousands
  /// of depths, some 0.1 s.
  explicit SolidDepth(const Mesh& mesh);
  SolidDepth(const SolidDepth&) = delete;
  SolidDepth& operator=(const SolidDepth&) = delete;

  const Vec3& origin() const { return origin_; }  ///< scene frame; all else here is about it
  const Box& bounds() const { return bounds_; }
  const Mesh& mesh() const { return mesh_; }
  const SegmentDistance& distance() const { return distance_; }
  double size_m() const { return (bounds_.max - bounds_.min).norm(); }

  /// The distance to the surface: positive inside, negative outside. Cost: microseconds; where thousands of facets are
  /// as near, as in the middle of a dome, up to a millisecond.
  double depth_m(const Vec3& point) const;
  /// No less than the depth, from a grid of depths: some nanoseconds.
  double at_most_m(const Vec3& point) const;
  double at_least_m(const Vec3& point) const;  ///< no more than the depth, likewise
  /// The bound is no less than the depth of any point of a box, given by its middle and half widths; where the solid is
  /// thin, far less than the depth and half of the diagonal. The depth is that of the middle, or less by at most a
  /// quarter of half of the diagonal. Cost: a few microseconds.
  struct Bounded {
    double depth_m = 0, bound_m = 0;
  };
  Bounded bounded_m(const Vec3& middle, const Vec3& half) const;
  /// The same bound, not as good, in nanoseconds.
  double box_at_most_m(const Vec3& middle, const Vec3& half) const;
  /// How far a depth may be wrong: what moving to the origin and back rounds.
  double rounding_m() const { return rounding_m_; }

 private:
  struct Cell {
    double depth = 0;   ///< of the cell's middle, right to cell_error_
    double offset = 0;  ///< how far the point may be from where it is the depth, that error added
  };
  Cell cell_at(const Vec3& point) const;
  double distance_outside(const Vec3& point) const;
  bool is_inside(const Vec3& point) const;
  void fill_cells(std::size_t begin, std::size_t end);

  Vec3 origin_ = Vec3::Zero();
  Mesh mesh_;
  Box bounds_;
  double rounding_m_ = 0;
  core::TriangleTree tree_;  ///< for winding numbers
  SegmentDistance distance_;
  double cell_m_ = 1, cell_error_ = 0;
  std::array<int, 3> count_{};
  std::vector<double> cells_;
};

}  // namespace vantage::internal::flight
