#include "exact/direction_tree.h"

#include <algorithm>
#include <limits>

namespace vantage::exact {
namespace {

constexpr std::size_t kLongList = 24;     // leaves with more blockers than this are split,
constexpr std::uint32_t kDeepest = 9;     // but not below 1/512 of a quadrant
constexpr double kRounding = 1 - 1e-12;   // bounds are compared with this margin, so that ties stay listed
constexpr std::size_t kMostPlanes = 256;  // N + 2 M + 1 for 64 vertices and a 32-gon is less

double greatest(const ChartCell& cell, std::span<const QuadrantLinear> planes) {
  double upper = std::numeric_limits<double>::infinity();
  for (const QuadrantLinear& f : planes) upper = std::min(upper, cell.max_of(f));
  return upper;
}

double least(const ChartCell& cell, std::span<const QuadrantLinear> planes) {
  double lower = std::numeric_limits<double>::infinity();
  for (const QuadrantLinear& f : planes) lower = std::min(lower, cell.min_of(f));
  return lower;
}

struct QuadrantBuffer {
  std::array<QuadrantLinear, kMostPlanes> values;
  std::span<const QuadrantLinear> fill(std::span<const Plane> planes, int quadrant) {
    const std::size_t count = std::min(planes.size(), kMostPlanes);
    for (std::size_t i = 0; i < count; ++i) values[i] = on_quadrant(planes[i], quadrant);
    return {values.data(), count};
  }
};

}  // namespace

DirectionTree::DirectionTree(const BlockerSet& blockers, const RangeRegion& range)
    : blockers_(blockers), range_(range) {
  for (int quadrant = 0; quadrant < 4; ++quadrant) add_node({quadrant, 0, 0, 1}, 0, 0);
  for (std::uint32_t root = 0; root < 4; ++root) split(root);
  for (std::uint32_t node = 4, end = std::uint32_t(nodes_.size()); node < end; ++node) split(node);
}

void DirectionTree::add_node(const ChartCell& cell, double bound, std::uint32_t depth) {
  const Plane below_range = range_.supporting_plane(cell.centre_direction());
  Node node{cell, std::max(bound, cell.min_of(on_quadrant(below_range, cell.quadrant)))};
  node.depth = depth;
  node.list = std::uint32_t(lists_.size());
  lists_.emplace_back();
  nodes_.push_back(node);
}

double DirectionTree::upper_bound(const Node& node, std::uint32_t index) const {
  double upper = std::numeric_limits<double>::infinity();
  for (const Plane& plane : blockers_.planes_of(index))
    upper = std::min(upper, node.cell.max_of(on_quadrant(plane, node.cell.quadrant)));
  return upper;
}

bool DirectionTree::may_show(std::span<const Plane> planes) const {
  QuadrantBuffer buffer;
  for (std::uint32_t root = 0; root < 4; ++root)
    if (shows_below(root, buffer.fill(planes, int(root)))) return true;
  return false;
}

bool DirectionTree::shows_below(std::uint32_t at, std::span<const QuadrantLinear> planes) const {
  const Node& node = nodes_[at];
  if (greatest(node.cell, planes) < node.bound * kRounding) return false;
  if (node.first_child == 0) return true;
  for (std::uint32_t child = 0; child < node.child_count; ++child)
    if (shows_below(node.first_child + child, planes)) return true;
  return false;
}

bool DirectionTree::insert(std::uint32_t index) {
  QuadrantBuffer buffer;
  bool shown = false;
  for (std::uint32_t root = 0; root < 4; ++root)
    shown |= insert_below(root, index, buffer.fill(blockers_.planes_of(index), int(root)));
  return shown;
}

bool DirectionTree::insert_below(std::uint32_t at, std::uint32_t index, std::span<const QuadrantLinear> planes) {
  if (greatest(nodes_[at].cell, planes) < nodes_[at].bound * kRounding) return false;
  if (nodes_[at].first_child == 0) {
    Node& leaf = nodes_[at];
    leaf.bound = std::max(leaf.bound, least(leaf.cell, planes));
    lists_[leaf.list].push_back(index);
    if (lists_[leaf.list].size() > kLongList) {
      prune(leaf);
      if (lists_[leaf.list].size() > kLongList && leaf.depth < kDeepest) split(at);
    }
    return true;
  }
  bool shown = false;
  double bound = std::numeric_limits<double>::infinity();
  for (std::uint32_t child = 0; child < nodes_[at].child_count; ++child) {
    shown |= insert_below(nodes_[at].first_child + child, index, planes);
    bound = std::min(bound, nodes_[nodes_[at].first_child + child].bound);
  }
  nodes_[at].bound = std::max(nodes_[at].bound, bound);
  return shown;
}

void DirectionTree::prune(Node& node) {
  std::erase_if(lists_[node.list],
                [&](std::uint32_t index) { return upper_bound(node, index) < node.bound * kRounding; });
}

void DirectionTree::split(std::uint32_t at) {
  const ChartCell cell = nodes_[at].cell;
  const double half = cell.size / 2, bound = nodes_[at].bound;
  const std::uint32_t depth = nodes_[at].depth + 1, first = std::uint32_t(nodes_.size());
  add_node({cell.quadrant, cell.a, cell.b, half}, bound, depth);
  add_node({cell.quadrant, cell.a + half, cell.b, half}, bound, depth);
  add_node({cell.quadrant, cell.a, cell.b + half, half}, bound, depth);
  if (!cell.at_horizon()) add_node({cell.quadrant, cell.a + half, cell.b + half, half}, bound, depth);
  nodes_[at].first_child = first;
  nodes_[at].child_count = std::uint32_t(nodes_.size()) - first;
  const std::vector<std::uint32_t> list = std::move(lists_[nodes_[at].list]);
  lists_[nodes_[at].list].clear();
  QuadrantBuffer buffer;
  for (std::uint32_t index : list) {
    const auto planes = buffer.fill(blockers_.planes_of(index), cell.quadrant);
    for (std::uint32_t child = first; child < first + nodes_[at].child_count; ++child) {
      Node& node = nodes_[child];
      if (greatest(node.cell, planes) < node.bound * kRounding) continue;
      node.bound = std::max(node.bound, least(node.cell, planes));
      lists_[node.list].push_back(index);
    }
  }
  for (std::uint32_t child = first; child < first + nodes_[at].child_count; ++child) prune(nodes_[child]);
}

std::vector<DirectionTree::Leaf> DirectionTree::leaves() const {
  std::vector<Leaf> result;
  for (const Node& node : nodes_) {
    if (node.first_child != 0) continue;
    Leaf leaf{node.cell, node.bound, {}};
    for (std::uint32_t index : lists_[node.list])
      if (upper_bound(node, index) >= node.bound * kRounding) leaf.blockers.push_back(index);
    result.push_back(std::move(leaf));
  }
  return result;
}

std::span<const std::uint32_t> DirectionTree::blockers_at(const ChartPoint& point) const {
  const double a = std::abs(point.x()), b = std::abs(point.y());
  std::uint32_t at = std::uint32_t(quadrant_of(point.x(), point.y()));
  while (nodes_[at].first_child != 0) {
    const ChartCell& cell = nodes_[at].cell;
    const double half = cell.size / 2;
    std::uint32_t child = (a >= cell.a + half ? 1u : 0u) + (b >= cell.b + half ? 2u : 0u);
    if (child >= nodes_[at].child_count) child = a - cell.a > b - cell.b ? 1 : 2;  // beyond the horizon by rounding
    at = nodes_[at].first_child + child;
  }
  return lists_[nodes_[at].list];
}

}  // namespace vantage::exact
