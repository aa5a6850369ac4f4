#include "flight/tour/cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vantage::internal::flight::tour {
namespace {

constexpr double kCellRounding = 0x1p-53;
constexpr double kFarEnough = 0.3;   // known halves are used where both lie so far from the point, of what is usual
constexpr double kLeastShare = 0.1;  // planes keep so far from the ends of a cell

/// The planes that are tried: the axes, and those between two of them.
constexpr std::array<std::array<std::int8_t, 3>, 9> kNormals = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}};

Vec3 vector_of_normal(const std::array<std::int8_t, 3>& normal) {
  return {normal[0] * 1.0, normal[1] * 1.0, normal[2] * 1.0};
}

/// What of a convex polygon has height >= 0.
void clip(const std::vector<Vec3>& polygon, const Vec3& normal, double offset, std::vector<Vec3>& kept) {
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double at_a = normal.dot(a) - offset, at_b = normal.dot(b) - offset;
    if (at_a >= 0) kept.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) kept.push_back(a + std::clamp(at_a / (at_a - at_b), 0.0, 1.0) * (b - a));
  }
}

std::vector<Vec3> points_of(const std::vector<std::vector<Vec3>>& polygons) {
  std::vector<Vec3> points;
  for (const std::vector<Vec3>& polygon : polygons) points.insert(points.end(), polygon.begin(), polygon.end());
  std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  points.erase(std::unique(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) { return a == b; }),
               points.end());
  return points;
}

double largest_of(const std::vector<Vec3>& points) {
  double largest = 0;
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

bool crosses(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& corners) {
  const Vec3 along = to - from;
  const Vec3 first = corners[1] - corners[0], second = corners[2] - corners[0];
  const Vec3 cross = along.cross(second);
  const double determinant = first.dot(cross);
  if (determinant == 0) return false;
  const Vec3 offset = from - corners[0];
  const double u = offset.dot(cross) / determinant;
  if (!(u >= 0 && u <= 1)) return false;
  const Vec3 other = offset.cross(first);
  const double v = along.dot(other) / determinant;
  if (!(v >= 0 && u + v <= 1)) return false;
  const double t = second.dot(other) / determinant;
  return t >= 0 && t <= 1;
}

}  // namespace

Cells::Cells(std::span<const OuterRegion> regions) {
  Box all;
  for (const OuterRegion& region : regions) {
    for (const Vec3& v : region.mesh().vertices) all.extend(v);
  }
  if (!all.empty()) origin_ = (0.5 * (all.min + all.max)).array().round();
  for (const OuterRegion& region : regions) {
    Shape shape{region.mesh(), nullptr};
    for (Vec3& v : shape.mesh.vertices) v -= origin_;
    auto cell = std::make_unique<Cell>();
    cell->region = shapes_.size();
    for (const Triangle& t : shape.mesh.triangles) {
      cell->polygons.push_back({shape.mesh.vertices[t[0]], shape.mesh.vertices[t[1]], shape.mesh.vertices[t[2]]});
    }
    if (shape.mesh.empty()) cell->polygons.push_back({shape.mesh.vertices.front()});
    std::vector<Vec3> points = points_of(cell->polygons);
    // Subtracting the origin rounds each of three numbers by half a unit in its last place.
    const double moved = 2 * kCellRounding * largest_of(points);
    cell->hull = std::make_unique<Hull>(std::move(points), moved);
    reach_m_ = std::max(reach_m_, cell->hull->reach_m());
    shapes_.push_back(std::move(shape));
    cells_.push_back(std::move(cell));
  }
  for (Shape& shape : shapes_) {  // the trees refer to the meshes, which stay where they are from now on
    if (!shape.mesh.empty()) shape.tree = std::make_unique<core::TriangleTree>(shape.mesh);
  }
}

double Cells::distance_m(std::size_t region, const Vec3& point) const {
  const Shape& shape = shapes_[region];
  if (!shape.tree) return (point - shape.mesh.vertices.front()).norm();
  const double distance = shape.tree->distance(point);
  if (distance == 0 || shape.tree->winding_number(point) > 0) return 0;
  return distance;
}

bool Cells::meets_segment(std::size_t region, const Vec3& from, const Vec3& to) const {
  const Shape& shape = shapes_[region];
  if (!shape.tree) return false;
  Box box;
  box.extend(from);
  box.extend(to);
  const auto meets = [&](std::uint32_t triangle) {
    const Triangle& t = shape.mesh.triangles[triangle];
    return crosses(from, to, {shape.mesh.vertices[t[0]], shape.mesh.vertices[t[1]], shape.mesh.vertices[t[2]]});
  };
  return shape.tree->any_near(box, meets) || distance_m(region, from) == 0;
}

