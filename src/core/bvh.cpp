#include "core/bvh.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "core/parallel.h"

namespace vantage::internal::core {
namespace {

constexpr std::size_t kLeafSize = 4;
constexpr int kBins = 16;
constexpr std::size_t kParallelSize = 1 << 14;

// Four numbers are as fast as one. The fourth is zero.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

Float4 all(float value) { return Float4{value, value, value, value}; }

struct Box4 {
  Float4 min, max;

  static Box4 empty() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return {all(kInfinity), all(-kInfinity)};
  }
  static Box4 of(const Bounds& b) {
    return {Float4{b.min[0], b.min[1], b.min[2], 0}, Float4{b.max[0], b.max[1], b.max[2], 0}};
  }
  Bounds bounds() const { return {{min[0], min[1], min[2]}, {max[0], max[1], max[2]}}; }

  void extend(const Box4& other) {
    min = min < other.min ? min : other.min;
    max = max > other.max ? max : other.max;
  }
  Float4 centre() const { return 0.5f * (min + max); }
  float half_area() const {
    const Float4 size = max - min;
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

struct Item {
  Box4 box;
  std::uint32_t index;
};

/// Into which bins the centre of a box falls, along each axis.
struct Binning {
  Float4 low, scale;  // of no extent: 0

  explicit Binning(const Box4& centres) : low(centres.min) {
    const Float4 extent = centres.max - centres.min;
    for (int axis = 0; axis < 4; ++axis) scale[axis] = extent[axis] > 0 ? kBins / extent[axis] : 0;
  }
  Int4 bins_of(const Box4& box) const {
    constexpr Int4 kFirst{0, 0, 0, 0}, kLast{kBins - 1, kBins - 1, kBins - 1, kBins - 1};
    const Int4 bins = __builtin_convertvector((box.centre() - low) * scale, Int4);
    const Int4 positive = bins > kFirst ? bins : kFirst;
    return positive < kLast ? positive : kLast;
  }
};

struct Split {
  int axis = -1;
  int bin = 0;  // items in bins <= bin go left
};

struct Bins {
  std::array<Box4, kBins> boxes;  // only of those that have items
  std::array<std::size_t, kBins> count{};
};

class Builder {
 public:
  explicit Builder(const std::vector<Bounds>& items) : items_(items.size()), right_(items.size()) {
    for (std::uint32_t i = 0; i < items.size(); ++i) items_[i] = {Box4::of(items[i]), i};
  }

  std::vector<BvhNode> run(std::vector<std::uint32_t>& order) {
    std::vector<BvhNode> nodes(1);
    build(nodes, 0, 0, items_.size());
    order.resize(items_.size());
    for (std::size_t i = 0; i < items_.size(); ++i) order[i] = items_[i].index;
    return nodes;
  }

 private:
  void build(std::vector<BvhNode>& nodes, std::size_t node, std::size_t begin, std::size_t end) {
    Box4 box = Box4::empty(), centres = Box4::empty();
    for (std::size_t i = begin; i < end; ++i) {
      box.extend(items_[i].box);
      const Float4 centre = items_[i].box.centre();
      centres.extend({centre, centre});
    }
    nodes[node].bounds = box.bounds();
    nodes[node].first = static_cast<std::uint32_t>(begin);
    nodes[node].count = static_cast<std::uint32_t>(end - begin);
    if (end - begin <= kLeafSize) return;
    const std::size_t middle = partition(begin, end, centres);
    const std::size_t left = nodes.size();
    nodes[node].first = static_cast<std::uint32_t>(left);
    nodes[node].count = 0;
    nodes.resize(left + 2);
    if (end - begin < kParallelSize) {
      build(nodes, left, begin, middle);
      build(nodes, left + 1, middle, end);
      return;
    }
    std::vector<BvhNode> below[2];
    const auto grow = [&](int side, std::size_t from, std::size_t to) {
      below[side].resize(1);
      build(below[side], 0, from, to);
    };
    parallel::both([&] { grow(0, begin, middle); }, [&] { grow(1, middle, end); });
    for (int side = 0; side < 2; ++side) append(nodes, left + side, below[side]);
  }

  // Puts a subtree built apart under `node`: its root replaces the node, the rest goes to the end.
  static void append(std::vector<BvhNode>& nodes, std::size_t node, const std::vector<BvhNode>& subtree) {
    const std::uint32_t shift = static_cast<std::uint32_t>(nodes.size()) - 1;
    const auto moved = [&](BvhNode n) {
      if (!n.leaf()) n.first += shift;
      return n;
    };
    nodes[node] = moved(subtree[0]);
    for (std::size_t i = 1; i < subtree.size(); ++i) nodes.push_back(moved(subtree[i]));
  }

  // Reorders [begin, end) and returns where the right half starts.
  std::size_t partition(std::size_t begin, std::size_t end, const Box4& centres) {
    const Binning binning(centres);
    const Split split = best_split(begin, end, binning);
    if (split.axis >= 0) {
      std::size_t left = begin, right = begin;
      for (std::size_t i = begin; i < end; ++i) {
        if (binning.bins_of(items_[i].box)[split.axis] <= split.bin) {
          items_[left++] = items_[i];
        } else {
          right_[right++] = items_[i];
        }
      }
      std::copy(right_.begin() + static_cast<std::ptrdiff_t>(begin),
                right_.begin() + static_cast<std::ptrdiff_t>(right),
                items_.begin() + static_cast<std::ptrdiff_t>(left));
      if (left != begin && left != end) return left;
    }
    return begin + (end - begin) / 2;  // all centres coincide
  }

  Split best_split(std::size_t begin, std::size_t end, const Binning& binning) const {
    std::array<Bins, 3> bins;
    for (std::size_t i = begin; i < end; ++i) {
      const Int4 at = binning.bins_of(items_[i].box);
      for (int axis = 0; axis < 3; ++axis) {
        Box4& box = bins[axis].boxes[at[axis]];
        if (bins[axis].count[at[axis]]++ == 0) {
          box = items_[i].box;
        } else {
          box.extend(items_[i].box);
        }
      }
    }
    Split best;
    float best_cost = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const auto& [boxes, count] = bins[axis];
      std::array<float, kBins> right_cost{};  // of what is right of a bin
      Box4 right = Box4::empty();
      std::size_t right_count = 0;
      for (int bin = kBins - 1; bin >= 0; --bin) {
        if (count[bin] == 0) continue;
        right_cost[bin] = right_count ? right.half_area() * static_cast<float>(right_count) : 0;
        right.extend(boxes[bin]);
        right_count += count[bin];
      }
      Box4 left = Box4::empty();
      std::size_t left_count = 0;
      for (int bin = 0; left_count + count[bin] < end - begin; ++bin) {
        if (count[bin] == 0) continue;  // as good as the bin before it
        left.extend(boxes[bin]);
        left_count += count[bin];
        const float cost = left.half_area() * static_cast<float>(left_count) + right_cost[bin];
        if (cost < best_cost) {
          best_cost = cost;
          best = {axis, bin};
        }
      }
    }
    return best;
  }

  std::vector<Item> items_, right_;  // in the order so far; those that go right, for partition
};

/// The items of one group, and the hierarchy over them.
struct Group {
  Bvh bvh;
  std::vector<std::uint32_t> order;  // of the items in its leaves
  std::uint32_t rank = 0;            // of its root
};

/// Puts a hierarchy over the roots of groups, split in the middle of the longest side.
class TopBuilder {
 public:
  TopBuilder(const std::vector<Group>& groups, std::vector<std::uint32_t>& order) : groups_(groups), order_(order) {}

