#include "prove/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "prove/orientation.h"

namespace vantage::internal::prove {

namespace {

/// A convex polygon, counter-clockwise, less what lies nearer to its outline than `width`. Nothing may be left.
std::vector<Eigen::Vector2d> less_strip(const std::vector<Eigen::Vector2d>& polygon, double width) {
  std::vector<Eigen::Vector2d> kept = polygon;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &from = polygon[i], along = polygon[(i + 1) % polygon.size()] - from;
    const Eigen::Vector2d inward = Eigen::Vector2d(-along.y(), along.x()).normalized();
    std::vector<Eigen::Vector2d> left;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const Eigen::Vector2d &a = kept[k], &b = kept[(k + 1) % kept.size()];
      const double at_a = inward.dot(a - from) - width, at_b = inward.dot(b - from) - width;
      if (at_a >= 0) left.push_back(a);
      if ((at_a >= 0) != (at_b >= 0)) left.emplace_back(a + at_a / (at_a - at_b) * (b - a));
    }
    kept = std::move(left);
  }
  return kept;
}

}  // namespace

double View::unsure_at(const Vec3& position) const {
  constexpr double kRoundings = 8;
  return margin_m + kRoundings * std::numeric_limits<double>::epsilon() * position.norm();
}

View make_view(const Target& target, std::size_t part, double lift_m) {
  const TargetFrame frame = make_target_frame(target, part);
  View view;
  view.origin = frame.origin + lift_m * frame.normal;
  view.normal = frame.normal;
  view.all_sides = frame.all_sides;
  const auto placed = [&](const std::vector<Eigen::Vector2d>& polygon) {
    std::vector<Vec3> corners;
    for (const Eigen::Vector2d& corner : polygon) {
      corners.emplace_back(frame.axis_u * corner.x() + frame.axis_v * corner.y());
    }
    return corners;
  };
  view.corners = view.whole = view.surely = view.inner = placed(frame.polygon);
  if (view.all_sides) return view;
  // vantage/volume.h says what numbers cannot tell.
  constexpr double kPart = 1e-9, kMost = 1e-9, kRoundings = 8;
  const double largest = view.origin.cwiseAbs().maxCoeff() + frame.enclosing_radius_m;
  const double rounded = kRoundings * std::numeric_limits<double>::epsilon() * largest;
  view.margin_m = std::max(std::min(kPart * frame.enclosing_radius_m, kMost), rounded);
  if (frame.polygon.size() < 3) return view;
  view.surely = placed(less_strip(frame.polygon, rounded));
  if (view.surely.size() < 3) view.surely = {Vec3::Zero()};
  view.corners = placed(less_strip(frame.polygon, view.margin_m));
  if (view.corners.size() < 3) view.corners = {Vec3::Zero()};
  view.inner = placed(less_strip(frame.polygon, view.inner_margin_m()));
  if (view.inner.size() < 3) view.inner = {Vec3::Zero()};
  return view;
}

namespace {

/// What of a triangle is in front, about View::origin: its corners, to `keep`. Cut at half the height, less what is
/// rounded in the heights of this triangle: so no less is left than what is above all of it.
template <class Number, class Keep>
void cut_in_front(const Scene& scene, std::uint32_t t, const View& view, const Keep& keep) {
  using Vector = Eigen::Matrix<Number, 3, 1>;
  const double floor = view.all_sides ? -std::numeric_limits<double>::infinity() : view.margin_m;
  const Vector normal = view.normal.cast<Number>();
  const auto& [first, second, third] = scene.mesh.triangles[t];
  const std::vector<Vec3>& vertices = scene.mesh.vertices;
  if (are_on_a_line(vertices[first], vertices[second], vertices[third])) return;  // hides nothing
  std::array<Vector, 3> corners;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& corner = scene.mesh.vertices[scene.mesh.triangles[t][k]];
    corners[k] = corner.cast<Number>() - view.origin.cast<Number>();
    const double height = view.normal.dot(corner - view.origin);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  double farthest = 0;
  for (const Vector& corner : corners) farthest = std::max(farthest, static_cast<double>(corner.norm()));
  constexpr double kRoundings = 8;  // of a difference, three products and two sums
  const double rounded = kRoundings * std::numeric_limits<double>::epsilon() * farthest;
  if (high <= floor - rounded) return;
  const auto cut = static_cast<Number>(floor) / 2 - static_cast<Number>(rounded);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector &a = corners[k], &b = corners[(k + 1) % 3];
    const Number at_a = normal.dot(a) - cut, at_b = normal.dot(b) - cut;
    if (low >= floor || at_a >= 0) keep(a);
    if (low < floor && (at_a >= 0) != (at_b >= 0)) keep(Vector(a + at_a / (at_a - at_b) * (b - a)));
  }
}

Piece piece_in_front(const Scene& scene, std::uint32_t t, const View& view) {
  Piece piece{.of = t};
  cut_in_front<double>(scene, t, view, [&](const Vec3& corner) { piece.corners[piece.count++] = corner; });
  return piece;
}

}  // namespace

SceneTree obstacles_in_front(const Scene& scene, const View& view, const Box& near) {
  std::vector<Piece> pieces;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const Piece piece = piece_in_front(scene, t, view);
    Box box;
    for (const Vec3& corner : piece.polygon()) box.extend(corner);
    if ((box.min.array() > near.max.array()).any() || (box.max.array() < near.min.array()).any()) continue;
    pieces.push_back(piece);
  }
  return make_tree(scene.mesh, std::move(pieces));
}

SceneTree all_obstacles_in_front(const Scene& scene, const View& view) {
  std::vector<Piece> pieces;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) pieces.push_back(piece_in_front(scene, t, view));
  return make_tree(scene.mesh, std::move(pieces));
}

std::vector<FineVec3> fine_corners_in_front(const Scene& scene, std::uint32_t t, const View& view) {
  std::vector<FineVec3> corners;
  cut_in_front<long double>(scene, t, view, [&](const FineVec3& corner) { corners.push_back(corner); });
  return corners;
}

}  // namespace vantage::internal::prove