std::vector<std::size_t> Cells::three_far_apart() const {
  const std::size_t count = region_count();
  std::vector<std::size_t> three;
  for (std::size_t r = 0; r < std::min<std::size_t>(count, 3); ++r) three.push_back(r);
  std::vector<Vec3> at;
  for (std::size_t r = 0; r < count; ++r) at.push_back(cells_[r]->hull->inside());
  const auto is_point = [&](std::size_t r) { return cells_[r]->hull->is_point() ? 1 : 0; };
  int most_points = 0;
  double longest = -1;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      for (std::size_t k = j + 1; k < count; ++k) {
        const double length = (at[i] - at[j]).norm() + (at[j] - at[k]).norm() + (at[k] - at[i]).norm();
        const int points = is_point(i) + is_point(j) + is_point(k);
        if (points < most_points || (points == most_points && length <= longest)) continue;
        most_points = points;
        longest = length;
        three = {i, j, k};
      }
    }
  }
  return three;
}

/// Cuts the true cell: the plane is moved back by more than all that rounding does to corners and heights. So the cell
/// that is kept holds the true one, but for how far its points were rounded along the way: Hull::moved_m.
std::unique_ptr<Cell> Cells::cut(std::size_t number, const CellPlane& plane) const {
  const Cell& cell = *cells_[number];
  const Vec3 normal = (plane.lower ? -1 : 1) * vector_of_normal(plane.normal);
  const double offset = (plane.lower ? -1 : 1) * (plane.offset - vector_of_normal(plane.normal).dot(origin_));
  const double back = 1e-9 * reach_m_ + 64 * kCellRounding * (origin_.cwiseAbs().sum() + reach_m_);
  auto part = std::make_unique<Cell>();
  part->region = cell.region;
  part->parent = number;
  part->plane = plane;
  std::vector<Vec3> kept;
  for (const std::vector<Vec3>& polygon : cell.polygons) {
    clip(polygon, normal, offset - back, kept);
    if (!kept.empty()) part->polygons.push_back(kept);
  }
  std::vector<Vec3> points = points_of(part->polygons);
  if (points.empty()) return part;
  const double moved = cell.hull->moved_m() + 8 * kCellRounding * cells_[cell.region]->hull->reach_m();
  part->hull = std::make_unique<Hull>(std::move(points), moved);
  return part;
}

/// The nearer of the two.
double Cells::distance_to_halves(const std::array<const Cell*, 2>& halves, const Vec3& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Cell* half : halves) {
    if (half->hull) nearest = std::min(nearest, half->hull->nearest(point, 1e-6 * reach_m_).distance_m);
  }
  return nearest;
}

std::array<std::size_t, 2> Cells::halves(std::size_t number, const Vec3& point) {
  Cell& cell = *cells_[number];
  const double usual = distance_m(cell.region, point);
  for (const std::array<std::size_t, 2>& known : cell.halves) {
    if (distance_to_halves({cells_[known[0]].get(), cells_[known[1]].get()}, point) >= kFarEnough * usual) return known;
  }
  double best = -1;
  std::array<std::unique_ptr<Cell>, 2> parts;
  for (const std::array<std::int8_t, 3>& normal : kNormals) {
    const Vec3 direction = vector_of_normal(normal);
    const double low = direction.dot(cell.hull->lowest(direction)), high = direction.dot(cell.hull->lowest(-direction));
    const double margin = kLeastShare * (high - low);
    if (!(margin > 1e-6 * reach_m_)) continue;
    const double height = std::clamp(direction.dot(point), low + margin, high - margin);
    CellPlane plane{normal, height + direction.dot(origin_), false};
    std::unique_ptr<Cell> upper = cut(number, plane);
    plane.lower = true;
    std::unique_ptr<Cell> lower = cut(number, plane);
    const double here = distance_to_halves({upper.get(), lower.get()}, point);
    if (here > best) {
      best = here;
      parts = {std::move(upper), std::move(lower)};
    }
  }
  if (!parts[0]) return {number, number};  // a speck: nothing is to be cut
  const std::array<std::size_t, 2> made = {cells_.size(), cells_.size() + 1};
  for (std::unique_ptr<Cell>& part : parts) cells_.push_back(std::move(part));
  cells_[number]->halves.push_back(made);
  return made;
}

}  // namespace vantage::internal::flight::tour
