// Outlines of targets: what a survey or a drawing program may hold.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "draw.h"

namespace attack {
namespace {

using Outline = std::vector<Vec3>;

Outline on_circle(Random& random, int corners, double jitter) {
  Outline outline;
  const double start = random.uniform(0, 2 * std::numbers::pi), step = 2 * std::numbers::pi / corners;
  for (int k = 0; k < corners; ++k) {
    const double angle = start + step * (k + random.uniform(-jitter, jitter));
    outline.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0);
  }
  return outline;
}

Outline rectangle(double half_x, double half_y) {
  return {{-half_x, -half_y, 0}, {half_x, -half_y, 0}, {half_x, half_y, 0}, {-half_x, half_y, 0}};
}

/// Each corner, or some, cut off `size` from it along both sides, with an arc of `steps` sides.
Outline rounded(Random& random, const Outline& outline, double size, int steps, double share) {
  Outline result;
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &p = outline[i], before = outline[(i + n - 1) % n], after = outline[(i + 1) % n];
    if (!random.chance(share)) {
      result.push_back(p);
      continue;
    }
    const Vec3 back = (before - p).normalized(), on = (after - p).normalized();
    for (int k = 0; k <= steps; ++k) {  // a quadratic curve: convex, tangent at both ends
      const double t = static_cast<double>(k) / steps;
      result.push_back(p + size * ((1 - t) * (1 - t) * back + t * t * on));
    }
  }
  return result;
}

/// Some sides with points that stand out of them by next to nothing.
Outline with_flat_corners(Random& random, double scale, const Outline& outline) {
  Outline result;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    result.push_back(a);
    if (!random.chance(0.6)) continue;
    const Vec3 along = b - a, out = Vec3(along.y(), -along.x(), 0).normalized();
    const double rise = std::min(std::abs(tiny(random, scale)), 1e-2);
    const int points = random.integer(1, 6);
    for (int k = 1; k <= points; ++k) {
      const double t = static_cast<double>(k) / (points + 1);
      result.push_back(a + t * along + 4 * t * (1 - t) * rise * out);
    }
  }
  return result;
}

Outline draw_shape(Random& random, double scale, std::string& kind) {
  Outline square = rectangle(0.5, 0.5);
  switch (random.integer(0, 9)) {
    case 0:
      kind = "triangle";
      return on_circle(random, 3, 0.3);
    case 1:
      kind = "square";
      return square;
    case 2:
      kind = "polygon";
      return on_circle(random, random.integer(4, 12), 0.3);
    case 3:
      kind = "many corners";
      return on_circle(random, random.integer(20, 64), 0.4);
    case 4:
      kind = "chamfer";
      return rounded(random, square, random.chance(0.5) ? random.magnitude(5e-10, 1e-8) : random.magnitude(1e-8, 0.4),
                     1, 0.7);
    case 5: {
      kind = "fillet";
      const int corners = random.integer(1, 4);
      return rounded(random, corners == 3 ? on_circle(random, 3, 0.2) : square,
                     random.magnitude(random.chance(0.3) ? 1e-7 : 1e-4, 0.4), 60 / 4 / corners + 1, 1.0);
    }
    case 6:
      kind = "flat corners";
      return with_flat_corners(random, scale, random.chance(0.5) ? square : on_circle(random, 4, 0.3));
    case 7:
      kind = "needle";
      return rectangle(0.5, random.magnitude(1e-6, 1e-2));
    case 8: {
      kind = "needle triangle";
      const double height = random.magnitude(1e-6, 1e-1);
      return {{-0.5, 0, 0}, {0.5, 0, 0}, {random.uniform(-0.4, 0.4), height, 0}};
    }
    default:
      kind = "half disc";
      return rounded(random, rectangle(0.5, 0.25), random.pick({0.2, 0.2499, 0.2499999999}), random.integer(2, 25),
                     0.5);
  }
}

/// Turned within its plane; not always, so that sides also lie along the axes.
void turn(Random& random, Outline& outline) {
  if (random.chance(0.5)) return;
  const Eigen::AngleAxisd rotation(random.uniform(0, 2 * std::numbers::pi), Vec3::UnitZ());
  for (Vec3& p : outline) p = rotation * p;
  for (Vec3& p : outline) p.z() = 0;
}

}  // namespace

double tiny(Random& random, double scale, bool either) {
  if (random.chance(0.2)) return 0;
  const double sign = either ? random.sign() : 1;
  const double size = random.chance(0.5)
                          ? random.pick({1e-12, 1e-10, 5e-10, 1e-9, 2e-9, 5e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3})
                          : random.magnitude(1e-12, 1e-3);
  return sign * (random.chance(0.7) ? size / scale : std::min(size * 10, 1e-2));
}

std::vector<Vec3> draw_outline(Random& random, double scale, std::string& kind) {
  Outline outline = draw_shape(random, scale, kind);
  if (outline.size() > 64) outline.resize(64);
  turn(random, outline);
  const double size = random.chance(0.85) ? random.uniform(0.3, 2) : random.magnitude(0.05, 30);
  for (Vec3& p : outline) p *= size;
  if (random.chance(0.3)) {  // on a grid: coordinates that a person would type
    for (Vec3& p : outline) {
      const Vec3 q = (p * 1024).array().round() / 1024;
      if (size > 0.3 && (kind == "square" || kind == "triangle" || kind == "polygon")) p = q;
    }
  }
  return outline;
}

}  // namespace attack
