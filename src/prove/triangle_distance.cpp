// The nearest points of two triangles that do not meet are on two edges, or on a corner and a face. If they meet, an
// edge of one passes through the other.
#include "prove/triangle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>

namespace vantage::internal::prove {
namespace {

Vec3 nearest_of_edge(const Vec3& from, const Vec3& to, const Vec3& point) {
  const Vec3 along = to - from;
  const double length = along.squaredNorm();
  return length > 0 ? Vec3(from + std::clamp((point - from).dot(along) / length, 0.0, 1.0) * along) : from;
}

/// Compares two segments: each of the four ends with the other segment, and where both are nearest inside.
void see_edges(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, NearestPoints& best) {
  const auto see = [&](const Vec3& on_a, const Vec3& on_b) {
    const double distance = (on_a - on_b).norm();
    if (distance < best.distance) best = {on_a, on_b, distance};
  };
  see(a, nearest_of_edge(c, d, a));
  see(b, nearest_of_edge(c, d, b));
  see(nearest_of_edge(a, b, c), c);
  see(nearest_of_edge(a, b, d), d);
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), area = uu * vv - uv * uv;
  if (!(area > 0)) return;
  const double s = (uv * v.dot(w) - vv * u.dot(w)) / area;
  if (!(s > 0 && s < 1)) return;
  const Vec3 on_a = a + s * u, on_b = nearest_of_edge(c, d, on_a);
  see(nearest_of_edge(a, b, on_b), on_b);
}

/// Over the inside of the triangle, along its normal.
std::optional<Vec3> below_on(const Corners3& triangle, const Vec3& point) {
  const auto& [a, b, c] = triangle;
  const Vec3 normal = (b - a).cross(c - a);
  const double length = normal.squaredNorm();
  if (!(length > 0)) return std::nullopt;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &from = triangle[k], &to = triangle[(k + 1) % 3];
    if (normal.cross(to - from).dot(point - from) < 0) return std::nullopt;
  }
  return Vec3(point - normal.dot(point - a) / length * normal);
}

std::optional<Vec3> place_in(const Corners3& triangle, const Vec3& from, const Vec3& to) {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double at_from = normal.dot(from - triangle[0]), at_to = normal.dot(to - triangle[0]);
  if ((at_from > 0) == (at_to > 0) || at_from == at_to) return std::nullopt;
  const Vec3 place = from + at_from / (at_from - at_to) * (to - from);
  return below_on(triangle, place) ? std::optional(place) : std::nullopt;
}

}  // namespace

NearestPoints nearest_points(const Corners3& a, const Corners3& b) {
  NearestPoints best{Vec3::Zero(), Vec3::Zero(), std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t after_i = (i + 1) % 3;
    for (std::size_t j = 0; j < 3; ++j) see_edges(a[i], a[after_i], b[j], b[(j + 1) % 3], best);
    if (const auto below = below_on(b, a[i]); below && (*below - a[i]).norm() < best.distance) {
      best = {a[i], *below, (*below - a[i]).norm()};
    }
    if (const auto below = below_on(a, b[i]); below && (*below - b[i]).norm() < best.distance) {
      best = {*below, b[i], (*below - b[i]).norm()};
    }
    if (const auto place = place_in(b, a[i], a[after_i])) return {*place, *place, 0};
    if (const auto place = place_in(a, b[i], b[after_i])) return {*place, *place, 0};
  }
  return best;
}

/// In barycentric coordinates (Ericson 2005, chapter 5).
double at_most_from(const Corners3& triangle, const Vec3& point) {
  const auto& [a, b, c] = triangle;
  const Vec3 ab = b - a, ac = c - a, ap = point - a;
  const auto on_edge = [&](const Vec3& from, const Vec3& along) {
    const double length = along.squaredNorm();
    const double part = length > 0 ? std::clamp((point - from).dot(along) / length, 0.0, 1.0) : 0.0;
    return (point - from - part * along).norm();
  };
  double least = std::min({on_edge(a, ab), on_edge(a, ac), on_edge(b, c - b)});
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm(), area = bb * cc - bc * bc;
  if (!(area > 0)) return least;
  const double of_b = (cc * ab.dot(ap) - bc * ac.dot(ap)) / area, of_c = (bb * ac.dot(ap) - bc * ab.dot(ap)) / area;
  if (of_b >= 0 && of_c >= 0 && of_b + of_c <= 1) least = std::min(least, (ap - of_b * ab - of_c * ac).norm());
  return least;
}

double unsure_over(const Corners3& triangle, double distance) {
  constexpr double kRoundings = 16;  // of a normal, in parts of the square of the longest side
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (triangle[(k + 1) % 3] - triangle[k]).norm());
  const double twice = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
  if (!(longest > 0)) return 0;
  const double width = twice / longest, rounded = kRoundings * std::numeric_limits<double>::epsilon() * longest;
  return width > rounded ? rounded / width * (longest + distance) : std::numeric_limits<double>::infinity();
}

namespace {

/// What is nearest over the inside of the triangle may have been missed, or found too far away. All that is over it is
/// within half of its width of its outline, which is not missed.
double lost_over(const Corners3& triangle, double distance) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (triangle[(k + 1) % 3] - triangle[k]).norm());
  if (!(longest > 0)) return 0;
  const double twice = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
  const double rounded = 16 * std::numeric_limits<double>::epsilon() * longest;
  const double width = twice / longest + rounded;
  return std::min(unsure_over(triangle, distance), width * width / (4 * distance));
}

}  // namespace

double surely_apart_by(const NearestPoints& nearest, const Corners3& a, const Corners3& b) {
  constexpr double kParallel = 1e-7;
  if (!(nearest.distance > 0)) return 0;
  double longest = 0, largest = 0;
  for (const Corners3* corners : {&a, &b}) {
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, ((*corners)[(k + 1) % 3] - (*corners)[k]).norm());
      largest = std::max(largest, (*corners)[k].cwiseAbs().maxCoeff());
    }
  }
  const double missed = kParallel * longest, rounded = 16 * std::numeric_limits<double>::epsilon() * largest;
  const double lost = lost_over(a, nearest.distance) + lost_over(b, nearest.distance);
  return std::max(nearest.distance - missed * missed / nearest.distance - rounded - lost, 0.0);
}

double distance_of_boxes(const Box& a, const Box& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm();
}

Box box_of(const Corners3& corners) {
  Box box;
  for (const Vec3& corner : corners) box.extend(corner);
  return box;
}

}  // namespace vantage::internal::prove
