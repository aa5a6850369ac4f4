// Barber, Dobkin and Huhdanpaa, The quickhull algorithm for convex hulls (1996), with exact predicates: a facet is seen
// from a point only if the point lies strictly outside of its plane. So what is seen of a hull is one disc, its rim
// runs once through each of its corners, and no triangle between the rim and the point is without area: were the point
// on the line of a side of the rim, it would lie in the planes of both facets there, and see neither. What was outside
// of a facet that goes is then inside of the hull, or outside of a new facet: the way from it to a point inside of that
// facet stays outside of the old hull, so it can enter the new one only through a new facet.
#include "solid/convex_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/orientation.h"
#include "core/pieces.h"
#include "vantage/error.h"

namespace vantage::internal::solid {
namespace {

using Simplex = std::array<std::uint32_t, 4>;

bool are_on_a_line(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (unsigned x = 0; x < 3; ++x) {
    const unsigned y = (x + 1) % 3;
    if (core::turn({a[x], a[y]}, {b[x], b[y]}, {c[x], c[y]}) != 0) return false;
  }
  return true;
}

/// The point with the largest `value` of those for which `is_allowed` holds. Rounding of values may choose another one,
/// not one that is not allowed.
template <typename Value, typename IsAllowed>
std::optional<std::uint32_t> farthest(std::span<const Vec3> points, const Value& value, const IsAllowed& is_allowed) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 1; i < points.size(); ++i) {
    if (value(points[i]) > value(points[best])) best = i;
  }
  if (is_allowed(points[best])) return best;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (is_allowed(points[i])) return i;
  }
  return std::nullopt;
}

/// Four points that are not in one plane, turned so that the last one lies inside of the first three.
std::optional<Simplex> first_simplex(std::span<const Vec3> points) {
  if (points.size() < 4) return std::nullopt;
  const Vec3& a = points[0];
  const auto apart = [&](const Vec3& p) { return (p - a).squaredNorm(); };
  const auto second = farthest(points, apart, [&](const Vec3& p) { return p != a; });
  if (!second) return std::nullopt;
  const Vec3& b = points[*second];
  const auto aside = [&](const Vec3& p) { return (b - a).cross(p - a).squaredNorm(); };
  const auto third = farthest(points, aside, [&](const Vec3& p) { return !are_on_a_line(a, b, p); });
  if (!third) return std::nullopt;
  const Vec3& c = points[*third];
  const Vec3 normal = (b - a).cross(c - a);
  const auto above = [&](const Vec3& p) { return std::abs(normal.dot(p - a)); };
  const auto fourth = farthest(points, above, [&](const Vec3& p) { return core::orientation(a, b, c, p) != 0; });
  if (!fourth) return std::nullopt;
  Simplex simplex = {0, *second, *third, *fourth};
  if (core::orientation(a, b, c, points[*fourth]) < 0) std::swap(simplex[0], simplex[1]);
  return simplex;
}

class HullBuilder {
 public:
  explicit HullBuilder(std::span<const Vec3> points) : points_(points) {}

  Mesh build();

 private:
  struct Facet {
    Triangle corners{};
    std::array<std::uint32_t, 3> neighbours{};  ///< across the side from each corner to the next
    std::vector<std::uint32_t> outside;         ///< points that see it; each point is in one facet's list at most
    bool is_gone = false;
    std::uint32_t seen_in = 0;  ///< the last round that found it seen
  };
  /// A side of the rim of what is seen: of the facet that stays.
  struct RimSide {
    std::uint32_t from, to, facet;
  };

  bool sees(std::uint32_t point, const Facet& facet) const {
    const auto& [a, b, c] = facet.corners;
    return core::orientation(points_[a], points_[b], points_[c], points_[point]) < 0;
  }
  void begin(const Simplex& simplex);
  void deal_out(std::span<const std::uint32_t> points, std::uint32_t first_facet);
  std::uint32_t take_farthest(std::uint32_t facet);
  void add(std::uint32_t point, std::uint32_t facet);
  void find_seen(std::uint32_t point, std::uint32_t facet);
  void close_rim(std::uint32_t point);

  std::span<const Vec3> points_;
  std::vector<Facet> facets_;
  std::vector<std::uint32_t> waiting_;  // facets with points outside
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> seen_;
  std::vector<RimSide> rim_;
};

