#include "prove/shadow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace vantage::internal::prove {
namespace {

/// A convex polygon that half-spaces are taken from, without memory of its own.
class ClippedFace {
 public:
  static constexpr std::size_t kMost = 160;  // a target's 64 corners, and one more for each side of a polygon

  explicit ClippedFace(const std::vector<Vec3>& corners) : count_(std::min(corners.size(), kMost / 2)) {
    std::copy_n(corners.begin(), count_, at_.begin());
  }
  bool empty() const { return count_ == 0; }

  /// Keeps where the normal's product with a point is at least `least`.
  void keep(const Vec3& normal, double least) {
    std::array<double, kMost> side;
    bool all = true;
    for (std::size_t i = 0; i < count_; ++i) {
      side[i] = normal.dot(at_[i]) - least;
      all = all && side[i] >= 0;
    }
    if (all) return;
    std::array<Vec3, kMost> kept;
    std::size_t n = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t next = i + 1 < count_ ? i + 1 : 0;
      if (side[i] >= 0) kept[n++] = at_[i];
      if ((side[i] >= 0) == (side[next] >= 0) || n + 2 > kMost) continue;
      kept[n++] = at_[i] + side[i] / (side[i] - side[next]) * (at_[next] - at_[i]);
    }
    std::copy_n(kept.begin(), n, at_.begin());
    count_ = n;
  }

  Vec3 middle() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < count_; ++i) sum += at_[i];
    return sum / static_cast<double>(count_);
  }

 private:
  std::array<Vec3, kMost> at_;
  std::size_t count_;
};

/// Planes through a position that have the target between them. Not exact: only candidates are found with it.
class Pyramid {
 public:
  Pyramid(const Vec3& apex, const ShadowTarget& target) : apex_(apex) {
    box_.extend(apex);
    const double radius = target.radius_m;
    const Vec3 back = target.is_flat ? target.normal : apex.normalized();
    const double thick = target.is_flat ? 0 : radius;
    const double away = back.dot(apex) - thick;
    const Vec3 sideways = apex - back.dot(apex) * back;
    const bool is_aside = sideways.norm() > 1e-9 * apex.norm();
    const Vec3 u = is_aside ? sideways.normalized() : back.unitOrthogonal();
    const Vec3 v = back.cross(u);
    for (const auto& face : target.faces) {
      for (const Vec3& corner : face) box_.extend(corner);
    }
    is_wide_ = !(away > 0);
    if (is_wide_) return;
    for (const Vec3& axis : {u, v}) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const auto& face : target.faces) {
        for (const Vec3& corner : face) {
          const double slope = axis.dot(corner - apex) / back.dot(apex - corner);
          low = std::min(low, slope);
          high = std::max(high, slope);
        }
      }
      inside_.push_back(axis + low * back);  // at least 0 where the slope is at least `low`
      inside_.push_back(-axis - high * back);
    }
    if (!target.is_flat) return;
    const std::vector<Vec3>& corners = target.faces[0];  // counter-clockwise about the normal
    for (std::size_t i = 0; i < corners.size(); ++i) {
      inside_.push_back((corners[i + 1 < corners.size() ? i + 1 : 0] - apex).cross(corners[i] - apex));
    }
  }

  bool may_meet(const Box& box) const {
    if ((box.min.array() > box_.max.array()).any() || (box.max.array() < box_.min.array()).any()) return false;
    if (is_wide_) return true;
    for (const Vec3& normal : inside_) {
      double most = 0;
      for (Eigen::Index k = 0; k < 3; ++k) {
        most += normal[k] * ((normal[k] > 0 ? box.max[k] : box.min[k]) - apex_[k]);
      }
      if (most < 0) return false;
    }
    return true;
  }
  bool may_meet(std::span<const Vec3> corners) const {
    Box box;
    for (const Vec3& corner : corners) box.extend(corner);
    if (!may_meet(box)) return false;
    if (is_wide_) return true;
    return std::all_of(inside_.begin(), inside_.end(), [&](const Vec3& normal) {
      return std::any_of(corners.begin(), corners.end(),
                         [&](const Vec3& corner) { return normal.dot(corner - apex_) >= 0; });
    });
  }

 private:
  Vec3 apex_;
  Box box_;
  std::vector<Vec3> inside_;  ///< normals of planes through the apex: about the target's box, and its sides
  bool is_wide_ = false;
};

}  // namespace

