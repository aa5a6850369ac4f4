#include "prove/rounded_surface.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "prove/distance.h"
#include "prove/limited_volume.h"
#include "prove/tree_search.h"
#include "prove/triangle_distance.h"

namespace vantage::internal::prove {

RoundedSurface::RoundedSurface(const Mesh& volume, double rounding_m) : rounding_m_(rounding_m) {
  if (rounding_m == 0) return;
  std::vector<Piece> pieces;
  for (const auto& [a, b, c] : volume.triangles) {
    facets_.push_back({volume.vertices[a], volume.vertices[b], volume.vertices[c]});
    pieces.push_back(Piece::triangle(facets_.back(), static_cast<std::uint32_t>(pieces.size())));
  }
  tree_ = make_tree(std::move(pieces));
}

bool RoundedSurface::was_below_for_sure(const Vec3& on_surface, double depth_m) const {
  if (rounding_m_ == 0) return true;
  constexpr int kTried = 8;
  for (int i = 1; i <= kTried; ++i) {
    const Vec3 position = on_surface * (1 - depth_m / on_surface.norm() * i / kTried);
    if (is_clear(position) && turns_round(facets_, position).value_or(0) != 0) return true;
  }
  return false;
}

bool RoundedSurface::is_clear(const Vec3& position) const {
  const Box here{position, position};
  bool is_clear = true;
  search_tree(
      tree_, [&](const Box& box) { return !is_clear || distance_of_boxes(here, box) > rounding_m_; },
      [&](std::uint32_t i) {
        is_clear = is_clear && distance_from(position, tree_.pieces[i].first_three()) > rounding_m_;
      });
  return is_clear;
}

}  // namespace vantage::internal::prove
