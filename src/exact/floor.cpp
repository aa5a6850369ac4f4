#include "exact/floor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/edges.h"
#include "exact/quadrant_parts.h"
#include "exact/segment_cover.h"
#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

using core::FacetPolygon;

/// A plane that passes the centre nearer than this part of the range has an inverse depth that rounding decides.
constexpr double kNearest = 1e-7;
/// Normals of facets that are larger than this, in parts of the square of their distance, are right to 1e-9.
constexpr double kNarrow = 1e-6;
/// In parts of the size: about what coordinates on a map of the world are rounded by.
constexpr double kFlat = 1e-9;
/// Of coordinates on the map.
constexpr double kRounding = 1e-9;
/// Cells along the side of a quadrant; with a star, which has many facets.
constexpr int kCells = 16, kStarCells = 32;

/// For each side of a closed mesh's triangles, the triangle beside it. nullopt where the mesh is not closed.
std::optional<std::vector<std::array<std::uint32_t, 3>>> neighbours_in(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> beside(mesh.triangles.size());
  const std::vector<core::EdgeUse> uses = core::edge_uses(mesh.triangles, mesh.vertices.size());
  bool is_closed = true;
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    if (edge.size() != 2) {
      is_closed = false;
      return;
    }
    for (int i = 0; i < 2; ++i) {
      const Triangle& t = mesh.triangles[edge[i].triangle];
      const std::uint32_t from = edge[i].forward ? edge[i].low : edge[i].high;
      beside[edge[i].triangle][t[0] == from ? 0 : t[1] == from ? 1 : 2] = edge[1 - i].triangle;
    }
  });
  if (!is_closed) return std::nullopt;
  return beside;
}

}  // namespace

std::optional<Floor> Floor::of(const ChartLimits& limits, double reach, std::vector<ChartLimits::Side>& ceilings) {
  Floor floor;
  std::vector<ChartLimits::Side> beyond;
  for (const ChartLimits::Side& side : limits.kept) {
    const double size = side.normal.norm();
    if (!(std::abs(side.at) > kNearest * reach * size)) {
      // The target's own plane, from behind: all of the volume is in front of it.
      const bool is_own = side.normal.head<2>().norm() <= 1e-15 * size && side.normal.z() < 0;
      if (is_own) continue;
      return std::nullopt;
    }
    (side.at > 0 ? ceilings : beyond).push_back(side);
  }
  if (!beyond.empty()) floor.add_kept(beyond, reach);
  for (const ChartLimits::Body& body : limits.removed) {
    if (!floor.add_removed(body)) return std::nullopt;
  }
  floor.list_planes();
  return floor;
}

std::optional<Floor> Floor::with(const std::vector<ChartLimits::Star>& stars) const {
  Floor floor = *this;
  for (const ChartLimits::Star& star : stars) {
    if (!floor.add_star(star)) return std::nullopt;
  }
  floor.list_planes();
  return floor;
}

void Floor::add_kept(const std::vector<ChartLimits::Side>& sides, double reach) {
  const auto body = static_cast<std::uint32_t>(bodies_.size()), first = static_cast<std::uint32_t>(planes_.size());
  for (const ChartLimits::Side& side : sides) {
    planes_.emplace_back(side.normal / (side.at * (1 + kShrinks * numerics::kShrink)));
    labels_.push_back(side.label);
  }
  bodies_.push_back({first, static_cast<std::uint32_t>(planes_.size()), Kind::kept});
  FacetPolygon scratch;
  for (std::uint32_t k = first; k < planes_.size(); ++k) {
    if (planes_[k].norm() * reach <= 1) continue;
    Facet facet{k, body, {}};
    core::make_facet_square(planes_[k], reach, facet.polygon);
    core::clip_facet(facet.polygon, Vec3::UnitZ(), 0, 0, FacetPolygon::kHorizon, scratch);
    for (std::uint32_t other = first; other < planes_.size() && !facet.polygon.empty(); ++other) {
      if (other == k) continue;
      const double margin = kSiblingMargin + 1e-15 * reach * planes_[other].cwiseAbs().sum();
      core::clip_facet(facet.polygon, planes_[other], 1, margin, other, scratch);
    }
    if (!facet.polygon.empty()) facets_.push_back(std::move(facet));
  }
}