  Bvh run() {
    std::vector<std::uint32_t> all(groups_.size());
    std::iota(all.begin(), all.end(), 0u);
    bvh_.nodes.resize(1);
    bvh_.rank.resize(1);
    build(0, all);
    return std::move(bvh_);
  }

 private:
  static Box4 box_of(const Group& group) { return Box4::of(group.bvh.nodes.front().bounds); }

  void build(std::size_t node, std::span<std::uint32_t> groups) {
    if (groups.size() == 1) return place(node, groups_[groups.front()]);
    Box4 box = Box4::empty(), centres = Box4::empty();
    for (const std::uint32_t group : groups) {
      const Box4 own = box_of(groups_[group]);
      box.extend(own);
      centres.extend({own.centre(), own.centre()});
    }
    const Float4 extent = centres.max - centres.min;
    int axis = 0;
    for (int other = 1; other < 3; ++other) axis = extent[other] > extent[axis] ? other : axis;
    const auto middle = groups.begin() + static_cast<std::ptrdiff_t>(groups.size() / 2);
    std::nth_element(groups.begin(), middle, groups.end(), [&](std::uint32_t a, std::uint32_t b) {
      const float at_a = box_of(groups_[a]).centre()[axis], at_b = box_of(groups_[b]).centre()[axis];
      return at_a != at_b ? at_a < at_b : a < b;
    });
    const std::size_t left = bvh_.nodes.size();
    bvh_.nodes[node] = {box.bounds(), static_cast<std::uint32_t>(left), 0};
    bvh_.nodes.resize(left + 2);
    bvh_.rank.resize(left + 2);
    build(left, {groups.begin(), middle});
    build(left + 1, {middle, groups.end()});
  }

