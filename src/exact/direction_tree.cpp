#include "exact/direction_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "exact/segment_cover.h"

namespace vantage::internal::exact {
namespace {

constexpr std::size_t kLongList = 20;     // leaves with more blockers than this are split,
constexpr std::uint32_t kDeepest = 14;    // but not below 2^-14 of a quadrant
constexpr double kFutile = 1.6;           // A split that makes the lists this much longer in all is of little use:
                                          // after each of them in a row a list must be twice as long to be split.
constexpr std::size_t kMostRepeats = 32;  // All splits may add so many entries for each blocker; in cities 11.
constexpr double kBoundRounding = 1e-13;  // bounds are good to this fraction

using Corners = DirectionTree::Corners;

}  // namespace

DirectionTree::DirectionTree(const BlockerSet& blockers, const target::RangeRegion& range)
    : blockers_(blockers), range_(range), scratch_(kDeepest + 2) {
  nodes_.reserve(256);
  for (int quadrant = 0; quadrant < 4; ++quadrant) add_node({quadrant, 0, 0, 1}, 0, 0);
  for (std::uint32_t root = 0; root < 4; ++root) split(root);
}

void DirectionTree::add_node(const OctahedralCell& cell, double bound, std::uint32_t depth) {
  const QuadrantLinear below_range = on_quadrant(range_.supporting_plane(cell.centre_direction()), cell.quadrant);
  Node& node = nodes_.emplace_back();
  node.cell = node.leaf.cell = cell;
  node.range = cell.at_corners(below_range);
  node.bound = std::max(bound, *std::min_element(node.range.begin(), node.range.end()));
  node.depth = depth;
}

// Leaves out planes that stay above another one of the blocker's all over the cell. False, with nothing to be relied on
// in `reduced`, where one plane alone shows that the blocker is hidden.
bool DirectionTree::reduce(const Node& node, std::span<const std::uint32_t> planes, CellBlocker& reduced) {
  corners_.clear();
  for (std::uint32_t plane : planes) {
    const Corners& corners =
        corners_.emplace_back(node.cell.at_corners(on_quadrant(blockers_.planes[plane], node.cell.quadrant)));
    const double upper = std::max(std::max(corners[0], corners[1]), std::max(corners[2], corners[3]));
    if (upper < node.bound * (1 - kBoundRounding) || below(corners, node.range)) return false;
  }
  reduced.planes.clear();
  reduced.values.clear();
  reduced.least.fill(std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Corners& corners = corners_[k];
    if (std::any_of(reduced.values.begin(), reduced.values.end(), [&](const Corners& v) { return below(v, corners); }))
      continue;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < reduced.values.size(); ++i) {
      if (below(corners, reduced.values[i])) continue;
      reduced.values[kept] = reduced.values[i];
      reduced.planes[kept++] = reduced.planes[i];
    }
    reduced.values.resize(kept);
    reduced.planes.resize(kept);
    reduced.values.push_back(corners);
    reduced.planes.push_back(planes[k]);
    for (int c = 0; c < 4; ++c) reduced.least[c] = std::min(reduced.least[c], corners[c]);
  }
  return true;
}

// Under each plane of the higher one there must be a plane of the lower one over the whole cell. Sufficient, not
// necessary. It is tried only where the corners allow it.
bool DirectionTree::stays_under(std::span<const Corners> low, std::span<const Corners> high) {
  for (const Corners& h : high)
    if (std::none_of(low.begin(), low.end(), [&](const Corners& l) { return below(l, h); })) return false;
  return true;
}

bool DirectionTree::hidden_in(const Node& node, const CellBlocker& reduced) {
  return std::any_of(node.dominators.begin(), node.dominators.end(), [&](const CellBlocker& dominator) {
    return !dominator.values.empty() && below(reduced.least, dominator.least) &&
           stays_under(reduced.values, dominator.values);
  });
}

void DirectionTree::consider_dominator(Node& node, const CellBlocker& reduced) {
  const double least = *std::min_element(reduced.least.begin(), reduced.least.end());
  node.bound = std::max(node.bound, least);
  double middle = std::numeric_limits<double>::infinity();
  for (const Corners& v : reduced.values) middle = std::min(middle, v[0] + v[1] + v[2] + v[3]);
  const std::array<double, 2> scores{least, middle};
  for (std::size_t i = 0; i < 2; ++i) {
    if (scores[i] > node.dominator_score[i]) {
      node.dominator_score[i] = scores[i];
      node.dominators[i] = reduced;
    }
  }
}