bool Floor::add_removed(const ChartLimits::Body& body) {
  const Mesh& mesh = body.mesh;
  const auto number = static_cast<std::uint32_t>(bodies_.size());
  const auto first = static_cast<std::uint32_t>(planes_.size());
  const double away = 1 + kShrinks * numerics::kShrink;
  std::vector<std::uint32_t> plane_of(mesh.triangles.size(), Value::kNone);
  const auto closed = neighbours_in(mesh);
  if (!closed) return false;
  const std::vector<std::array<std::uint32_t, 3>>& beside = *closed;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec3, 3> corners;
    double highest = 0;
    for (int i = 0; i < 3; ++i) {
      corners[i] = mesh.vertices[mesh.triangles[t][i]] * away;
      highest = std::max(highest, corners[i].z());
    }
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    double size = 0;
    for (const Vec3& corner : corners) size = std::max(size, corner.norm());
    // What faces down and lies in the target's plane, but for rounding, as the target itself does, bounds nothing.
    const bool is_bottom =
        highest <= kFlat * size && normal.z() < 0 && normal.head<2>().norm() <= kFlat * normal.norm();
    if (highest <= 0 || is_bottom) continue;
    // The plane must hold what is next to the facet and, where that is so narrow that rounding turns it, all of the
    // body.
    double at = std::max({normal.dot(corners[0]), normal.dot(corners[1]), normal.dot(corners[2])});
    for (const std::uint32_t other : beside[t]) {
      for (const std::uint32_t v : mesh.triangles[other]) at = std::max(at, away * normal.dot(mesh.vertices[v]));
    }
    if (normal.norm() < kNarrow * size * size) {
      for (const Vec3& vertex : mesh.vertices) at = std::max(at, away * normal.dot(vertex));
    }
    if (!(at > kNearest * size * normal.norm())) return false;
    plane_of[t] = static_cast<std::uint32_t>(planes_.size());
    planes_.emplace_back(normal / at);
    labels_.push_back(body.label);
  }
  if (planes_.size() == first) return true;  // nothing of it is in front
  bodies_.push_back({first, static_cast<std::uint32_t>(planes_.size()), Kind::convex});
  FacetPolygon scratch;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (plane_of[t] == Value::kNone) continue;
    Facet facet{plane_of[t], number, {}};
    for (int i = 0; i < 3; ++i) {
      facet.polygon.corners.push_back(mesh.vertices[mesh.triangles[t][i]] * away);
      const std::uint32_t next = plane_of[beside[t][i]];
      facet.polygon.makers.push_back(next == Value::kNone ? FacetPolygon::kHorizon : next);
    }
    core::clip_facet(facet.polygon, Vec3::UnitZ(), 0, 0, FacetPolygon::kHorizon, scratch);
    if (!facet.polygon.empty()) facets_.push_back(std::move(facet));
  }
  return true;
}

