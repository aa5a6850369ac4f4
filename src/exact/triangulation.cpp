#include "exact/triangulation.h"

#include <CDT.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "exact/gauge.h"
#include "exact/numerics.h"
#include "exact/vertex_snapper.h"
#include "vantage/error.h"

namespace vantage::exact {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

class BoundaryBuilder {
 public:
  BoundaryBuilder(const Skeleton& skeleton, const BlockerSet& blockers, const DirectionTree& tree,
                  const RangeRegion& range, ChartGrid& grid)
      : skeleton_(skeleton),
        blockers_(blockers),
        tree_(tree),
        range_(range),
        grid_(grid),
        snapper_(2 * skeleton.planar.size() + 8 * skeleton.curved.size() + 1024) {}

  Boundary run() {
    for (const ChartPoint& corner :
         {ChartPoint(0, 0), ChartPoint(1, 0), ChartPoint(0, 1), ChartPoint(-1, 0), ChartPoint(0, -1)})
      snapper_.add(corner);
    add_creases();
    grid_.settle(
        [&](const ChartPoint& p) { return evaluate_gauge(blockers_, tree_, range_, p).blocker == GaugeValue::kRange; });
    node_vertex_.assign(std::size_t(2 * grid_.size() + 1) * (2 * grid_.size() + 1), kNone);
    node_slot(0, 0) = 0;
    add_grid_border();
    add_fill();
    add_axes();
    add_horizon();
    triangulate();
    lift();
    emit_range_cells();
    emit_base();
    drop_unused_vertices();
    return std::move(result_);
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;

  // ---- vertices and constraints ----

  void add_edge(std::uint32_t a, std::uint32_t b) {
    if (a != b) edges_.emplace_back(std::min(a, b), std::max(a, b));
  }

  void add_creases() {
    for (const Skeleton::Edge& edge : skeleton_.planar) add_crease(edge.from, edge.to, false);
    for (const auto& line : skeleton_.curved)
      for (std::size_t i = 0; i + 1 < line.size(); ++i) add_crease(line[i], line[i + 1], true);
  }

  // A straight line in space is straight in the chart but for bends where it crosses the planes x = 0 and y = 0.
  void add_crease(const Vec3& from, const Vec3& to, bool on_sphere) {
    std::array<double, 4> cuts{0, 1, 1, 1};
    int count = 1;
    for (int axis = 0; axis < 2; ++axis)
      if ((from[axis] < 0 && to[axis] > 0) || (from[axis] > 0 && to[axis] < 0))
        cuts[count++] = from[axis] / (from[axis] - to[axis]);
    if (count == 3 && cuts[2] < cuts[1]) std::swap(cuts[1], cuts[2]);
    cuts[count] = 1;
    ChartPoint previous = to_chart(from);
    std::uint32_t vertex = snapper_.add(previous);
    for (int i = 1; i <= count; ++i) {
      const ChartPoint next = to_chart(cuts[i] == 1 ? to : Vec3(from + cuts[i] * (to - from)));
      const std::uint32_t next_vertex = snapper_.add(next);
      add_edge(vertex, next_vertex);
      if (on_sphere) grid_.mark(previous, next);
      previous = next, vertex = next_vertex;
    }
  }

  std::uint32_t& node_slot(int i, int j) {
    const int n = grid_.size();
    return node_vertex_[std::size_t(j + n) * (2 * n + 1) + std::size_t(i + n)];
  }

  std::uint32_t node_vertex(int i, int j) {
    std::uint32_t& slot = node_slot(i, j);
    if (slot == kNone) slot = snapper_.add(grid_.node(i, j));
    return slot;
  }

  // The edges between cells that are cut in two and the rest of the chart.
  void add_grid_border() {
    const int n = grid_.size();
    for (int j = -n; j < n; ++j) {
      const int width = n - (j >= 0 ? j : -1 - j);
      for (int i = -width; i < width; ++i) {
        const bool here = grid_.is_range(i, j);
        if (i + 1 < width && here != grid_.is_range(i + 1, j))
          add_edge(node_vertex(i + 1, j), node_vertex(i + 1, j + 1));
        if (grid_.has_cell(i, j + 1) && here != grid_.is_range(i, j + 1))
          add_edge(node_vertex(i, j + 1), node_vertex(i + 1, j + 1));
        if (here && i_at_horizon(i, j)) add_horizon_edge(i, j);
      }
    }
  }

  bool i_at_horizon(int i, int j) const { return !ChartGrid::inside(i, j, grid_.size() - 1); }

  // The two nodes of a cell at the horizon that lie on it.
  std::pair<Eigen::Vector2i, Eigen::Vector2i> horizon_nodes(int i, int j) const {
    const int a0 = i >= 0 ? i : i + 1, a1 = i >= 0 ? i + 1 : i, b0 = j >= 0 ? j : j + 1, b1 = j >= 0 ? j + 1 : j;
    return {{a1, b0}, {a0, b1}};
  }

  void add_horizon_edge(int i, int j) {
    const auto [p, q] = horizon_nodes(i, j);
    node_vertex(p.x(), p.y());
    node_vertex(q.x(), q.y());
  }

  // Triangles must not pass over the axes, where the chart bends.
  void add_axes() {
    for (int axis = 0; axis < 2; ++axis) {
      std::vector<std::uint32_t> on_axis;
      for (std::uint32_t v = 0; v < snapper_.points().size(); ++v)
        if (snapper_.points()[v][1 - axis] == 0) on_axis.push_back(v);
      std::sort(on_axis.begin(), on_axis.end(), [&](std::uint32_t a, std::uint32_t b) {
        return snapper_.points()[a][axis] < snapper_.points()[b][axis];
      });
      for (std::size_t k = 0; k + 1 < on_axis.size(); ++k) add_edge(on_axis[k], on_axis[k + 1]);
    }
  }

  void add_horizon() {
    for (std::uint32_t v = 0; v < snapper_.points().size(); ++v)
      if (snapper_.on_horizon(v)) horizon_.push_back(v);
    std::sort(horizon_.begin(), horizon_.end(), [&](std::uint32_t a, std::uint32_t b) {
      const ChartPoint &p = snapper_.points()[a], &q = snapper_.points()[b];
      return turn_of(p) < turn_of(q);
    });
    for (std::size_t k = 0; k < horizon_.size(); ++k) add_edge(horizon_[k], horizon_[(k + 1) % horizon_.size()]);
  }

  // Monotone in the angle round the diamond, exact where atan2 would round.
  static double turn_of(const ChartPoint& p) {
    if (p.y() >= 0) return p.x() > 0 ? p.y() : 2 - p.y();
    return p.x() < 0 ? 2 - p.y() : 4 + p.y();
  }

  // Nodes among mixed cells that see the sphere: they keep the triangles beside the creases as small as the cells.
  void add_fill() {
    const int n = grid_.size();
    for (int j = -n; j < n; ++j) {
      const int width = n - (j >= 0 ? j : -1 - j);
      for (int i = -width; i < width; ++i) {
        if (grid_.state(i, j) != ChartGrid::mixed) continue;
        for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
          const int a = i + di, b = j + dj;
          if (std::abs(a) + std::abs(b) > n || node_slot(a, b) != kNone) continue;
          const ChartPoint p = grid_.node(a, b);
          if (evaluate_gauge(blockers_, tree_, range_, p).blocker == GaugeValue::kRange) node_vertex(a, b);
        }
      }
    }
  }

