#include "prove/scene_tree.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace vantage::internal::prove {
namespace {

constexpr std::uint32_t kMostInLeaf = 2;

class Halver {
 public:
  Halver(const Mesh& scene, SceneTree& tree) : tree_(tree), middles_(scene.triangles.size()) {
    for (const Piece& piece : tree.pieces) {
      const Triangle& t = scene.triangles[piece.of];
      const Vec3 &a = scene.vertices[t[0]], &b = scene.vertices[t[1]], &c = scene.vertices[t[2]];
      middles_[piece.of] = a.cwiseMin(b).cwiseMin(c) + a.cwiseMax(b).cwiseMax(c);
    }
  }

  void halve(std::uint32_t begin, std::uint32_t end) {
    const auto at = [&](std::uint32_t i) { return tree_.pieces.begin() + static_cast<std::ptrdiff_t>(i); };
    const auto index = tree_.nodes.size();
    tree_.nodes.push_back({{}, begin, end, 0});
    if (end - begin <= kMostInLeaf) {
      std::sort(at(begin), at(end), [](const Piece& a, const Piece& b) { return a.of < b.of; });
      for (std::uint32_t i = begin; i < end; ++i) {
        for (const Vec3& corner : tree_.pieces[i].polygon()) tree_.nodes[index].box.extend(corner);
      }
      return;
    }
    Box spread;
    for (std::uint32_t i = begin; i < end; ++i) spread.extend(middles_[tree_.pieces[i].of]);
    const Vec3 size = spread.max - spread.min;
    Eigen::Index axis = 0;
    for (Eigen::Index k = 1; k < 3; ++k) {
      if (size[k] > size[axis]) axis = k;
    }
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(at(begin), at(half), at(end), [&](const Piece& a, const Piece& b) {
      const double at_a = middles_[a.of][axis], at_b = middles_[b.of][axis];
      return at_a < at_b || (at_a == at_b && a.of < b.of);
    });
    halve(begin, half);
    const auto second = static_cast<std::uint32_t>(tree_.nodes.size());
    halve(half, end);
    tree_.nodes[index].second = second;
    for (const std::size_t child : {index + 1, static_cast<std::size_t>(second)}) {
      tree_.nodes[index].box.extend(tree_.nodes[child].box);
    }
  }

 private:
  SceneTree& tree_;
  std::vector<Vec3> middles_;  ///< per triangle of the scene: twice that of its box
};

}  // namespace

SceneTree make_tree(const Mesh& scene, std::vector<Piece> pieces) {
  SceneTree tree;
  tree.pieces = std::move(pieces);
  if (!tree.pieces.empty()) Halver(scene, tree).halve(0, static_cast<std::uint32_t>(tree.pieces.size()));
  return tree;
}

}  // namespace vantage::internal::prove
