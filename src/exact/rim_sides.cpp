#include "exact/rim_sides.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage::internal::exact {

RimSides::RimSides(std::vector<ConstraintGraph::Edge> rim) : rim_(std::move(rim)) {
  for (auto& [a, b] : rim_) {
    if (a > b) std::swap(a, b);
  }
  std::sort(rim_.begin(), rim_.end());
}

const char* RimSides::find(const ConstrainedDelaunay& delaunay, const std::function<bool(const Triangle&)>& is_outside,
                           const std::function<bool(const OctahedralPoint&)>& is_beyond, std::vector<char>& found) {
  constexpr char kOutside = 2, kUnknown = 3;
  const auto& facets = delaunay.facets();
  const auto& points = delaunay.vertices();
  state_.assign(facets.size(), kUnknown);
  std::uint32_t largest = 0;
  double most = 0;
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    const Triangle& t = facets[f].vertices;
    if (is_outside(t)) {
      state_[f] = kOutside;
      continue;
    }
    const OctahedralPoint a = points[t[1]] - points[t[0]], b = points[t[2]] - points[t[0]];
    const double area = std::abs(a.x() * b.y() - a.y() * b.x());
    if (area > most) {
      most = area;
      largest = f;
    }
  }
  state_[largest] = 1;
  open_.assign(1, largest);
  std::size_t met = 0, met_on_border = 0;  // pieces of the rim: twice each between facets, once on the border
  while (!open_.empty()) {
    const std::uint32_t f = open_.back();
    open_.pop_back();
    for (unsigned side = 0; side < 3; ++side) {
      const std::uint32_t next = facets[f].neighbours[side];
      const bool is_rim = (facets[f].constraints >> side & 1u) != 0 &&
                          is_piece(facets[f].vertices[side], facets[f].vertices[(side + 1) % 3]);
      const bool is_border = next == ConstrainedDelaunay::kNone || state_[next] == kOutside;
      if (is_rim) ++(is_border ? met_on_border : met);
      if (is_border) continue;
      const char state = is_rim ? static_cast<char>(1 - state_[f]) : state_[f];
      if (state_[next] == kUnknown) {
        state_[next] = state;
        open_.push_back(next);
      } else if (state_[next] != state) {
        return "the rim of the floor is not closed";
      }
    }
  }
  if (met / 2 + met_on_border != rim_.size()) return "a crease has split the rim of the floor";
  const Triangle& t = facets[largest].vertices;
  const char beyond = is_beyond((points[t[0]] + points[t[1]] + points[t[2]]) / 3) ? 1 : 0;
  found.assign(facets.size(), 0);
  for (std::size_t f = 0; f < facets.size(); ++f) found[f] = state_[f] == beyond ? 1 : 0;
  return "";
}

std::vector<OctahedralPoint> RimSides::splits(const ConstrainedDelaunay& delaunay, double snap) const {
  std::vector<ConstraintGraph::Edge> sides;
  for (const ConstrainedDelaunay::Facet& facet : delaunay.facets()) {
    for (unsigned side = 0; side < 3; ++side) {
      const std::uint32_t a = facet.vertices[side], b = facet.vertices[(side + 1) % 3];
      if (is_piece(a, b)) sides.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  std::sort(sides.begin(), sides.end());
  const auto& points = delaunay.vertices();
  std::vector<OctahedralPoint> found;
  for (const auto& [from, to] : rim_) {
    if (std::binary_search(sides.begin(), sides.end(), ConstraintGraph::Edge(from, to))) continue;
    const OctahedralPoint way = points[to] - points[from];
    const double length = way.squaredNorm();
    for (std::uint32_t v = ConstrainedDelaunay::kOwn; v < points.size(); ++v) {
      const OctahedralPoint to_it = points[v] - points[from];
      const double along = to_it.dot(way), beside = way.x() * to_it.y() - way.y() * to_it.x();
      if (v == from || v == to || along <= 0 || along >= length || beside * beside > snap * snap * length) continue;
      found.push_back(points[v]);
    }
  }
  return found;
}

bool RimSides::is_piece(std::uint32_t a, std::uint32_t b) const {
  return std::binary_search(rim_.begin(), rim_.end(), ConstraintGraph::Edge(std::min(a, b), std::max(a, b)));
}

}  // namespace vantage::internal::exact
