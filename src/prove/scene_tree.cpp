#include "prove/scene_tree.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace vantage::internal::prove {
namespace {

constexpr std::uint32_t kMostInLeaf = 2;

/// `middle`: of a piece, twice that of its box.
template <class Middle>
class Halver {
 public:
  Halver(const Middle& middle, SceneTree& tree) : middle_(middle), tree_(tree) {}

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
    for (std::uint32_t i = begin; i < end; ++i) spread.extend(middle_(tree_.pieces[i]));
    const Vec3 size = spread.max - spread.min;
    Eigen::Index axis = 0;
    for (Eigen::Index k = 1; k < 3; ++k) {
      if (size[k] > size[axis]) axis = k;
    }
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(at(begin), at(half), at(end), [&](const Piece& a, const Piece& b) {
      const double at_a = middle_(a)[axis], at_b = middle_(b)[axis];
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
  const Middle& middle_;
  SceneTree& tree_;
};

template <class Middle>
SceneTree halved(const Middle& middle, std::vector<Piece> pieces) {
  SceneTree tree;
  tree.pieces = std::move(pieces);
  if (!tree.pieces.empty()) Halver(middle, tree).halve(0, static_cast<std::uint32_t>(tree.pieces.size()));
  return tree;
}

Vec3 twice_middle(std::span<const Vec3> corners) {
  Vec3 low = corners[0], high = low;
  for (const Vec3& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return low + high;
}

}  // namespace

SceneTree make_tree(const Mesh& scene, std::vector<Piece> pieces) {
  std::vector<Vec3> middles(scene.triangles.size());
  for (const Piece& piece : pieces) {
    const auto& [a, b, c] = scene.triangles[piece.of];
    middles[piece.of] = twice_middle(std::array<Vec3, 3>{scene.vertices[a], scene.vertices[b], scene.vertices[c]});
  }
  return halved([&](const Piece& piece) -> const Vec3& { return middles[piece.of]; }, std::move(pieces));
}

SceneTree make_tree(std::vector<Piece> pieces) {
  return halved([](const Piece& piece) { return twice_middle(piece.polygon()); }, std::move(pieces));
}

}  // namespace vantage::internal::prove
