#include "flight/tour/hull.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vantage::internal::flight::tour {
namespace {

constexpr std::uint32_t kPointsInLeaf = 8;
constexpr std::size_t kFirstHalfSpaces = 26, kMostAdded = 32;
constexpr int kMostSteps = 60;  // of the search for the nearest point; some ten are usual

double lowest_of_box(const Box& box, const Vec3& direction) {
  double low = 0;
  for (int k = 0; k < 3; ++k) low += direction[k] * (direction[k] > 0 ? box.min[k] : box.max[k]);
  return low;
}

/// The weights of the corners of a subset for the point of their flat that is nearest to the origin; false where they
/// depend on each other or a weight is not positive.
bool weights_of(const std::array<Vec3, 4>& corners, int count, std::array<double, 4>& weights) {
  if (count == 1) {
    weights[0] = 1;
    return true;
  }
  const int n = count - 1;
  Eigen::Matrix3d gram = Eigen::Matrix3d::Identity();
  Vec3 right = Vec3::Zero();
  for (int i = 0; i < n; ++i) {
    const Vec3 side = corners[i + 1] - corners[0];
    right[i] = -side.dot(corners[0]);
    for (int j = 0; j < n; ++j) gram(i, j) = side.dot(corners[j + 1] - corners[0]);
  }
  double scale = 1;
  for (int i = 0; i < n; ++i) scale *= gram(i, i);
  const double determinant = gram.determinant();
  if (!(determinant > 1e-14 * scale)) return false;
  const Vec3 solution = gram.inverse() * right;
  double first = 1;
  for (int i = 0; i < n; ++i) {
    weights[i + 1] = solution[i];
    first -= solution[i];
    if (!(solution[i] > 0)) return false;
  }
  weights[0] = first;
  return first > 0;
}

/// The nearest point of a convex set that is given by its lowest points.
template <typename Lowest>
Vec3 nearest_to_origin(const Vec3& start, double tolerance_m, const Lowest& lowest) {
  std::vector<Vec3> simplex = {start};
  Vec3 best = start;
  for (int step = 0; step < kMostSteps; ++step) {
    const double squared = best.squaredNorm();
    if (squared <= tolerance_m * tolerance_m || simplex.size() == 4) break;  // of four corners: it is inside
    const Vec3 next = lowest(best);
    if (squared - best.dot(next) <= tolerance_m * std::sqrt(squared)) break;
    if (std::find(simplex.begin(), simplex.end(), next) != simplex.end()) break;
    simplex.push_back(next);
    const Vec3 moved = nearest_of_simplex(simplex);
    if (!(moved.squaredNorm() < squared)) break;  // rounding has the last word
    best = moved;
  }
  return best;
}

}  // namespace

Vec3 nearest_of_simplex(std::vector<Vec3>& corners) {
  const int count = static_cast<int>(corners.size());
  double least = std::numeric_limits<double>::infinity();
  Vec3 best = corners.front();
  int best_set = 1;
  for (int set = 1; set < 1 << count; ++set) {
    std::array<Vec3, 4> of;
    std::array<double, 4> weights = {};
    int n = 0;
    for (int i = 0; i < count; ++i) {
      if ((set >> i & 1) != 0) of[n++] = corners[i];
    }
    if (!weights_of(of, n, weights)) continue;
    Vec3 point = Vec3::Zero();
    for (int i = 0; i < n; ++i) point += weights[i] * of[i];
    if (point.squaredNorm() < least) {
      least = point.squaredNorm();
      best = point;
      best_set = set;
    }
  }
  std::vector<Vec3> kept;
  for (int i = 0; i < count; ++i) {
    if ((best_set >> i & 1) != 0) kept.push_back(corners[i]);
  }
  corners = std::move(kept);
  return best;
}

