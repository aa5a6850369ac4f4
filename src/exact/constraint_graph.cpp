#include "exact/constraint_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vantage::internal::exact {
namespace {

// Monotone in the angle round the diamond.
double turn_of(const OctahedralPoint& p) {
  if (p.y() >= 0) return p.x() > 0 ? p.y() : 2 - p.y();
  return p.x() < 0 ? 2 - p.y() : 4 + p.y();
}

}  // namespace

ConstraintGraph::ConstraintGraph(const Skeleton& skeleton, const FloorSkeleton* floor,
                                 std::span<const OctahedralPoint> rim_splits, OctahedralGrid& grid,
                                 const IsRange& is_range, double snap)
    : grid_(grid),
      snap_(snap),
      has_floor_(floor != nullptr),
      snapper_(2 * skeleton.planar.size() + 16 * skeleton.curved.size() + 1024, snap) {
  for (const OctahedralPoint& corner : {OctahedralPoint(0, 0), OctahedralPoint(1, 0), OctahedralPoint(0, 1),
                                        OctahedralPoint(-1, 0), OctahedralPoint(0, -1)})
    note(snapper_.add(corner), kBoth);
  at_node_.assign(points().size(), true);
  nodes_.assign(static_cast<std::size_t>(2 * grid_.size() + 1) * (2 * grid_.size() + 1), kNone);
  node(0, 0) = 0;
  if (floor) add_floor(*floor);
  add_rim_splits(rim_splits);
  add_creases(skeleton);
  grid_.settle(is_range);
  add_border();
  add_fill(is_range);
  add_axes(Sheet::envelope);
  if (floor) add_axes(Sheet::floor);
  add_horizon();
  for (std::vector<Edge>& edges : edges_) {
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  }
  keep_one_sided_rim();
  at_node_.resize(points().size());
  crease_gauges_.resize(points().size());
  floor_gauges_.resize(points().size(), std::numeric_limits<double>::infinity());
}

void ConstraintGraph::note(std::uint32_t vertex, Sheets sheets) {
  if (sheets_.size() <= vertex) sheets_.resize(vertex + 1);
  sheets_[vertex] |= sheets;
}

void ConstraintGraph::add_edge(std::uint32_t a, std::uint32_t b, Sheets sheets) {
  if (a == b) return;
  for (const Sheet sheet : {Sheet::envelope, Sheet::floor}) {
    if ((sheets & bit(sheet)) != 0)
      edges_[static_cast<std::size_t>(sheet)].emplace_back(std::min(a, b), std::max(a, b));
  }
}

void ConstraintGraph::add_creases(const Skeleton& skeleton) {
  for (const Skeleton::Edge& edge : skeleton.planar) add_crease(edge.from, edge.to, false, bit(Sheet::envelope));
  for (const Skeleton::Curve& curve : skeleton.curved) {
    const std::vector<Vec3>& line = curve.points;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) add_crease(line[i], line[i + 1], true, bit(Sheet::envelope));
  }
}

// The rim first: what else ends there is snapped to it.
void ConstraintGraph::add_floor(const FloorSkeleton& floor) {
  for (const Skeleton::Edge& edge : floor.rim) add_crease(edge.from, edge.to, true, kBoth);
  for (const Skeleton::Curve& curve : floor.curved_rim) {
    const std::vector<Vec3>& line = curve.points;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) add_crease(line[i + 1], line[i], true, kBoth);
  }
  for (const Skeleton::Edge& edge : floor.creases) add_crease(edge.from, edge.to, false, bit(Sheet::floor));
  // Both sheets have the same points at the horizon, and cells that are cut in two have theirs at nodes alone.
  for (std::uint32_t v = 0; v < points().size(); ++v) {
    if (on_horizon(v)) grid_.mark(points()[v], points()[v], snap_);
  }
}

void ConstraintGraph::add_rim_splits(std::span<const OctahedralPoint> splits) {
  for (const OctahedralPoint& point : splits) {
    rim_splits_.push_back(snapper_.add(point));
    note(rim_splits_.back(), kBoth);
  }
}

