#include "simplify/facet_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/walk_bvh.h"

namespace vantage::internal::simplify {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr core::Bounds kNowhere = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};

core::Bounds bounds_of(const Box& box) {
  if (box.empty()) return kNowhere;
  core::Bounds bounds = {};
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<float>(box.min[axis]), high = static_cast<float>(box.max[axis]);
    bounds.min[axis] = low > box.min[axis] ? std::nextafter(low, -kFar) : low;
    bounds.max[axis] = high < box.max[axis] ? std::nextafter(high, kFar) : high;
  }
  return bounds;
}

void extend(core::Bounds& bounds, const core::Bounds& by) {
  for (int axis = 0; axis < 3; ++axis) {
    bounds.min[axis] = std::min(bounds.min[axis], by.min[axis]);
    bounds.max[axis] = std::max(bounds.max[axis], by.max[axis]);
  }
}

bool have_common_point(const core::Bounds& a, const core::Bounds& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
  }
  return true;
}

}  // namespace

FacetTree::FacetTree(const std::vector<Box>& facets) : leaf_of_(facets.size(), 0), boxes_(facets.size(), kNowhere) {
  std::vector<core::Bounds> items;
  std::vector<std::uint32_t> facet_of;
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    if (facets[f].empty()) continue;
    boxes_[f] = bounds_of(facets[f]);
    items.push_back(boxes_[f]);
    facet_of.push_back(f);
  }
  tree_ = core::build_bvh(items, order_);
  for (std::uint32_t& item : order_) item = facet_of[item];
  parent_.assign(tree_.nodes.size(), 0);
  for (std::uint32_t n = 0; n < tree_.nodes.size(); ++n) {
    const core::BvhNode& node = tree_.nodes[n];
    if (!node.leaf()) {
      parent_[node.first] = parent_[node.first + 1] = n;
      continue;
    }
    for (std::uint32_t i = 0; i < node.count; ++i) leaf_of_[order_[node.first + i]] = n;
  }
}

void FacetTree::fit(std::uint32_t n) {
  core::BvhNode& node = tree_.nodes[n];
  node.bounds = kNowhere;
  if (node.leaf()) {
    for (std::uint32_t i = 0; i < node.count; ++i) extend(node.bounds, boxes_[order_[node.first + i]]);
  } else {
    extend(node.bounds, tree_.nodes[node.first].bounds);
    extend(node.bounds, tree_.nodes[node.first + 1].bounds);
  }
}

void FacetTree::update(std::uint32_t facet, const Box& box) {
  boxes_[facet] = bounds_of(box);
  std::uint32_t node = leaf_of_[facet];
  for (;;) {
    fit(node);
    if (node == 0) return;
    node = parent_[node];
  }
}

void FacetTree::find(const Box& box, std::vector<std::uint32_t>& found) const {
  if (tree_.nodes.empty()) return;
  const core::Bounds bounds = bounds_of(box);
  core::walking::Stack<std::uint32_t> stack;
  stack.push(0);
  while (!stack.empty()) {
    const core::BvhNode& node = tree_.nodes[stack.pop()];
    if (!have_common_point(node.bounds, bounds)) continue;
    if (!node.leaf()) {
      stack.push(node.first + 1);
      stack.push(node.first);
      continue;
    }
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t facet = order_[node.first + i];
      if (have_common_point(boxes_[facet], bounds)) found.push_back(facet);
    }
  }
}

}  // namespace vantage::internal::simplify
