#include "exact/zone_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/grown_polygon.h"
#include "core/triangle_distance.h"

namespace vantage::internal::exact {
namespace {

/// A polygon before a piece stands for its polytope where all of that is seen at no more than 89 degrees off the
/// piece's normal: the cosine. So the polygon is at most 50 times as far away as the piece.
constexpr double kFacing = 0.02;

/// Normals of the polytope's triangles that differ by less are one face's: its sides turn by an eighth of a half turn.
constexpr double kSameFace = 1e-6;

/// From the origin to a convex polygon.
double least_distance(std::span<const Vec3> corners) {
  double least = corners[0].squaredNorm();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    least = std::min(least, core::squared_distance_to_triangle(Vec3::Zero(), corners[0], corners[i - 1], corners[i]));
  }
  return std::sqrt(least);
}

/// The parts of a convex polygon on either side of normal . x = height; the second one is where it is more.
std::array<std::vector<Vec3>, 2> halves(std::span<const Vec3> corners, const Vec3& normal, double height) {
  std::array<std::vector<Vec3>, 2> parts;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &from = corners[i], &to = corners[(i + 1) % corners.size()];
    const double a = normal.dot(from) - height, b = normal.dot(to) - height;
    if (a <= 0) parts[0].push_back(from);
    if (a >= 0) parts[1].push_back(from);
    if (!((a < 0 && b > 0) || (a > 0 && b < 0))) continue;
    const Vec3 cut = from + a / (a - b) * (to - from);
    for (std::vector<Vec3>& part : parts) part.push_back(cut);
  }
  return parts;
}

/// Unit, by Newell's rule, on the side that is away from the origin; zero for a polygon without an area.
Vec3 normal_of(std::span<const Vec3> corners) {
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    area += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  }
  const double length = area.norm();
  if (!(length > 0)) return Vec3::Zero();
  return area / (area.dot(corners[0]) < 0 ? -length : length);
}

/// Corners of a convex polygon in order round `normal`: those of the hull of the points (Andrew 1979).
std::vector<Vec3> outline(std::vector<Vec3> points, const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  std::stable_sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
    const double first = u.dot(a), second = u.dot(b);
    return first != second ? first < second : v.dot(a) < v.dot(b);
  });
  const auto turns_left = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return normal.dot((b - a).cross(c - a)) > 0;
  };
  std::vector<Vec3> corners;
  for (int half = 0; half < 2; ++half) {
    const std::size_t first = corners.size();
    for (const Vec3& point : points) {
      while (corners.size() >= first + 2 && !turns_left(corners[corners.size() - 2], corners.back(), point)) {
        corners.pop_back();
      }
      corners.push_back(point);
    }
    corners.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return corners;
}

/// The faces of a convex polytope that face the origin, at more than `clear`; nothing where none does so.
std::vector<std::vector<Vec3>> faces_towards_origin(const Mesh& mesh, double clear) {
  struct Face {
    Vec3 normal;
    std::vector<Vec3> points;
  };
  std::vector<Face> faces;
  double farthest = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 area = (b - a).cross(c - a);
    const double length = area.norm();
    if (!(length > 0)) continue;
    const Vec3 normal = area / length;
    const double towards = -normal.dot(a);
    if (!(towards > 0)) continue;
    farthest = std::max(farthest, towards);
    auto face = std::find_if(faces.begin(), faces.end(),
                             [&](const Face& one) { return (one.normal - normal).norm() < kSameFace; });
    if (face == faces.end()) face = faces.insert(face, {normal, {}});
    face->points.insert(face->points.end(), {a, b, c});
  }
  std::vector<std::vector<Vec3>> result;
  if (farthest <= clear) return result;
  for (Face& face : faces) result.push_back(outline(std::move(face.points), face.normal));
  return result;
}

}  // namespace

