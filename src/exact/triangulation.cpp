#include "exact/triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/mend_welded.h"
#include "core/parallel.h"
#include "exact/beyond_floor.h"
#include "exact/floor_mesh.h"
#include "exact/gauge.h"
#include "exact/quadrant_mesh.h"
#include "exact/range_cells.h"
#include "target/numerics.h"
#include "vantage/error.h"

namespace vantage::internal::exact {
namespace {

// A crease that crosses the rim away from its vertices, as one between two facets in one plane, is known to one sheet
// alone. So often both sheets get a vertex there.
constexpr int kMostRimSplits = 4;

/// A boundary, or what to change before the next attempt.
struct Attempt {
  Boundary boundary;
  std::string failure;                         ///< if not empty, creases meet in a way that needs wider snapping
  std::vector<OctahedralPoint> rim_splits;     ///< then: or the rim needs vertices where creases have split it
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
  BoundaryBuilder(const Creases& creases, const Envelope& envelope, std::span<const OctahedralPoint> rim_splits,
                  OctahedralGrid& grid, double snap)
      : envelope_(envelope),
        grid_(grid),
        snap_(snap),
        graph_(creases.envelope, creases.floor, rim_splits, grid, is_range(), snap) {}

  Attempt run() {
    result_.constraint_edges = graph_.edges(Sheet::envelope).size();
    parallel::both([&] { mesh_quadrants(); }, [&] { cells_ = cut_range_cells(graph_, grid_, envelope_.range); });
    Attempt attempt;
    for (const QuadrantMesh& quadrant : quadrants_) {
      if (attempt.failure.empty()) attempt.failure = quadrant.failure;
      attempt.rim_splits.insert(attempt.rim_splits.end(), quadrant.rim_splits.begin(), quadrant.rim_splits.end());
      attempt.border_splits.insert(attempt.border_splits.end(), quadrant.border_splits.begin(),
                                   quadrant.border_splits.end());
    }
    for (const FloorMesh& floor : floors_) {
      if (attempt.failure.empty()) attempt.failure = floor.failure;
      attempt.rim_splits.insert(attempt.rim_splits.end(), floor.rim_splits.begin(), floor.rim_splits.end());
    }
    if (!attempt.failure.empty() || !attempt.border_splits.empty()) return attempt;
    result_.mesh.vertices = std::move(cells_.vertices);
    result_.mesh.triangles = std::move(cells_.triangles);
    result_.blocker_of.assign(result_.mesh.triangles.size(), Boundary::kRange);
    base_ = std::move(cells_.base);
    reserve_quadrants();
    lift_graph();
    for (const QuadrantMesh& quadrant : quadrants_) add(quadrant);
    if (envelope_.floor) {
      attempt.failure = add_floors();
      if (attempt.failure.empty() && !lies_beyond_floor()) attempt.failure = "a facet lies before the floor";
      if (attempt.failure.empty() && !part_sheets()) attempt.failure = "sheets that touch cannot be told apart";
      if (!attempt.failure.empty()) return attempt;
    } else {
      emit_base();
    }
    drop_unused_vertices();
    if (!is_closed(result_.mesh)) attempt.failure = "the parts of the mesh do not meet";
    attempt.boundary = std::move(result_);
    return attempt;
  }

 private:
  IsRange is_range() const {
    return [this](const OctahedralPoint& p) {
      const GaugeValue gauge = evaluate_gauge(envelope_.blockers, envelope_.tree, envelope_.range, p);
      return gauge.blocker == GaugeValue::kRange && (!envelope_.floor || gauge.value < envelope_.floor->at(p).gauge);
    };
  }

  void mesh_quadrants() {
    parallel::for_ranges(envelope_.floor ? 8 : 4, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const int quadrant = static_cast<int>(i % 4);
        if (i < 4) {
          quadrants_[i] = mesh_quadrant(quadrant, graph_, grid_, envelope_, snap_);
        } else {
          floors_[i - 4] = mesh_floor(quadrant, graph_, envelope_, snap_);
        }
      }
    });
  }

