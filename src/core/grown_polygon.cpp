#include "core/grown_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "core/portable_math.h"

namespace vantage::internal::core {
namespace {

using Vec2 = Eigen::Vector2d;

/// The frame in which the polygon is flat. Whatever it is, the polytope holds the grown polygon: a bad one of corners
/// that are nearly on a line costs only tightness.
struct Frame {
  Vec3 origin, u, v, normal;

  Vec3 to_scene(const Vec2& at, double height) const { return origin + at.x() * u + at.y() * v + height * normal; }
};

Frame frame_of(std::span<const Vec3> corners) {
  Frame frame;
  frame.origin = corners[0];
  Vec3 longest = Vec3::Zero(), area = Vec3::Zero();
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Vec3 from = corners[i] - frame.origin;
    if (from.squaredNorm() > longest.squaredNorm()) longest = from;
    if (i + 1 < corners.size()) area += from.cross(corners[i + 1] - frame.origin);
  }
  if (!(longest.norm() > 0)) longest = Vec3::UnitX();
  frame.u = longest.normalized();
  area -= area.dot(frame.u) * frame.u;
  frame.normal = area.norm() > 0 ? area : frame.u.unitOrthogonal();
  frame.normal = (frame.normal - frame.normal.dot(frame.u) * frame.u).normalized();
  frame.v = frame.normal.cross(frame.u);
  return frame;
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Counter-clockwise (Andrew 1979); points on its sides are left out.
std::vector<Vec2> convex_outline(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> outline;
  for (int half = 0; half < 2; ++half) {
    const std::size_t first = outline.size();
    for (const Vec2& point : points) {
      while (outline.size() >= first + 2 && !(turn(outline[outline.size() - 2], outline.back(), point) > 0)) {
        outline.pop_back();
      }
      outline.push_back(point);
    }
    outline.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return outline;
}

/// A corner of the outline that is moved outwards by s lies at `from` + s `by`.
struct MovingCorner {
  Vec2 from, by;
};

/// Corners of the outline with all sides moved outwards alike; where two sides turn by more than an eighth of a full
/// turn, more sides are put between them, so that no corner sticks out far.
std::vector<MovingCorner> moving_corners(const std::vector<Vec2>& outline) {
  constexpr double kMostTurn = std::numbers::pi / 4;
  const std::size_t count = outline.size();
  const auto normal_after = [&](std::size_t i) -> Vec2 {
    if (count == 1) return {1, 0};
    const Vec2 side = (outline[(i + 1) % count] - outline[i]).normalized();
    return {side.y(), -side.x()};
  };
  std::vector<MovingCorner> corners;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 before = normal_after((i + count - 1) % count), after = normal_after(i);
    double angle = portable::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
    if (count == 1) angle = 2 * std::numbers::pi;
    if (count == 2) angle = std::numbers::pi;
    angle = std::max(angle, 0.0);
    const int steps = std::max(1, static_cast<int>(std::ceil(angle / kMostTurn - 1e-9)));
    const double half = angle / steps / 2;
    for (int step = 0; step < steps; ++step) {
      // Two sides whose normals turn by 2 h meet at 1 / cos h along the direction between them.
      const portable::SineCosine turn = portable::sine_cosine((2 * step + 1) * half);
      const Vec2 between(turn.cosine * before.x() - turn.sine * before.y(),
                         turn.sine * before.x() + turn.cosine * before.y());
      corners.push_back({outline[i], between / portable::cos(half)});
    }
  }
  return corners;
}

}  // namespace

// Round the polygon as seen along its normal, and round its edge as seen along the edge, the circle is replaced by an
// octagon about it: four rings of corners, of which the outer two lie at tan(pi / 8) of the radius over and under the
// polygon, and the others the same part of the radius beside it. Every side of the polytope touches the grown polygon:
// so it holds it.
Mesh grow_polygon(std::span<const Vec3> corners, double radius_m) {
  const Frame frame = frame_of(corners);
  std::vector<Vec2> plan;
  double low = std::numeric_limits<double>::infinity(), high = -low, largest = radius_m;
  for (const Vec3& corner : corners) {
    const Vec3 from = corner - frame.origin;
    plan.emplace_back(frame.u.dot(from), frame.v.dot(from));
    low = std::min(low, frame.normal.dot(from));
    high = std::max(high, frame.normal.dot(from));
    largest = std::max({largest, corner.cwiseAbs().maxCoeff(), from.norm()});
  }
  // A few roundings in the frame, in the outline, in the corners of the result.
  const double radius = radius_m + 32 * std::numeric_limits<double>::epsilon() * largest;
  const double part = portable::tan(std::numbers::pi / 8) * radius;
  const std::array<double, 4> outwards = {part, radius, radius, part};
  const std::array<double, 4> heights = {low - radius, low - part, high + part, high + radius};

  const std::vector<MovingCorner> moving = moving_corners(convex_outline(std::move(plan)));
  const auto count = static_cast<std::uint32_t>(moving.size());
  Mesh mesh;
  for (std::size_t ring = 0; ring < outwards.size(); ++ring) {
    for (const auto& [from, by] : moving) {
      mesh.vertices.push_back(frame.to_scene(from + outwards[ring] * by, heights[ring]));
    }
  }
  const std::uint32_t top = 3 * count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    for (std::uint32_t ring = 0; ring < top; ring += count) {
      mesh.triangles.push_back({ring + i, ring + next, ring + count + next});
      mesh.triangles.push_back({ring + i, ring + count + next, ring + count + i});
    }
    if (i < 2) continue;
    mesh.triangles.push_back({0, i, i - 1});
    mesh.triangles.push_back({top, top + i - 1, top + i});
  }
  return mesh;
}

}  // namespace vantage::internal::core
