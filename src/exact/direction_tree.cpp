#include "exact/direction_tree.h"

#include <algorithm>
#include <limits>

#include "exact/segment_cover.h"

namespace vantage::exact {
namespace {

constexpr std::size_t kLongList = 16;   // leaves with more blockers than this are split,
constexpr std::uint32_t kDeepest = 14;  // but not below 1/512 of a quadrant
constexpr double kRounding = 1e-13;     // comparisons of planes at corners are good to this fraction

}  // namespace

void BlockerSet::close(std::uint32_t scene_polygon) {
  first.push_back(std::uint32_t(planes.size()));
  first_corner.push_back(std::uint32_t(corners.size()));
  polygon.push_back(scene_polygon);
}

void BlockerSet::drop_last() {
  first.pop_back();
  first_corner.pop_back();
  polygon.pop_back();
  planes.resize(first.back());
  corners.resize(first_corner.back());
}

DirectionTree::DirectionTree(const BlockerSet& blockers, const RangeRegion& range)
    : blockers_(blockers), range_(range) {
  nodes_.reserve(256);
  for (int quadrant = 0; quadrant < 4; ++quadrant) add_node({quadrant, 0, 0, 1}, 0, 0);
  for (std::uint32_t root = 0; root < 4; ++root) split(root);
}

void DirectionTree::add_node(const ChartCell& cell, double bound, std::uint32_t depth) {
  const QuadrantLinear below_range = on_quadrant(range_.supporting_plane(cell.centre_direction()), cell.quadrant);
  Node& node = nodes_.emplace_back();
  node.cell = cell;
  node.range = cell.at_corners(below_range);
  node.bound = std::max(bound, *std::min_element(node.range.begin(), node.range.end()));
  node.depth = depth;
}

void DirectionTree::evaluate(const ChartCell& cell, std::span<const Plane> planes, std::vector<Corners>& values) {
  values.resize(planes.size());
  for (std::size_t k = 0; k < planes.size(); ++k) values[k] = cell.at_corners(on_quadrant(planes[k], cell.quadrant));
}

namespace {

double least_of(std::span<const std::array<double, 4>> values) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& v : values) least = std::min(least, std::min(std::min(v[0], v[1]), std::min(v[2], v[3])));
  return least;
}

double upper_of(std::span<const std::array<double, 4>> values) {
  double upper = std::numeric_limits<double>::infinity();
  for (const auto& v : values) upper = std::min(upper, std::max(std::max(v[0], v[1]), std::max(v[2], v[3])));
  return upper;
}

bool below(const std::array<double, 4>& low, const std::array<double, 4>& high) {
  constexpr double k = 1 + kRounding;
  return low[0] <= high[0] * k && low[1] <= high[1] * k && low[2] <= high[2] * k && low[3] <= high[3] * k;
}

}  // namespace

// Under each plane of the champion there must be a plane of the other over the whole cell. Sufficient, not necessary.
bool DirectionTree::stays_under(std::span<const Corners> values, std::span<const Corners> champion) {
  if (champion.empty()) return false;
  for (const Corners& high : champion)
    if (std::none_of(values.begin(), values.end(), [&](const Corners& low) { return below(low, high); })) return false;
  return true;
}

bool DirectionTree::hidden_in(const Node& node, std::span<const Corners> values) {
  if (upper_of(values) < node.bound * (1 - kRounding)) return true;
  if (std::any_of(values.begin(), values.end(), [&](const Corners& v) { return below(v, node.range); })) return true;
  return stays_under(values, node.champions[0].values) || stays_under(values, node.champions[1].values);
}

bool DirectionTree::hidden_in_leaf(const Node& leaf, std::span<const Corners> values) {
  for (std::size_t i = 0; i < leaf.list.size(); ++i)
    if (stays_under(values, {leaf.values.data() + leaf.first_value[i], leaf.first_value[i + 1] - leaf.first_value[i]}))
      return true;
  return false;
}

void DirectionTree::consider_champion(Node& node, std::span<const Corners> values) {
  const double least = least_of(values);
  node.bound = std::max(node.bound, least);
  double middle = std::numeric_limits<double>::infinity();
  for (const Corners& v : values) middle = std::min(middle, v[0] + v[1] + v[2] + v[3]);
  const std::array<double, 2> scores{least, middle};
  for (std::size_t i = 0; i < 2; ++i)
    if (scores[i] > node.champions[i].score) {
      node.champions[i].score = scores[i];
      node.champions[i].values.assign(values.begin(), values.end());
    }
}