  /// The group's root becomes the node; what is below it goes to the end.
  void place(std::size_t node, const Group& group) {
    const auto shift = static_cast<std::uint32_t>(bvh_.nodes.size()) - 1;
    const auto first_item = static_cast<std::uint32_t>(order_.size());
    const auto moved = [&](BvhNode n) {
      n.first += n.leaf() ? first_item : shift;
      return n;
    };
    bvh_.nodes[node] = moved(group.bvh.nodes.front());
    bvh_.rank[node] = group.rank;
    for (std::uint32_t i = 1; i < group.bvh.nodes.size(); ++i) {
      bvh_.nodes.push_back(moved(group.bvh.nodes[i]));
      bvh_.rank.push_back(group.rank + i);
    }
    order_.insert(order_.end(), group.order.begin(), group.order.end());
  }

  const std::vector<Group>& groups_;
  std::vector<std::uint32_t>& order_;
  Bvh bvh_;
};

}  // namespace

Bvh build_bvh_of_groups(const std::vector<Bounds>& items, const std::vector<std::uint64_t>& group_of,
                        std::vector<std::uint32_t>& order) {
  order.clear();
  if (items.empty()) return {};
  std::vector<std::uint32_t> sorted(items.size());
  std::iota(sorted.begin(), sorted.end(), 0u);
  std::stable_sort(sorted.begin(), sorted.end(), [&](auto a, auto b) { return group_of[a] < group_of[b]; });
  std::vector<Group> groups;
  std::uint32_t rank = 1;
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    std::vector<Bounds> own;
    for (end = begin; end < sorted.size() && group_of[sorted[end]] == group_of[sorted[begin]]; ++end) {
      own.push_back(items[sorted[end]]);
    }
    Group& group = groups.emplace_back();
    group.bvh = build_bvh(own, group.order);
    for (std::uint32_t& item : group.order) item = sorted[begin + item];
    group.rank = rank;
    rank += static_cast<std::uint32_t>(group.bvh.nodes.size());
  }
  return TopBuilder(groups, order).run();
}

Bvh build_bvh(const std::vector<Bounds>& items, std::vector<std::uint32_t>& order) {
  order.clear();
  if (items.empty()) return {};
  return {Builder(items).run(order)};
}

}  // namespace vantage::internal::core
