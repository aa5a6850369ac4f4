#include "solid/cell_tree.h"

#include <algorithm>
#include <utility>

#include "solid/clean.h"

namespace vantage::internal::solid {
namespace {

/// Booleans grow with the square of the levels, and so do the facets of what they leave. Up to 16 cells of one cost
/// nothing is rounded: below the root no node has more.
constexpr std::uint64_t kMostLevels = 8;

/// A level whose solid is larger than that of the one before by no more than this part of it is left out.
constexpr double kNoGain = 1e-9;

/// The levels of one node. Above the last level, from `all` on, every position counts.
struct Levels {
  std::vector<MissedAtMost> kept;  ///< ascending in cost and in what they hold; those that hold nothing are left out
  std::uint64_t all = 0;           ///< the cost of all cells below
};

std::uint64_t stride_of(std::uint64_t all) {
  std::uint64_t stride = 1;
  while (all > kMostLevels * stride) stride *= 2;
  return stride;
}

/// Solid, or everywhere.
struct Operand {
  const Solid* solid = nullptr;
  bool is_everywhere = false;
};

/// The positions that miss at most `cost`; neither solid nor everywhere where there are none.
Operand missed_at_most(const Levels& levels, std::uint64_t cost) {
  if (cost >= levels.all) return {nullptr, true};
  const MissedAtMost* best = nullptr;
  for (const MissedAtMost& level : levels.kept) {
    if (level.cost <= cost) best = &level;
  }
  return {best ? &best->solid : nullptr, false};
}

/// Volumes of neighbours all but coincide on many walls. Without this each boolean would double the facets. Only what
/// is as short as rounding is taken away: what that adds, in as many steps as the tree is deep, stays far below what a
/// volume may be off by.
Solid cleaned(const Solid& solid) {
  if (solid.empty()) return solid;
  LabelledMesh labelled = solid.to_mesh();
  CleaningLimits limits = cleaning_limits(0, solid.epsilon(), solid.bounds());
  limits.is_checked = false;
  clean_inward(labelled, Vec3::Zero(), {}, limits);
  return simplified(Solid(labelled, "what sees some cells"));
}

class Tree {
 public:
  Tree(std::span<const std::uint64_t> costs, std::uint64_t budget, const std::function<Solid(std::size_t)>& volume_of,
       const core::ProgressReporter& progress)
      : costs_(costs), budget_(budget), volume_of_(volume_of), progress_(progress), quiet_(progress.part(0, 0)) {
    all_ = effort_of(0, costs.size());
  }

  Solid run() {
    Levels root = node(0, costs_.size(), true);
    return root.kept.empty() ? Solid() : std::move(root.kept.back().solid);
  }

 private:
  Levels node(std::size_t begin, std::size_t end, bool is_root);
  Levels leaf(std::size_t cell);
  static double effort_of(std::size_t begin, std::size_t end);
  void add_effort(double effort);
  Solid level(const Levels& left, const Levels& right, std::uint64_t cost) const;
  std::vector<std::uint64_t> costs_of(const Levels& left, const Levels& right, std::uint64_t most) const;
  std::vector<Solid> solids_of(const Levels& left, const Levels& right, const std::vector<std::uint64_t>& costs,
                               double effort);