bool Floor::add_star(const ChartLimits::Star& star) {
  const Mesh& mesh = star.mesh;
  const auto number = static_cast<std::uint32_t>(bodies_.size());
  const auto first = static_cast<std::uint32_t>(planes_.size());
  const auto first_cone = static_cast<std::uint32_t>(cones_.size());
  const double away = 1 + kShrinks * numerics::kShrink;
  std::vector<std::uint32_t> plane_of(mesh.triangles.size(), Value::kNone);
  const auto beside = neighbours_in(mesh);
  if (!beside) return false;
  const auto corner = [&](std::uint32_t t, std::size_t i) -> Vec3 {
    return mesh.vertices[mesh.triangles[t][i]] * away;
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    if (std::max({a.z(), b.z(), c.z()}) <= 0) continue;
    const Vec3 normal = (b - a).cross(c - a);
    const double at = std::max({normal.dot(a), normal.dot(b), normal.dot(c)});
    const double size = std::max({a.norm(), b.norm(), c.norm()});
    // Seen from the centre a facet must not be narrow: the planes through its edges tell which one a direction is in.
    const double volume = a.dot(b.cross(c));
    if (!(at > kNearest * size * normal.norm()) || !(volume > kNarrow * a.norm() * b.norm() * c.norm())) return false;
    plane_of[t] = static_cast<std::uint32_t>(planes_.size());
    planes_.emplace_back(normal / at);
    labels_.push_back(star.labels[t]);
    cones_.push_back({a.cross(b) / volume, b.cross(c) / volume, c.cross(a) / volume});
  }
  if (planes_.size() == first) return true;  // nothing of it is in front
  bodies_.push_back({first, static_cast<std::uint32_t>(planes_.size()), Kind::star, first_cone});
  FacetPolygon scratch;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (plane_of[t] == Value::kNone) continue;
    Facet facet{plane_of[t], number, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      facet.polygon.corners.push_back(corner(t, i));
      const std::uint32_t next = plane_of[(*beside)[t][i]];
      facet.polygon.makers.push_back(next == Value::kNone ? FacetPolygon::kHorizon : next);
      if (next == Value::kNone) continue;
      steepness_ = std::max(steepness_, std::abs(planes_[next].dot(corner(t, (i + 2) % 3)) - 1));
    }
    core::clip_facet(facet.polygon, Vec3::UnitZ(), 0, 0, FacetPolygon::kHorizon, scratch);
    if (!facet.polygon.empty()) facets_.push_back(std::move(facet));
  }
  return true;
}

void Floor::list_planes() {
  if (bodies_.empty()) return;
  side_ = cones_.empty() ? kCells : kStarCells;
  cells_.assign(static_cast<std::size_t>(4 * side_) * static_cast<std::size_t>(side_), {});
  Found found(cells_.size());
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].kind == Kind::kept) list_kept(b, found);
  }
  for (const Facet& facet : facets_) {
    if (bodies_[facet.body].kind != Kind::kept) list_facet(facet, found);
  }
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    std::sort(found[c].begin(), found[c].end());
    Listed& listed = cells_[c];
    for (const auto& [body, plane] : found[c]) {
      while (listed.first.size() <= body) listed.first.push_back(static_cast<std::uint32_t>(listed.planes.size()));
      listed.planes.push_back(plane);
    }
    while (listed.first.size() <= bodies_.size()) {
      listed.first.push_back(static_cast<std::uint32_t>(listed.planes.size()));
    }
  }
}

// A plane matters in a cell if it can be the least there.
void Floor::list_kept(std::uint32_t body, Found& found) const {
  const std::uint32_t first = bodies_[body].first, end = bodies_[body].end;
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    for (int j = 0; j < side_; ++j) {
      for (int i = 0; i + j < side_; ++i) {
        const OctahedralCell cell{quadrant, static_cast<double>(i) / side_, static_cast<double>(j) / side_,
                                  1.0 / side_};
        double bound = std::numeric_limits<double>::infinity();
        for (std::uint32_t k = first; k < end; ++k) {
          bound = std::min(bound, cell.max_of(on_quadrant(planes_[k], quadrant)));
        }
        bound += kRounding * std::abs(bound);
        for (std::uint32_t k = first; k < end; ++k) {
          if (cell.min_of(on_quadrant(planes_[k], quadrant)) <= bound) {
            found[cell_index(quadrant, i, j)].emplace_back(body, k);
          }
        }
      }
    }
  }
}