  void reserve_quadrants() {
    std::size_t vertices = result_.mesh.vertices.size() + 1, base = base_.size(),
                facets = result_.mesh.triangles.size();
    for (const QuadrantMesh& quadrant : quadrants_) {
      vertices += quadrant.added.size();
      base += quadrant.base.size();
      facets += quadrant.triangles.size();
    }
    base_.reserve(base);
    result_.mesh.vertices.reserve(vertices);
    result_.mesh.triangles.reserve(facets + base);
    result_.blocker_of.reserve(facets + base);
  }

  // The mesh has the vertices of the graph first, then those of the cells, then those that refinement added. On the
  // axes the quadrant that draws a vertex in more decides.
  void lift_graph() {
    gauges_.assign(graph_.points().size(), 0);
    for (const QuadrantMesh& quadrant : quadrants_) {
      for (std::size_t i = 0; i < quadrant.graph_vertex.size(); ++i) {
        double& gauge = gauges_[quadrant.graph_vertex[i]];
        gauge = std::max(gauge, quadrant.graph_gauge[i]);
      }
    }
    for (std::uint32_t v = 0; v < gauges_.size(); ++v) {
      if (gauges_[v] > 0) result_.mesh.vertices[v] = lifted(graph_.points()[v], gauges_[v], graph_.on_horizon(v));
    }
  }

  /// The floor's facets, and the base between both sheets. Why it is of no use, or nothing.
  std::string add_floors() {
    if (!lift_floor()) return "the rim lies before the floor";
    std::vector<ConstraintGraph::Edge> base;
    for (const FloorMesh& floor : floors_) {
      add(floor);
      base.insert(base.end(), floor.base.begin(), floor.base.end());
    }
    std::sort(base.begin(), base.end());
    std::sort(base_.begin(), base_.end());
    if (base != base_) return "the sheets do not meet at the horizon";
    for (const auto& [from, to] : base_) {
      emit_base(on_floor(to), to, from);
      emit_base(on_floor(to), from, on_floor(from));
    }
    return {};
  }

  /// Sheets are compared in the middle of their facets while they are made. What they claim is between their corners:
  /// less than what is kept, but where a body that is taken away has an edge, or where corners were drawn in.
  bool lies_beyond_floor() const {
    return BeyondFloor(*envelope_.floor).holds(result_.mesh, [&](std::size_t i) {
      return result_.blocker_of[i] != Boundary::kTargetPlane;
    });
  }

