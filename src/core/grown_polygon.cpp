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

/// Corners of the outline with all sides moved outwards alike; where two sides turn by more than `most_turn`, more
/// sides are put between them, so that no corner sticks out far.
std::vector<MovingCorner> moving_corners(const std::vector<Vec2>& outline, double most_turn) {
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
    const int steps = std::max(1, static_cast<int>(std::ceil(angle / most_turn - 1e-9)));
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

/// A convex polygon in its plane, and how far its corners are under and over it.
struct FlatPolygon {
  explicit FlatPolygon(std::span<const Vec3> corners) : frame(frame_of(corners)) {
    std::vector<Vec2> plan;
    for (const Vec3& corner : corners) {
      const Vec3 from = corner - frame.origin;
      plan.emplace_back(frame.u.dot(from), frame.v.dot(from));
      low = std::min(low, frame.normal.dot(from));
      high = std::max(high, frame.normal.dot(from));
      largest = std::max({largest, corner.cwiseAbs().maxCoeff(), from.norm()});
    }
    outline = convex_outline(std::move(plan));
  }

  /// For a few roundings in the frame, in the outline, in the corners of the result.
  double rounding(double radius) const {
    return 32 * std::numeric_limits<double>::epsilon() * std::max(largest, radius);
  }

  Frame frame;
  std::vector<Vec2> outline;
  double low = std::numeric_limits<double>::infinity(), high = -low, largest = 0;
};

/// Of a polytope: its corners at that height are those of the outline with all sides moved outwards.
struct Ring {
  double outwards, height;
};

Mesh polytope(const FlatPolygon& flat, std::span<const Ring> rings, double most_turn) {
  const std::vector<MovingCorner> moving = moving_corners(flat.outline, most_turn);
  const auto count = static_cast<std::uint32_t>(moving.size());
  Mesh mesh;
  for (const Ring& ring : rings) {
    for (const auto& [from, by] : moving) {
      mesh.vertices.push_back(flat.frame.to_scene(from + ring.outwards * by, ring.height));
    }
  }
  const std::uint32_t top = static_cast<std::uint32_t>(rings.size() - 1) * count;
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

}  // namespace

// Round the polygon as seen along its normal, and round its edge as seen along the edge, the circle is replaced by an
// octagon about it: four rings of corners, of which the outer two lie at tan(pi / 8) of the radius over and under the
// polygon, and the others the same part of the radius beside it. Every side of the polytope touches the grown polygon:
// so it holds it.
Mesh grow_polygon(std::span<const Vec3> corners, double radius_m) {
  const FlatPolygon flat(corners);
  const double radius = radius_m + flat.rounding(radius_m), part = portable::tan(std::numbers::pi / 8) * radius;
  const std::array<Ring, 4> rings = {
      {{part, flat.low - radius}, {radius, flat.low - part}, {radius, flat.high + part}, {part, flat.high + radius}}};
  return polytope(flat, rings, std::numbers::pi / 4);
}

// Its corners lie at sqrt(1 + (aside / cos(turn / 2))^2) of the radius, where two sides turn by that: what is farther
// out than corners of grow_polygon is cut off by more sides.
Mesh grow_across(std::span<const Vec3> corners, double radius_m, double aside_m) {
  constexpr double kMostOut = 0.58;  // sqrt(1 + 0.58^2) < 1 + kMostGrownTooFar
  constexpr double kSharpest = 0.17;
  const FlatPolygon flat(corners);
  const double rounding = flat.rounding(radius_m), radius = radius_m + rounding, aside = aside_m + rounding;
  const std::array<Ring, 2> rings = {{{aside, flat.low - radius}, {aside, flat.high + radius}}};
  const double cosine = std::clamp(aside / (kMostOut * radius), kSharpest, 1.0);
  return polytope(flat, rings, 2 * portable::atan2(std::sqrt(1 - cosine * cosine), cosine));
}

}  // namespace vantage::internal::core