ShadowTarget shadow_target(const View& view, double point_radius_m) {
  ShadowTarget target;
  target.normal = view.normal;
  target.floor_m = view.all_sides ? -std::numeric_limits<double>::infinity() : view.margin_m;
  target.is_flat = view.surely.size() >= 3;
  if (target.is_flat) {
    target.faces.push_back(view.surely);
  } else {
    const Vec3 u = point_radius_m * view.normal.unitOrthogonal(), w = point_radius_m * view.normal;
    const Vec3 v = view.normal.cross(u);
    for (const auto& [a, b] : {std::pair(u, v), std::pair(u, w), std::pair(v, w)}) {
      target.faces.push_back({a + b, b - a, -a - b, a - b});
    }
  }
  for (const auto& face : target.faces) {
    for (const Vec3& corner : face) target.radius_m = std::max(target.radius_m, corner.norm());
  }
  return target;
}

std::optional<Hit> find_hit(const Vec3& position, const FlatPolygon& polygon, const ShadowTarget& target) {
  const double height = polygon.normal.dot(position - polygon.corners[0]);
  if (height == 0) return std::nullopt;
  const double turn = height > 0 ? 1 : -1;
  std::optional<Hit> best;
  for (const std::vector<Vec3>& face : target.faces) {
    ClippedFace seen(face);
    seen.keep(-turn * polygon.normal, -turn * polygon.normal.dot(polygon.corners[0]));
    for (std::size_t i = 0; i < polygon.corners.size() && !seen.empty(); ++i) {
      const Vec3& next = polygon.corners[i + 1 < polygon.corners.size() ? i + 1 : 0];
      const Vec3 inside = -turn * (polygon.corners[i] - position).cross(next - position);
      seen.keep(inside, inside.dot(position));
    }
    if (seen.empty()) continue;
    Hit hit;
    hit.target_point = seen.middle();
    hit.is_front = height > 0;
    hit.behind_m = std::abs(height);
    hit.before_m = -turn * polygon.normal.dot(hit.target_point - polygon.corners[0]);
    if (!(hit.before_m > 0)) continue;
    const Vec3 through = position + hit.behind_m / (hit.behind_m + hit.before_m) * (hit.target_point - position);
    if (!(target.normal.dot(through) >= target.floor_m)) continue;
    hit.depth_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
      hit.depth_m = std::min(hit.depth_m, polygon.inward[i].dot(through - polygon.corners[i]));
    }
    if (hit.depth_m > 0 && (!best || hit.depth_m > best->depth_m)) best = hit;
  }
  return best;
}

namespace {

/// Whether a segment passes through a polygon, whatever was rounded: its outline and its plane are known to `unsure_m`.
class Certainty {
 public:
  Certainty(const FlatPolygon& polygon, const ShadowTarget& target, double farthest_m, double unsure_m)
      : before_reach_(polygon.reach_m + target.radius_m),
        behind_reach_(polygon.reach_m + farthest_m),
        unsure_(unsure_m) {}

  bool passes(double depth_m, double before_m, double behind_m) const {
    if (!(before_m > 2 * unsure_ && behind_m > 2 * unsure_)) return false;
    // So far a segment runs along the plane while it comes nearer to it by a metre.
    const double along = std::min(before_reach_ / (before_m - unsure_), behind_reach_ / (behind_m - unsure_));
    return depth_m > unsure_ * (1 + 2 * along);
  }
  bool passes(const Hit& hit) const { return passes(hit.depth_m, hit.before_m, hit.behind_m); }