ZonePieces::Step ZonePieces::look_at(const std::vector<Vec3>& piece) {
  const double from = least_distance(piece);
  if (from > radius_.reach()) return Step::far;
  if (from <= radius_.largest(from, from) + clear_) return Step::covers;
  const auto farthest = std::max_element(
      piece.begin(), piece.end(), [](const Vec3& a, const Vec3& b) { return a.squaredNorm() < b.squaredNorm(); });
  const double to = farthest->norm();
  if (radius_.is_even(from, to)) return Step::grow;
  // Across the longest way through the piece, where it is about as many times farther from the antenna than the nearest
  // point as the farthest one is than that: the radius grows with the distance's root. Both parts are shorter by a
  // fifth at least, so that cutting comes to an end.
  Vec3 start = Vec3::Zero();
  for (const Vec3& corner : piece) {
    if ((corner - *farthest).squaredNorm() > (start - *farthest).squaredNorm() || start.isZero()) start = corner;
  }
  const Vec3 way = *farthest - start;
  const double length = way.norm();
  const Vec3 along = way / length;
  const double wanted = std::sqrt(from * std::min(to, radius_.reach()));
  const double near = -along.dot(start), aside = std::sqrt(std::max(0.0, start.squaredNorm() - near * near));
  double cut = near + std::sqrt(std::max(0.0, wanted * wanted - aside * aside));
  cut = std::clamp(cut, 0.2 * length, 0.8 * length);
  for (std::vector<Vec3>& half : halves(piece, along, along.dot(start) + cut)) {
    if (half.size() >= 3) waiting_.push_back(std::move(half));
  }
  return Step::halve;
}

// The way from the antenna to a vehicle whose zone a point of the piece enters passes that point at no more than the
// radius, so it meets the polytope, and comes in through one of the faces towards the antenna.
//
// Where all of the polytope is on one side of the antenna, a single polygon does, and takes away less: that in which a
// plane before the piece cuts the cone from A over the polytope. All of these vehicles are in the cone, and beyond the
// plane, if it is one of two. It may be the nearest one that touches the polytope. Or: with the foci A and b, the
// vehicles whose zones b enters are those inside of a sheet of a hyperboloid, |p| - |p - b| > d - e. Its supporting
// plane with the normal n, n . b = h > 0, is n . p = (h + sqrt(h^2 - 2 d e + e^2)) / 2, and there is one where the root
// is real: with the least h and the largest d of the piece it bounds them all.
std::optional<GrownPiece> ZonePieces::grow(const std::vector<Vec3>& piece) const {
  const double from = least_distance(piece);
  double to = 0, height = std::numeric_limits<double>::infinity();
  const Vec3 normal = normal_of(piece);
  for (const Vec3& corner : piece) {
    to = std::max(to, corner.norm());
    height = std::min(height, normal.dot(corner));
  }
  Mesh mesh = core::grow_polygon(piece, radius_.largest(from, std::min(to, radius_.reach())));
  GrownPiece grown{std::move(mesh.vertices), {}};
  const bool faces = std::all_of(grown.hull.begin(), grown.hull.end(),
                                 [&](const Vec3& corner) { return normal.dot(corner) > kFacing * corner.norm(); });
  double before = std::numeric_limits<double>::infinity();
  for (const Vec3& corner : grown.hull) before = std::min(before, normal.dot(corner));
  const double root = height * height - 2 * to * radius_.excess() + radius_.excess() * radius_.excess();
  if (root > 0) before = std::max(before, 0.5 * (height + std::sqrt(root)));
  if (faces && before > clear_) {
    std::vector<Vec3> section;
    for (const Vec3& corner : grown.hull) section.push_back(corner * (before / normal.dot(corner)));
    grown.surfaces.push_back(outline(std::move(section), normal));
    return grown;
  }
  mesh.vertices = grown.hull;
  grown.surfaces = faces_towards_origin(mesh, clear_);
  if (grown.surfaces.empty()) return std::nullopt;
  return grown;
}

}  // namespace vantage::internal::exact
