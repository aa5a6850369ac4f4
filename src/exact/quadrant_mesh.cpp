#include "exact/quadrant_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "exact/constrained_delaunay.h"
#include "exact/gauge.h"
#include "exact/over_claim_bound.h"
#include "exact/rim_sides.h"
#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

// When refinement has made this many times the triangles that it began with, no more are split: corners are drawn in.
constexpr std::size_t kMostGrowth = 4;
// The gauge may rise this fraction above a triangle before it counts as over-claimed: less than the final shrinking.
constexpr double kSafe = 0.5 * numerics::kShrink;
// Where it rises less than this (0.1 mm at 1 km), or the triangle is narrower than that in the octahedral map, the
// triangle's corners are drawn in; otherwise a crease is missing and the triangle is split.
constexpr double kSmallRise = 1e-7;
constexpr double kThinnest = 1e-8;
constexpr std::size_t kGrain = 256;  // directions that one thread takes at a time

class QuadrantMesher {
 public:
  QuadrantMesher(int quadrant, const ConstraintGraph& graph, const OctahedralGrid& grid, const Envelope& envelope,
                 double snap)
      : quadrant_(quadrant), graph_(graph), grid_(grid), envelope_(envelope), snap_(snap), delaunay_(snap) {}

  QuadrantMesh run() {
    triangulate();
    if (!delaunay_.failure().empty()) result_.failure = delaunay_.failure();
    if (!result_.failure.empty()) return failed();
    for (std::uint32_t v = 0; v < result_.graph_vertex.size(); ++v) result_.graph_gauge.push_back(gauges_[v + kSuper]);
    for (std::uint32_t v = kSuper + own_count(); v < delaunay_.vertices().size(); ++v) {
      result_.added.push_back(point(v));
      result_.added_gauge.push_back(gauges_[v]);
    }
    collect_triangles();
    return std::move(result_);
  }

 private:
  static constexpr std::uint32_t kSuper = ConstrainedDelaunay::kOwn;  // its own vertices come first

  enum class Region : std::uint8_t { outside, not_beyond_floor, range_cell, kept };

  /// What is known of one triangle of the triangulation, the gauge at its centre among it; valid while its vertices
  /// stay the same.
  struct Known {
    Triangle vertices{};
    std::uint32_t blocker = 0;
    double gauge = 0;
    Region region = Region::outside;
  };

  /// A new triangle, and the gauge at its centre.
  struct Fresh {
    std::uint32_t triangle;
    GaugeValue gauge;
  };

  std::uint32_t own_count() const { return static_cast<std::uint32_t>(result_.graph_vertex.size()); }
  bool is_own(std::uint32_t v) const { return v - kSuper < own_count(); }
  /// The graph's vertex; only of its own.
  std::uint32_t in_graph(std::uint32_t v) const { return result_.graph_vertex[v - kSuper]; }
  bool on_horizon(std::uint32_t v) const { return is_own(v) && graph_.on_horizon(in_graph(v)); }
  /// Whether a triangle in a range cell may have this corner: a node, or where an edge between nodes was split.
  bool may_bound_cell(std::uint32_t v) const { return !is_own(v) || graph_.at_node(in_graph(v)); }
  const OctahedralPoint& point(std::uint32_t v) const { return delaunay_.vertices()[v]; }
  OctahedralPoint centre_of(const Triangle& t) const { return (point(t[0]) + point(t[1]) + point(t[2])) / 3; }
  GaugeValue gauge_at(const OctahedralPoint& p) const {
    return evaluate_gauge(envelope_.blockers, envelope_.tree, envelope_.range, p);
  }

  void triangulate() {
    std::vector<ConstraintGraph::Edge> rim;
    const std::vector<ConstraintGraph::Edge> edges = take_own(rim);
    std::vector<OctahedralPoint> points;
    for (const std::uint32_t v : result_.graph_vertex) points.push_back(graph_.points()[v]);
    delaunay_.add_vertices(points);
    for (const auto& [from, to] : edges) delaunay_.add_constraint(from + kSuper, to + kSuper);
    if (envelope_.floor) rim_.emplace(std::move(rim));
    envelope_.progress.check();
    most_triangles_ = kMostGrowth * delaunay_.facets().size() + 1000;
    while (refine()) envelope_.progress.check();
    if (result_.failure.empty()) tighten_tilted();
  }