// Of surfaces that end at one line some may end before the others do: so a piece of the rim may lie on a longer one.
// What passes a vertex within the snapping distance goes through it in the triangulation, too.
void ConstraintGraph::split_rim() {
  std::vector<std::uint32_t> ends = rim_splits_;  // from left to right
  for (const auto& [a, b] : rim_) ends.insert(ends.end(), {a, b});
  const auto is_left = [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(points()[a].x(), a) < std::pair(points()[b].x(), b);
  };
  std::sort(ends.begin(), ends.end(), is_left);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<Edge> pieces;
  std::vector<std::pair<double, std::uint32_t>> between;
  for (const auto& [from, to] : rim_) {
    const OctahedralPoint &a = points()[from], &b = points()[to], way = b - a;
    const double length = way.squaredNorm(), left = std::min(a.x(), b.x()) - snap_,
                 right = std::max(a.x(), b.x()) + snap_;
    auto at = std::partition_point(ends.begin(), ends.end(), [&](std::uint32_t v) { return points()[v].x() < left; });
    between.clear();
    for (; at != ends.end() && points()[*at].x() <= right; ++at) {
      const OctahedralPoint to_it = points()[*at] - a;
      const double along = to_it.dot(way), beside = way.x() * to_it.y() - way.y() * to_it.x();
      const bool is_end = *at == from || *at == to;
      if (is_end || along <= 0 || along >= length || beside * beside > snap_ * snap_ * length) continue;
      between.emplace_back(along, *at);
    }
    std::sort(between.begin(), between.end());
    std::uint32_t last = from;
    for (const auto& [along, vertex] : between) {
      pieces.emplace_back(last, vertex);
      last = vertex;
    }
    pieces.emplace_back(last, to);
  }
  rim_ = std::move(pieces);
}

// Of surfaces that end at one line there may be several. Where some end at it from the one side and some from the other
// there is nothing between them.
void ConstraintGraph::keep_one_sided_rim() {
  split_rim();
  const auto is_before = [](const Edge& x, const Edge& y) {
    return std::minmax(x.first, x.second) < std::minmax(y.first, y.second);
  };
  std::sort(rim_.begin(), rim_.end(), is_before);
  std::vector<Edge> kept;
  for (std::size_t i = 0; i < rim_.size();) {
    std::size_t end = i, forward = 0;
    for (; end < rim_.size() && !is_before(rim_[i], rim_[end]); ++end) forward += rim_[end].first < rim_[end].second;
    if (forward == 0 || forward == end - i) kept.push_back(std::minmax(rim_[i].first, rim_[i].second));
    i = end;
  }
  rim_ = std::move(kept);
}

std::uint32_t ConstraintGraph::add_crease_point(const Vec3& point, const OctahedralPoint& on_map, Sheets sheets) {
  const std::uint32_t vertex = snapper_.add(on_map);
  note(vertex, sheets);
  const double gauge = 1 / point.lpNorm<1>();
  if ((sheets & bit(Sheet::envelope)) != 0) {
    if (crease_gauges_.size() <= vertex) crease_gauges_.resize(vertex + 1);
    crease_gauges_[vertex] = std::max(crease_gauges_[vertex], gauge);
  } else {
    if (floor_gauges_.size() <= vertex) floor_gauges_.resize(vertex + 1, std::numeric_limits<double>::infinity());
    floor_gauges_[vertex] = std::min(floor_gauges_[vertex], gauge);
  }
  return vertex;
}

// A straight line in space is straight in the octahedral map but for bends where it crosses the planes x = 0 and y = 0.
void ConstraintGraph::add_crease(const Vec3& from, const Vec3& to, bool is_marked, Sheets sheets) {
  std::array<double, 4> stops{0, 1, 1, 1};
  int count = 1;
  for (int axis = 0; axis < 2; ++axis) {
    if ((from[axis] < 0 && to[axis] > 0) || (from[axis] > 0 && to[axis] < 0))
      stops[count++] = from[axis] / (from[axis] - to[axis]);
  }
  if (count == 3 && stops[2] < stops[1]) std::swap(stops[1], stops[2]);
  stops[count] = 1;
  OctahedralPoint previous = to_octahedral(from);
  std::uint32_t vertex = add_crease_point(from, previous, sheets);
  for (int i = 1; i <= count; ++i) {
    const Vec3 stop = stops[i] == 1 ? to : Vec3(from + stops[i] * (to - from));
    const OctahedralPoint next = to_octahedral(stop);
    const std::uint32_t next_vertex = add_crease_point(stop, next, sheets);
    add_edge(vertex, next_vertex, sheets);
    if (sheets == kBoth && vertex != next_vertex) rim_.emplace_back(vertex, next_vertex);
    if (is_marked) grid_.mark(previous, next, snap_);
    previous = next;
    vertex = next_vertex;
  }
}