  std::span<const std::uint64_t> costs_;
  std::uint64_t budget_;
  const std::function<Solid(std::size_t)>& volume_of_;
  const core::ProgressReporter& progress_;
  core::ProgressReporter quiet_;  // only asks whether to go on
  double done_ = 0, all_ = 0;     // effort
};

/// An estimate of the work for a node by itself: the volumes of many cells have more facets, and more levels.
double own_effort(std::size_t cells) { return static_cast<double>(cells * cells); }

double Tree::effort_of(std::size_t begin, std::size_t end) {
  const std::size_t cells = end - begin, middle = begin + cells / 2;
  return own_effort(cells) + (cells > 1 ? effort_of(begin, middle) + effort_of(middle, end) : 0);
}

void Tree::add_effort(double effort) {
  done_ += effort;
  progress_.report(done_ / all_);
  // What is left will cost about as much for each effort: stop now where a part of that is too much already.
  constexpr double kSurely = 0.3;
  progress_.expect(kSurely * progress_.spent() * (all_ / done_ - 1));
}

Levels Tree::leaf(std::size_t cell) {
  Levels levels;
  levels.all = costs_[cell];
  Solid solid = volume_of_(cell);
  if (!solid.empty()) levels.kept.push_back({0, std::move(solid)});
  add_effort(own_effort(1));
  return levels;
}

/// What misses at most `cost` of two nodes: where it misses at most a of the left one, for each a.
Solid Tree::level(const Levels& left, const Levels& right, std::uint64_t cost) const {
  std::vector<std::uint64_t> shares;
  for (const MissedAtMost& kept : left.kept) {
    if (kept.cost <= cost) shares.push_back(kept.cost);
  }
  if (cost >= left.all) shares.push_back(left.all);
  std::vector<Solid> terms;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const Operand b = missed_at_most(right, cost - shares[i]);
    if (!b.is_everywhere && !b.solid) continue;
    if (i + 1 < shares.size()) {
      // The next one asks less of the left and the same of the right.
      const Operand next = missed_at_most(right, cost - shares[i + 1]);
      if (next.is_everywhere == b.is_everywhere && next.solid == b.solid) continue;
    }
    const Operand a = missed_at_most(left, shares[i]);
    if (a.is_everywhere) {
      terms.push_back(*b.solid);
    } else {
      terms.push_back(b.is_everywhere ? *a.solid : intersect(*a.solid, *b.solid, quiet_));
    }
  }
  std::erase_if(terms, [](const Solid& term) { return term.empty(); });
  if (terms.empty()) return {};
  return cleaned(terms.size() == 1 ? terms.front() : unite(terms, quiet_));
}

/// One after the other: Manifold numbers what it makes, and its results depend on these numbers.
std::vector<Solid> Tree::solids_of(const Levels& left, const Levels& right, const std::vector<std::uint64_t>& costs,
                                   double effort) {
  std::vector<Solid> solids;
  for (const std::uint64_t cost : costs) {
    quiet_.check();
    solids.push_back(level(left, right, cost));
    add_effort(effort / static_cast<double>(costs.size()));
  }
  return solids;
}

/// What two nodes can miss together, rounded up to the stride, up to `most`.
std::vector<std::uint64_t> Tree::costs_of(const Levels& left, const Levels& right, std::uint64_t most) const {
  const auto all_of = [](const Levels& levels) {
    std::vector<std::uint64_t> costs;
    for (const MissedAtMost& level : levels.kept) costs.push_back(level.cost);
    costs.push_back(levels.all);
    return costs;
  };
  const std::uint64_t stride = stride_of(left.all + right.all);
  std::vector<std::uint64_t> costs;
  for (const std::uint64_t a : all_of(left)) {
    for (const std::uint64_t b : all_of(right)) {
      const std::uint64_t rounded = (a + b + stride - 1) / stride * stride;
      if (rounded <= most) costs.push_back(rounded);
    }
  }
  std::sort(costs.begin(), costs.end());
  costs.erase(std::unique(costs.begin(), costs.end()), costs.end());
  return costs;
}

Levels Tree::node(std::size_t begin, std::size_t end, bool is_root) {
  if (end - begin == 1) return leaf(begin);
  const std::size_t middle = begin + (end - begin) / 2;
  const Levels left = node(begin, middle, false), right = node(middle, end, false);
  Levels levels;
  levels.all = left.all + right.all;
  const std::uint64_t most = std::min(budget_, levels.all - 1);
  std::vector<std::uint64_t> costs;
  if (is_root) {
    costs.push_back(most);
  } else {
    costs = costs_of(left, right, most);
  }
  std::vector<Solid> solids = solids_of(left, right, costs, own_effort(end - begin));
  double volume = 0;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const double own = solids[i].empty() ? 0 : solids[i].volume();
    if (!(own > volume * (1 + kNoGain))) continue;
    volume = own;
    levels.kept.push_back({costs[i], std::move(solids[i])});
  }
  return levels;
}

}  // namespace

Solid seen_within(std::span<const std::uint64_t> costs, std::uint64_t budget,
                  const std::function<Solid(std::size_t)>& volume_of, const core::ProgressReporter& progress) {
  return Tree(costs, budget, volume_of, progress).run();
}

}  // namespace vantage::internal::solid
