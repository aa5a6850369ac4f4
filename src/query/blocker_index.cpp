#include "query/blocker_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "exact/collect.h"

namespace vantage::internal::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What g . d may come out larger than the bound from a cell's corners says, of |x| + |y| + |z| of g: the product has
/// rounding errors of 4e-16, and the direction's place in the cell another 1e-15 or so.
constexpr double kDirectionRounding = 1e-14;

constexpr int kDeepest = 11;             // cells of half a milliradian
constexpr std::size_t kFewEntries = 12;  // not worth dividing for
constexpr std::size_t kPatience = 8;     // entries looked at, for each in the list, before it is divided
constexpr std::size_t kLeavesAtOnce = 64;

float rounded_up(double value) {
  const auto result = static_cast<float>(value);
  return static_cast<double>(result) < value ? std::nextafter(result, std::numeric_limits<float>::infinity()) : result;
}

/// For each child of a cell the least, over a blocker's planes, of the greatest value that a plane takes in it.
class Bounds {
 public:
  void take(std::uint32_t index, double a, double b, double c, double room) {
    const double ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    take(0, index, std::max({a, ab, ca}) + room);
    take(1, index, std::max({b, bc, ab}) + room);
    take(2, index, std::max({c, ca, bc}) + room);
    take(3, index, std::max({ab, bc, ca}) + room);
  }
  double bound(std::size_t child) const { return bound_[child]; }
  std::uint32_t plane(std::size_t child) const { return plane_[child]; }

 private:
  void take(std::size_t child, std::uint32_t index, double value) {
    if (!(value < bound_[child])) return;
    bound_[child] = value;
    plane_[child] = index;
  }

  std::array<double, 4> bound_{kInfinity, kInfinity, kInfinity, kInfinity};
  std::array<std::uint32_t, 4> plane_{};
};

void sort_by_bound(std::vector<BlockerIndex::Entry>& entries) {
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.bound != b.bound ? a.bound > b.bound : a.blocker < b.blocker;
  });
}

}  // namespace

BlockerIndex::BlockerIndex(const PreparedScene::Data& scene, const TargetFrame& frame,
                           const target::LocalTarget& target, std::span<const std::uint32_t> leaves, double reach)
    : least_bound_((1 - 1e-9) / (std::sqrt(3.0) * reach)) {
  build_blockers(scene, frame, target, leaves);
  parallel::for_ranges(roots_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Cell& root = roots_[i];
      root.corners = {Vec3(i % 2 == 0 ? 1 : -1, 0, 0), Vec3(0, i / 2 == 0 ? 1 : -1, 0), Vec3(0, 0, 1)};
      for (std::uint32_t b = 0; b < blockers_.size(); ++b) {
        Entry entry{rounded_up(kInfinity), b, blockers_[b].first_plane};
        double least = kInfinity;
        for (std::uint32_t p = 0; p < blockers_[b].plane_count; ++p) {
          const exact::Plane& plane = planes_[blockers_[b].first_plane + p];
          double greatest = -kInfinity;
          for (const Vec3& corner : root.corners) greatest = std::max(greatest, plane.dot(corner));
          greatest += kDirectionRounding * plane.cwiseAbs().sum();
          if (greatest < least) {
            least = greatest;
            entry.plane = blockers_[b].first_plane + p;
          }
        }
        entry.bound = rounded_up(least);
        if (entry.bound > least_bound_) root.entries.push_back(entry);
      }
      sort_by_bound(root.entries);
      entry_count_ += root.entries.size();
    }
  });
  most_entries_ = std::max<std::size_t>(std::size_t{1} << 22, 8 * entry_count_);
}

BlockerIndex::~BlockerIndex() {
  for (Cell& root : roots_) free_below(root);
}

void BlockerIndex::free_below(Cell& cell) {
  std::array<Cell, 4>* children = cell.children.load();
  if (!children) return;
  for (Cell& child : *children) free_below(child);
  delete children;
}