  // ---- triangulation ----

  void triangulate() {
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    result_.constraint_edges = edges_.size();
    CDT::Triangulation<double> cdt(CDT::VertexInsertionOrder::Auto, CDT::IntersectingConstraintEdges::TryResolve,
                                   numerics::kSnap);
    cdt.insertVertices(
        snapper_.points().begin(), snapper_.points().end(), [](const ChartPoint& p) { return p.x(); },
        [](const ChartPoint& p) { return p.y(); });
    cdt.insertEdges(
        edges_.begin(), edges_.end(), [](const Edge& e) { return e.first; }, [](const Edge& e) { return e.second; });
    cdt.eraseSuperTriangle();
    for (const auto& v : cdt.vertices) points_.emplace_back(v.x, v.y);
    for (const auto& t : cdt.triangles) keep_triangle({t.vertices[0], t.vertices[1], t.vertices[2]});
  }

  void keep_triangle(const Triangle& t) {
    const ChartPoint centre = (points_[t[0]] + points_[t[1]] + points_[t[2]]) / 3;
    if (grid_.is_range(grid_.locate(centre.x()), grid_.locate(centre.y()))) return;
    const auto horizon = [&](std::uint32_t v) { return v < snapper_.points().size() && snapper_.on_horizon(v); };
    if (horizon(t[0]) && horizon(t[1]) && horizon(t[2]) && centre.cwiseAbs().sum() > 1 - 1e-9) return;
    result_.mesh.triangles.push_back(t);
    result_.blocker_of.push_back(evaluate_gauge(blockers_, tree_, range_, centre).blocker);
  }

