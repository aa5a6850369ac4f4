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
    : origin_(middle_of(bounding_box(mesh))), mesh_(moved(mesh, origin_)), bounds_(bounding_box(mesh_)),
      rounding_m_(rounding_of(bounding_box(mesh))), tree_(mesh_) {
  const Vec3 size = bounds_.max - bounds_.min;
  cell_m_ = std::max(size.maxCoeff() / kCellsAlong, std::numeric_limits<double>::min());
  for (int a = 0; a < 3; ++a) count_[a] = std::clamp(static_cast<int>(std::ceil(size[a] / cell_m_)), 1, kCellsAlong);
  const auto width = static_cast<std::size_t>(count_[0]), depth = static_cast<std::size_t>(count_[1]);
  cells_.resize(width * depth * static_cast<std::size_t>(count_[2]));
  constexpr std::size_t kGrain = 256;
  parallel::for_ranges(cells_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 index(static_cast<double>(i % width), static_cast<double>(i / width % depth),
                       static_cast<double>(i / (width * depth)));
      const Vec3 point = bounds_.min + (index + Vec3::Constant(0.5)) * cell_m_;
      const double distance = tree_.distance(point);
      cells_[i] = distance > 0 && tree_.winding_number(point) > 0 ? distance : -distance;
    }
  });
}

SolidDepth::Cell SolidDepth::cell_at(const Vec3& point) const {
  std::array<int, 3> index{};
  Vec3 middle;
  for (int a = 0; a < 3; ++a) {
    const double cell = std::floor((point[a] - bounds_.min[a]) / cell_m_);
    index[a] = static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(count_[a] - 1)));
    middle[a] = bounds_.min[a] + (index[a] + 0.5) * cell_m_;
  }
  const auto i = (static_cast<std::size_t>(index[2]) * static_cast<std::size_t>(count_[1]) +
                  static_cast<std::size_t>(index[1])) *
                     static_cast<std::size_t>(count_[0]) +
                 static_cast<std::size_t>(index[0]);
  return {cells_[i], (point - middle).norm()};
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

double SolidDepth::signed_depth(const Vec3& point, double distance) const {
  if (distance_outside(point) > 0 || !(distance > 0)) return -distance;
  const Cell cell = cell_at(point);
  if (cell.depth > cell.offset) return distance;
  if (-cell.depth > cell.offset) return -distance;
  return tree_.winding_number(point) > 0 ? distance : -distance;
}

double SolidDepth::depth_m(const Vec3& point) const { return signed_depth(point, tree_.distance(point)); }

double SolidDepth::box_at_most_m(const Vec3& middle, const Vec3& half) const {
  // A point of the solid is no deeper than the solid's box is near: the way there leaves the solid.
  const double in_box =
      std::min((bounds_.max - middle + half).minCoeff(), (middle + half - bounds_.min).minCoeff());
  return std::min(in_box, at_most_m(middle) + half.norm());
}

SolidDepth::Bounded SolidDepth::bounded_m(const Vec3& middle, const Vec3& half) const {
  const core::TriangleTree::Nearest nearest = tree_.nearest(middle);
  const double depth = signed_depth(middle, nearest.distance);
  const double bound = std::min(depth + half.norm(), box_at_most_m(middle, half));
  if (!(depth > 0)) return {depth, bound};
  // No point is deeper than it is far from one triangle. That distance is convex, so a corner of the box has the most.
  const Triangle& t = mesh_.triangles[nearest.triangle];
  double squared = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sides(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Vec3 point = middle + sides.cwiseProduct(half);
    squared = std::max(squared, core::squared_distance_to_triangle(point, mesh_.vertices[t[0]], mesh_.vertices[t[1]],
                                                                   mesh_.vertices[t[2]]));
  }
  return {depth, std::min(bound, std::sqrt(squared))};
}

}  // namespace vantage::internal::flight
