#include "target/equal_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "target/clean_outline.h"

namespace vantage::internal::target {
namespace {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

constexpr double kOverlap = 0x1p-44;  // of the extent: 64 times the rounding of a crossing
constexpr int kHalvings = 60;         // until nothing but rounding is left

double extent_of(const Polygon& polygon) {
  double extent = 0;
  for (const Vector2d& p : polygon) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  return extent;
}

/// The part of the polygon whose value along `direction` is no more than `limit`. Ends of the cut are moved out of the
/// polygon, at right angles to their edges, by `outward`.
Polygon part_below(const Polygon& polygon, const Vector2d& direction, double limit, double outward) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
    const double a = direction.dot(here) - limit, b = direction.dot(next) - limit;
    if (a <= 0) part.push_back(here);
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
      const Vector2d edge = next - here;
      part.push_back(here + a / (a - b) * edge + outward * Vector2d(edge.y(), -edge.x()).normalized());
    }
  }
  return part;
}

/// Along the edge over which the polygon is lowest: where two are as good, the first.
Vector2d long_direction(const Polygon& polygon) {
  constexpr double kAsGood = 1 - 1e-9;
  double least = std::numeric_limits<double>::infinity();
  Vector2d direction = Vector2d::UnitX();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (!(edge.norm() > 0)) continue;
    const Vector2d along = edge.normalized();
    double height = 0;
    for (const Vector2d& p : polygon) height = std::max(height, cross(along, p - polygon[i]));
    if (height > 0 && height < kAsGood * least) {
      least = height;
      direction = along;
    }
  }
  return direction;
}

/// Where along `direction` the polygon has that part of its area below. By halving: what is below only grows.
double limit_of_part(const Polygon& polygon, const Vector2d& direction, double part) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector2d& p : polygon) {
    low = std::min(low, direction.dot(p));
    high = std::max(high, direction.dot(p));
  }
  const double wanted = part * area_of(polygon);
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (area_of(part_below(polygon, direction, middle, 0)) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void cut(const Polygon& polygon, std::size_t count, double extent, std::vector<Polygon>& cells) {
  if (count == 1) {
    cells.push_back(cleaned_outline(polygon, extent));
    return;
  }
  const std::size_t first = count / 2;
  const Vector2d along = long_direction(polygon);
  const double limit = limit_of_part(polygon, along, static_cast<double>(first) / static_cast<double>(count));
  const double room = kOverlap * extent;
  cut(part_below(polygon, along, limit + room, room), first, extent, cells);
  cut(part_below(polygon, -along, -limit + room, room), count - first, extent, cells);
}

}  // namespace

double area_of(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    twice += cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return 0.5 * twice;
}

std::vector<Polygon> equal_cells(const Polygon& polygon, std::size_t count) {
  std::vector<Polygon> cells;
  if (count <= 1) return {polygon};
  cut(polygon, count, extent_of(polygon), cells);
  return cells;
}

}  // namespace vantage::internal::target