  // ---- lifting ----

  void lift() {
    result_.mesh.vertices.reserve(points_.size());
    for (std::size_t v = 0; v < points_.size(); ++v) {
      const double gauge = evaluate_gauge(blockers_, tree_, range_, points_[v]).value;
      const bool horizon = v < snapper_.points().size() && snapper_.on_horizon(std::uint32_t(v));
      result_.mesh.vertices.push_back(lifted(points_[v], gauge, horizon));
    }
  }

  static Vec3 lifted(const ChartPoint& point, double gauge, bool horizon) {
    Vec3 direction = to_direction(point);
    if (horizon) direction.z() = 0;
    return direction * ((1 - numerics::kShrink) / gauge);
  }

  void emit_range_cells() {
    const int n = grid_.size();
    auto& vertices = result_.mesh.vertices;
    const auto vertex = [&](int i, int j) {
      std::uint32_t& slot = node_slot(i, j);
      if (slot == kNone) {
        slot = std::uint32_t(vertices.size());
        const ChartPoint p = grid_.node(i, j);
        vertices.push_back(lifted(p, range_.gauge(to_direction(p)), std::abs(i) + std::abs(j) == n));
      }
      return slot;
    };
    for (int j = -n; j < n; ++j) {
      const int width = n - (j >= 0 ? j : -1 - j);
      for (int i = -width; i < width; ++i) {
        if (!grid_.is_range(i, j)) continue;
        // a runs away from the axis, so the diagonal from (a1, b0) to (a0, b1) is the short one in every quadrant
        const int a0 = i >= 0 ? i : i + 1, a1 = i >= 0 ? i + 1 : i, b0 = j >= 0 ? j : j + 1, b1 = j >= 0 ? j + 1 : j;
        const bool mirrored = (i >= 0) != (j >= 0);
        emit_range_triangle(vertex(a0, b0), vertex(a1, b0), vertex(a0, b1), mirrored);
        if (!i_at_horizon(i, j)) emit_range_triangle(vertex(a1, b0), vertex(a1, b1), vertex(a0, b1), mirrored);
      }
    }
  }

  void emit_range_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool mirrored) {
    if (mirrored) std::swap(b, c);
    result_.mesh.triangles.push_back({a, b, c});
    result_.blocker_of.push_back(Boundary::kRange);
  }

  void emit_base() {
    const std::uint32_t centre = std::uint32_t(result_.mesh.vertices.size());
    result_.mesh.vertices.push_back(Vec3::Zero());
    for (std::size_t k = 0; k < horizon_.size(); ++k) {
      result_.mesh.triangles.push_back({centre, horizon_[(k + 1) % horizon_.size()], horizon_[k]});
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

  const Skeleton& skeleton_;
  const BlockerSet& blockers_;
  const DirectionTree& tree_;
  const RangeRegion& range_;
  ChartGrid& grid_;
  VertexSnapper snapper_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> node_vertex_;  // per grid node
  std::vector<std::uint32_t> horizon_;      // in order round the horizon
  std::vector<ChartPoint> points_;          // as the triangulation leaves them
  Boundary result_;
};

}  // namespace

Boundary triangulate_boundary(const Skeleton& skeleton, const BlockerSet& blockers, const DirectionTree& tree,
                              const RangeRegion& range, ChartGrid& grid) {
  return BoundaryBuilder(skeleton, blockers, tree, range, grid).run();
}

}  // namespace vantage::exact
