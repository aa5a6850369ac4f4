// What all points of a box see of a target, where one test can tell: docs/theory.md, "How much is seen from a box".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "query/side.h"
#include "vantage/fraction.h"

namespace vantage::internal::query {

/// A box with edges along the axes of the scene, metres. Its centre is relative to the target's.
struct SightBox {
  Vec3 centre, half;
};

/// The blockers of one side of a target, as boxes of viewpoints meet them. Any number of threads may use it at once.
class BoxView {
 public:
  /// For boxes within reach of the index. Keeps references to nothing.
  BoxView(const Side& side, const BlockerIndex& index, bool is_point);

  std::size_t blocker_count() const { return blockers_.size(); }
  /// `low`, `high`: in the scene frame.
  SightBox box(const Vec3& low, const Vec3& high) const {
    return {0.5 * (low - origin_ + (high - origin_)), 0.5 * (high - low)};
  }

  enum class Place { behind, across, in_front };
  Place place_of(const SightBox& box) const;

  /// False only where the blocker hides nothing from any point of the box.
  bool may_hide(std::uint32_t blocker, const SightBox& box) const {
    const Blocker& b = blockers_[blocker];
    for (std::uint32_t p = b.first_plane; p < b.first_plane + b.plane_count; ++p) {
      if (planes_[p].dot(box.centre) + planes_[p].cwiseAbs().dot(box.half) <= 1) return false;
    }
    return true;
  }

  /// True only where all of the target is hidden from every point of a box in front of it. `blockers`: those that may
  /// hide some of it.
  bool hides_all(std::span<const std::uint32_t> blockers, const SightBox& box) const;

 private:
  struct Blocker {
    std::uint32_t first_plane, plane_count;
    std::uint32_t first_corner, corner_count;
    std::uint32_t polygon;       ///< of the scene
    bool is_beside;              ///< the target is on one side of the polygon's plane
    Vec3 normal = Vec3::Zero();  ///< of that plane, away from the target
    double height = 0;           ///< of it, along `normal`
  };
  struct Corner {
    Vec3 place;
    std::uint32_t neighbour;  ///< blocker beyond the edge to the next corner, if there is just one
  };
  /// A convex piece of the target, and its halves.
  struct Piece {
    std::vector<Vec3> corners;
    Vec3 centre;               ///< inside
    std::uint32_t halves = 0;  ///< the first of two in `pieces_`; 0: it is not halved
  };
  enum class Crossing { no, yes, unsure };

  void add_corners(const Side& side);
  void find_neighbours(const Side& side);
  void halve(std::uint32_t piece, int depth);
  bool separates(const Blocker& blocker, const SightBox& box) const;
  bool is_clear(const Vec3& a, const Vec3& b, const Piece& piece, const SightBox& box) const;
  Crossing crosses(const Blocker& blocker, const Vec3& from, const Vec3& to) const;
  bool hides_piece(std::span<const std::uint32_t> between, const Piece& piece, const SightBox& box) const;
  bool surface_hides(std::uint32_t first, const Piece& piece, const SightBox& box) const;
  bool hides_point(const Blocker& blocker, const SightBox& box) const;

  std::vector<Blocker> blockers_;
  std::vector<Vec3> planes_;  // g of g . x = 1
  std::vector<Corner> corners_;
  std::vector<Piece> pieces_;  // the whole target first
  Vec3 origin_, up_;
  double slack_, reach_;
  bool is_point_;
};

}  // namespace vantage::internal::query
