// The triangles that face up cover the footprint. Where neighbours both do, their common side is inside: what is left
// of their sides are rings that wind round each place as often as there are such triangles above it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/closed_mesh_check.h"
#include "core/edges.h"
#include "maps/city/clipping.h"
#include "maps/city/grid_polygon.h"
#include "vantage/solid.h"

namespace vantage {
namespace {

using internal::city::GridPoint;
using internal::city::GridPolygon;
using internal::city::GridRing;

constexpr double kUnitsAcross = 0x1p28;  ///< in half of the longer side; below city::kLargest

class PlanGrid {
 public:
  explicit PlanGrid(const Box& box)
      : origin_((box.min / 2 + box.max / 2).head<2>()),
        unit_m_(std::max((box.max - box.min).head<2>().maxCoeff() / 2, 1e-300) / kUnitsAcross) {}

  GridPoint to_grid(const Vec3& p) const {
    return {std::llround((p.x() - origin_.x()) / unit_m_), std::llround((p.y() - origin_.y()) / unit_m_)};
  }
  PlanPolygon::Ring to_metres(const GridRing& ring) const {
    PlanPolygon::Ring result;
    for (const GridPoint& p : ring) {
      result.push_back(origin_ + Eigen::Vector2d(static_cast<double>(p.x), static_cast<double>(p.y)) * unit_m_);
    }
    return result;
  }

 private:
  Eigen::Vector2d origin_;
  double unit_m_;
};

/// The mesh seen from above, rounded to the grid before anything is decided: what is made of it has to do with itself
/// alone, so that no sliver of a rounding's width winds the wrong way.
struct Plan {
  std::vector<GridPoint> corners;   ///< each place once
  std::vector<Triangle> facing_up;  ///< exactly

  Plan(const Mesh& mesh, const PlanGrid& grid) {
    std::map<GridPoint, std::uint32_t> at;
    std::vector<std::uint32_t> corner_of;
    corner_of.reserve(mesh.vertices.size());
    for (const Vec3& vertex : mesh.vertices) {
      const auto [place, is_new] = at.try_emplace(grid.to_grid(vertex), static_cast<std::uint32_t>(corners.size()));
      if (is_new) corners.push_back(place->first);
      corner_of.push_back(place->second);
    }
    for (const Triangle& t : mesh.triangles) {
      const Triangle seen{corner_of[t[0]], corner_of[t[1]], corner_of[t[2]]};
      if (internal::city::turn(corners[seen[0]], corners[seen[1]], corners[seen[2]]) > 0) facing_up.push_back(seen);
    }
  }
};

/// The sides of triangles that face up and whose neighbours there do not, each in the triangles' direction.
std::multimap<std::uint32_t, std::uint32_t> rim_of(const Plan& plan) {
  std::multimap<std::uint32_t, std::uint32_t> rim;
  const std::vector<internal::core::EdgeUse> uses = internal::core::edge_uses(plan.facing_up, plan.corners.size());
  internal::core::for_each_edge(uses, [&](std::span<const internal::core::EdgeUse> edge) {
    long forward = 0;
    for (const internal::core::EdgeUse& use : edge) forward += use.forward ? 1 : -1;
    for (long i = 0; i < std::abs(forward); ++i) {
      rim.emplace(forward > 0 ? edge[0].low : edge[0].high, forward > 0 ? edge[0].high : edge[0].low);
    }
  });
  return rim;
}

/// As many sides end at a corner as begin there: any way through them is a ring.
std::vector<GridRing> rings_of_rim(const Plan& plan) {
  std::multimap<std::uint32_t, std::uint32_t> rim = rim_of(plan);
  std::vector<GridRing> rings;
  while (!rim.empty()) {
    GridRing& ring = rings.emplace_back();
    for (auto side = rim.begin(); side != rim.end();) {
      ring.push_back(plan.corners[side->first]);
      const std::uint32_t next = side->second;
      rim.erase(side);
      side = rim.find(next);
    }
  }
  return rings;
}

}  // namespace

std::vector<PlanPolygon> footprint_of_mesh(const Mesh& mesh) {
  internal::core::check_closed(mesh);
  internal::core::check_oriented(mesh);
  if (mesh.empty()) return {};
  const PlanGrid grid(bounding_box(mesh));
  const std::vector<GridRing> rings = rings_of_rim(Plan(mesh, grid));
  internal::city::Clipping clipping;
  for (const GridRing& ring : rings) clipping.add(ring);
  std::vector<PlanPolygon> polygons;
  for (const GridPolygon& polygon : internal::city::settled(
           clipping.run(internal::city::ClipOperation::unite, internal::city::FillRule::non_zero))) {
    PlanPolygon& made = polygons.emplace_back();
    made.outer = grid.to_metres(internal::city::turned(polygon.outer, true));
    for (const GridRing& hole : polygon.holes)
      made.holes.push_back(grid.to_metres(internal::city::turned(hole, false)));
  }
  std::stable_sort(polygons.begin(), polygons.end(),
                   [](const PlanPolygon& a, const PlanPolygon& b) { return area_m2(a) > area_m2(b); });
  return polygons;
}

}  // namespace vantage