// Drops from the list what the new one hides.
void DirectionTree::add_to_leaf(Leaf& leaf, std::uint32_t index, const CellBlocker& reduced) {
  std::size_t kept = 0;
  std::uint32_t end = 0;
  for (std::size_t i = 0; i < leaf.count(); ++i) {
    const std::uint32_t begin = leaf.first_plane[i], count = leaf.first_plane[i + 1] - begin;
    if (below(leaf.least[i], reduced.least) && stays_under(leaf.values_of(i), reduced.values)) continue;
    if (begin != end) {
      std::copy_n(leaf.values.begin() + begin, count, leaf.values.begin() + end);
      std::copy_n(leaf.planes.begin() + begin, count, leaf.planes.begin() + end);
    }
    leaf.blockers[kept] = leaf.blockers[i];
    leaf.least[kept] = leaf.least[i];
    leaf.first_plane[kept++] = end;
    end += count;
  }
  leaf.blockers.resize(kept);
  leaf.first_plane.resize(kept + 1);
  leaf.first_plane[kept] = end;
  leaf.planes.resize(end);
  leaf.values.resize(end);
  leaf.least.resize(kept);
  leaf.blockers.push_back(index);
  leaf.least.push_back(reduced.least);
  leaf.planes.insert(leaf.planes.end(), reduced.planes.begin(), reduced.planes.end());
  leaf.values.insert(leaf.values.end(), reduced.values.begin(), reduced.values.end());
  leaf.first_plane.push_back(static_cast<std::uint32_t>(leaf.planes.size()));
}

