#include "prove/rounded_surface.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "prove/distance.h"
#include "prove/tree_search.h"
#include "prove/triangle_distance.h"
#include "prove/winding.h"

namespace vantage::internal::prove {

RoundedSurface::RoundedSurface(const Mesh& volume, double rounding_m) : rounding_m_(rounding_m) {
  std::vector<Piece> pieces;
  for (const auto& [a, b, c] : volume.triangles) {
    const std::array<Vec3, 3> corners = {volume.vertices[a], volume.vertices[b], volume.vertices[c]};
    pieces.push_back(Piece::triangle(corners, static_cast<std::uint32_t>(pieces.size())));
    for (const Vec3& corner : corners) box_.extend(corner);
  }
  const double largest = std::max(box_.min.cwiseAbs().maxCoeff(), box_.max.cwiseAbs().maxCoeff());
  constexpr double kRoundings = 16;  // of a place and of its distance
  rounding_m_ += kRoundings * std::numeric_limits<double>::epsilon() * largest;
  tree_ = make_tree(std::move(pieces));
}

std::optional<double> RoundedSurface::surely_held(const Vec3& on_surface, double depth_m) const {
  const double distance = on_surface.norm();
  if (!(distance > 0)) return std::nullopt;
  constexpr int kTried = 8, kHalvings = 24;
  double part = 1.0 / kTried;
  for (int i = 0; i < kHalvings; ++i, part /= 2) {
    if (surely_holds(on_surface * (1 - part * depth_m / distance)) || surely_holds(on_surface * (1 + part))) return 0;
  }
  for (int i = 2; i <= kTried; ++i) {
    const double nearer_m = depth_m * i / kTried;
    if (surely_holds(on_surface * (1 - nearer_m / distance))) return nearer_m;
  }
  return std::nullopt;
}

bool RoundedSurface::surely_holds(const Vec3& position) const {
  return turns_round(position).value_or(0) != 0 && is_clear(position);
}

/// As Winding counts, with a tree.
std::optional<int> RoundedSurface::turns_round(const Vec3& position) const {
  if (!(position.array() >= box_.min.array()).all() || !(position.array() <= box_.max.array()).all()) return 0;
  const double height = 2 * (box_.max.z() - box_.min.z()) + 1;
  for (const Vec3& way : Winding::ways()) {
    const Vec3 end = position + height * way;
    const Vec3 low = position.cwiseMin(end), high = position.cwiseMax(end);
    int turns = 0;
    bool is_known = true;
    search_tree(
        tree_,
        [&](const Box& box) {
          return !is_known || (box.min.array() > high.array()).any() || (box.max.array() < low.array()).any();
        },
        [&](std::uint32_t i) {
          const std::optional<int> passes = passage(position, end, tree_.pieces[i].first_three());
          is_known = is_known && passes;
          turns += passes.value_or(0);
        });
    if (is_known) return turns;
  }
  return std::nullopt;
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
