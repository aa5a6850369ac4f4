#include "scene/triangulated_terrain.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "vantage/error.h"

namespace vantage::internal::scene {
namespace {

// What rounding may put outside a triangle, in its own coordinates (1 is a corner).
constexpr double kOutside = 1e-9;
constexpr int kMaxCells = 4096;  // in one direction
const Incline kLevel{Eigen::Vector2d::Zero(), 0};

Eigen::Vector2d flat(const Vec3& point) { return point.head<2>(); }

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

Vec3 measured_from(const Incline& plane, Vec3 vertex) {
  vertex.z() -= plane.at(flat(vertex));
  return vertex;
}

/// A triangle as a linear height above a plane.
class Facet {
 public:
  Facet(const Mesh& mesh, const Triangle& triangle, const Incline& above)
      : a_(measured_from(above, mesh.vertices[triangle[0]])),
        b_(measured_from(above, mesh.vertices[triangle[1]]) - a_),
        c_(measured_from(above, mesh.vertices[triangle[2]]) - a_) {}

  /// How much each corner counts at a place; all are in 0 to 1 inside.
  Eigen::Vector3d weights(const Eigen::Vector2d& at) const {
    const Eigen::Vector2d place = at - flat(a_);
    const double area = cross(flat(b_), flat(c_));
    const double b = cross(place, flat(c_)) / area, c = cross(flat(b_), place) / area;
    return {1 - b - c, b, c};
  }
  double height(const Eigen::Vector3d& weights) const { return a_.z() + weights[1] * b_.z() + weights[2] * c_.z(); }