bool DirectionTree::hides_box(const Vec3& centre, const std::array<Vec3, 3>& half_extents) const {
  if (centre.z() <= 0) return false;
  for (std::uint32_t blocker : leaf_at(to_octahedral(centre)).blockers) {
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
  for (const Vec3& point : points) centre += point / static_cast<double>(points.size());
  if (centre.z() <= 0) return false;
  for (std::uint32_t blocker : leaf_at(to_octahedral(centre)).blockers) {
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
  std::vector<std::uint32_t>& all = scratch_.back().planes;
  all.resize(blockers_.first[index + 1] - blockers_.first[index]);
  std::iota(all.begin(), all.end(), blockers_.first[index]);
  const PolygonCone* cone = cone_of(index, cone_);
  bool shown = false;
  for (std::uint32_t root = 0; root < 4; ++root) shown |= insert_below(root, index, all, cone);
  return shown;
}

// Null for a blocker that is not confined to what its polygon covers.
const PolygonCone* DirectionTree::cone_of(std::uint32_t blocker, PolygonCone& cone) const {
  if (!blockers_.confined[blocker]) return nullptr;
  cone.assign(blockers_.corners_of(blocker));
  return &cone;
}

bool DirectionTree::insert_below(std::uint32_t at, std::uint32_t index, std::span<const std::uint32_t> planes,
                                 const PolygonCone* cone) {
  if (cone && cone->misses(nodes_[at].cell)) return false;
  const bool leaf = nodes_[at].first_child == 0;
  // What a cone confines to a few leaves is too small to matter to the cells above them.
  if (leaf || !cone) {
    CellBlocker& reduced = scratch_[nodes_[at].depth];
    if (!reduce(nodes_[at], planes, reduced) || !insert_into(nodes_[at], index, reduced)) return false;
    planes = reduced.planes;
  }
  if (leaf) {
    if (is_worth_splitting(nodes_[at])) split(at);
    return true;
  }
  bool shown = false;
  double bound = std::numeric_limits<double>::infinity();
  const std::uint32_t first = nodes_[at].first_child, count = nodes_[at].child_count;
  for (std::uint32_t child = first; child < first + count; ++child) {
    shown |= insert_below(child, index, planes, cone);
    bound = std::min(bound, nodes_[child].bound);
  }
  nodes_[at].bound = std::max(nodes_[at].bound, bound);
  return shown;
}

// The shadows of sheets that share an edge run side by side through the same cells: no split separates them, and lists
// would be repeated until memory ends. So what all splits add is bounded, in proportion to the blockers.
bool DirectionTree::is_worth_splitting(const Node& node) const {
  if (node.leaf.count() <= kLongList << node.futile_splits || node.depth == kDeepest) return false;
  return repeats_ <= kMostRepeats * blockers_.count();
}

// False when the blocker is hidden all over the cell.
bool DirectionTree::insert_into(Node& node, std::uint32_t index, const CellBlocker& reduced) {
  if (std::none_of(reduced.planes.begin(), reduced.planes.end(), [&](std::uint32_t k) { return blockers_.visible[k]; }))
    return false;
  if (hidden_in(node, reduced)) return false;
  if (node.first_child == 0) {
    for (std::size_t i = 0; i < node.leaf.count(); ++i)
      if (below(reduced.least, node.leaf.least[i]) && stays_under(reduced.values, node.leaf.values_of(i))) return false;
    add_to_leaf(node.leaf, index, reduced);
  }
  consider_dominator(node, reduced);
  return true;
}

void DirectionTree::split(std::uint32_t at) {
  const OctahedralCell cell = nodes_[at].cell;
  const double half = cell.size / 2, bound = nodes_[at].bound;
  const std::uint32_t depth = nodes_[at].depth + 1, first = static_cast<std::uint32_t>(nodes_.size());
  add_node({cell.quadrant, cell.a, cell.b, half}, bound, depth);
  add_node({cell.quadrant, cell.a + half, cell.b, half}, bound, depth);
  add_node({cell.quadrant, cell.a, cell.b + half, half}, bound, depth);
  if (!cell.at_horizon()) add_node({cell.quadrant, cell.a + half, cell.b + half, half}, bound, depth);
  nodes_[at].first_child = first;
  nodes_[at].child_count = static_cast<std::uint32_t>(nodes_.size()) - first;
  const Leaf leaf = std::move(nodes_[at].leaf);
  nodes_[at].leaf = Leaf();
  for (std::size_t i = 0; i < leaf.count(); ++i) {
    const PolygonCone* cone = cone_of(leaf.blockers[i], listed_cone_);
    for (std::uint32_t child = first; child < static_cast<std::uint32_t>(nodes_.size()); ++child) {
      if (cone && cone->misses(nodes_[child].cell)) continue;
      CellBlocker& reduced = scratch_[depth];
      const std::span<const std::uint32_t> planes(leaf.planes.data() + leaf.first_plane[i],
                                                  leaf.first_plane[i + 1] - leaf.first_plane[i]);
      if (reduce(nodes_[child], planes, reduced)) insert_into(nodes_[child], leaf.blockers[i], reduced);
    }
  }
  std::size_t listed = 0;
  for (std::uint32_t child = first; child < static_cast<std::uint32_t>(nodes_.size()); ++child)
    listed += nodes_[child].leaf.count();
  const bool futile = static_cast<double>(listed) > kFutile * static_cast<double>(leaf.count());
  repeats_ += std::max(listed, leaf.count()) - leaf.count();
  for (std::uint32_t child = first; child < static_cast<std::uint32_t>(nodes_.size()); ++child)
    nodes_[child].futile_splits = futile ? nodes_[at].futile_splits + 1 : 0;
}

std::vector<const DirectionTree::Leaf*> DirectionTree::leaves() const {
  std::vector<const Leaf*> result;
  for (const Node& node : nodes_)
    if (node.first_child == 0 && node.leaf.count() > 0) result.push_back(&node.leaf);
  return result;
}

void DirectionTree::leaves_over(int quadrant, const std::array<OctahedralPoint, 3>& triangle,
                                std::vector<const Leaf*>& found) const {
  std::array<Eigen::Vector2d, 3> corners;
  for (int i = 0; i < 3; ++i) corners[i] = triangle[i].cwiseAbs();
  const Eigen::Vector2d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Eigen::Vector2d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  std::array<QuadrantLinear, 3> sides;  // at most 0 inside
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d &from = corners[i], along = corners[(i + 1) % 3] - from,
                          to_third = corners[(i + 2) % 3] - from;
    const double turn = along.x() * to_third.y() - along.y() * to_third.x() > 0 ? 1 : -1;
    sides[i] = {turn * (along.x() * from.y() - along.y() * from.x()), turn * along.y(), -turn * along.x()};
  }
  std::array<std::uint32_t, 4 * (kDeepest + 1)> open;
  std::size_t count = 0;
  open[count++] = static_cast<std::uint32_t>(quadrant);
  while (count > 0) {
    const Node& node = nodes_[open[--count]];
    const OctahedralCell& cell = node.cell;
    if (low.x() > cell.a + cell.size || high.x() < cell.a || low.y() > cell.b + cell.size || high.y() < cell.b)
      continue;
    const bool apart = std::any_of(sides.begin(), sides.end(),
                                   [&](const QuadrantLinear& s) { return cell.min_of(s) > kBoundRounding; });
    if (apart) continue;
    if (node.first_child == 0) found.push_back(&node.leaf);
    for (std::uint32_t child = 0; child < node.child_count; ++child) open[count++] = node.first_child + child;
  }
}

std::vector<std::uint32_t> DirectionTree::listed_between(const Vec3& normal, double low, double high) const {
  std::vector<std::uint32_t> found, open{0, 1, 2, 3};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    const QuadrantLinear value = on_quadrant(normal, node.cell.quadrant);
    if (node.cell.max_of(value) < low || node.cell.min_of(value) > high) continue;
    for (std::uint32_t child = 0; child < node.child_count; ++child) open.push_back(node.first_child + child);
    found.insert(found.end(), node.leaf.blockers.begin(), node.leaf.blockers.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

const DirectionTree::Leaf& DirectionTree::leaf_at(const OctahedralPoint& point) const {
  const double a = std::abs(point.x()), b = std::abs(point.y());
  std::uint32_t at = static_cast<std::uint32_t>(quadrant_of(point.x(), point.y()));
  while (nodes_[at].first_child != 0) {
    const OctahedralCell& cell = nodes_[at].cell;
    const double half = cell.size / 2;
    std::uint32_t child = (a >= cell.a + half ? 1u : 0u) + (b >= cell.b + half ? 2u : 0u);
    if (child >= nodes_[at].child_count) child = a - cell.a > b - cell.b ? 1 : 2;  // beyond the horizon by rounding
    at = nodes_[at].first_child + child;
  }
  return nodes_[at].leaf;
}

}  // namespace vantage::internal::exact
