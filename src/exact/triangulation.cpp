#include "exact/triangulation.h"

#include <CDT.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "exact/constraint_graph.h"
#include "exact/gauge.h"
#include "exact/numerics.h"
#include "exact/range_cells.h"
#include "parallel/parallel.h"
#include "vantage/error.h"

namespace vantage::exact {
namespace {

// Refinement that makes this many times the triangles that it began with will not end: something is broken.
constexpr std::size_t kMostGrowth = 4;
// The gauge may rise this fraction above a triangle before it counts as over-claimed: less than the final shrinking.
constexpr double kSafe = 0.5 * numerics::kShrink;
// Where it rises less than this (0.1 mm at 1 km), or the triangle is narrower than that in the chart, the triangle's
// corners are drawn in; otherwise a crease is missing and the triangle is split.
constexpr double kSmallRise = 1e-7;

constexpr double kThinnest = 1e-8;
constexpr std::size_t kGrain = 256;  // directions that one thread takes at a time

/// Thrown when the triangulation has split an edge of a cell; the cell is marked as mixed by then.
struct BorderSplit {};

class BoundaryBuilder {
 public:
  BoundaryBuilder(const Skeleton& skeleton, const BlockerSet& blockers, const DirectionTree& tree,
                  const RangeRegion& range, ChartGrid& grid, double tolerance, double snap)
      : blockers_(blockers),
        tree_(tree),
        range_(range),
        grid_(grid),
        tolerance_(tolerance),
        graph_(
            skeleton, grid, [&](const ChartPoint& p) { return gauge_at(p).blocker == GaugeValue::kRange; }, snap),
        cdt_(CDT::VertexInsertionOrder::Auto, CDT::IntersectingConstraintEdges::TryResolve, snap) {}

  Boundary run() {
    result_.constraint_edges = graph_.edges().size();
    parallel::both([&] { triangulate(); }, [&] { cells_ = cut_range_cells(graph_, grid_, range_); });
    cell_vertices_ = std::uint32_t(cells_.vertices.size() - graph_.points().size());
    result_.mesh.vertices = std::move(cells_.vertices);
    result_.mesh.triangles = std::move(cells_.triangles);
    result_.blocker_of.assign(result_.mesh.triangles.size(), Boundary::kRange);
    base_ = std::move(cells_.base);
    lift();
    collect_triangles();
    emit_base();
    drop_unused_vertices();
    return std::move(result_);
  }

 private:
  static constexpr std::uint32_t kNone = ConstraintGraph::kNone;
  static constexpr std::uint32_t kSuper = 3;  // the library's own vertices come first

  enum class Place : std::uint8_t { outside, range_cell, kept };

  /// What is known of one triangle of the triangulation; valid while its vertices stay the same.
  struct Known {
    Triangle vertices{};
    std::uint32_t blocker = 0;
    Place place = Place::outside;
  };

  /// A new triangle, and the gauge at its centre.
  struct Fresh {
    std::uint32_t triangle;
    GaugeValue gauge;
  };

  GaugeValue gauge_at(const ChartPoint& p) const { return evaluate_gauge(blockers_, tree_, range_, p); }
  ChartPoint point(std::uint32_t v) const { return {cdt_.vertices[v].x, cdt_.vertices[v].y}; }
  bool on_horizon(std::uint32_t v) const {
    return v - kSuper < graph_.points().size() && graph_.on_horizon(v - kSuper);
  }

  // ---- triangulation ----

  void triangulate() {
    cdt_.insertVertices(
        graph_.points().begin(), graph_.points().end(), [](const ChartPoint& p) { return p.x(); },
        [](const ChartPoint& p) { return p.y(); });
    cdt_.insertEdges(
        graph_.edges().begin(), graph_.edges().end(), [](const auto& e) { return e.first; },
        [](const auto& e) { return e.second; });
    const std::size_t most = kMostGrowth * cdt_.triangles.size() + 1000;
    while (refine())
      if (cdt_.triangles.size() > most)
        throw Error(ErrorKind::internal, "the boundary could not be triangulated safely", "triangulation",
                    "please report this with the mission and the scene");
  }

