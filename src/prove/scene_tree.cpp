#include "prove/scene_tree.h"

#include <algorithm>
#include <cstddef>

namespace vantage::internal::prove {
namespace {

constexpr std::uint32_t kMostInLeaf = 2;

Vec3 middle(const TreeTriangle& triangle) {
  const Vec3 low = triangle.corners[0].cwiseMin(triangle.corners[1]).cwiseMin(triangle.corners[2]);
  const Vec3 high = triangle.corners[0].cwiseMax(triangle.corners[1]).cwiseMax(triangle.corners[2]);
  return low + high;
}

void split(SceneTree& tree, std::uint32_t begin, std::uint32_t end) {
  const auto index = tree.nodes.size();
  tree.nodes.push_back({{}, begin, end, 0});
  Box box, middles;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const Vec3& corner : tree.triangles[i].corners) box.extend(corner);
    middles.extend(middle(tree.triangles[i]));
  }
  tree.nodes[index].box = box;
  if (end - begin <= kMostInLeaf) return;
  Eigen::Index axis = 0;
  (middles.max - middles.min).maxCoeff(&axis);
  const std::uint32_t half = begin + (end - begin) / 2;
  const auto at = [&](std::uint32_t i) { return tree.triangles.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(half), at(end), [&](const TreeTriangle& a, const TreeTriangle& b) {
    const double at_a = middle(a)[axis], at_b = middle(b)[axis];
    return at_a < at_b || (at_a == at_b && a.of < b.of);
  });
  split(tree, begin, half);
  tree.nodes[index].second = static_cast<std::uint32_t>(tree.nodes.size());
  split(tree, half, end);
}

}  // namespace

SceneTree make_tree(std::vector<TreeTriangle> triangles) {
  SceneTree tree;
  tree.triangles = std::move(triangles);
  if (!tree.triangles.empty()) split(tree, 0, static_cast<std::uint32_t>(tree.triangles.size()));
  return tree;
}

}  // namespace vantage::internal::prove
