// The points and edges of the octahedral map that the triangulation must hold.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "exact/envelope.h"
#include "exact/floor_tracer.h"
#include "exact/octahedral_grid.h"
#include "exact/vertex_snapper.h"

namespace vantage::internal::exact {

/// Answers whether the boundary in the direction of a point of the map is range sphere, with the volume behind it.
using IsRange = std::function<bool(const OctahedralPoint&)>;

/// What is triangulated: the envelope, or the floor. The rim, where they meet, is in both, and so is the horizon.
enum class Sheet : std::uint8_t { envelope, floor };

/// Creases, split where they cross the map's axes; the border of the cells that are cut in two; the axes; the
/// horizon; and free points on the range sphere among the creases, so that triangles there are no larger than cells.
class ConstraintGraph {
 public:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  static constexpr std::uint32_t kNone = ~0u;

  /// Marks and settles the cells of `grid`. Points closer than `snap` become one. `floor`: null where there is none.
  /// `rim_splits`: where pieces of the rim are to have vertices, too.
  ConstraintGraph(const Skeleton& skeleton, const FloorSkeleton* floor, std::span<const OctahedralPoint> rim_splits,
                  OctahedralGrid& grid, const IsRange& is_range, double snap);

  const std::vector<OctahedralPoint>& points() const { return snapper_.points(); }
  bool on_horizon(std::uint32_t vertex) const { return snapper_.on_horizon(vertex); }
  const std::vector<Edge>& edges(Sheet sheet) const { return edges_[static_cast<std::size_t>(sheet)]; }
  /// Without a floor all are of the envelope.
  bool is_of(Sheet sheet, std::uint32_t vertex) const { return (sheets_[vertex] & bit(sheet)) != 0; }
  /// Edges on one side of which the volume is and on the other not, sorted.
  const std::vector<Edge>& rim() const { return rim_; }

  /// The greatest inverse depth of the crease points that became this vertex; 0 for one that is on no crease. Where
  /// snapping moves a vertex off a crease towards the shadow of what makes it, the gauge falls steeply: by 2e-5 of
  /// itself at 50 m for a point and kSnap. The facets that end at the crease would be tilted by as much.
  double crease_gauge(std::uint32_t vertex) const { return crease_gauges_[vertex]; }
  /// The least inverse depth of the points of the floor's creases that became this vertex; infinite where none did.
  double floor_gauge(std::uint32_t vertex) const { return floor_gauges_[vertex]; }

  /// Whether a vertex is at a node of the grid. Only triangles between three such vertices can be halves of its cells.
  bool at_node(std::uint32_t vertex) const { return at_node_[vertex]; }

  /// The vertex at a node of the grid; kNone where there is none yet.
  std::uint32_t& node(int i, int j) {
    const int n = grid_.size();
    return nodes_[static_cast<std::size_t>(j + n) * (2 * n + 1) + static_cast<std::size_t>(i + n)];
  }

 private:
  using Sheets = std::uint8_t;  // bits
  static constexpr Sheets kBoth = 3;
  static Sheets bit(Sheet sheet) { return static_cast<Sheets>(1u << static_cast<unsigned>(sheet)); }

  void note(std::uint32_t vertex, Sheets sheets);
  void add_edge(std::uint32_t a, std::uint32_t b, Sheets sheets = 1);
  void add_crease(const Vec3& from, const Vec3& to, bool is_marked, Sheets sheets);
  std::uint32_t add_crease_point(const Vec3& point, const OctahedralPoint& on_map, Sheets sheets);
  void add_creases(const Skeleton& skeleton);
  void add_floor(const FloorSkeleton& floor);
  std::uint32_t vertex_at(int i, int j);
  void add_grid_edge(const std::array<int, 2>& from, const std::array<int, 2>& to);
  void add_border();
  void add_steps(std::span<const OctahedralGrid::Run> below, std::span<const OctahedralGrid::Run> above, int width,
                 int j);
  void add_fill(const IsRange& is_range);
  void add_axes(Sheet sheet);
  void add_horizon();
  void add_rim_splits(std::span<const OctahedralPoint> splits);
  void split_rim();
  void keep_one_sided_rim();

  OctahedralGrid& grid_;
  double snap_;
  bool has_floor_;
  VertexSnapper snapper_;
  std::array<std::vector<Edge>, 2> edges_;
  std::vector<Edge> rim_;
  std::vector<std::uint32_t> rim_splits_;
  std::vector<Sheets> sheets_;
  std::vector<std::uint32_t> nodes_;
  std::vector<bool> at_node_;
  std::vector<double> crease_gauges_, floor_gauges_;
  std::vector<int> steps_;  // for reuse
};

}  // namespace vantage::internal::exact
