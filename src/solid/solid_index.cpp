#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "core/closed_mesh_check.h"
#include "core/parallel.h"
#include "core/pieces.h"
#include "core/triangle_distance.h"
#include "core/triangle_tree.h"
#include "solid/exact_winding.h"
#include "vantage/error.h"
#include "vantage/solid.h"

namespace vantage {
namespace {

using internal::core::TriangleTree;
using Corners = std::array<Vec3, 3>;

constexpr double kRounding = 1e-12;  ///< of sizes and distances

double squared_between_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double denominator = uu * vv - uv * uv;
  double s = denominator > 0 ? std::clamp((uv * vw - vv * uw) / denominator, 0.0, 1.0) : 0.0;
  const double t = vv > 0 ? std::clamp((uv * s + vw) / vv, 0.0, 1.0) : 0.0;
  if (uu > 0) s = std::clamp((uv * t - uw) / uu, 0.0, 1.0);
  return (w + s * u - t * v).squaredNorm();
}

/// Whether the segment passes from one side of the triangle to the other. Where rounding decides, it passes so close to
/// an edge or a corner that distances tell.
bool pierces(const Vec3& from, const Vec3& to, const Corners& t) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  if ((normal.dot(from - t[0]) > 0) == (normal.dot(to - t[0]) > 0)) return false;
  const Vec3 along = to - from;
  const auto side = [&](int k) { return along.dot((t[k] - from).cross(t[(k + 1) % 3] - from)); };
  const double a = side(0), b = side(1), c = side(2);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

bool are_near(const Corners& a, const Corners& b, double within) {
  const double squared = within * within;
  for (std::size_t i = 0; i < 3; ++i) {
    if (internal::core::squared_distance_to_triangle(a[i], b[0], b[1], b[2]) <= squared) return true;
    if (internal::core::squared_distance_to_triangle(b[i], a[0], a[1], a[2]) <= squared) return true;
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return true;
    for (std::size_t j = 0; j < 3; ++j) {
      if (squared_between_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]) <= squared) return true;
    }
  }
  return false;
}

Mesh about(const Mesh& mesh, const Vec3& origin) {
  Mesh moved = mesh;
  for (Vec3& vertex : moved.vertices) vertex -= origin;
  return moved;
}

Vec3 middle_of(const Box& box) { return box.empty() ? Vec3(Vec3::Zero()) : Vec3((box.min + box.max) / 2); }

Corners corners_of(const Mesh& mesh, std::size_t triangle, const Vec3& shift) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]] + shift, mesh.vertices[t[1]] + shift, mesh.vertices[t[2]] + shift};
}

}  // namespace

struct SolidIndex::Data {
  explicit Data(const Mesh& given)
      : as_given(given),
        bounds(bounding_box(given)),
        origin(middle_of(bounds)),
        mesh(about(given, origin)),
        tree(mesh) {
    const internal::core::Pieces pieces = internal::core::find_pieces(mesh);
    std::vector<bool> has(pieces.pieces.size(), false);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (has[pieces.piece_of[t]]) continue;
      has[pieces.piece_of[t]] = true;
      of_pieces.push_back(mesh.vertices[mesh.triangles[t][0]]);
    }
  }

  /// A point about `origin`.
  double depth(const Vec3& point) const {
    const double distance = tree.distance(point);
    return distance > 0 && tree.winding_number(point) < 1 ? -distance : distance;
  }

  /// Made when it is first asked for.
  const internal::solid::ExactWinding& winding() const {
    std::call_once(winding_once, [&] {
      internal::core::check_oriented(as_given);
      exact_winding.emplace(as_given);
    });
    return *exact_winding;
  }

  Mesh as_given;
  Box bounds;
  Vec3 origin;
  Mesh mesh;  ///< about `origin`
  TriangleTree tree;
  std::vector<Vec3> of_pieces;  ///< a vertex of each

 private:
  mutable std::once_flag winding_once;
  mutable std::optional<internal::solid::ExactWinding> exact_winding;
};

namespace {

void check_points(std::span<const Vec3> points) {
  for (const Vec3& point : points) {
    if (point.allFinite()) continue;
    throw Error(ErrorCode::coordinate_not_finite, "a point has a coordinate that is not finite", "points",
                "pass finite coordinates");
  }
}

}  // namespace

SolidIndex::SolidIndex(const Mesh& mesh) {
  internal::core::check_closed(mesh);
  data_ = std::make_shared<const Data>(mesh);
}

std::vector<double> SolidIndex::depths_m(std::span<const Vec3> points) const {
  check_points(points);
  std::vector<double> depths(points.size(), -std::numeric_limits<double>::infinity());
  if (data_->mesh.empty()) return depths;
  constexpr std::size_t kGrain = 64;
  internal::parallel::for_ranges(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) depths[i] = data_->depth(points[i] - data_->origin);
  });
  return depths;
}

std::vector<std::uint8_t> SolidIndex::contains(std::span<const Vec3> points) const {
  check_points(points);
  std::vector<std::uint8_t> inside(points.size(), 0);
  if (data_->mesh.empty()) return inside;
  const internal::solid::ExactWinding& winding = data_->winding();
  constexpr std::size_t kGrain = 256;
  internal::parallel::for_ranges(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) inside[i] = winding.holds(points[i]) ? 1 : 0;
  });
  return inside;
}

bool SolidIndex::comes_near(const SolidIndex& other, double within_m) const {
  if (!(within_m >= 0)) {
    throw Error(ErrorCode::value_out_of_range, "the distance is not a number of at least 0", "within_m", "give metres");
  }
  if (data_->mesh.empty() || other.data_->mesh.empty()) return false;
  const bool is_smaller = data_->mesh.triangles.size() <= other.data_->mesh.triangles.size();
  const Data &a = is_smaller ? *data_ : *other.data_, &b = is_smaller ? *other.data_ : *data_;
  const Vec3 shift = a.origin - b.origin;  // from the frame of a to that of b
  const double size = (a.bounds.max - a.bounds.min).norm() + (b.bounds.max - b.bounds.min).norm() + shift.norm() +
                      1e-3 * (a.origin.norm() + b.origin.norm());
  const double within = within_m + kRounding * size;
  if ((a.bounds.min.array() > b.bounds.max.array() + within).any()) return false;
  if ((b.bounds.min.array() > a.bounds.max.array() + within).any()) return false;
  for (std::size_t t = 0; t < a.mesh.triangles.size(); ++t) {
    const Corners corners = corners_of(a.mesh, t, shift);
    Box box;
    for (const Vec3& corner : corners) box.extend(corner);
    box.min.array() -= within;
    box.max.array() += within;
    if (b.tree.any_near(
            box, [&](std::uint32_t i) { return are_near(corners, corners_of(b.mesh, i, Vec3::Zero()), within); })) {
      return true;
    }
  }
  // The surfaces are apart: a piece is wholly in the other solid, or wholly outside.
  const auto holds = [&](const Data& one, const Vec3& point) { return one.depth(point) > 0; };
  return std::any_of(a.of_pieces.begin(), a.of_pieces.end(), [&](const Vec3& p) { return holds(b, p + shift); }) ||
         std::any_of(b.of_pieces.begin(), b.of_pieces.end(), [&](const Vec3& p) { return holds(a, p - shift); });
}

}  // namespace vantage
