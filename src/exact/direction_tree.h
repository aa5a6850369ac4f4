// Which blockers may be seen in which directions: a quadtree over the chart that culls what is hidden.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exact/blocker.h"
#include "exact/chart.h"
#include "exact/range_region.h"

namespace vantage::exact {

/// Blockers stored one after another: blocker i owns the planes [first[i], first[i + 1]) and likewise its corners.
struct BlockerSet {
  std::vector<Plane> planes;
  std::vector<std::uint32_t> first{0};
  std::vector<Vec3> corners;  ///< of the scene polygon, clipped to the target's front
  std::vector<std::uint32_t> first_corner{0};
  std::vector<std::uint32_t> polygon;  ///< index of the scene polygon

  /// Ends a blocker whose planes and corners have been appended.
  void close(std::uint32_t scene_polygon);
  /// Takes the last one back.
  void drop_last();

  std::size_t count() const { return polygon.size(); }
  std::span<const Plane> planes_of(std::size_t blocker) const {
    return {planes.data() + first[blocker], first[blocker + 1] - first[blocker]};
  }
  std::span<const Vec3> corners_of(std::size_t blocker) const {
    return {corners.data() + first_corner[blocker], first_corner[blocker + 1] - first_corner[blocker]};
  }
};

/// In each cell a few champions, blockers that rise high over all of it, bound the envelope from below. What stays
/// under a champion everywhere in the cell cannot be seen there: that is decided by comparing planes at the cell's
/// corners, so it costs the same for one polygon as for a box full of them. Leaves list the blockers that may be seen
/// and split while the lists are long: the tree is fine only where much is in view.
class DirectionTree {
 public:
  /// Keeps references to both.
  DirectionTree(const BlockerSet& blockers, const RangeRegion& range);

  /// Whether all of a box (centre and half extents along the target's axes) is hidden by one blocker that is listed
  /// where its centre is seen. What is hidden itself adds nothing to the boundary: docs/theory.md, "Only what is seen
  /// can hide".
  bool hides_box(const Vec3& centre, const std::array<Vec3, 3>& half_extents) const;

  /// The same for the convex hull of some points.
  bool hides_hull(std::span<const Vec3> points) const;

  /// Adds blocker `index` of the set wherever it may be seen. False when that is nowhere. To be called in the order of
  /// the indices: of two blockers that coincide the first one stays.
  bool insert(std::uint32_t index);

  struct Leaf {
    ChartCell cell;
    double bound;  ///< lower bound on the envelope in the cell (directions of |x| + |y| + z = 1)
    std::span<const std::uint32_t> blockers;  ///< ascending; none stays under another over the whole cell
  };
  std::vector<Leaf> leaves() const;

  /// Blockers that may be seen in the direction of a chart point.
  std::span<const std::uint32_t> blockers_at(const ChartPoint& point) const;

 private:
  using Corners = std::array<double, 4>;  // a linear function at the corners of a cell

  struct Champion {
    double score = 0;
    std::vector<Corners> values;  // one per plane
  };
  struct Node {
    ChartCell cell;
    double bound;                       // constant lower bound on the envelope
    std::array<double, 4> range;        // linear lower bound on the range region's gauge, at the corners
    std::array<Champion, 2> champions;  // the one with the greatest least value, the one that is greatest at the middle
    std::vector<std::uint32_t> list;    // of a leaf
    std::vector<std::uint32_t> first_value;  // of each in the list, into `values`; one more than the list has
    std::vector<Corners> values;
    std::uint32_t first_child = 0;  // 0: a leaf
    std::uint32_t child_count = 0;
    std::uint32_t depth = 0;
  };

  static void evaluate(const ChartCell& cell, std::span<const Plane> planes, std::vector<Corners>& values);
  static bool stays_under(std::span<const Corners> values, std::span<const Corners> champion);
  static bool hidden_in(const Node& node, std::span<const Corners> values);
  static bool hidden_in_leaf(const Node& leaf, std::span<const Corners> values);
  static void consider_champion(Node& node, std::span<const Corners> values);
  static void add_to_leaf(Node& leaf, std::uint32_t index, std::span<const Corners> values);

  bool insert_below(std::uint32_t node, std::uint32_t index);
  void split(std::uint32_t node);
  void add_node(const ChartCell& cell, double bound, std::uint32_t depth);

  const BlockerSet& blockers_;
  const RangeRegion& range_;
  std::vector<Node> nodes_;
  std::vector<Corners> scratch_;
};

}  // namespace vantage::exact