void BlockerIndex::build_blockers(const PreparedScene::Data& scene, const TargetFrame& frame,
                                  const target::LocalTarget& target, std::span<const std::uint32_t> leaves) {
  struct Piece {
    std::vector<Blocker> blockers;
    std::vector<exact::Plane> planes;
  };
  std::vector<Piece> pieces((leaves.size() + kLeavesAtOnce - 1) / kLeavesAtOnce);
  parallel::for_ranges(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    exact::BlockerBuilder builder(target);
    std::vector<Vec3> corners, clipped;
    for (std::size_t i = begin; i < end; ++i) {
      Piece& piece = pieces[i];
      const std::size_t first = i * kLeavesAtOnce, count = std::min(kLeavesAtOnce, leaves.size() - first);
      for (const std::uint32_t leaf : leaves.subspan(first, count)) {
        const core::BvhNode& node = scene.bvh.nodes[leaf];
        for (std::uint32_t polygon = node.first; polygon < node.first + node.count; ++polygon) {
          target::local_polygon(scene, frame, polygon, corners);
          clipped.clear();
          const std::size_t planes_before = piece.planes.size();
          if (!builder.build(corners, piece.planes, clipped)) continue;
          Blocker blocker;
          blocker.first_plane = static_cast<std::uint32_t>(planes_before);
          blocker.plane_count = static_cast<std::uint32_t>(piece.planes.size() - planes_before);
          blocker.object = scene.polygon_object[polygon];
          blocker.polygon = polygon;
          blocker.leaf = leaf;
          piece.blockers.push_back(blocker);
        }
      }
    }
  });
  for (const Piece& piece : pieces) {
    const auto shift = static_cast<std::uint32_t>(planes_.size());
    for (Blocker blocker : piece.blockers) {
      blocker.first_plane += shift;
      blockers_.push_back(blocker);
    }
    planes_.insert(planes_.end(), piece.planes.begin(), piece.planes.end());
  }
}

BlockerIndex::Cell& BlockerIndex::cell_at(const Vec3& direction, double sum) {
  Cell* cell = &roots_[(direction.x() < 0 ? 1 : 0) + (direction.y() < 0 ? 2 : 0)];
  // Weights of the cell's corners; halving the cell doubles them.
  std::array<double, 3> weight = {std::abs(direction.x()) / sum, std::abs(direction.y()) / sum, direction.z() / sum};
  while (std::array<Cell, 4>* children = cell->children.load(std::memory_order_acquire)) {
    std::size_t child = 3;
    for (std::size_t i = 0; i < 3; ++i) {
      if (weight[i] > 0.5) child = i;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      weight[i] = child == 3 ? 1 - 2 * weight[i] : 2 * weight[i] - (i == child ? 1 : 0);
    }
    cell = &(*children)[child];
  }
  return *cell;
}

bool BlockerIndex::is_worth_dividing(Cell& cell, std::size_t looked_at) const {
  if (looked_at <= kFewEntries || cell.is_settled.load(std::memory_order_relaxed)) return false;
  const std::size_t work = cell.work.fetch_add(looked_at, std::memory_order_relaxed) + looked_at;
  return work > kPatience * cell.entries.size();
}

void BlockerIndex::divide(Cell& cell) {
  if (cell.is_settled.exchange(true)) return;  // another thread is at it
  if (cell.depth >= kDeepest || entry_count_.load() > most_entries_) return;
  auto children = std::make_unique<std::array<Cell, 4>>();
  const std::array<Vec3, 3>& c = cell.corners;
  const Vec3 ab = 0.5 * (c[0] + c[1]), bc = 0.5 * (c[1] + c[2]), ca = 0.5 * (c[2] + c[0]);
  (*children)[0].corners = {c[0], ab, ca};
  (*children)[1].corners = {ab, c[1], bc};
  (*children)[2].corners = {ca, bc, c[2]};
  (*children)[3].corners = {bc, ca, ab};
  for (const Entry& entry : cell.entries) {
    const Blocker& blocker = blockers_[entry.blocker];
    Bounds bounds;
    for (std::uint32_t p = blocker.first_plane; p < blocker.first_plane + blocker.plane_count; ++p) {
      const exact::Plane& plane = planes_[p];
      bounds.take(p, plane.dot(c[0]), plane.dot(c[1]), plane.dot(c[2]), kDirectionRounding * plane.cwiseAbs().sum());
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Entry below{rounded_up(bounds.bound(i)), entry.blocker, bounds.plane(i)};
      if (below.bound > least_bound_) (*children)[i].entries.push_back(below);
    }
  }
  std::size_t count = 0;
  for (Cell& child : *children) {
    sort_by_bound(child.entries);
    child.entries.shrink_to_fit();
    child.depth = cell.depth + 1;
    count += child.entries.size();
  }
  entry_count_ += count;
  cell.children.store(children.release(), std::memory_order_release);
}

}  // namespace vantage::internal::query