  // Looks at the triangles that are new; adds a point to each that is not good enough. True when there were any.
  bool refine() {
    const std::size_t first_vertex = gauges_.size();
    gauges_.resize(cdt_.vertices.size());
    parallel::for_ranges(gauges_.size() - first_vertex, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = first_vertex + begin; v < first_vertex + end; ++v)
        gauges_[v] = v < kSuper ? 0 : gauge_at(point(std::uint32_t(v))).value;
    });
    known_.resize(cdt_.triangles.size());
    fresh_.clear();
    for (std::uint32_t i = 0; i < known_.size(); ++i) {
      const auto& v = cdt_.triangles[i].vertices;
      const Triangle t{v[0], v[1], v[2]};
      if (known_[i].vertices == t) continue;
      known_[i] = {t, 0, place_of(t)};
      if (known_[i].place == Place::kept) fresh_.push_back({i, {}});
    }
    parallel::for_ranges(fresh_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        fresh_[k].gauge = gauge_at(centre_of(known_[fresh_[k].triangle].vertices));
    });
    std::vector<ChartPoint> added;
    for (const Fresh& fresh : fresh_) {
      known_[fresh.triangle].blocker = fresh.gauge.blocker;
      improve(known_[fresh.triangle].vertices, fresh.gauge, added);
    }
    if (added.empty()) return false;
    cdt_.insertVertices(
        added.begin(), added.end(), [](const ChartPoint& p) { return p.x(); },
        [](const ChartPoint& p) { return p.y(); });
    return true;
  }

  // `gauge` is that at the triangle's centre.
  void improve(const Triangle& t, const GaugeValue& gauge, std::vector<ChartPoint>& added) {
    const double claimed = (gauges_[t[0]] + gauges_[t[1]] + gauges_[t[2]]) / 3;
    const double rise = gauge.value / claimed - 1;
    const bool deep = gauge.blocker == GaugeValue::kRange && too_deep(t);
    if (rise <= kSafe && !deep) return;
    if ((rise > kSmallRise || deep) && has_room(t))
      added.push_back(centre_of(t));
    else if (rise > kSafe)
      for (std::uint32_t corner : t) gauges_[corner] *= 1 + 2 * rise;  // a greater gauge only makes the volume smaller
  }

  ChartPoint centre_of(const Triangle& t) const { return (point(t[0]) + point(t[1]) + point(t[2])) / 3; }

  Place place_of(const Triangle& t) const {
    if (t[0] < kSuper || t[1] < kSuper || t[2] < kSuper) return Place::outside;
    const ChartPoint centre = centre_of(t);
    // Rounding leaves slivers between the points of one side of the horizon.
    if (on_horizon(t[0]) && on_horizon(t[1]) && on_horizon(t[2]) && centre.cwiseAbs().sum() > 1 - 1e-9)
      return Place::outside;
    const auto at_node = [&](std::uint32_t v) {
      return v - kSuper < graph_.points().size() && graph_.at_node(v - kSuper);
    };
    if (at_node(t[0]) && at_node(t[1]) && at_node(t[2]) &&
        grid_.is_range(grid_.locate(centre.x()), grid_.locate(centre.y())))
      return Place::range_cell;
    return Place::kept;
  }

  // Whether a triangle is worth splitting: in one that is no wider than what snapping moves, a crease cannot be found.
  bool has_room(const Triangle& t) const {
    const ChartPoint a = point(t[1]) - point(t[0]), b = point(t[2]) - point(t[0]), c = b - a;
    const double longest = std::sqrt(std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()}));
    return std::abs(a.x() * b.y() - a.y() * b.x()) > kThinnest * longest;
  }

  // Whether some point of a triangle on the range sphere lies more than the tolerance inside it.
  bool too_deep(const Triangle& t) const {
    std::array<Vec3, 3> v;
    for (int i = 0; i < 3; ++i) v[i] = to_direction(point(t[i])) / gauges_[t[i]];
    const std::array<double, 3> square{(v[2] - v[1]).squaredNorm(), (v[0] - v[2]).squaredNorm(),
                                       (v[1] - v[0]).squaredNorm()};
    const std::size_t longest = std::size_t(std::max_element(square.begin(), square.end()) - square.begin());
    // The deepest point is the middle of the circumcircle, or of the longest edge where that is outside.
    const bool obtuse = 2 * square[longest] >= square[0] + square[1] + square[2];
    const Vec3 middle = 0.5 * (v[(longest + 1) % 3] + v[(longest + 2) % 3]);
    const Vec3 normal = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    double farthest = 0;
    for (std::size_t ball = 0; ball < range_.ball_count(); ++ball) {
      const Vec3 centre(range_.centre(ball).x(), range_.centre(ball).y(), 0);
      farthest = std::max(farthest, obtuse ? (middle - centre).norm() : normal.dot(v[0] - centre));
    }
    return range_.radius() - farthest > tolerance_;
  }

  // ---- the mesh ----

  // The mesh has the vertices of the graph first, then those of the cells, then those that refinement added.
  std::uint32_t renamed(std::uint32_t v) const {
    return v - kSuper < graph_.points().size() ? v - kSuper : v - kSuper + cell_vertices_;
  }

  // An edge with nothing on its other side is on the horizon: the base closes it.
  void collect_triangles() {
    auto& vertices = result_.mesh.vertices;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (known_[i].place != Place::kept) continue;
      const Triangle& t = known_[i].vertices;
      result_.mesh.triangles.push_back({renamed(t[0]), renamed(t[1]), renamed(t[2])});
      result_.blocker_of.push_back(known_[i].blocker);
      for (int e = 0; e < 3; ++e) {
        const std::uint32_t from = t[e], to = t[(e + 1) % 3];
        switch (known_[cdt_.triangles[i].neighbors[e]].place) {
          case Place::kept:
            break;
          case Place::outside:
            base_.emplace_back(renamed(from), renamed(to));
            vertices[renamed(from)].z() = vertices[renamed(to)].z() = 0;
            break;
          case Place::range_cell:
            check_border(from, to);
        }
      }
    }
  }

  // Cells are cut in two without looking at the triangulation: it must not have split their edges.
  void check_border(std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t v : {from, to})
      if (v - kSuper >= graph_.points().size()) {
        grid_.mark(point(v), point(v));
        throw BorderSplit();
      }
  }

  void lift() {
    auto& vertices = result_.mesh.vertices;
    vertices.resize(cdt_.vertices.size() - kSuper + cell_vertices_);
    for (std::uint32_t v = kSuper; v < cdt_.vertices.size(); ++v)
      vertices[renamed(v)] = lifted(point(v), gauges_[v], on_horizon(v));
  }

  static Vec3 lifted(const ChartPoint& point, double gauge, bool horizon) {
    Vec3 direction = to_direction(point);
    if (horizon) direction.z() = 0;
    return direction * ((1 - numerics::kShrink) / gauge);
  }

  void emit_base() {
    const std::uint32_t centre = std::uint32_t(result_.mesh.vertices.size());
    result_.mesh.vertices.push_back(Vec3::Zero());
    for (const auto& [from, to] : base_) {
      result_.mesh.triangles.push_back({centre, to, from});
      result_.blocker_of.push_back(Boundary::kTargetPlane);
    }
  }

  void drop_unused_vertices() {
    Mesh& mesh = result_.mesh;
    std::vector<std::uint32_t> renamed(mesh.vertices.size(), kNone);
    for (const Triangle& t : mesh.triangles)
      for (std::uint32_t v : t) renamed[v] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < renamed.size(); ++v)
      if (renamed[v] != kNone) mesh.vertices[count] = mesh.vertices[v], renamed[v] = count++;
    mesh.vertices.resize(count);
    for (Triangle& t : mesh.triangles)
      for (std::uint32_t& v : t) v = renamed[v];
  }

  const BlockerSet& blockers_;
  const DirectionTree& tree_;
  const RangeRegion& range_;
  ChartGrid& grid_;
  double tolerance_;
  ConstraintGraph graph_;
  CDT::Triangulation<double> cdt_;
  std::vector<double> gauges_;  // per vertex of the triangulation
  std::vector<Known> known_;    // per triangle of it
  std::vector<Fresh> fresh_;
  RangeCells cells_;
  std::uint32_t cell_vertices_ = 0;
  std::vector<ConstraintGraph::Edge> base_;  // edges of the mesh on the horizon, as its triangles run them
  Boundary result_;
};

}  // namespace

Boundary triangulate_boundary(const Skeleton& skeleton, const BlockerSet& blockers, const DirectionTree& tree,
                              const RangeRegion& range, ChartGrid& grid, double tolerance) {
  // Where creases meet at less than the snapping distance the triangulation may find no place for their crossing; wider
  // snapping makes them one. What that moves, refinement finds.
  for (double snap = numerics::kSnap;;) try {
      return BoundaryBuilder(skeleton, blockers, tree, range, grid, tolerance, snap).run();
    } catch (const BorderSplit&) {
    } catch (const CDT::Error& error) {
      if (snap >= numerics::kWidestSnap)
        throw Error(ErrorKind::internal, std::string("the creases could not be triangulated: ") + error.what(),
                    "triangulation", "please report this with the mission and the scene");
      snap *= 10;
    }
}

}  // namespace vantage::exact
