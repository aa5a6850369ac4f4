#include "target/clean_outline.h"

#include <cstddef>
#include <optional>
#include <utility>

#include "core/convex_corners.h"
#include "vantage/geometry.h"

namespace vantage::internal::target {
namespace {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

constexpr double kShortEdge = 1e-9;    // of the extent, as of a target
constexpr double kMostLost = 0x1p-50;  // of the extent, as of a target

/// Where the line from a through b meets the line through c and d, ahead of b and before c: what a short edge from b
/// to c cuts off. Nothing where that is farther from b than `most`.
std::optional<Vector2d> corner_beyond(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d,
                                      double most) {
  const Vector2d u = b - a, v = d - c;
  const double turn = cross(u, v);
  if (!(turn > 0)) return std::nullopt;
  const double ahead = cross(c - b, v) / turn, back = cross(c - b, u) / turn;
  const Vector2d corner = b + ahead * u;
  // The corner is c - back * v too.
  if (!(ahead >= 0 && back >= 0) || !((corner - b).norm() <= most)) return std::nullopt;
  return corner;
}

void replace_short_edges(Polygon& polygon, double extent) {
  for (std::size_t i = 0; i < polygon.size() && polygon.size() > 3;) {
    const std::size_t n = polygon.size(), next = (i + 1) % n;
    if ((polygon[next] - polygon[i]).norm() > kShortEdge * extent) {
      ++i;
      continue;
    }
    const auto corner = corner_beyond(polygon[(i + n - 1) % n], polygon[i], polygon[next], polygon[(i + 2) % n],
                                      kMostOutlineGrowth * extent);
    if (!corner && polygon[i] != polygon[next]) {
      ++i;
      continue;
    }
    if (corner) polygon[i] = *corner;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(next));
    if (next < i) --i;
  }
}

}  // namespace

Polygon cleaned_outline(Polygon polygon, double extent) {
  replace_short_edges(polygon, extent);
  std::vector<Vec3> outline;
  for (const Vector2d& p : polygon) outline.emplace_back(p.x(), p.y(), 0);
  const auto is_corner =
      core::find_corners(outline, Vec3::UnitZ(), {.inside = kShortEdge * extent, .outside = kMostLost * extent});
  if (!is_corner) return polygon;
  Polygon corners;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if ((*is_corner)[i]) corners.push_back(polygon[i]);
  }
  return corners;
}

}  // namespace vantage::internal::target
