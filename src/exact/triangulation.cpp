#include "exact/triangulation.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/parallel.h"
#include "exact/gauge.h"
#include "exact/quadrant_mesh.h"
#include "exact/range_cells.h"
#include "target/numerics.h"
#include "vantage/error.h"

namespace vantage::internal::exact {
namespace {

/// A boundary, or what to change before the next attempt.
struct Attempt {
  Boundary boundary;
  std::string failure;                         ///< if not empty, creases meet in a way that needs wider snapping
  std::vector<OctahedralPoint> border_splits;  ///< where the triangulation has split edges of range cells
};

// Whether every edge is run as often one way as the other: a sum over the edges that is zero for a closed, oriented
// mesh and, but for chance, for no other.
bool is_closed(const Mesh& mesh) {
  const auto spread = [](std::uint64_t v) {
    v = (v + 1) * 0x9e3779b97f4a7c15ull;
    return (v ^ (v >> 29)) * 0xbf58476d1ce4e5b9ull;
  };
  std::vector<std::uint64_t> marks(mesh.vertices.size());
  for (std::size_t v = 0; v < marks.size(); ++v) marks[v] = spread(v);
  std::uint64_t sum = 0;
  for (const Triangle& t : mesh.triangles) {
    for (int e = 0; e < 3; ++e) {
      const std::uint64_t from = t[e], to = t[(e + 1) % 3];
      sum += marks[from] * (to * to) - marks[to] * (from * from);
    }
  }
  return sum == 0;
}

class BoundaryBuilder {
 public:
  BoundaryBuilder(const Skeleton& skeleton, const Envelope& envelope, OctahedralGrid& grid, double snap)
      : envelope_(envelope), grid_(grid), snap_(snap), graph_(skeleton, grid, is_range(), snap) {}

  Attempt run() {
    result_.constraint_edges = graph_.edges().size();
    parallel::both([&] { mesh_quadrants(); }, [&] { cells_ = cut_range_cells(graph_, grid_, envelope_.range); });
    Attempt attempt;
    for (const QuadrantMesh& quadrant : quadrants_) {
      if (attempt.failure.empty()) attempt.failure = quadrant.failure;
      attempt.border_splits.insert(attempt.border_splits.end(), quadrant.border_splits.begin(),
                                   quadrant.border_splits.end());
    }
    if (!attempt.failure.empty() || !attempt.border_splits.empty()) return attempt;
    result_.mesh.vertices = std::move(cells_.vertices);
    result_.mesh.triangles = std::move(cells_.triangles);
    result_.blocker_of.assign(result_.mesh.triangles.size(), Boundary::kRange);
    base_ = std::move(cells_.base);
    lift_graph();
    for (const QuadrantMesh& quadrant : quadrants_) add(quadrant);
    emit_base();
    drop_unused_vertices();
    if (!is_closed(result_.mesh)) attempt.failure = "the parts of the mesh do not meet";
    attempt.boundary = std::move(result_);
    return attempt;
  }

 private:
  IsRange is_range() const {
    return [this](const OctahedralPoint& p) {
      return evaluate_gauge(envelope_.blockers, envelope_.tree, envelope_.range, p).blocker == GaugeValue::kRange;
    };
  }

  void mesh_quadrants() {
    parallel::for_ranges(4, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q)
        quadrants_[q] = mesh_quadrant(static_cast<int>(q), graph_, grid_, envelope_, snap_);
    });
  }

  // The mesh has the vertices of the graph first, then those of the cells, then those that refinement added. On the
  // axes the quadrant that draws a vertex in more decides.
  void lift_graph() {
    std::vector<double> gauges(graph_.points().size(), 0);
    for (const QuadrantMesh& quadrant : quadrants_) {
      for (std::size_t i = 0; i < quadrant.graph_vertex.size(); ++i) {
        double& gauge = gauges[quadrant.graph_vertex[i]];
        gauge = std::max(gauge, quadrant.graph_gauge[i]);
      }
    }
    for (std::uint32_t v = 0; v < gauges.size(); ++v)
      result_.mesh.vertices[v] = lifted(graph_.points()[v], gauges[v], graph_.on_horizon(v));
  }