// Drops from the list what the new one hides.
void DirectionTree::add_to_leaf(Node& leaf, std::uint32_t index, std::span<const Corners> values) {
  if (leaf.first_value.empty()) leaf.first_value.push_back(0);
  std::size_t kept = 0;
  std::uint32_t end = 0;
  for (std::size_t i = 0; i < leaf.list.size(); ++i) {
    const std::uint32_t begin = leaf.first_value[i], count = leaf.first_value[i + 1] - begin;
    if (stays_under({leaf.values.data() + begin, count}, values)) continue;
    if (begin != end) std::copy_n(leaf.values.begin() + begin, count, leaf.values.begin() + end);
    leaf.list[kept] = leaf.list[i];
    leaf.first_value[kept++] = end;
    end += count;
  }
  leaf.list.resize(kept);
  leaf.first_value.resize(kept);
  leaf.values.resize(end);
  leaf.list.push_back(index);
  leaf.first_value.push_back(end);
  leaf.values.insert(leaf.values.end(), values.begin(), values.end());
  leaf.first_value.push_back(std::uint32_t(leaf.values.size()));
}

bool DirectionTree::hides_box(const Vec3& centre, const std::array<Vec3, 3>& half_extents) const {
  if (centre.z() <= 0) return false;
  for (std::uint32_t blocker : blockers_at(to_chart(centre))) {
    bool hides = true;
    for (const Plane& plane : blockers_.planes_of(blocker)) {
      double least = plane.dot(centre);
      for (const Vec3& half : half_extents) least -= std::abs(plane.dot(half));
      if (!(least > 1)) {
        hides = false;
        break;
      }
    }
    if (hides) return true;
  }
  return false;
}

bool DirectionTree::hides_hull(std::span<const Vec3> points) const {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& point : points) centre += point / double(points.size());
  if (centre.z() <= 0) return false;
  for (std::uint32_t blocker : blockers_at(to_chart(centre))) {
    bool hides = true;
    for (const Plane& plane : blockers_.planes_of(blocker)) {
      for (const Vec3& point : points) hides = hides && plane.dot(point) > 1 + tie_margin(plane, range_.radius());
      if (!hides) break;
    }
    if (hides) return true;
  }
  return false;
}

bool DirectionTree::insert(std::uint32_t index) {
  bool shown = false;
  for (std::uint32_t root = 0; root < 4; ++root) shown |= insert_below(root, index);
  return shown;
}

bool DirectionTree::insert_below(std::uint32_t at, std::uint32_t index) {
  {
    Node& node = nodes_[at];
    evaluate(node.cell, blockers_.planes_of(index), scratch_);
    if (hidden_in(node, scratch_)) return false;
    if (node.first_child == 0) {
      if (hidden_in_leaf(node, scratch_)) return false;
      consider_champion(node, scratch_);
      add_to_leaf(node, index, scratch_);
      if (node.list.size() > kLongList && node.depth < kDeepest) split(at);
      return true;
    }
    consider_champion(node, scratch_);
  }
  bool shown = false;
  double bound = std::numeric_limits<double>::infinity();
  const std::uint32_t first = nodes_[at].first_child, count = nodes_[at].child_count;
  for (std::uint32_t child = first; child < first + count; ++child) {
    shown |= insert_below(child, index);
    bound = std::min(bound, nodes_[child].bound);
  }
  nodes_[at].bound = std::max(nodes_[at].bound, bound);
  return shown;
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
  const std::vector<std::uint32_t> list = std::move(nodes_[at].list);
  nodes_[at].first_value = {};
  nodes_[at].values = {};
  for (std::uint32_t child = first; child < std::uint32_t(nodes_.size()); ++child) {
    Node& node = nodes_[child];
    for (std::uint32_t index : list) {
      evaluate(node.cell, blockers_.planes_of(index), scratch_);
      if (hidden_in(node, scratch_) || hidden_in_leaf(node, scratch_)) continue;
      consider_champion(node, scratch_);
      add_to_leaf(node, index, scratch_);
    }
  }
}

std::vector<DirectionTree::Leaf> DirectionTree::leaves() const {
  std::vector<Leaf> result;
  for (const Node& node : nodes_)
    if (node.first_child == 0) result.push_back({node.cell, node.bound, node.list});
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
  return nodes_[at].list;
}

}  // namespace vantage::exact
