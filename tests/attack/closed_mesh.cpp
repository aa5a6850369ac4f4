#include "closed_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace attack {
namespace {

constexpr int kUnclear = 1 << 20, kOnSurface = kUnclear + 1;

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double along = ab.squaredNorm() > 0 ? std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) : 0;
  return (p - a - along * ab).norm();
}

/// The corner that the shortest side runs from. A needle of 40 km is tilted by a micrometre when its normal is taken of
/// two long sides.
int start_of_shortest_side(const Corners& t) {
  int shortest = 0;
  for (int k = 1; k < 3; ++k)
    if ((t[(k + 1) % 3] - t[k]).squaredNorm() < (t[(shortest + 1) % 3] - t[shortest]).squaredNorm()) shortest = k;
  return shortest;
}

Vec3 normal_at(const Corners& t, int corner) {
  return (t[(corner + 1) % 3] - t[corner]).cross(t[(corner + 2) % 3] - t[corner]);
}

}  // namespace

double distance_to_triangle(const Vec3& p, const Corners& t) {
  const int base = start_of_shortest_side(t);
  const Vec3 normal = normal_at(t, base);
  const double length = normal.norm();
  bool over = length > 0;
  for (int k = 0; k < 3 && over; ++k) over = normal.dot((t[(k + 1) % 3] - t[k]).cross(p - t[k])) >= 0;
  if (over) return std::abs(normal.dot(p - t[base])) / length;
  return std::min(
      {distance_to_segment(p, t[0], t[1]), distance_to_segment(p, t[1], t[2]), distance_to_segment(p, t[2], t[0])});
}

MeshFaults faults(const vantage::Mesh& mesh) {
  MeshFaults found;
  std::map<std::pair<std::uint32_t, std::uint32_t>, long> edges;
  for (const vantage::Triangle& t : mesh.triangles) {
    if (*std::max_element(t.begin(), t.end()) >= mesh.vertices.size()) {
      found.bad_index = true;
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a < b) {
        ++edges[{a, b}];
      } else {
        --edges[{b, a}];
      }
    }
    found.flat_facets += collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]) ? 1 : 0;
  }
  for (const auto& edge : edges) found.open_edges += edge.second != 0 ? 1 : 0;
  return found;
}

ClosedMesh::ClosedMesh(const vantage::Mesh& mesh) : vertices_(mesh.vertices), facets_(mesh.triangles) {
  vantage::Box all;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    vantage::Box box;
    for (const Vec3& p : corners(i)) box.extend(p);
    boxes_.push_back(box);
    all.extend(box);
  }
  if (!facets_.empty()) extent_ = (all.max - all.min).norm();
}

Corners ClosedMesh::corners(std::size_t facet) const {
  const vantage::Triangle& t = facets_[facet];
  return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
}

int ClosedMesh::winding(const Vec3& point, const Vec3& far) const {
  vantage::Box path;
  path.extend(point);
  path.extend(far);
  int turns = 0;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    if ((boxes_[i].min.array() > path.max.array()).any() || (boxes_[i].max.array() < path.min.array()).any()) continue;
    const auto [a, b, c] = corners(i);
    const int start = orientation(a, b, c, point), end = orientation(a, b, c, far);
    if (start == end && start != 0) continue;
    const int ab = orientation(point, far, a, b), bc = orientation(point, far, b, c),
              ca = orientation(point, far, c, a);
    const bool apart = std::min({ab, bc, ca}) < 0 && std::max({ab, bc, ca}) > 0;
    if (apart) continue;
    const bool through = ab != 0 && ab == bc && bc == ca;
    if (start == 0 && through) return kOnSurface;
    if (start * end >= 0 || !through) return kUnclear;
    turns += end;  // out through the side that sees a, b, c counter-clockwise
  }
  return turns;
}

Place ClosedMesh::locate(const Vec3& point) const {
  const std::optional<int> count = turns(point);
  return !count ? Place::on_surface : *count > 0 ? Place::inside : Place::outside;
}

std::optional<int> ClosedMesh::turns(const Vec3& point) const {
  std::uint64_t state = 1;
  const auto draw = [&state] {  // in [-1, 1)
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state >> 11) * 0x1p-52 - 1;
  };
  for (int attempt = 0; attempt < 40; ++attempt) {
    // Nearly along an axis: most boxes are beside the path.
    const double spread = attempt < 4 ? 1e-3 : 1;
    const Vec3 direction(attempt % 2 ? 1 : -1, spread * draw(), spread * draw());
    const double away = extent_ + 2 * (point - vertices_[facets_[0][0]]).norm();
    const int count = winding(point, point + 2 * away * direction);
    if (count == kOnSurface) return std::nullopt;
    if (count != kUnclear) return count;
  }
  return std::nullopt;  // a vertex or an edge: no path away from it is clear
}

double ClosedMesh::distance(const Vec3& point) const {
  double least = INFINITY;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const Vec3 nearest = point.cwiseMax(boxes_[i].min).cwiseMin(boxes_[i].max);
    if ((nearest - point).squaredNorm() < least * least)
      least = std::min(least, distance_to_triangle(point, corners(i)));
  }
  return least;
}

double ClosedMesh::last_exit(const Vec3& from, const Vec3& direction) const {
  double last = 0;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const auto t = corners(i);
    const Vec3 a = t[0] - from, b = t[1] - from, c = t[2] - from;
    const double ab = a.cross(b).dot(direction), bc = b.cross(c).dot(direction), ca = c.cross(a).dot(direction);
    if (std::min({ab, bc, ca}) < 0) continue;  // leaving: the facet looks away
    const int base = start_of_shortest_side(t);
    const Vec3 normal = normal_at(t, base);
    const double rise = normal.dot(direction);
    if (rise > 0) last = std::max(last, normal.dot(t[base] - from) / rise);
  }
  return last;
}

}  // namespace attack