 private:
  Vec3 a_, b_, c_;
};

/// Whether a place is wound round by the ring an odd number of times.
bool is_inside(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& at) {
  bool inside = false;
  for (std::size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++) {
    const Eigen::Vector2d &a = ring[before], &b = ring[i];
    if ((a.y() > at.y()) == (b.y() > at.y())) continue;
    if (at.x() < a.x() + (b.x() - a.x()) * (at.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

}  // namespace

TriangulatedTerrain::TriangulatedTerrain(Mesh mesh, const core::ProgressReporter& progress) : mesh_(std::move(mesh)) {
  if (mesh_.empty()) throw Error(ErrorCode::internal_defect, "a surface without triangles", "terrain", "");
  const Box box = bounding_box(mesh_);
  min_ = flat(box.min);
  max_ = flat(box.max);
  // About one vertex a cell, cells about square.
  const Eigen::Vector2d size = max_ - min_;
  const double cell_m = std::sqrt(size.x() * size.y() / static_cast<double>(mesh_.vertices.size()));
  columns_ = std::clamp(static_cast<int>(std::min(size.x() / cell_m, 1e6)), 1, kMaxCells);
  rows_ = std::clamp(static_cast<int>(std::min(size.y() / cell_m, 1e6)), 1, kMaxCells);
  cells_per_m_ = {columns_ / size.x(), rows_ / size.y()};
  index_triangles(progress);
  index_vertices(progress);
}

int TriangulatedTerrain::cell_column(double x) const {
  return static_cast<int>(std::clamp((x - min_.x()) * cells_per_m_.x(), 0.0, columns_ - 1.0));
}
int TriangulatedTerrain::cell_row(double y) const {
  return static_cast<int>(std::clamp((y - min_.y()) * cells_per_m_.y(), 0.0, rows_ - 1.0));
}
std::uint32_t TriangulatedTerrain::cell(int column, int row) const {
  return static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(columns_) + static_cast<std::uint32_t>(column);
}

/// Lists each item in the cells that `cells_of(item, add)` adds: counted first, then placed.
template <typename CellsOf>
static void fill_cells(std::vector<std::uint32_t>& first, std::vector<std::uint32_t>& items, std::size_t cells,
                       std::size_t count, const CellsOf& cells_of, const core::ProgressReporter& progress) {
  first.assign(cells + 1, 0);
  for (std::uint32_t item = 0; item < count; ++item) {
    progress.tick();
    cells_of(item, [&](std::uint32_t cell) { ++first[cell + 1]; });
  }
  for (std::size_t c = 0; c < cells; ++c) first[c + 1] += first[c];
  items.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t item = 0; item < count; ++item) {
    progress.tick();
    cells_of(item, [&](std::uint32_t cell) { items[next[cell]++] = item; });
  }
}

/// Into the cells that each triangle meets, row by row of cells: the part of it in a row lies between the ends of its
/// sides' parts there.
void TriangulatedTerrain::index_triangles(const core::ProgressReporter& progress) {
  const auto cells_of = [&](std::uint32_t t, const auto& add) {
    std::array<Eigen::Vector2d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = flat(mesh_.vertices[mesh_.triangles[t][i]]);
    const auto [low, high] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
    const int first_row = cell_row(low), last_row = cell_row(high);
    for (int row = first_row; row <= last_row; ++row) {
      // A hair wider than the row: a triangle that ends on its border belongs to both.
      const double bottom = min_.y() + (row - 1e-6) / cells_per_m_.y(),
                   top = min_.y() + (row + 1 + 1e-6) / cells_per_m_.y();
      double left = std::numeric_limits<double>::infinity(), right = -left;
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % 3];
        if (std::max(a.y(), b.y()) < bottom || std::min(a.y(), b.y()) > top) continue;
        const auto x_at = [&](double y) {
          return a.y() == b.y() ? a.x() : a.x() + (b.x() - a.x()) * std::clamp((y - a.y()) / (b.y() - a.y()), 0.0, 1.0);
        };
        for (const double x : {x_at(bottom), x_at(top), a.y() == b.y() ? b.x() : x_at(bottom)}) {
          left = std::min(left, x);
          right = std::max(right, x);
        }
      }
      if (left > right) continue;
      const double hair = 1e-6 / cells_per_m_.x();
      for (int column = cell_column(left - hair); column <= cell_column(right + hair); ++column) add(cell(column, row));
    }
  };
  fill_cells(triangles_.first, triangles_.items, static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
             mesh_.triangles.size(), cells_of, progress);
}

void TriangulatedTerrain::index_vertices(const core::ProgressReporter& progress) {
  fill_cells(
      vertices_.first, vertices_.items, static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
      mesh_.vertices.size(),
      [&](std::uint32_t v, const auto& add) {
        add(cell(cell_column(mesh_.vertices[v].x()), cell_row(mesh_.vertices[v].y())));
      },
      progress);
}

std::optional<TriangulatedTerrain::Found> TriangulatedTerrain::find(const Eigen::Vector2d& at) const {
  return find(at, kLevel);
}

std::optional<TriangulatedTerrain::Found> TriangulatedTerrain::find(const Eigen::Vector2d& at,
                                                                    const Incline& above) const {
  const Eigen::Vector2d hair = (max_ - min_) * 1e-12;
  // Written so that not-a-number is outside too.
  if (!((at - min_ + hair).minCoeff() >= 0 && (max_ - at + hair).minCoeff() >= 0)) return std::nullopt;
  const std::uint32_t c = cell(cell_column(at.x()), cell_row(at.y()));
  std::optional<Found> found;
  double inside = -kOutside;
  for (std::uint32_t i = triangles_.first[c]; i < triangles_.first[c + 1]; ++i) {
    const Facet facet(mesh_, mesh_.triangles[triangles_.items[i]], above);
    const Eigen::Vector3d weights = facet.weights(at);
    if (weights.minCoeff() < inside) continue;
    inside = weights.minCoeff();
    found = {triangles_.items[i], facet.height(weights)};
    if (inside >= 0) break;
  }
  return found;
}

/// Takes in the heights along a segment: at the ends of its part in each triangle.
void TriangulatedTerrain::widen(Range& range, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                const Incline& above) const {
  const Eigen::Vector2d along = to - from;
  const auto [low, high] = std::minmax(from.y(), to.y());
  for (int row = cell_row(low); row <= cell_row(high); ++row) {
    double left = std::min(from.x(), to.x()), right = std::max(from.x(), to.x());
    if (along.y() != 0) {  // only the part of the segment in this row of cells
      const auto x_at = [&](double y) {
        return from.x() + along.x() * std::clamp((y - from.y()) / along.y(), 0.0, 1.0);
      };
      const double bottom = x_at(min_.y() + row / cells_per_m_.y()),
                   top = x_at(min_.y() + (row + 1) / cells_per_m_.y());
      left = std::min(bottom, top);
      right = std::max(bottom, top);
    }
    for (int column = cell_column(left); column <= cell_column(right); ++column) {
      const std::uint32_t c = cell(column, row);
      for (std::uint32_t i = triangles_.first[c]; i < triangles_.first[c + 1]; ++i) {
        const Facet facet(mesh_, mesh_.triangles[triangles_.items[i]], above);
        const Eigen::Vector3d start = facet.weights(from), end = facet.weights(to);
        double begin = 0, finish = 1;
        for (int side = 0; side < 3; ++side) {
          const double change = end[side] - start[side];
          if (change > 0) begin = std::max(begin, -start[side] / change);
          if (change < 0) finish = std::min(finish, -start[side] / change);
          if (change == 0 && start[side] < 0) finish = -1;
        }
        if (begin > finish) continue;
        for (const double part : {begin, finish}) {
          const double height = facet.height(start + part * (end - start));
          range.lowest = std::min(range.lowest, height);
          range.highest = std::max(range.highest, height);
        }
      }
    }
  }
}

std::optional<TriangulatedTerrain::Range> TriangulatedTerrain::range(const std::vector<Eigen::Vector2d>& ring,
                                                                     const Incline& above) const {
  if (ring.empty()) return std::nullopt;
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  Eigen::Vector2d low = ring.front(), high = ring.front();
  for (const Eigen::Vector2d& corner : ring) {
    const std::optional<Found> here = find(corner, above);
    if (!here) return std::nullopt;  // the surface is convex: when all corners lie in it, the polygon does
    range.lowest = std::min(range.lowest, here->height);
    range.highest = std::max(range.highest, here->height);
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  for (std::size_t i = 0; i < ring.size(); ++i) widen(range, ring[i], ring[(i + 1) % ring.size()], above);
  for (int row = cell_row(low.y()); row <= cell_row(high.y()); ++row) {
    for (int column = cell_column(low.x()); column <= cell_column(high.x()); ++column) {
      const std::uint32_t c = cell(column, row);
      for (std::uint32_t i = vertices_.first[c]; i < vertices_.first[c + 1]; ++i) {
        const Vec3 vertex = measured_from(above, mesh_.vertices[vertices_.items[i]]);
        if (!is_inside(ring, flat(vertex))) continue;
        range.lowest = std::min(range.lowest, vertex.z());
        range.highest = std::max(range.highest, vertex.z());
      }
    }
  }
  return range;
}

}  // namespace vantage::internal::scene