  // The graph's vertices in the quadrant, and its edges between them. `rim`: those of the triangulation.
  std::vector<ConstraintGraph::Edge> take_own(std::vector<ConstraintGraph::Edge>& rim) {
    const double sa = quadrant_ & 1 ? -1 : 1, sb = quadrant_ & 2 ? -1 : 1;
    constexpr std::uint32_t kNone = ConstraintGraph::kNone;
    std::vector<std::uint32_t> local(graph_.points().size(), kNone);
    for (std::uint32_t v = 0; v < local.size(); ++v) {
      if (sa * graph_.points()[v].x() >= 0 && sb * graph_.points()[v].y() >= 0 && graph_.is_of(Sheet::envelope, v)) {
        local[v] = own_count();
        result_.graph_vertex.push_back(v);
      }
    }
    std::vector<ConstraintGraph::Edge> edges;
    for (const auto& [a, b] : graph_.edges(Sheet::envelope))
      if (local[a] != kNone && local[b] != kNone) edges.emplace_back(local[a], local[b]);
    for (const auto& [a, b] : graph_.rim())
      if (local[a] != kNone && local[b] != kNone) rim.emplace_back(local[a] + kSuper, local[b] + kSuper);
    return edges;
  }

  QuadrantMesh failed() const {
    QuadrantMesh nothing;
    nothing.failure = result_.failure;
    nothing.rim_splits = result_.rim_splits;
    return nothing;
  }

