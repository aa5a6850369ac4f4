#include "exact/floor_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exact/constrained_delaunay.h"
#include "exact/gauge.h"
#include "exact/rim_sides.h"
#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

// A facet may rise this fraction above the floor, which lies farther out than the limits by more than that.
constexpr double kFloorSafe = numerics::kShrink;
// Corners are moved out where it rises more, but no farther than this.
constexpr double kMostRise = 1e-5;

class FloorMesher {
 public:
  FloorMesher(int quadrant, const ConstraintGraph& graph, const Envelope& envelope, double snap)
      : quadrant_(quadrant), graph_(graph), envelope_(envelope), snap_(snap), delaunay_(snap) {}

  FloorMesh run() {
    triangulate();
    if (delaunay_.failure().empty() && result_.failure.empty()) move_out();
    if (!delaunay_.failure().empty()) result_.failure = delaunay_.failure();
    if (!result_.failure.empty()) {
      FloorMesh nothing;
      nothing.failure = result_.failure;
      nothing.rim_splits = std::move(result_.rim_splits);
      return nothing;
    }
    for (std::uint32_t v = 0; v < own_count(); ++v) result_.graph_gauge.push_back(gauges_[v + kSuper]);
    for (std::uint32_t v = kSuper + own_count(); v < gauges_.size(); ++v) {
      result_.added.push_back(delaunay_.vertices()[v]);
      result_.added_gauge.push_back(gauges_[v]);
    }
    collect_triangles();
    return std::move(result_);
  }

 private:
  static constexpr std::uint32_t kSuper = ConstrainedDelaunay::kOwn;

  std::uint32_t own_count() const { return static_cast<std::uint32_t>(result_.graph_vertex.size()); }
  const OctahedralPoint& point(std::uint32_t v) const { return delaunay_.vertices()[v]; }
  OctahedralPoint centre_of(const Triangle& t) const { return (point(t[0]) + point(t[1]) + point(t[2])) / 3; }
  bool on_horizon(std::uint32_t v) const {
    return v >= kSuper && v - kSuper < own_count() && graph_.on_horizon(result_.graph_vertex[v - kSuper]);
  }
  bool is_outside_quadrant(const Triangle& t) const {
    if (t[0] < kSuper || t[1] < kSuper || t[2] < kSuper) return true;
    return on_horizon(t[0]) && on_horizon(t[1]) && on_horizon(t[2]) && centre_of(t).cwiseAbs().sum() > 1 - 1e-9;
  }

  void triangulate() {
    const double sa = quadrant_ & 1 ? -1 : 1, sb = quadrant_ & 2 ? -1 : 1;
    std::vector<std::uint32_t> local(graph_.points().size(), ConstraintGraph::kNone);
    std::vector<OctahedralPoint> points;
    for (std::uint32_t v = 0; v < local.size(); ++v) {
      const OctahedralPoint& p = graph_.points()[v];
      if (!graph_.is_of(Sheet::floor, v) || sa * p.x() < 0 || sb * p.y() < 0) continue;
      local[v] = own_count() + kSuper;
      result_.graph_vertex.push_back(v);
      points.push_back(p);
    }
    const auto in_quadrant = [&](const std::vector<ConstraintGraph::Edge>& edges) {
      std::vector<ConstraintGraph::Edge> found;
      for (const auto& [a, b] : edges) {
        if (local[a] != ConstraintGraph::kNone && local[b] != ConstraintGraph::kNone) {
          found.emplace_back(local[a], local[b]);
        }
      }
      return found;
    };
    delaunay_.add_vertices(points);
    for (const auto& [from, to] : in_quadrant(graph_.edges(Sheet::floor))) delaunay_.add_constraint(from, to);
    if (!delaunay_.failure().empty()) return;
    RimSides rim(in_quadrant(graph_.rim()));
    result_.failure = rim.find(
        delaunay_, [&](const Triangle& t) { return is_outside_quadrant(t); },
        [&](const OctahedralPoint& p) { return is_below_floor(p, 0); }, is_beyond_);
    if (!result_.failure.empty()) result_.rim_splits = rim.splits(delaunay_, snap_);
    gauges_.resize(delaunay_.vertices().size());
    for (std::uint32_t v = kSuper; v < gauges_.size(); ++v) {
      gauges_[v] = envelope_.floor->at(point(v)).gauge;
      if (v - kSuper < own_count()) {
        gauges_[v] = std::min(gauges_[v], graph_.floor_gauge(result_.graph_vertex[v - kSuper]));
      }
    }
  }

  /// Whether the envelope, in inverse depth, is below the floor: something is between them.
  bool is_below_floor(const OctahedralPoint& at, double slack) const {
    const double envelope = evaluate_gauge(envelope_.blockers, envelope_.tree, envelope_.range, at).value;
    return envelope <= (1 + slack) * envelope_.floor->at(at).gauge;
  }

  // Where snapping has moved a vertex off a crease, facets may rise above the floor in their middle.
  void move_out() {
    std::vector<double> factor(gauges_.size(), 1);
    for (std::size_t i = 0; i < is_beyond_.size(); ++i) {
      if (is_beyond_[i] == 0) continue;
      const Triangle& t = delaunay_.facets()[i].vertices;
      const OctahedralPoint centre = centre_of(t);
      if (!is_below_floor(centre, kMostCrossing)) {
        result_.failure = "the floor has come out of the envelope";
        return;
      }
      const double claimed = (gauges_[t[0]] + gauges_[t[1]] + gauges_[t[2]]) / 3;
      const double rise = claimed / envelope_.floor->at(centre).gauge - 1;
      if (rise <= kFloorSafe) continue;
      if (rise > kMostRise) {
        result_.failure = "a facet of the floor lies above it";
        return;
      }
      for (const std::uint32_t corner : t) factor[corner] = std::min(factor[corner], 1 - 2 * rise);
    }
    for (std::size_t v = 0; v < gauges_.size(); ++v) gauges_[v] *= factor[v];
  }

  std::uint32_t renamed(std::uint32_t v) const {
    if (v - kSuper < own_count()) return result_.graph_vertex[v - kSuper];
    return static_cast<std::uint32_t>(graph_.points().size()) + (v - kSuper - own_count());
  }

  void collect_triangles() {
    const auto& facets = delaunay_.facets();
    for (std::size_t i = 0; i < facets.size(); ++i) {
      if (is_beyond_[i] == 0) continue;
      const Triangle& t = facets[i].vertices;
      result_.triangles.push_back({renamed(t[0]), renamed(t[1]), renamed(t[2])});
      result_.plane_of.push_back(envelope_.floor->at(centre_of(t)).plane);
      for (unsigned e = 0; e < 3; ++e) {
        const std::uint32_t from = t[e], to = t[(e + 1) % 3];
        if (!is_outside_quadrant(facets[facets[i].neighbours[e]].vertices)) continue;
        if (on_horizon(from) && on_horizon(to)) result_.base.emplace_back(renamed(from), renamed(to));
      }
    }
  }

  int quadrant_;
  const ConstraintGraph& graph_;
  const Envelope& envelope_;
  double snap_;
  ConstrainedDelaunay delaunay_;
  std::vector<double> gauges_;   // per vertex of the triangulation
  std::vector<char> is_beyond_;  // per facet of it
  FloorMesh result_;
};

}  // namespace

FloorMesh mesh_floor(int quadrant, const ConstraintGraph& graph, const Envelope& envelope, double snap) {
  return FloorMesher(quadrant, graph, envelope, snap).run();
}

}  // namespace vantage::internal::exact