template <typename Visit>
void Floor::for_each_cell(int quadrant, std::span<const Vec3> part, const Visit& visit) const {
  OctahedralPoint low(1, 1), high(0, 0);
  for (const Vec3& corner : part) {
    const OctahedralPoint at = to_octahedral(corner).cwiseAbs();
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  const auto cell_of = [&](double x) { return std::clamp(static_cast<int>(x * side_), 0, side_ - 1); };
  const int last_j = cell_of(high.y() + kRounding), last_i = cell_of(high.x() + kRounding);
  for (int j = cell_of(low.y() - kRounding); j <= last_j; ++j) {
    for (int i = cell_of(low.x() - kRounding); i <= last_i && i + j < side_; ++i) visit(cell_index(quadrant, i, j));
  }
}

// Where the facet is: another plane of its body is nowhere greater there.
void Floor::list_facet(const Facet& facet, Found& found) {
  FacetPolygon scratch_part, scratch;
  for_each_quadrant(facet.polygon, scratch_part, scratch, [&](int quadrant, const FacetPolygon& part) {
    double farthest = 0;
    for (const Vec3& corner : facet.polygon.corners) farthest = std::max(farthest, corner.norm());
    for_each_cell(quadrant, part.corners, [&](std::size_t cell) {
      found[cell].emplace_back(facet.body, facet.plane);
      cells_[cell].farthest = std::max(cells_[cell].farthest, farthest);
    });
  });
}

void Floor::planes_over(std::uint32_t body, int quadrant, std::span<const Vec3> part, double beyond,
                        std::vector<std::uint32_t>& found) const {
  for_each_cell(quadrant, part, [&](std::size_t cell) {
    const Listed& listed = cells_[cell];
    if (listed.farthest <= beyond) return;
    found.insert(found.end(), listed.planes.begin() + listed.first[body],
                 listed.planes.begin() + listed.first[body + 1]);
  });
}

const Floor::Listed& Floor::listed_at(const OctahedralPoint& point) const {
  int i = std::min(static_cast<int>(std::abs(point.x()) * side_), side_ - 1);
  int j = std::min(static_cast<int>(std::abs(point.y()) * side_), side_ - 1);
  while (i + j >= side_) --(i > j ? i : j);  // on the horizon, or beyond it by rounding
  return cells_[cell_index(quadrant_of(point.x(), point.y()), i, j)];
}

// The facet that the direction is in, or outside of by rounding alone.
Floor::Value Floor::value_in_star(const Body& body, std::span<const std::uint32_t> planes,
                                  const Vec3& direction) const {
  Value found{0, body.first};
  double deepest = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t plane : planes) {
    const Cone& cone = cone_of(body, plane);
    const double gauge = planes_[plane].dot(direction);
    // In parts of the place where the direction meets the plane.
    const double depth = std::min({cone[0].dot(direction), cone[1].dot(direction), cone[2].dot(direction)}) / gauge;
    if (!(gauge > 0) || !(depth > deepest)) continue;
    deepest = depth;
    found = {gauge, plane};
    if (depth >= 0) break;
  }
  return found;
}

Floor::Value Floor::at(const OctahedralPoint& point) const {
  const Vec3 direction = to_direction(point);
  const Listed& listed = listed_at(point);
  Value least{std::numeric_limits<double>::infinity(), Value::kNone};
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].kind == Kind::star) {
      const Value of_star = value_in_star(
          bodies_[b], std::span(listed.planes).subspan(listed.first[b], listed.first[b + 1] - listed.first[b]),
          direction);
      if (of_star.gauge < least.gauge) least = of_star;
      continue;
    }
    const bool is_kept = bodies_[b].kind == Kind::kept;
    Value of_body{is_kept ? std::numeric_limits<double>::infinity() : 0, Value::kNone};
    for (std::uint32_t i = listed.first[b]; i < listed.first[b + 1]; ++i) {
      const double gauge = planes_[listed.planes[i]].dot(direction);
      if (is_kept ? gauge < of_body.gauge : gauge > of_body.gauge) of_body = {gauge, listed.planes[i]};
    }
    if (of_body.gauge < least.gauge) least = of_body;
  }
  return least;
}

}  // namespace vantage::internal::exact
