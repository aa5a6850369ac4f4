// Which blockers may be seen in which directions: a quadtree over the octahedral map that culls what is hidden.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exact/blocker_set.h"
#include "exact/octahedral_map.h"
#include "exact/polygon_cone.h"
#include "target/range_region.h"

namespace vantage::internal::exact {

/// In each cell a blocker is reduced to the planes that can be its least there, most often one or two. A few
/// dominators, blockers that rise high over all of the cell, bound the envelope from below. What stays under a
/// dominator everywhere in the cell cannot be seen there; comparing planes at the cell's corners decides that. Leaves
/// list the blockers that may be seen and split while the lists are long: the tree is fine only where much is in view.
class DirectionTree {
 public:
  /// Keeps references to both.
  DirectionTree(const BlockerSet& blockers, const target::RangeRegion& range);

  /// Whether all of a box (centre and half extents, target's frame) is hidden by one blocker that is listed where its
  /// centre is seen. What is hidden itself adds nothing to the boundary: docs/theory.md, "Only what is seen can hide".
  bool hides_box(const Vec3& centre, const std::array<Vec3, 3>& half_extents) const;

  /// The same for the convex hull of some points.
  bool hides_hull(std::span<const Vec3> points) const;

  /// Adds blocker `index` of the set wherever it may be seen. False when that is nowhere. To be called in the order of
  /// the indices: of two blockers that coincide the first one stays.
  bool insert(std::uint32_t index);

  using Corners = CellCorners;

  /// What may be seen in a cell. Blocker i of the list keeps the planes [first_plane[i], first_plane[i + 1]) of
  /// `planes` (indices into BlockerSet::planes), with their values at the cell's corners.
  struct Leaf {
    OctahedralCell cell;
    std::vector<std::uint32_t> blockers;
    std::vector<std::uint32_t> first_plane{0};
    std::vector<std::uint32_t> planes;
    std::vector<Corners> values;
    std::vector<Corners> least;  ///< per blocker: the least of its planes at each corner

    std::size_t count() const { return blockers.size(); }
    std::span<const Corners> values_of(std::size_t i) const {
      return {values.data() + first_plane[i], first_plane[i + 1] - first_plane[i]};
    }
  };
  std::vector<const Leaf*> leaves() const;
  const Leaf& leaf_at(const OctahedralPoint& point) const;

  /// Appends the leaves of one quadrant whose cells a triangle of the octahedral map meets, and perhaps some that it
  /// only nearly meets.
  void leaves_over(int quadrant, const std::array<OctahedralPoint, 3>& triangle, std::vector<const Leaf*>& found) const;

  /// The blockers listed in cells that a direction with low <= normal . direction <= high (|x| + |y| + z = 1) may lie
  /// in, ascending.
  std::vector<std::uint32_t> listed_between(const Vec3& normal, double low, double high) const;

 private:
  /// A blocker over a cell: the planes that matter there, and the least of them at each corner.
  struct CellBlocker {
    std::vector<std::uint32_t> planes;
    std::vector<Corners> values;
    Corners least{};
  };
  struct Node {
    OctahedralCell cell{};
    double bound = 0;                       // constant lower bound on the envelope
    Corners range{};                        // linear lower bound on the range region's gauge
    std::array<CellBlocker, 2> dominators;  // of greatest least value; greatest at the middle
    std::array<double, 2> dominator_score{};
    Leaf leaf;
    std::uint32_t first_child = 0;  // 0: a leaf
    std::uint32_t child_count = 0;
    std::uint32_t depth = 0;
    std::uint32_t futile_splits = 0;  // of the last ancestors in a row
  };

  bool reduce(const Node& node, std::span<const std::uint32_t> planes, CellBlocker& reduced);
  static bool stays_under(std::span<const Corners> low, std::span<const Corners> high);
  static bool hidden_in(const Node& node, const CellBlocker& reduced);
  static void consider_dominator(Node& node, const CellBlocker& reduced);
  static void add_to_leaf(Leaf& leaf, std::uint32_t index, const CellBlocker& reduced);

  const PolygonCone* cone_of(std::uint32_t blocker, PolygonCone& cone) const;
  bool insert_below(std::uint32_t node, std::uint32_t index, std::span<const std::uint32_t> planes,
                    const PolygonCone* cone);
  bool insert_into(Node& node, std::uint32_t index, const CellBlocker& reduced);
  bool is_worth_splitting(const Node& node) const;
  void split(std::uint32_t node);
  void add_node(const OctahedralCell& cell, double bound, std::uint32_t depth);

  const BlockerSet& blockers_;
  const target::RangeRegion& range_;
  std::vector<Node> nodes_;
  std::size_t repeats_ = 0;           // entries of lists that all splits together have added
  std::vector<CellBlocker> scratch_;  // one per level
  std::vector<Corners> corners_;
  PolygonCone cone_, listed_cone_;  // of what is inserted; of what a split deals out
};

}  // namespace vantage::internal::exact