  /// Where both sheets have an edge across from one vertex of the rim to another they touch there: each gets its own.
  /// False where that cannot be.
  bool part_sheets() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> across;
    for (const Triangle& t : result_.mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        if (is_on_rim(from) && is_on_rim(to)) across.emplace_back(from, to);
      }
    }
    std::sort(across.begin(), across.end());
    if (std::adjacent_find(across.begin(), across.end()) == across.end()) return true;
    core::LabelledMesh labelled{std::move(result_.mesh), std::move(result_.blocker_of)};
    core::take_out_facing_facets(labelled);
    const bool is_done = core::split_shared_edges(labelled);
    result_.mesh = std::move(labelled.mesh);
    result_.blocker_of = std::move(labelled.labels);
    return is_done;
  }

  bool is_on_rim(std::uint32_t v) const { return v < is_on_rim_.size() && is_on_rim_[v] != 0; }

  /// False where the rim lies before the limits: it is drawn in where it was snapped across a crease.
  bool lift_floor() {
    const std::size_t points = graph_.points().size();
    is_on_rim_.assign(points, 0);
    for (const auto& [a, b] : graph_.rim()) is_on_rim_[a] = is_on_rim_[b] = 1;
    std::vector<double> gauges(points, std::numeric_limits<double>::infinity());
    for (const FloorMesh& floor : floors_) {
      for (std::size_t i = 0; i < floor.graph_vertex.size(); ++i) {
        double& gauge = gauges[floor.graph_vertex[i]];
        gauge = std::min(gauge, floor.graph_gauge[i]);
      }
    }
    std::vector<Vec3>& vertices = result_.mesh.vertices;
    first_of_floor_ = static_cast<std::uint32_t>(vertices.size());
    vertices.resize(first_of_floor_ + points);
    constexpr double kMost = 1 + (Floor::kShrinks - 2) * numerics::kShrink;
    for (std::uint32_t v = 0; v < points; ++v) {
      if (is_on_rim_[v] != 0) {
        if (gauges_[v] > kMost * gauges[v]) return false;
      } else if (std::isfinite(gauges[v]) && gauges[v] > 0) {
        vertices[first_of_floor_ + v] = to_direction(graph_.points()[v], graph_.on_horizon(v)) / gauges[v];
      }
    }
    return true;
  }

  /// The vertex of the floor at a point of the graph.
  std::uint32_t on_floor(std::uint32_t v) const { return is_on_rim_[v] != 0 ? v : first_of_floor_ + v; }

  void add(const FloorMesh& floor) {
    Mesh& mesh = result_.mesh;
    const auto points = static_cast<std::uint32_t>(graph_.points().size());
    const auto shift = static_cast<std::uint32_t>(mesh.vertices.size()) - points;
    const auto renamed = [&](std::uint32_t v) { return v < points ? on_floor(v) : v + shift; };
    for (std::size_t i = 0; i < floor.added.size(); ++i) {
      mesh.vertices.emplace_back(exact::to_direction(floor.added[i]) / floor.added_gauge[i]);
    }
    for (std::size_t i = 0; i < floor.triangles.size(); ++i) {
      const auto& [a, b, c] = floor.triangles[i];
      mesh.triangles.push_back({renamed(a), renamed(c), renamed(b)});
      result_.blocker_of.push_back(Boundary::kFloor + floor.plane_of[i]);
    }
  }

  void emit_base(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a == b || b == c || c == a) return;
    result_.mesh.triangles.push_back({a, b, c});
    result_.blocker_of.push_back(Boundary::kTargetPlane);
  }

  static Vec3 to_direction(const OctahedralPoint& point, bool horizon) {
    Vec3 direction = exact::to_direction(point);
    if (horizon) direction.z() = 0;
    return direction;
  }

  static Vec3 lifted(const OctahedralPoint& point, double gauge, bool horizon) {
    return to_direction(point, horizon) * ((1 - numerics::kShrink) / gauge);
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
    for (const auto& [from, to] : base_) emit_base(centre, to, from);
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
  std::array<FloorMesh, 4> floors_;
  std::vector<double> gauges_;   // per point of the graph
  std::vector<char> is_on_rim_;  // the same
  std::uint32_t first_of_floor_ = 0;
  RangeCells cells_;
  std::vector<ConstraintGraph::Edge> base_;  // edges of the mesh on the horizon, as its triangles run them
  Boundary result_;
};

}  // namespace

std::optional<Boundary> triangulate_boundary(const Creases& creases, const Envelope& envelope, OctahedralGrid& grid) {
  // Where creases meet at less than the snapping distance the triangulation may find no place for their crossing; wider
  // snapping makes them one. What that moves, refinement finds.
  double snap = numerics::kSnap, width = 1.0 / grid.size();
  std::vector<OctahedralPoint> rim_splits;
  for (int more_splits = kMostRimSplits;;) {
    Attempt attempt = BoundaryBuilder(creases, envelope, rim_splits, grid, snap).run();
    if (attempt.failure.empty() && attempt.border_splits.empty()) return std::move(attempt.boundary);
    if (attempt.failure.empty()) {
      // Cells round about are triangulated with the rest: more of them each time, as what splits one edge goes on.
      for (const OctahedralPoint& p : attempt.border_splits) grid.mark_square(p, width);
      width *= 2;
    } else if (!attempt.rim_splits.empty() && more_splits-- > 0) {
      rim_splits.insert(rim_splits.end(), attempt.rim_splits.begin(), attempt.rim_splits.end());
    } else if (snap < numerics::kWidestSnap) {
      snap *= 10;
    } else if (creases.floor) {
      return std::nullopt;
    } else {
      throw Error(ErrorCode::internal_defect, "the creases could not be triangulated: " + attempt.failure,
                  "triangulation", "please report this with the mission and the scene");
    }
  }
}

}  // namespace vantage::internal::exact