 private:
  double before_reach_, behind_reach_, unsure_;
};

constexpr double kShadowRoundings = 32;

/// A polygon's plane with more digits, and how far its corners are from that.
struct FinePlane {
  FineVec3 normal = FineVec3::Zero();
  double off_m = 0;

  explicit FinePlane(const std::vector<FineVec3>& corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      normal += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
    }
    normal.normalize();
    for (const FineVec3& corner : corners) {
      off_m = std::max(off_m, std::abs(static_cast<double>(normal.dot(corner - corners[0]))));
    }
  }
};

/// Where the segment that was hit passes, with more digits.
std::optional<Hit> fine_hit(const Vec3& position, const Hit& hit, const FlatPolygon& polygon, const FinePlane& plane) {
  const std::vector<FineVec3>& corners = polygon.fine_corners;
  const FineVec3 from = position.cast<long double>(), to = hit.target_point.cast<long double>();
  const long double turn = hit.is_front ? 1 : -1;
  const long double behind = turn * plane.normal.dot(from - corners[0]);
  const long double before = -turn * plane.normal.dot(to - corners[0]);
  if (!(behind > 0 && before > 0)) return std::nullopt;
  const FineVec3 through = from + behind / (behind + before) * (to - from);
  long double depth = std::numeric_limits<long double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const FineVec3 side = corners[i + 1 < corners.size() ? i + 1 : 0] - corners[i];
    depth = std::min(depth, plane.normal.cross(side).normalized().dot(through - corners[i]));
  }
  return Hit{hit.target_point, static_cast<double>(depth), static_cast<double>(before), static_cast<double>(behind),
             hit.is_front};
}

}  // namespace

bool hides(const FlatPolygon& polygon, const ShadowTarget& target, const std::array<Hit, 3>& hits, double farthest_m,
           double largest) {
  constexpr double kUnitRounding = 1.2e-16;
  const Certainty sure(polygon, target, farthest_m, polygon.slack_m + kShadowRoundings * kUnitRounding * largest);
  // What a flat polygon hides is convex: each position by itself.
  if (polygon.is_exactly_flat) {
    return std::all_of(hits.begin(), hits.end(), [&](const Hit& hit) { return sure.passes(hit); });
  }
  // Else every segment must pass from one side of the layer that holds the polygon to the other.
  Hit least = hits[0];
  for (const Hit& hit : hits) {
    if (hit.is_front != least.is_front) return false;
    least.depth_m = std::min(least.depth_m, hit.depth_m);
    least.before_m = std::min(least.before_m, hit.before_m);
    least.behind_m = std::min(least.behind_m, hit.behind_m);
  }
  return sure.passes(least);
}

bool hides_finely(const FlatPolygon& polygon, const ShadowTarget& target, const std::array<Vec3, 3>& positions,
                  const std::array<Hit, 3>& hits, double farthest_m, double largest) {
  if (!polygon.is_exactly_flat) return false;
  const FinePlane plane(polygon.fine_corners);
  const Certainty sure(polygon, target, farthest_m,
                       polygon.outline_slack_m + plane.off_m + kShadowRoundings * kFineUnitRounding * largest);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<Hit> hit = fine_hit(positions[k], hits[k], polygon, plane);
    if (!hit || !sure.passes(*hit)) return false;
  }
  return true;
}

void collect_hiding(const Vec3& position, const ShadowTarget& target, const SceneTree& obstacles,
                    std::vector<std::uint32_t>& triangles) {
  triangles.clear();
  if (obstacles.nodes.empty()) return;
  const Pyramid pyramid(position, target);
  std::vector<std::uint32_t> stack = {0};
  while (!stack.empty()) {
    const std::uint32_t index = stack.back();
    stack.pop_back();
    const TreeNode& node = obstacles.nodes[index];
    if (!pyramid.may_meet(node.box)) continue;
    if (node.second != 0) {
      stack.push_back(node.second);
      stack.push_back(index + 1);
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const Piece& piece = obstacles.pieces[i];
      if (pyramid.may_meet(piece.polygon())) triangles.push_back(piece.of);
    }
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
}

}  // namespace vantage::internal::prove
