#include "simplify/surface.h"

#include <algorithm>
#include <utility>

namespace vantage::internal::simplify {

Surface::Surface(const Mesh& mesh, std::vector<std::uint32_t> piece_of)
    : vertices_(mesh.vertices),
      facets_(mesh.triangles),
      gone_(mesh.triangles.size(), 0),
      piece_of_(std::move(piece_of)),
      stars_(mesh.triangles, mesh.vertices.size()),
      count_(mesh.triangles.size()),
      count_in_tree_(count_),
      tree_(make_tree()) {
  for (const std::uint32_t piece : piece_of_) pieces_ = std::max(pieces_, piece + 1);
}

FacetTree Surface::make_tree() const {
  std::vector<Box> boxes(facets_.size());
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    if (gone_[f]) continue;
    for (const std::uint32_t v : facets_[f]) boxes[f].extend(vertices_[v]);
  }
  return FacetTree(boxes);
}

Corners Surface::corners_after(const Patch& patch, std::uint32_t f, const Vec3& place) const {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = facets_[f][k];
    corners[k] = v == patch.from || v == patch.to ? place : vertices_[v];
  }
  return corners;
}

void Surface::neighbours(std::uint32_t v, std::vector<std::uint32_t>& found) const {
  found.clear();
  for (const std::uint32_t f : star(v)) {
    for (const std::uint32_t w : facets_[f]) {
      if (w != v) found.push_back(w);
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

bool Surface::find_patch(std::uint32_t from, std::uint32_t to, Patch& patch) const {
  patch.from = from;
  patch.to = to;
  patch.facets.clear();
  const auto holds = [&](std::uint32_t f, std::uint32_t v) {
    return facets_[f][0] == v || facets_[f][1] == v || facets_[f][2] == v;
  };
  for (const std::uint32_t f : star(from)) {
    if (holds(f, to)) patch.facets.push_back(f);
  }
  if (patch.facets.size() != 2) return false;
  patch.gone = 2;
  for (const std::uint32_t f : star(from)) {
    if (!holds(f, to)) patch.facets.push_back(f);
  }
  for (const std::uint32_t f : star(to)) {
    if (!holds(f, from)) patch.facets.push_back(f);
  }
  // Each neighbour is a corner of two facets; one that both ends have, of four.
  thread_local std::vector<std::uint32_t> of_from, of_to;
  neighbours(from, of_from);
  neighbours(to, of_to);
  std::size_t common = 0;
  for (std::size_t i = 0, k = 0; i < of_from.size() && k < of_to.size();) {
    if (of_from[i] == of_to[k]) ++common;
    const bool is_less = of_from[i]<of_to[k], is_more = of_from[i]> of_to[k];
    i += is_more ? 0 : 1;
    k += is_less ? 0 : 1;
  }
  return common == 2 && patch.facets.size() > 4;
}

void Surface::remove(std::uint32_t f) {
  gone_[f] = 1;
  --count_;
  for (const std::uint32_t v : facets_[f]) stars_.remove(v, f);
  tree_.update(f, Box{});
}

void Surface::collapse(const Patch& patch, const Vec3& place) {
  for (std::size_t i = 0; i < patch.gone; ++i) remove(patch.facets[i]);
  vertices_[patch.from] = place;
  for (std::size_t i = patch.gone; i < patch.facets.size(); ++i) {
    const std::uint32_t f = patch.facets[i];
    for (std::uint32_t& v : facets_[f]) {
      if (v != patch.to) continue;
      v = patch.from;
      stars_.add(patch.from, f);
    }
    Box box;
    for (const std::uint32_t v : facets_[f]) box.extend(vertices_[v]);
    tree_.update(f, box);
  }
  stars_.clear(patch.to);
  thin_out();
}

void Surface::drop(std::span<const std::uint32_t> facets) {
  for (const std::uint32_t f : facets) remove(f);
  thin_out();
}

/// The boxes of facets that have grown overlap more and more.
void Surface::thin_out() {
  if (count_ > count_in_tree_ - count_in_tree_ / 4) return;
  count_in_tree_ = count_;
  tree_ = make_tree();
}

}  // namespace vantage::internal::simplify