  static Vec3 lifted(const OctahedralPoint& point, double gauge, bool horizon) {
    Vec3 direction = to_direction(point);
    if (horizon) direction.z() = 0;
    return direction * ((1 - numerics::kShrink) / gauge);
  }

  void add(const QuadrantMesh& quadrant) {
    auto& mesh = result_.mesh;
    const std::uint32_t points = static_cast<std::uint32_t>(graph_.points().size());
    const std::uint32_t shift = static_cast<std::uint32_t>(mesh.vertices.size()) - points;
    const auto renamed = [&](std::uint32_t v) { return v < points ? v : v + shift; };
    for (std::size_t i = 0; i < quadrant.added.size(); ++i)
      mesh.vertices.push_back(lifted(quadrant.added[i], quadrant.added_gauge[i], false));
    for (const Triangle& t : quadrant.triangles)
      mesh.triangles.push_back({renamed(t[0]), renamed(t[1]), renamed(t[2])});
    result_.blocker_of.insert(result_.blocker_of.end(), quadrant.blocker_of.begin(), quadrant.blocker_of.end());
    base_.insert(base_.end(), quadrant.base.begin(), quadrant.base.end());
  }

  void emit_base() {
    const std::uint32_t centre = static_cast<std::uint32_t>(result_.mesh.vertices.size());
    result_.mesh.vertices.push_back(Vec3::Zero());
    for (const auto& [from, to] : base_) {
      result_.mesh.triangles.push_back({centre, to, from});
      result_.blocker_of.push_back(Boundary::kTargetPlane);
    }
  }

  void drop_unused_vertices() {
    Mesh& mesh = result_.mesh;
    constexpr std::uint32_t kNone = ConstraintGraph::kNone;
    std::vector<std::uint32_t> renamed(mesh.vertices.size(), kNone);
    for (const Triangle& t : mesh.triangles)
      for (std::uint32_t v : t) renamed[v] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < renamed.size(); ++v) {
      if (renamed[v] != kNone) {
        mesh.vertices[count] = mesh.vertices[v];
        renamed[v] = count++;
      }
    }
    mesh.vertices.resize(count);
    for (Triangle& t : mesh.triangles)
      for (std::uint32_t& v : t) v = renamed[v];
  }

  const Envelope& envelope_;
  OctahedralGrid& grid_;
  double snap_;
  ConstraintGraph graph_;
  std::array<QuadrantMesh, 4> quadrants_;
  RangeCells cells_;
  std::vector<ConstraintGraph::Edge> base_;  // edges of the mesh on the horizon, as its triangles run them
  Boundary result_;
};

}  // namespace

Boundary triangulate_boundary(const Skeleton& skeleton, const BlockerSet& blockers, const DirectionTree& tree,
                              const target::RangeRegion& range, OctahedralGrid& grid, double tolerance,
                              const core::ProgressReporter& progress) {
  const Envelope envelope{blockers, tree, range, tolerance, progress};
  // Where creases meet at less than the snapping distance the triangulation may find no place for their crossing; wider
  // snapping makes them one. What that moves, refinement finds.
  double snap = numerics::kSnap, width = 1.0 / grid.size();
  for (;;) {
    Attempt attempt = BoundaryBuilder(skeleton, envelope, grid, snap).run();
    if (attempt.failure.empty() && attempt.border_splits.empty()) return std::move(attempt.boundary);
    if (attempt.failure.empty()) {
      // Cells round about are triangulated with the rest: more of them each time, as what splits one edge goes on.
      for (const OctahedralPoint& p : attempt.border_splits) grid.mark_square(p, width);
      width *= 2;
    } else if (snap < numerics::kWidestSnap) {
      snap *= 10;
    } else {
      throw Error(ErrorCode::internal_defect, "the creases could not be triangulated: " + attempt.failure,
                  "triangulation", "please report this with the mission and the scene");
    }
  }
}

}  // namespace vantage::internal::exact