void HullBuilder::begin(const Simplex& s) {
  const std::array<Triangle, 4> corners = {
      {{s[0], s[1], s[2]}, {s[0], s[3], s[1]}, {s[1], s[3], s[2]}, {s[2], s[3], s[0]}}};
  constexpr std::array<std::array<std::uint32_t, 3>, 4> kNeighbours = {{{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}}};
  for (std::size_t i = 0; i < 4; ++i) {
    facets_.emplace_back();
    facets_.back().corners = corners[i];
    facets_.back().neighbours = kNeighbours[i];
  }
  std::vector<std::uint32_t> all(points_.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  deal_out(all, 0);
}

/// To the facets from `first_facet` on.
void HullBuilder::deal_out(std::span<const std::uint32_t> points, std::uint32_t first_facet) {
  for (const std::uint32_t point : points) {
    for (std::uint32_t f = first_facet; f < facets_.size(); ++f) {
      if (!sees(point, facets_[f])) continue;
      facets_[f].outside.push_back(point);
      break;
    }
  }
  for (std::uint32_t f = first_facet; f < facets_.size(); ++f) {
    if (!facets_[f].outside.empty()) waiting_.push_back(f);
  }
}

/// Any would do; the farthest leaves the least to do.
std::uint32_t HullBuilder::take_farthest(std::uint32_t facet) {
  std::vector<std::uint32_t>& outside = facets_[facet].outside;
  const auto& [a, b, c] = facets_[facet].corners;
  const Vec3 at = points_[a], normal = (points_[b] - at).cross(points_[c] - at);
  const auto height = [&](std::uint32_t p) { return normal.dot(points_[p] - at); };
  const auto best = std::max_element(outside.begin(), outside.end(),
                                     [&](std::uint32_t p, std::uint32_t q) { return height(p) < height(q); });
  std::iter_swap(best, outside.end() - 1);
  const std::uint32_t point = outside.back();
  outside.pop_back();
  return point;
}

/// All facets that the point sees, and their rim; `facet` is one of them.
void HullBuilder::find_seen(std::uint32_t point, std::uint32_t facet) {
  ++round_;
  rim_.clear();
  seen_ = {facet};
  facets_[facet].seen_in = round_;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const Facet& seen = facets_[seen_[i]];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = seen.neighbours[k];
      if (facets_[other].seen_in == round_) continue;
      if (sees(point, facets_[other])) {
        facets_[other].seen_in = round_;
        seen_.push_back(other);
      } else {
        rim_.push_back({seen.corners[k], seen.corners[(k + 1) % 3], other});
      }
    }
  }
}

/// Facets between the rim and the point; of each corner of the rim one begins there and one ends.
void HullBuilder::close_rim(std::uint32_t point) {
  const auto first = static_cast<std::uint32_t>(facets_.size());
  std::unordered_map<std::uint32_t, std::uint32_t> from;
  for (const RimSide& side : rim_) {
    const auto made = static_cast<std::uint32_t>(facets_.size());
    from.emplace(side.from, made);
    facets_.emplace_back();
    facets_.back().corners = {side.from, side.to, point};
    facets_.back().neighbours[0] = side.facet;
    Facet& beyond = facets_[side.facet];
    for (std::size_t k = 0; k < 3; ++k) {
      if (beyond.corners[k] == side.to && beyond.corners[(k + 1) % 3] == side.from) beyond.neighbours[k] = made;
    }
  }
  for (std::uint32_t f = first; f < facets_.size(); ++f) {
    const auto begins = from.find(facets_[f].corners[1]);
    if (begins == from.end()) throw Error(ErrorCode::internal_defect, "a convex hull is not closed", "", "");
    const std::uint32_t next = begins->second;
    facets_[f].neighbours[1] = next;
    facets_[next].neighbours[2] = f;
  }
}

void HullBuilder::add(std::uint32_t point, std::uint32_t facet) {
  find_seen(point, facet);
  const auto first = static_cast<std::uint32_t>(facets_.size());
  close_rim(point);
  std::vector<std::uint32_t> left;
  for (const std::uint32_t f : seen_) {
    left.insert(left.end(), facets_[f].outside.begin(), facets_[f].outside.end());
    facets_[f].outside = {};
    facets_[f].is_gone = true;
  }
  deal_out(left, first);
}

Mesh HullBuilder::build() {
  const std::optional<Simplex> simplex = first_simplex(points_);
  if (!simplex) return {};
  begin(*simplex);
  while (!waiting_.empty()) {
    const std::uint32_t facet = waiting_.back();
    if (facets_[facet].outside.empty()) {
      waiting_.pop_back();
    } else {
      add(take_farthest(facet), facet);
    }
  }
  Mesh hull;
  hull.vertices.assign(points_.begin(), points_.end());
  for (const Facet& facet : facets_) {
    if (facet.is_gone) continue;
    Triangle& triangle = hull.triangles.emplace_back(facet.corners);
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  }
  std::sort(hull.triangles.begin(), hull.triangles.end());
  core::drop_unused_vertices(hull);
  return hull;
}

}  // namespace

Mesh convex_hull(std::span<const Vec3> points) {
  constexpr double kUnderflows = 1e-40;
  std::vector<Vec3> taken(points.begin(), points.end());
  for (Vec3& point : taken) {
    for (double& coordinate : point) coordinate = std::abs(coordinate) < kUnderflows ? 0 : coordinate;
  }
  return HullBuilder(taken).build();
}

}  // namespace vantage::internal::solid
