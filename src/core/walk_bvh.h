// The traversal of bounding volume hierarchies: which nodes are entered is the caller's choice, and in which order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <type_traits>
#include <vector>

#include "core/bvh.h"

namespace vantage::internal::core {

namespace walking {

/// A stack that needs no memory of its own until the hierarchy is deep.
template <typename T>
class Stack {
 public:
  bool empty() const { return size_ == 0; }
  void push(const T& value) {
    if (size_ < few_.size()) {
      few_[size_] = value;
    } else {
      more_.push_back(value);
    }
    ++size_;
  }
  T pop() {
    if (--size_ < few_.size()) return few_[size_];
    const T value = more_.back();
    more_.pop_back();
    return value;
  }

 private:
  std::array<T, 64> few_;
  std::vector<T> more_;
  std::size_t size_ = 0;
};

struct Waiting {
  std::uint32_t node;
  double distance;
};

/// The left child before the right one.
class LeftFirst {
 public:
  bool empty() const { return stack_.empty(); }
  Waiting next() { return {stack_.pop(), 0}; }
  void add_root() { stack_.push(0); }
  void add_children(std::uint32_t left) {
    stack_.push(left + 1);
    stack_.push(left);
  }

 private:
  Stack<std::uint32_t> stack_;
};

/// The nearer child before the other one; the left one of two at the same distance.
template <typename Distance>
class NearerFirst {
 public:
  NearerFirst(const Bvh& bvh, const Distance& distance) : bvh_(bvh), distance_(distance) {}
  bool empty() const { return stack_.empty(); }
  Waiting next() { return stack_.pop(); }
  void add_root() { stack_.push(waiting(0)); }
  void add_children(std::uint32_t left) {
    const Waiting a = waiting(left), b = waiting(left + 1);
    const bool left_first = a.distance <= b.distance;
    stack_.push(left_first ? b : a);
    stack_.push(left_first ? a : b);
  }

 private:
  Waiting waiting(std::uint32_t node) const { return {node, distance_(bvh_.nodes[node].bounds)}; }

  const Bvh& bvh_;
  const Distance& distance_;
  Stack<Waiting> stack_;
};

/// The nearest of all nodes, of those within reach; of several at the same distance the one with the lowest rank, or
/// else index.
template <typename Distance>
class NearestFirst {
 public:
  NearestFirst(const Bvh& bvh, const Distance& distance, double reach)
      : bvh_(bvh), distance_(distance), reach_(reach) {}
  bool empty() const { return queue_.empty(); }
  Waiting next() {
    const Ranked nearest = queue_.top();
    queue_.pop();
    return {nearest.node, nearest.distance};
  }
  void add_root() { add(0); }
  void add_children(std::uint32_t left) {
    add(left);
    add(left + 1);
  }

 private:
  struct Ranked {
    std::uint32_t node, rank;
    double distance;
  };
  struct IsLater {
    bool operator()(const Ranked& a, const Ranked& b) const {
      return a.distance != b.distance ? a.distance > b.distance : a.rank > b.rank;
    }
  };

  void add(std::uint32_t node) {
    const double distance = distance_(bvh_.nodes[node].bounds);
    if (distance <= reach_) queue_.push({node, bvh_.rank.empty() ? node : bvh_.rank[node], distance});
  }

  const Bvh& bvh_;
  const Distance& distance_;
  double reach_;
  std::priority_queue<Ranked, std::vector<Ranked>, IsLater> queue_;
};

template <typename Order, typename Enter, typename Visit>
bool walk(const Bvh& bvh, Order order, const Enter& enter, const Visit& visit) {
  if (bvh.nodes.empty()) return true;
  order.add_root();
  while (!order.empty()) {
    const Waiting waiting = order.next();
    const BvhNode& node = bvh.nodes[waiting.node];
    if constexpr (std::is_invocable_v<Enter, const BvhNode&, double>) {
      if (!enter(node, waiting.distance)) continue;
    } else {
      if (!enter(node)) continue;
    }
    if (!node.leaf()) {
      order.add_children(node.first);
      continue;
    }
    for (std::uint32_t item = node.first; item < node.first + node.count; ++item) {
      if constexpr (std::is_same_v<std::invoke_result_t<Visit, std::uint32_t>, bool>) {
        if (!visit(item)) return false;
      } else {
        visit(item);
      }
    }
  }
  return true;
}

}  // namespace walking

/// Calls `enter(node)` for the root and for the children of every inner node that was entered: for which it returned
/// true. Calls `visit(item)` for the items of every leaf that was entered; where it returns a bool, false ends the
/// walk. Depth first, the left child first. Returns whether the walk came to its end.
template <typename Enter, typename Visit>
bool walk_bvh(const Bvh& bvh, const Enter& enter, const Visit& visit) {
  return walking::walk(bvh, walking::LeftFirst(), enter, visit);
}

/// The same, and of two children the one with the smaller `distance(bounds)` first. `enter(node, distance)` may take
/// the distance, too: it may have found something nearer since.
template <typename Distance, typename Enter, typename Visit>
bool walk_nearer_first(const Bvh& bvh, const Distance& distance, const Enter& enter, const Visit& visit) {
  return walking::walk(bvh, walking::NearerFirst<Distance>(bvh, distance), enter, visit);
}

/// The same, and of all nodes that wait the one with the smallest `distance(bounds)` first. Nodes farther away than
/// `reach` are left out.
template <typename Distance, typename Enter, typename Visit>
bool walk_nearest_first(const Bvh& bvh, const Distance& distance, double reach, const Enter& enter,
                        const Visit& visit) {
  return walking::walk(bvh, walking::NearestFirst<Distance>(bvh, distance, reach), enter, visit);
}

}  // namespace vantage::internal::core
