// A closed surface of which edges are collapsed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/stars.h"
#include "simplify/exact.h"
#include "simplify/facet_tree.h"
#include "vantage/geometry.h"

namespace vantage::internal::simplify {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// The facets that change when an edge is collapsed: those at either of its ends.
struct Patch {
  std::uint32_t from = 0, to = 0;     ///< the edge
  std::vector<std::uint32_t> facets;  ///< in order
  std::size_t gone = 0;               ///< the first two: they hold the edge
};

class Surface {
 public:
  /// Two facets at each edge, running it in opposite directions; `piece_of` says for each facet which piece it is of.
  Surface(const Mesh& mesh, std::vector<std::uint32_t> piece_of);

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const Triangle& facet(std::uint32_t f) const { return facets_[f]; }
  bool is_gone(std::uint32_t f) const { return gone_[f] != 0; }
  std::size_t slots() const { return facets_.size(); }  ///< facets, those that are gone included
  std::size_t count() const { return count_; }          ///< facets that are not gone
  std::span<const std::uint32_t> star(std::uint32_t v) const { return stars_.of(v); }
  std::uint32_t piece_of(std::uint32_t f) const { return piece_of_[f]; }
  std::uint32_t pieces() const { return pieces_; }  ///< as built
  const FacetTree& tree() const { return tree_; }

  Corners corners(std::uint32_t f) const {
    return {vertices_[facets_[f][0]], vertices_[facets_[f][1]], vertices_[facets_[f][2]]};
  }

  /// Facet `f` of the patch as it is after its edge has been collapsed to `place`.
  Corners corners_after(const Patch& patch, std::uint32_t f, const Vec3& place) const;

  /// Fills in `patch` for the edge; false where collapsing it would not leave a surface: its ends have other neighbours
  /// in common than the two across the edge, or only four facets hang together.
  bool find_patch(std::uint32_t from, std::uint32_t to, Patch& patch) const;

  /// The vertices that share a facet with `v`, without it, in order.
  void neighbours(std::uint32_t v, std::vector<std::uint32_t>& found) const;

  /// The edge's first end moves to `place`, the other one goes, and with it the two facets at the edge.
  void collapse(const Patch& patch, const Vec3& place);

  /// Takes out a whole piece.
  void drop(std::span<const std::uint32_t> facets);

 private:
  FacetTree make_tree() const;
  void remove(std::uint32_t f);
  void thin_out();

  std::vector<Vec3> vertices_;
  std::vector<Triangle> facets_;
  std::vector<char> gone_;
  std::vector<std::uint32_t> piece_of_;
  std::uint32_t pieces_ = 1;
  core::Stars stars_;
  std::size_t count_, count_in_tree_;
  FacetTree tree_;
};

}  // namespace vantage::internal::simplify
