#include "simplify/whole_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "simplify/exact.h"
#include "simplify/inner_point.h"

namespace vantage::internal::simplify {
namespace {

bool holds(const Box& outer, const Box& inner) {
  return (outer.min.array() <= inner.min.array()).all() && (outer.max.array() >= inner.max.array()).all();
}

/// A point on the inner side of all the facets, as far as numbers tell.
std::optional<Vec3> inner_point(const Surface& surface, const std::vector<std::uint32_t>& facets) {
  Vec3 middle = Vec3::Zero();
  Box box;
  for (const std::uint32_t f : facets) {
    for (const Vec3& corner : surface.corners(f)) {
      middle += corner;
      box.extend(corner);
    }
  }
  middle /= 3 * static_cast<double>(facets.size());
  const double step = std::ldexp((box.max - box.min).norm(), -40);
  std::vector<HalfSpace> half_spaces;
  for (const std::uint32_t f : facets) {
    const Corners corners = surface.corners(f);
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    half_spaces.push_back({normal, normal.dot(corners[0] - middle) - step});
  }
  const std::optional<Vec3> found = nearest_inner_point(half_spaces, Vec3::Zero());
  return found ? std::optional<Vec3>(middle + *found) : std::nullopt;
}

}  // namespace

WholePieces::WholePieces(const Mesh& mesh, const core::Pieces& pieces)
    : pieces_(pieces.pieces.size()), facets_(pieces.pieces.size()), left_(pieces.pieces.size()) {
  std::vector<Box> boxes(pieces_.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t piece = pieces.piece_of[t];
    facets_[piece].push_back(t);
    for (const std::uint32_t v : mesh.triangles[t]) boxes[piece].extend(mesh.vertices[v]);
  }
  std::vector<std::uint32_t> cavities;
  for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
    pieces_[i].volume_m3 = pieces.pieces[i].volume_m3;
    pieces_[i].facets = pieces_[i].wait_for = facets_[i].size();
    if (!(pieces_[i].volume_m3 > 0)) cavities.push_back(i);
  }
  solid_left_ = left_ - cavities.size();
  for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
    pieces_[i].may_go = pieces_[i].volume_m3 > 0 && std::none_of(cavities.begin(), cavities.end(), [&](auto cavity) {
                          return holds(boxes[i], boxes[cavity]);
                        });
    if (pieces_[i].may_go) waiting_.insert({cost(i), i});
  }
}

double WholePieces::cost(std::uint32_t piece) const {
  return 2 * std::max(0.0, pieces_[piece].volume_m3) / static_cast<double>(pieces_[piece].facets);
}

std::optional<double> WholePieces::cheapest_m3() const {
  if (waiting_.empty() || solid_left_ < 2) return std::nullopt;
  return waiting_.begin()->first;
}

std::optional<std::vector<std::uint32_t>> WholePieces::take_cheapest(const Surface& surface) {
  const std::uint32_t piece = waiting_.begin()->second;
  waiting_.erase(waiting_.begin());
  std::vector<std::uint32_t>& facets = facets_[piece];
  facets.erase(std::remove_if(facets.begin(), facets.end(), [&](std::uint32_t f) { return surface.is_gone(f); }),
               facets.end());
  const std::optional<Vec3> point = inner_point(surface, facets);
  const bool is_inner = point && std::all_of(facets.begin(), facets.end(),
                                             [&](std::uint32_t f) { return side_of(surface.corners(f), *point) >= 0; });
  if (!is_inner) {
    pieces_[piece].wait_for = facets.size() / 2;
    return std::nullopt;
  }
  pieces_[piece].may_go = false;
  --left_;
  --solid_left_;
  return facets;
}

void WholePieces::collapsed(std::uint32_t piece, double loss_m3) {
  State& state = pieces_[piece];
  if (state.may_go) waiting_.erase({cost(piece), piece});
  state.volume_m3 -= loss_m3;
  state.facets -= 2;
  if (state.may_go && state.facets <= std::max<std::size_t>(state.wait_for, 4)) waiting_.insert({cost(piece), piece});
}

}  // namespace vantage::internal::simplify