Hull::Hull(std::vector<Vec3> points, double moved_m) : points_(std::move(points)), moved_m_(moved_m) {
  for (const Vec3& p : points_) box_.extend(p);
  middle_ = 0.5 * (box_.min + box_.max);
  extent_m_ = (box_.max - box_.min).norm();
  reach_m_ = std::max(box_.min.cwiseAbs().maxCoeff(), box_.max.cwiseAbs().maxCoeff());
  nodes_.reserve(2 * points_.size() / kPointsInLeaf + 1);
  build(0, static_cast<std::uint32_t>(points_.size()));
  inside_ = Vec3::Zero();
  for (int i = 0; i < 27; ++i) {
    const int y = i / 3 % 3 - 1, z = i / 9 - 1;
    Vec3 normal(i % 3 - 1, y, z);
    if (normal.isZero(0)) continue;
    normal.normalize();
    half_spaces_.push_back(half_space(normal));
    inside_ += lowest(-normal) / 26.0;
  }
}

std::uint32_t Hull::build(std::uint32_t begin, std::uint32_t end) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, begin, end, 0});
  for (std::uint32_t i = begin; i < end; ++i) nodes_[number].box.extend(points_[i]);
  if (end - begin <= kPointsInLeaf) return number;
  int axis = 0;
  (nodes_[number].box.max - nodes_[number].box.min).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(points_.begin() + begin, points_.begin() + middle, points_.begin() + end,
                   [axis](const Vec3& a, const Vec3& b) {
                     if (a[axis] != b[axis]) return a[axis] < b[axis];
                     return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
                   });
  build(begin, middle);
  const std::uint32_t right = build(middle, end);
  nodes_[number].right = right;
  return number;
}

const Vec3& Hull::lowest(const Vec3& direction) const {
  const Vec3* best = &points_.front();
  double least = direction.dot(*best);
  std::array<std::uint32_t, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node* node = &nodes_[stack[--depth]];
    if (lowest_of_box(node->box, direction) >= least) continue;
    while (node->right != 0) {
      const auto left = static_cast<std::uint32_t>(node - nodes_.data()) + 1;
      const double at_left = lowest_of_box(nodes_[left].box, direction);
      const double at_right = lowest_of_box(nodes_[node->right].box, direction);
      const bool left_first = at_left <= at_right;
      if ((left_first ? at_right : at_left) < least) stack[depth++] = left_first ? node->right : left;
      node = &nodes_[left_first ? left : node->right];
    }
    for (std::uint32_t i = node->begin; i < node->end; ++i) {
      const double here = direction.dot(points_[i]);
      if (here < least) {
        least = here;
        best = &points_[i];
      }
    }
  }
  return *best;
}

HalfSpace Hull::half_space(const Vec3& normal) const {
  const double offset = normal.dot(lowest(-normal));
  return {normal, offset, offset - normal.dot(lowest(normal))};
}

void Hull::add(const HalfSpace& half_space) {
  if (half_spaces_.size() < kFirstHalfSpaces + kMostAdded) {
    half_spaces_.push_back(half_space);
  } else {
    half_spaces_[kFirstHalfSpaces + added_ % kMostAdded] = half_space;
  }
  ++added_;
}

NearestInHull Hull::nearest(const Vec3& point, double tolerance_m) const {
  const Vec3 away = nearest_to_origin(lowest(middle_ - point) - point, tolerance_m,
                                      [&](const Vec3& direction) -> Vec3 { return lowest(direction) - point; });
  return {point + away, away.norm()};
}

NearestInHull Hull::nearest_to_segment(const Vec3& from, const Vec3& to, double tolerance_m) const {
  constexpr int kRounds = 6;  // of projecting from one set to the other
  const Vec3 along = to - from;
  const double squared = along.squaredNorm();
  double place = 0.5;
  NearestInHull best;
  for (int i = 0; i < kRounds; ++i) {
    best = nearest(from + place * along, tolerance_m);
    const double next = squared > 0 ? std::clamp((best.point - from).dot(along) / squared, 0.0, 1.0) : 0.0;
    if (best.distance_m == 0 || std::abs(next - place) * std::sqrt(squared) <= tolerance_m) break;
    place = next;
  }
  return best;
}

}  // namespace vantage::internal::flight::tour
