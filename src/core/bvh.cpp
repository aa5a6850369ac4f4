#include "core/bvh.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/parallel.h"

namespace vantage::internal::core {
namespace {

constexpr std::size_t kLeafSize = 4;
constexpr int kBins = 16;
constexpr std::size_t kParallelSize = 1 << 14;

Bounds empty_bounds() {
  constexpr float inf = std::numeric_limits<float>::infinity();
  return {{inf, inf, inf}, {-inf, -inf, -inf}};
}

void extend(Bounds& bounds, const Bounds& other) {
  for (int a = 0; a < 3; ++a) {
    bounds.min[a] = std::min(bounds.min[a], other.min[a]);
    bounds.max[a] = std::max(bounds.max[a], other.max[a]);
  }
}

float half_area(const Bounds& b) {
  const float x = b.max[0] - b.min[0], y = b.max[1] - b.min[1], z = b.max[2] - b.min[2];
  return x * y + y * z + z * x;
}

float centre(const Bounds& b, int axis) { return 0.5f * (b.min[axis] + b.max[axis]); }

struct Split {
  int axis = -1;
  int bin = 0;  // items in bins <= bin go left
  float low = 0, scale = 0;
};

class Builder {
 public:
  Builder(const std::vector<Bounds>& items, std::vector<std::uint32_t>& order) : items_(items), order_(order) {}

  std::vector<BvhNode> run() {
    std::vector<BvhNode> nodes(1);
    build(nodes, 0, 0, order_.size());
    return nodes;
  }

 private:
  void build(std::vector<BvhNode>& nodes, std::size_t node, std::size_t begin, std::size_t end) {
    Bounds bounds = empty_bounds(), centres = empty_bounds();
    for (std::size_t i = begin; i < end; ++i) {
      const Bounds& item = items_[order_[i]];
      extend(bounds, item);
      for (int a = 0; a < 3; ++a) {
        centres.min[a] = std::min(centres.min[a], centre(item, a));
        centres.max[a] = std::max(centres.max[a], centre(item, a));
      }
    }
    nodes[node].bounds = bounds;
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

  int bin_of(const Split& split, std::uint32_t item) const {
    return std::clamp(static_cast<int>((centre(items_[item], split.axis) - split.low) * split.scale), 0, kBins - 1);
  }

  // Reorders [begin, end) and returns where the right half starts.
  std::size_t partition(std::size_t begin, std::size_t end, const Bounds& centres) {
    const Split split = best_split(begin, end, centres);
    if (split.axis >= 0) {
      const auto middle = std::stable_partition(order_.begin() + begin, order_.begin() + end,
                                                [&](std::uint32_t item) { return bin_of(split, item) <= split.bin; });
      const std::size_t at = static_cast<std::size_t>(middle - order_.begin());
      if (at != begin && at != end) return at;
    }
    return begin + (end - begin) / 2;  // all centres coincide
  }

  Split best_split(std::size_t begin, std::size_t end, const Bounds& centres) const {
    Split best;
    float best_cost = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = centres.max[axis] - centres.min[axis];
      if (!(extent > 0)) continue;
      Split split{axis, 0, centres.min[axis], kBins / extent};
      std::array<Bounds, kBins> bounds;
      std::array<std::size_t, kBins> count{};
      bounds.fill(empty_bounds());
      for (std::size_t i = begin; i < end; ++i) {
        const int bin = bin_of(split, order_[i]);
        extend(bounds[bin], items_[order_[i]]);
        ++count[bin];
      }
      std::array<float, kBins> right_cost{};
      Bounds right = empty_bounds();
      std::size_t right_count = 0;
      for (int bin = kBins - 1; bin > 0; --bin) {
        extend(right, bounds[bin]);
        right_count += count[bin];
        right_cost[bin] = right_count ? half_area(right) * static_cast<float>(right_count) : 0;
      }
      Bounds left = empty_bounds();
      std::size_t left_count = 0;
      for (int bin = 0; bin + 1 < kBins; ++bin) {
        extend(left, bounds[bin]);
        left_count += count[bin];
        if (left_count == 0 || left_count == end - begin) continue;
        const float cost = half_area(left) * static_cast<float>(left_count) + right_cost[bin + 1];
        if (cost < best_cost) {
          best_cost = cost;
          split.bin = bin;
          best = split;
        }
      }
    }
    return best;
  }

  const std::vector<Bounds>& items_;
  std::vector<std::uint32_t>& order_;
};

}  // namespace

Bvh build_bvh(const std::vector<Bounds>& items, std::vector<std::uint32_t>& order) {
  order.resize(items.size());
  std::iota(order.begin(), order.end(), 0u);
  if (items.empty()) return {};
  return {Builder(items, order).run()};
}

}  // namespace vantage::internal::core