  // Looks at the triangles that are new; adds a point to each that is not good enough. True when there were any.
  bool refine() {
    if (!delaunay_.failure().empty()) return false;
    const std::size_t first_vertex = gauges_.size();
    gauges_.resize(delaunay_.vertices().size());
    exact_gauges_.resize(gauges_.size());
    parallel::for_ranges(gauges_.size() - first_vertex, kGrain, [&](std::size_t begin, std::size_t end) {
      for (auto v = static_cast<std::uint32_t>(first_vertex + begin); v < first_vertex + end; ++v) {
        if (v < kSuper) continue;
        exact_gauges_[v] = gauge_at(point(v)).value;
        gauges_[v] = is_own(v) ? std::max(exact_gauges_[v], graph_.crease_gauge(in_graph(v))) : exact_gauges_[v];
      }
    });
    if (!find_beyond_floor()) return false;
    find_fresh();
    parallel::for_ranges(fresh_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        fresh_[k].gauge = gauge_at(centre_of(known_[fresh_[k].triangle].vertices));
    });
    std::vector<OctahedralPoint> added;
    for (const Fresh& fresh : fresh_) {
      known_[fresh.triangle].blocker = fresh.gauge.blocker;
      known_[fresh.triangle].gauge = fresh.gauge.value;
      if (!is_beyond_floor(known_[fresh.triangle].vertices, fresh.gauge)) return false;
      improve(known_[fresh.triangle].vertices, fresh.gauge, added);
    }
    if (added.empty()) return false;
    delaunay_.add_vertices(added);
    return true;
  }

  bool find_beyond_floor() {
    if (!rim_) return true;
    result_.failure = rim_->find(
        delaunay_, [&](const Triangle& t) { return is_outside_quadrant(t); },
        [&](const OctahedralPoint& p) { return gauge_at(p).value <= envelope_.floor->at(p).gauge; }, is_beyond_);
    if (!result_.failure.empty()) result_.rim_splits = rim_->splits(delaunay_, snap_);
    return result_.failure.empty();
  }

  // `gauge` is that at the triangle's centre.
  bool is_beyond_floor(const Triangle& t, const GaugeValue& gauge) {
    if (!rim_) return true;
    const bool crosses = gauge.value > (1 + kMostCrossing) * envelope_.floor->at(centre_of(t)).gauge;
    if (crosses) result_.failure = "the floor has come out of the envelope";
    return result_.failure.empty();
  }

  void find_fresh() {
    known_.resize(delaunay_.facets().size());
    fresh_.clear();
    for (std::uint32_t i = 0; i < known_.size(); ++i) {
      const Triangle& t = delaunay_.facets()[i].vertices;
      if (known_[i].vertices == t) continue;
      known_[i] = {t, 0, 0, region_of(t)};
      if (rim_ && known_[i].region == Region::kept && is_beyond_[i] == 0) known_[i].region = Region::not_beyond_floor;
      if (known_[i].region == Region::kept) fresh_.push_back({i, {}});
    }
  }

  bool is_outside_quadrant(const Triangle& t) const {
    if (t[0] < kSuper || t[1] < kSuper || t[2] < kSuper) return true;
    // Rounding leaves slivers between the points of one side of the horizon.
    return on_horizon(t[0]) && on_horizon(t[1]) && on_horizon(t[2]) && centre_of(t).cwiseAbs().sum() > 1 - 1e-9;
  }

  Region region_of(const Triangle& t) const {
    if (is_outside_quadrant(t)) return Region::outside;
    const OctahedralPoint centre = centre_of(t);
    if (may_bound_cell(t[0]) && may_bound_cell(t[1]) && may_bound_cell(t[2]) &&
        grid_.is_range(grid_.locate(centre.x()), grid_.locate(centre.y())))
      return Region::range_cell;
    return Region::kept;
  }

  // `gauge` is that at the triangle's centre.
  void improve(const Triangle& t, const GaugeValue& gauge, std::vector<OctahedralPoint>& added) {
    const double claimed = (gauges_[t[0]] + gauges_[t[1]] + gauges_[t[2]]) / 3;
    const double rise = gauge.value / claimed - 1;
    const bool deep = gauge.blocker == GaugeValue::kRange && too_deep(t);
    if (rise <= kSafe && !deep) return;
    if ((rise > kSmallRise || deep) && delaunay_.facets().size() <= most_triangles_ && has_room(t)) {
      added.push_back(centre_of(t));
    } else if (rise > kSafe) {
      tighten(t, gauge.value, rise);
    }
  }

  // A greater gauge only makes the volume smaller. Either all corners by twice the rise or the far ones to the gauge:
  // what takes less.
  void tighten(const Triangle& t, double gauge, double rise) {
    const double least = std::min({gauges_[t[0]], gauges_[t[1]], gauges_[t[2]]});
    const double level = gauge * (1 + kSafe);
    const bool to_level = level < least * (1 + 2 * rise);
    for (std::uint32_t corner : t)
      gauges_[corner] = to_level ? std::max(gauges_[corner], level) : gauges_[corner] * (1 + 2 * rise);
  }

  // Refinement looks at the middle of each triangle alone. A crease that passes a vertex closer than the snapping
  // distance goes through it, and the vertex may lie well behind the crease: the facets that end there are tilted. What
  // then rises above them, wherever it is, is found here, and covered. A facet that lies on the gauge in its middle is
  // not tilted, and one on the range sphere cannot be: where its rim has moved, it claims that much sideways at most.
  void tighten_tilted() {
    std::vector<double> rises(known_.size(), 0);
    parallel::for_ranges(known_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      OverClaimBound check(envelope_.blockers, envelope_.tree);
      for (std::size_t i = begin; i < end; ++i) {
        const Known& known = known_[i];
        if (known.region != Region::kept || known.blocker == GaugeValue::kRange) continue;
        const auto& [a, b, c] = known.vertices;
        const double claimed = (gauges_[a] + gauges_[b] + gauges_[c]) / 3;
        if (std::abs(known.gauge / claimed - 1) > kSafe) {
          rises[i] = check.greatest_rise(quadrant_, {point(a), point(b), point(c)},
                                         {gauges_[a], gauges_[b], gauges_[c]}, kSafe);
        }
      }
    });
    std::vector<double> greatest(gauges_.size(), 0);
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (rises[i] == 0) continue;
      for (const std::uint32_t corner : known_[i].vertices) greatest[corner] = std::max(greatest[corner], rises[i]);
    }
    for (std::size_t v = 0; v < gauges_.size(); ++v) gauges_[v] *= 1 + greatest[v];
  }

  // Whether a triangle is worth splitting: in one that is no wider than what snapping moves, a crease cannot be found.
  bool has_room(const Triangle& t) const {
    const OctahedralPoint a = point(t[1]) - point(t[0]), b = point(t[2]) - point(t[0]), c = b - a;
    const double longest = std::sqrt(std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()}));
    return std::abs(a.x() * b.y() - a.y() * b.x()) > kThinnest * longest;
  }

  // Whether some point of a triangle on the range sphere lies more than the tolerance inside it. Corners that were
  // drawn in do not count: no splitting would mend that.
  bool too_deep(const Triangle& t) const {
    std::array<Vec3, 3> v;
    for (int i = 0; i < 3; ++i) v[i] = to_direction(point(t[i])) / exact_gauges_[t[i]];
    return envelope_.range.is_deeper_than(envelope_.tolerance_m, v);
  }

  std::uint32_t renamed(std::uint32_t v) const {
    return is_own(v) ? in_graph(v) : static_cast<std::uint32_t>(graph_.points().size()) + (v - kSuper - own_count());
  }

  void collect_triangles() {
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (known_[i].region != Region::kept) continue;
      const Triangle& t = known_[i].vertices;
      result_.triangles.push_back({renamed(t[0]), renamed(t[1]), renamed(t[2])});
      result_.blocker_of.push_back(known_[i].blocker);
      for (int e = 0; e < 3; ++e) {
        const std::uint32_t from = t[e], to = t[(e + 1) % 3];
        const Region beyond = known_[delaunay_.facets()[i].neighbours[e]].region;
        if (beyond == Region::outside) {
          close(from, to);
        } else if (beyond == Region::range_cell) {
          check_border(from, to);
        }
      }
    }
  }

  // An edge with nothing on its other side is on the horizon, where the base closes it, or on an axis, where the next
  // quadrant goes on.
  void close(std::uint32_t from, std::uint32_t to) {
    if (on_horizon(from) && on_horizon(to)) {
      result_.base.emplace_back(renamed(from), renamed(to));
      return;
    }
    const OctahedralPoint a = point(from), b = point(to);
    const bool on_axis = (a.x() == 0 && b.x() == 0) || (a.y() == 0 && b.y() == 0);
    if (!on_axis || !is_own(from) || !is_own(to)) result_.failure = "a crease has split the border of a quadrant";
  }

  // Cells are cut in two without looking at the triangulation: it must not have split their edges.
  void check_border(std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t v : {from, to})
      if (!is_own(v)) result_.border_splits.push_back(point(v));
  }

  int quadrant_;
  const ConstraintGraph& graph_;
  const OctahedralGrid& grid_;
  const Envelope& envelope_;
  double snap_;
  ConstrainedDelaunay delaunay_;
  std::size_t most_triangles_ = 0;
  std::vector<double> gauges_;        // per vertex of the triangulation, drawn in where need be
  std::vector<double> exact_gauges_;  // as evaluated
  std::vector<Known> known_;          // per triangle of it
  std::vector<Fresh> fresh_;
  std::optional<RimSides> rim_;
  std::vector<char> is_beyond_;  // per triangle of it: on the side of the rim that is beyond the floor
  QuadrantMesh result_;
};

}  // namespace

QuadrantMesh mesh_quadrant(int quadrant, const ConstraintGraph& graph, const OctahedralGrid& grid,
                           const Envelope& envelope, double snap) {
  return QuadrantMesher(quadrant, graph, grid, envelope, snap).run();
}

}  // namespace vantage::internal::exact