std::uint32_t ConstraintGraph::vertex_at(int i, int j) {
  std::uint32_t& slot = node(i, j);
  if (slot == kNone) {
    slot = snapper_.add(grid_.node(i, j));
    note(slot, bit(Sheet::envelope));
    if (at_node_.size() <= slot) at_node_.resize(slot + 1);
    at_node_[slot] = true;
  }
  return slot;
}

// One vertex after the other: compilers disagree on which argument of a call comes first, and vertices are numbered as
// they come.
void ConstraintGraph::add_grid_edge(const std::array<int, 2>& from, const std::array<int, 2>& to) {
  const std::uint32_t a = vertex_at(from[0], from[1]);
  const std::uint32_t b = vertex_at(to[0], to[1]);
  add_edge(a, b);
}

// The edges between cells that are cut in two and the rest of the octahedral map.
void ConstraintGraph::add_border() {
  const int n = grid_.size();
  for (int j = -n; j <= n; ++j) {
    const int width = j < n ? grid_.row_width(j) : 0, width_below = j > -n ? grid_.row_width(j - 1) : 0;
    for (const OctahedralGrid::Run& run : grid_.range_runs(j)) {
      if (run.begin > -width) add_grid_edge({run.begin, j}, {run.begin, j + 1});
      if (run.end < width) add_grid_edge({run.end, j}, {run.end, j + 1});
      // Those of a floor meet its own at all nodes.
      for (int i = run.begin; i < run.end; i = has_floor_ || i == run.end - 1 ? i + 1 : run.end - 1) {
        if (grid_.at_horizon(i, j)) {
          const OctahedralGrid::Corners c = OctahedralGrid::corners(i, j);
          vertex_at(c.a1, c.b0);
          vertex_at(c.a0, c.b1);
        }
      }
    }
    add_steps(grid_.range_runs(j - 1), grid_.range_runs(j), std::min(width, width_below), j);
  }
}

// Along line j: where just one of the rows below and above it has a cell that is cut in two, and both have cells.
void ConstraintGraph::add_steps(std::span<const OctahedralGrid::Run> below, std::span<const OctahedralGrid::Run> above,
                                int width, int j) {
  steps_.clear();
  for (const auto& runs : {below, above}) {
    for (const OctahedralGrid::Run& run : runs)
      for (int end : {run.begin, run.end}) steps_.push_back(std::clamp(end, -width, width));
  }
  std::sort(steps_.begin(), steps_.end());
  for (std::size_t k = 0; k + 1 < steps_.size(); k += 2)
    for (int i = steps_[k]; i < steps_[k + 1]; ++i) add_grid_edge({i, j}, {i + 1, j});
}

void ConstraintGraph::add_fill(const IsRange& is_range) {
  for (const auto& [i, j] : grid_.mixed_cells()) {
    for (const auto& [a, b] : {std::pair{i, j}, {i + 1, j}, {i, j + 1}, {i + 1, j + 1}}) {
      if (std::abs(a) + std::abs(b) <= grid_.size() && node(a, b) == kNone && is_range(grid_.node(a, b)))
        vertex_at(a, b);
    }
  }
}

// Triangles must not pass over the axes, where the octahedral map bends.
void ConstraintGraph::add_axes(Sheet sheet) {
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<std::uint32_t> on_axis;
    for (std::uint32_t v = 0; v < points().size(); ++v)
      if (points()[v][1 - axis] == 0 && is_of(sheet, v)) on_axis.push_back(v);
    std::sort(on_axis.begin(), on_axis.end(),
              [&](std::uint32_t a, std::uint32_t b) { return points()[a][axis] < points()[b][axis]; });
    for (std::size_t k = 0; k + 1 < on_axis.size(); ++k) add_edge(on_axis[k], on_axis[k + 1], bit(sheet));
  }
}

void ConstraintGraph::add_horizon() {
  std::vector<std::uint32_t> horizon;
  for (std::uint32_t v = 0; v < points().size(); ++v)
    if (on_horizon(v)) horizon.push_back(v);
  std::sort(horizon.begin(), horizon.end(),
            [&](std::uint32_t a, std::uint32_t b) { return turn_of(points()[a]) < turn_of(points()[b]); });
  for (std::size_t k = 0; k < horizon.size(); ++k) {
    note(horizon[k], kBoth);
    add_edge(horizon[k], horizon[(k + 1) % horizon.size()], kBoth);
  }
}

}  // namespace vantage::internal::exact
