#include "flight/solid_depth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/parallel.h"
#include "core/triangle_distance.h"

namespace vantage::internal::flight {
namespace {

/// Cells along the longest side of the bounds: 64,000 of a cube. More cost more than they save.
constexpr int kCellsAlong = 40;

Vec3 middle_of(const Box& box) { return (box.min + box.max) / 2; }

Mesh moved(const Mesh& mesh, const Vec3& origin) {
  Mesh result = mesh;
  for (Vec3& vertex : result.vertices) vertex -= origin;
  return result;
}

/// Vertices are rounded once on the way to the origin, and points once on the way back: each by half of the last place
/// of the largest coordinate, in three axes. Twice that.
double rounding_of(const Box& box) {
  const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  return 4 * largest * std::numeric_limits<double>::epsilon();
}

}  // namespace

SolidDepth::SolidDepth(const Mesh& mesh)
    : origin_(middle_of(bounding_box(mesh))),
      mesh_(moved(mesh, origin_)),
      bounds_(bounding_box(mesh_)),
      rounding_m_(rounding_of(bounding_box(mesh))),
      tree_(mesh_),
      distance_(mesh_) {
  const Vec3 size = bounds_.max - bounds_.min;
  cell_m_ = std::max(size.maxCoeff() / kCellsAlong, std::numeric_limits<double>::min());
  cell_error_ = cell_m_ / 4;
  for (int a = 0; a < 3; ++a) count_[a] = std::clamp(static_cast<int>(std::ceil(size[a] / cell_m_)), 1, kCellsAlong);
  cells_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                static_cast<std::size_t>(count_[2]));
  constexpr std::size_t kGrain = 256;
  parallel::for_ranges(cells_.size(), kGrain, [&](std::size_t begin, std::size_t end) { fill_cells(begin, end); });
}

void SolidDepth::fill_cells(std::size_t begin, std::size_t end) {
  const auto width = static_cast<std::size_t>(count_[0]), depth = static_cast<std::size_t>(count_[1]);
  double last = 0;  // depth of the cell before, 0: not known
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t row = i / width % depth, layer = i / (width * depth);
    const Vec3 index(static_cast<double>(i % width), static_cast<double>(row), static_cast<double>(layer));
    const Vec3 point = bounds_.min + (index + Vec3::Constant(0.5)) * cell_m_;
    // Up to the error too large. So the depth of a point near the surface is 0, to that error.
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const double distance = distance_.nearest(point, point, kNone, cell_error_).distance_m;
    if (distance <= cell_error_ + rounding_m_) {
      last = cells_[i] = 0;
      continue;
    }
    // The surface is not between two cells if it is farther from one of them than they are apart.
    const bool is_same = i % width > 0 && std::abs(last) > cell_m_ + cell_error_;
    const bool is_in = is_same ? last > 0 : tree_.winding_number(point) > 0;
    last = cells_[i] = is_in ? distance : -distance;
  }
}

SolidDepth::Cell SolidDepth::cell_at(const Vec3& point) const {
  std::array<int, 3> index{};
  Vec3 middle;
  for (int a = 0; a < 3; ++a) {
    const double cell = std::floor((point[a] - bounds_.min[a]) / cell_m_);
    index[a] = static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(count_[a] - 1)));
    middle[a] = bounds_.min[a] + (index[a] + 0.5) * cell_m_;
  }
  const auto i =
      (static_cast<std::size_t>(index[2]) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(index[1])) *
          static_cast<std::size_t>(count_[0]) +
      static_cast<std::size_t>(index[0]);
  return {cells_[i], (point - middle).norm() + cell_error_};
}

double SolidDepth::distance_outside(const Vec3& point) const {
  return (point - point.cwiseMax(bounds_.min).cwiseMin(bounds_.max)).norm();
}

double SolidDepth::at_most_m(const Vec3& point) const {
  const double outside = distance_outside(point);
  if (outside > 0) return -outside;
  const Cell cell = cell_at(point);
  return cell.depth + cell.offset;
}

double SolidDepth::at_least_m(const Vec3& point) const {
  const Cell cell = cell_at(point);  // the nearest one, of a point outside of the grid
  return cell.depth - cell.offset;
}

bool SolidDepth::is_inside(const Vec3& point) const {
  if (distance_outside(point) > 0) return false;
  const Cell cell = cell_at(point);
  if (std::abs(cell.depth) > cell.offset) return cell.depth > 0;
  return tree_.winding_number(point) > 0;
}

double SolidDepth::depth_m(const Vec3& point) const {
  const Cell cell = cell_at(point);
  const double below = (std::abs(cell.depth) + cell.offset) * (1 + 1e-9);
  const double distance = distance_.nearest(point, point, below, 0).distance_m;
  // Nearer than rounding it is on neither side.
  return distance > rounding_m_ && is_inside(point) ? distance : -distance;
}

double SolidDepth::box_at_most_m(const Vec3& middle, const Vec3& half) const {
  // A point of the solid is no deeper than the solid's box is near: the way there leaves the solid.
  const double in_box = std::min((bounds_.max - middle + half).minCoeff(), (middle + half - bounds_.min).minCoeff());
  return std::min(in_box, at_most_m(middle) + half.norm());
}

SolidDepth::Bounded SolidDepth::bounded_m(const Vec3& middle, const Vec3& half) const {
  const double reach = half.norm(), slack = reach / 4;
  const SegmentDistance::Nearest nearest =
      distance_.nearest(middle, middle, std::numeric_limits<double>::infinity(), slack);
  if (nearest.distance_m <= slack + rounding_m_) {  // it may be on the surface
    const double depth = depth_m(middle);
    return {depth, std::min(depth + reach, box_at_most_m(middle, half))};
  }
  if (!is_inside(middle)) {
    return {-nearest.distance_m, std::min(reach - nearest.distance_m + slack, box_at_most_m(middle, half))};
  }
  const double bound = std::min(nearest.distance_m + reach, box_at_most_m(middle, half));
  // No point is deeper than it is far from one triangle. That distance is convex, so a corner of the box has the most.
  const Triangle& t = mesh_.triangles[*nearest.triangle];
  double squared = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sides(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Vec3 point = middle + sides.cwiseProduct(half);
    squared = std::max(squared, core::squared_distance_to_triangle(point, mesh_.vertices[t[0]], mesh_.vertices[t[1]],
                                                                   mesh_.vertices[t[2]]));
  }
  return {nearest.distance_m - slack, std::min(bound, std::sqrt(squared))};
}

}  // namespace vantage::internal::flight
