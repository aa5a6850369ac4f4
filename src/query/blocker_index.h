// The blockers of one target, and which of them may matter in which directions: makes many points quick to answer.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exact/blocker.h"
#include "scene/prepared_data.h"

namespace vantage::internal::query {

/// Holds the planes of every blocker, built once, and a tree of triangular cells over the hemisphere of directions. A
/// cell lists the blockers that may hide something there, with a bound of how near they begin, nearest first. Cells are
/// divided where points come by often enough to pay for it. The bounds come from the planes alone, with room for
/// rounding: what for_each leaves out could not have changed an answer by a single bit. So the answers depend neither
/// on which cells are divided nor on the threads that ask.
class BlockerIndex {
 public:
  struct Blocker {
    std::uint32_t first_plane = 0, plane_count = 0;
    std::uint32_t object = 0;  ///< of the scene
    std::uint32_t polygon = 0;
    std::uint32_t leaf = 0;  ///< node of the scene's hierarchy that holds the polygon
  };
  struct Entry {
    float bound;            ///< of the inverse distance at which it begins, for directions with |x| + |y| + |z| = 1
    std::uint32_t blocker;  ///< for blocker()
    std::uint32_t plane;    ///< the one that gives the bound, for plane(): the first to try
  };

  /// Indexes the polygons in `leaves` (nodes of the scene's hierarchy), for points up to `reach` metres from the
  /// target's centre. Keeps references to nothing. Uses the threads of the caller's arena. Cost: O(N M) for each
  /// polygon, as BlockerBuilder.
  BlockerIndex(const PreparedScene::Data& scene, const TargetFrame& frame, const target::LocalTarget& target,
               std::span<const std::uint32_t> leaves, double reach);
  ~BlockerIndex();
  BlockerIndex(const BlockerIndex&) = delete;
  BlockerIndex& operator=(const BlockerIndex&) = delete;

  std::size_t blocker_count() const { return blockers_.size(); }
  const Blocker& blocker(std::uint32_t index) const { return blockers_[index]; }
  const exact::Plane& plane(std::uint32_t index) const { return planes_[index]; }
  std::span<const exact::Plane> planes_of(const Blocker& blocker) const {
    return {planes_.data() + blocker.first_plane, blocker.plane_count};
  }

  /// Calls visit(entry, bound) for what may be met along `direction` (unit length, z >= 0), in order of falling bound,
  /// until it returns false. `bound`: no smaller than the least of g . direction over the blocker's planes g, as
  /// doubles have it. Any number of threads may call it at once.
  template <typename Visit>
  void for_each(const Vec3& direction, const Visit& visit) {
    const double sum = direction.cwiseAbs().sum(), scale = sum * (1 + 1e-12);
    Cell& cell = cell_at(direction, sum);
    std::size_t looked_at = 0;
    for (const Entry& entry : cell.entries) {
      ++looked_at;
      if (!visit(entry, entry.bound * scale)) break;
    }
    if (is_worth_dividing(cell, looked_at)) divide(cell);
  }

 private:
  struct Cell {
    std::array<Vec3, 3> corners;  ///< directions with |x| + |y| + z = 1
    std::vector<Entry> entries;
    std::atomic<std::array<Cell, 4>*> children = nullptr;  ///< at each corner, and between them
    std::atomic<std::size_t> work = 0;                     ///< entries looked at
    std::atomic<bool> is_settled = false;                  ///< divided, or never to be
    int depth = 0;
  };

  Cell& cell_at(const Vec3& direction, double sum);
  bool is_worth_dividing(Cell& cell, std::size_t looked_at) const;
  void divide(Cell& cell);
  void build_blockers(const PreparedScene::Data& scene, const TargetFrame& frame, const target::LocalTarget& target,
                      std::span<const std::uint32_t> leaves);
  static void free_below(Cell& cell);

  std::vector<Blocker> blockers_;
  std::vector<exact::Plane> planes_;
  double least_bound_;
  std::array<Cell, 4> roots_;
  std::atomic<std::size_t> entry_count_ = 0;
  std::size_t most_entries_ = 0;
};

}  // namespace vantage::internal::query
