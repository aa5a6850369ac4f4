// BlockerBuilder against a brute-force oracle that knows nothing of its planes: a point p is in the interior of B(O)
// exactly when the pyramid over the target with apex p and the polygon O overlap. Overlap is decided by the separating
// axis theorem (Gottschalk 1996): two convex bodies are apart when they are along a face normal of one of them or along
// the cross product of two edges.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "exact/blocker.h"
#include "support/internals.h"
#include "support/random.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using exact::BlockerBuilder;
using exact::Plane;
using target::LocalTarget;
using testing::Random;

/// Corners on an integer grid: all that the oracle computes is exact.
using Corner = std::array<std::int64_t, 3>;
using Corners = std::vector<Corner>;

Corner minus(const Corner& a, const Corner& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Corner cross(const Corner& a, const Corner& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::int64_t dot(const Corner& a, const Corner& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 to_vec(const Corner& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}

std::pair<std::int64_t, std::int64_t> extent(const Corners& body, const Corner& axis) {
  std::int64_t low = dot(body[0], axis), high = low;
  for (const Corner& c : body) {
    low = std::min(low, dot(c, axis));
    high = std::max(high, dot(c, axis));
  }
  return {low, high};
}

Corners edges_of(const Corners& ring) {
  Corners edges;
  for (std::size_t i = 0; i < ring.size(); ++i) edges.push_back(minus(ring[(i + 1) % ring.size()], ring[i]));
  return edges;
}

/// Whether the interior of conv(p, T) meets the relative interior of O. Exact.
bool overlap(const Corner& p, const Corners& target, const Corners& polygon) {
  Corners pyramid = target;
  pyramid.push_back(p);
  Corners pyramid_edges = edges_of(target);
  for (const Corner& t : target) pyramid_edges.push_back(minus(p, t));
  Corners polygon_edges = edges_of(polygon);
  const Corner normal = cross(polygon_edges[0], polygon_edges[1]);
  polygon_edges.push_back(normal);  // a polygon is a prism of no height
  Corners axes = {{0, 0, 1}, normal};
  for (std::size_t i = 0; i < target.size(); ++i) axes.push_back(cross(pyramid_edges[i], minus(p, target[i])));
  for (const Corner& a : pyramid_edges)
    for (const Corner& b : polygon_edges) axes.push_back(cross(a, b));
  for (std::size_t i = 0; i + 1 < polygon_edges.size(); ++i) axes.push_back(cross(polygon_edges[i], normal));
  for (const Corner& axis : axes) {
    if (axis == Corner{0, 0, 0}) continue;
    const auto [low, high] = extent(pyramid, axis);
    const auto [own_low, own_high] = extent(polygon, axis);
    if (high <= own_low || own_high <= low) return false;
  }
  return true;
}

/// Where the boundary of O crosses the target's plane, times a positive weight: (x, y, weight).
Corners footprint(const Corners& polygon) {
  Corners feet;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a[2] == 0) feet.push_back({a[0], a[1], 1});
    if ((a[2] < 0) == (b[2] < 0) || a[2] == 0 || b[2] == 0) continue;
    const std::int64_t sign = b[2] > a[2] ? 1 : -1, weight = sign * (b[2] - a[2]);
    feet.push_back({sign * (b[2] * a[0] - a[2] * b[0]), sign * (b[2] * a[1] - a[2] * b[1]), weight});
  }
  return feet;
}

/// Whether O stands on the inside of the target: then nothing of the front is free, and compute_visibility refuses.
bool pierces(const Corners& target, const Corners& polygon) {
  bool above = false;
  for (const Corner& o : polygon) above = above || o[2] > 0;
  const Corners feet = footprint(polygon);
  if (!above || feet.empty()) return false;
  std::vector<std::array<std::int64_t, 2>> axes;
  for (const Corner& edge : edges_of(target)) axes.push_back({edge[1], -edge[0]});
  for (const Corner& f : feet) {
    for (const Corner& g : feet)
      axes.push_back({f[1] * g[2] - g[1] * f[2], g[0] * f[2] - f[0] * g[2]});  // across the footprint
  }
  for (const auto& axis : axes) {
    if (axis[0] == 0 && axis[1] == 0) continue;
    bool left = true, right = true;  // of the target's extent
    for (const Corner& t : target) {
      for (const Corner& f : feet) {
        const std::int64_t on_target = axis[0] * t[0] + axis[1] * t[1], foot = axis[0] * f[0] + axis[1] * f[1];
        left = left && foot <= on_target * f[2];
        right = right && foot >= on_target * f[2];
      }
    }
    if (left || right) return false;
  }
  return true;
}

target::LocalTarget local_target(const Corners& target) {
  std::vector<Vector2d> polygon;
  for (const Corner& t : target) polygon.emplace_back(static_cast<double>(t[0]), static_cast<double>(t[1]));
  return target::make_local_target(polygon, 1e-9, 0);
}

std::vector<Plane> planes_of(const target::LocalTarget& target, const std::vector<Vec3>& polygon) {
  std::vector<Plane> planes;
  std::vector<Vec3> corners;
  BlockerBuilder(target).build(polygon, planes, corners);
  return planes;
}

/// The least of the planes at p, less 1: positive inside B(O), times about the distance to the boundary over the depth.
double depth(const std::vector<Plane>& planes, const Vec3& p) {
  if (planes.empty()) return -1;
  double least = std::numeric_limits<double>::infinity();
  for (const Plane& g : planes) least = std::min(least, g.dot(p) - 1);
  return least;
}

// Targets on the grid with the origin strictly inside; some have a vertex on the straight line of an axis.
const std::vector<Corners>& targets() {
  static const std::vector<Corners> all = {
      {{-2, -2, 0}, {2, -2, 0}, {0, 2, 0}},
      {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
      {{-3, -1, 0}, {4, -1, 0}, {4, 1, 0}, {-3, 1, 0}},
      {{-2, -1, 0}, {0, -3, 0}, {3, -1, 0}, {2, 2, 0}, {-1, 3, 0}},
      {{-2, -4, 0}, {2, -4, 0}, {4, -2, 0}, {4, 2, 0}, {2, 4, 0}, {-2, 4, 0}, {-4, 2, 0}, {-4, -2, 0}},
      {{-9, -1, 0}, {9, 0, 0}, {-9, 1, 0}},
  };
  return all;
}

Corner random_corner(Random& random, int reach, int low, int high) {
  const int x = random.integer(-reach, reach), y = random.integer(-reach, reach);
  return {x, y, random.integer(low, high)};
}

/// A triangle or a parallelogram; coincidences with the target are common because the grid is coarse, and drawn on
/// purpose besides.
Corners random_polygon(Random& random, const Corners& target) {
  for (;;) {
    const int reach = random.integer(2, 6), low = random.chance(0.4) ? -3 : 0, high = random.integer(1, 5);
    Corners polygon;
    for (int k = 0; k < 3; ++k) polygon.push_back(random_corner(random, reach, low, high));
    const std::size_t i = static_cast<std::size_t>(random.integer(0, static_cast<int>(target.size()) - 1)),
                      j = (i + 1) % target.size();
    switch (random.integer(0, 7)) {
      case 0:  // a shared corner
        polygon[0] = target[i];
        break;
      case 1:  // a shared edge: a wall on the target's outline
        polygon[0] = target[i];
        polygon[1] = target[j];
        break;
      case 2:  // an edge on the line of a target edge, beyond it
        for (int a = 0; a < 3; ++a) polygon[0][a] = 2 * target[j][a] - target[i][a];
        polygon[1] = target[j];
        break;
      case 3:  // a sliver
        polygon[2] = polygon[0];
        polygon[2][random.integer(0, 2)] += 1;
        for (int a = 0; a < 3; ++a) polygon[1][a] = 3 * polygon[0][a] - 2 * polygon[1][a];
        break;
      case 4:  // upright
        polygon[1] = polygon[0];
        polygon[1][2] += random.integer(1, 4);
        break;
      case 5:  // level
        polygon[1][2] = polygon[2][2] = polygon[0][2];
        break;
      default:
        break;
    }
    if (random.chance(0.4)) {
      Corner fourth;
      for (int a = 0; a < 3; ++a) fourth[a] = polygon[0][a] + polygon[2][a] - polygon[1][a];
      polygon.push_back(fourth);
    }
    if (cross(minus(polygon[1], polygon[0]), minus(polygon[2], polygon[0])) != Corner{0, 0, 0}) return polygon;
  }
}

std::string describe(const Corners& target, const Corners& polygon, const Corner& p) {
  std::string text = "target";
  const auto put = [&](const Corner& c) {
    text += " (" + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + ")";
  };
  for (const Corner& c : target) put(c);
  text += "\npolygon";
  for (const Corner& c : polygon) put(c);
  text += "\npoint";
  put(p);
  return text;
}

/// A point above the target's plane: anywhere, or on the ray from a point of the target through a point of O and so, as
/// a rule, on the boundary of B(O), or a step aside of it.
Corner random_viewpoint(Random& random, const Corners& target, const Corners& polygon) {
  for (;;) {
    Corner p = random_corner(random, 14, 1, 14);
    const int kind = random.integer(0, 2);
    if (kind > 0) {
      const Corner& o = polygon[static_cast<std::size_t>(random.integer(0, static_cast<int>(polygon.size()) - 1))];
      const Corner& t = target[static_cast<std::size_t>(random.integer(0, static_cast<int>(target.size()) - 1))];
      const int s = random.integer(0, 3);
      for (int a = 0; a < 3; ++a) p[a] = o[a] + s * (o[a] - t[a]);
      if (kind == 2) p[random.integer(0, 2)] += random.chance(0.5) ? 1 : -1;
    }
    if (p[2] > 0) return p;
  }
}

TEST(Blocker, AgreesWithTheExactOracleOnAGrid) {
  Random random(7);
  int inside = 0, outside = 0, boundary = 0, pierced = 0;
  for (int draw = 0; draw < 4000; ++draw) {
    const Corners& target = targets()[static_cast<std::size_t>(draw) % targets().size()];
    const Corners polygon = random_polygon(random, target);
    if (pierces(target, polygon)) {
      ++pierced;
      continue;
    }
    std::vector<Vec3> corners;
    for (const Corner& c : polygon) corners.push_back(to_vec(c));
    const std::vector<Plane> planes = planes_of(local_target(target), corners);
    for (int k = 0; k < 40; ++k) {
      const Corner p = random_viewpoint(random, target, polygon);
      const double d = depth(planes, to_vec(p));
      const bool hidden = overlap(p, target, polygon);
      boundary += std::abs(d) < 1e-9;  // both answers are right there
      inside += hidden;
      outside += !hidden;
      ASSERT_TRUE(hidden ? d > -1e-9 : d < 1e-9)
          << describe(target, polygon, p) << "\noracle " << hidden << " depth " << d;
    }
  }
  std::cout << inside << " inside, " << outside << " outside, of these " << boundary << " on the boundary; " << pierced
            << " polygons pierced the target\n";
  EXPECT_GT(inside, 20000);
  EXPECT_GT(outside, 20000);
  EXPECT_GT(boundary, 1000);
}

/// Along the normalized axes: how far the two bodies are apart at most; negative when they overlap along all of them.
double separation(const Vec3& p, const std::vector<Vec3>& target, const std::vector<Vec3>& polygon) {
  std::vector<Vec3> pyramid = target, pyramid_edges, polygon_edges, axes;
  pyramid.push_back(p);
  for (std::size_t i = 0; i < target.size(); ++i) {
    pyramid_edges.push_back(target[(i + 1) % target.size()] - target[i]);
    axes.push_back(pyramid_edges.back().cross(p - target[i]));
  }
  for (const Vec3& t : target) pyramid_edges.emplace_back(p - t);
  for (std::size_t i = 0; i < polygon.size(); ++i)
    polygon_edges.emplace_back(polygon[(i + 1) % polygon.size()] - polygon[i]);
  const Vec3 normal = polygon_edges[0].cross(polygon_edges[1]);
  axes.push_back(normal);
  axes.emplace_back(0, 0, 1);
  for (const Vec3& edge : polygon_edges) axes.push_back(edge.cross(normal));
  polygon_edges.push_back(normal);
  for (const Vec3& a : pyramid_edges)
    for (const Vec3& b : polygon_edges) axes.push_back(a.cross(b));
  double widest = -std::numeric_limits<double>::infinity();
  for (const Vec3& axis : axes) {
    if (!(axis.norm() > 1e-12)) continue;
    const Vec3 m = axis.normalized();
    double high = -1e300, low = 1e300, own_high = -1e300, own_low = 1e300;
    for (const Vec3& v : pyramid) {
      high = std::max(high, m.dot(v));
      low = std::min(low, m.dot(v));
    }
    for (const Vec3& v : polygon) {
      own_high = std::max(own_high, m.dot(v));
      own_low = std::min(own_low, m.dot(v));
    }
    widest = std::max({widest, own_low - high, low - own_high});
  }
  return widest;
}

// The gaps stay below half a turn, so the centre is inside.
std::vector<Vec3> random_ring(Random& random, int corners, const Vec3& centre, const Vec3& normal, double squeeze) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Vec3> ring;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * (k + random.uniform(-0.2, 0.2)) / corners;
    ring.push_back(centre + 10 * (std::cos(angle) * u + squeeze * std::sin(angle) * v));
  }
  return ring;
}

TEST(Blocker, AgreesWithTheOracleForAnyShape) {
  Random random(11);
  int inside = 0, outside = 0, skipped = 0;
  for (int draw = 0; draw < 3000; ++draw) {
    const std::vector<Vec3> target = random_ring(random, random.integer(3, 12), {0, 0, 0}, {0, 0, 1},
                                                 random.chance(0.5) ? 1 : random.uniform(0.01, 1));
    std::vector<Vector2d> flat;
    for (const Vec3& t : target) flat.emplace_back(t.head<2>());
    const Vec3 centre = random.point(-30, 30).cwiseAbs();
    // Slivers down to a tenth of a millimetre; polygons that reach below the target's plane beside it.
    std::vector<Vec3> polygon =
        random_ring(random, random.integer(3, 8), centre, random.direction(), std::pow(10, random.uniform(-5, 0)));
    bool above_target = false;
    for (const Vec3& o : polygon) above_target = above_target || (o.z() < 0.1 && o.head<2>().norm() < 20);
    if (above_target) continue;  // might pierce it
    const std::vector<Plane> planes = planes_of(target::make_local_target(flat, 1e-9, 0), polygon);
    for (int k = 0; k < 30; ++k) {
      Vec3 p = random.point(-80, 80);
      if (random.chance(0.7)) {
        const Vec3& o = polygon[static_cast<std::size_t>(random.integer(0, static_cast<int>(polygon.size()) - 1))];
        const Vec3& t = target[static_cast<std::size_t>(random.integer(0, static_cast<int>(target.size()) - 1))];
        p = o + random.uniform(0, 3) * (o - t) + random.uniform(0, 1) * random.direction();
      }
      if (p.z() < 0.01) continue;
      const double d = depth(planes, p), apart = separation(p, target, polygon);
      if (std::abs(apart) < 1e-9 || std::abs(d) < 1e-9) {
        ++skipped;
        continue;
      }
      inside += apart < 0;
      outside += apart > 0;
      ASSERT_EQ(apart<0, d> 0) << "draw " << draw << ": apart by " << apart << " depth " << d;
    }
  }
  std::cout << inside << " inside, " << outside << " outside, " << skipped << " within 1e-9 of the boundary skipped\n";
  EXPECT_GT(inside, 5000);
  EXPECT_GT(outside, 5000);
  EXPECT_LT(skipped, 500);
}

TEST(Blocker, EveryPlaneKeepsTargetAndPolygonApart) {
  Random random(13);
  for (int draw = 0; draw < 3000; ++draw) {
    const Corners& target = targets()[static_cast<std::size_t>(draw) % targets().size()];
    const Corners polygon = random_polygon(random, target);
    std::vector<Vec3> corners;
    for (const Corner& c : polygon) corners.push_back(to_vec(c));
    for (const Plane& g : planes_of(local_target(target), corners)) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Corner& t : target) ASSERT_LE(g.dot(to_vec(t)), 1 + 1e-12);
      for (std::size_t i = 0; i < polygon.size(); ++i) {  // what reaches above the target's plane
        const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
        if (a.z() >= 0) nearest = std::min(nearest, g.dot(a));
        if (a.z() * b.z() < 0) nearest = std::min(nearest, g.dot(Vec3(a + a.z() / (a.z() - b.z()) * (b - a))));
      }
      ASSERT_NEAR(nearest, 1, 1e-12) << describe(target, polygon, {0, 0, 0});  // touches, from the far side
    }
  }
}

TEST(Blocker, WhatDoesNotReachAboveTheTargetHidesNothing) {
  const target::LocalTarget target = local_target(targets()[1]);
  EXPECT_TRUE(planes_of(target, {{5, 5, -1}, {6, 5, -1}, {6, 6, -3}}).empty());
  EXPECT_TRUE(planes_of(target, {{5, 5, 0}, {6, 5, 0}, {6, 6, 0}}).empty());
  EXPECT_TRUE(planes_of(target, {{5, 5, 0}, {6, 5, -1}, {6, 6, 0}}).empty());
  EXPECT_TRUE(planes_of(target, {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}).empty());  // the ground
  EXPECT_TRUE(planes_of(target, {{5, 5, 1e-10}, {6, 5, 1e-10}, {6, 6, 1e-10}}).empty());     // but for rounding
  EXPECT_FALSE(planes_of(target, {{5, 5, 0}, {6, 5, 0}, {6, 6, 1e-6}}).empty());
}

TEST(Blocker, APlateOverTheTargetHidesAFrustum) {
  // Above a plate with half sides 1 at height 5, over a target with half sides 1: at height 10 half sides 3.
  const std::vector<Plane> planes =
      planes_of(local_target(targets()[1]), {{-1, -1, 5}, {1, -1, 5}, {1, 1, 5}, {-1, 1, 5}});
  EXPECT_EQ(planes.size(), 5u);
  EXPECT_NEAR(depth(planes, {0, 0, 5}), 0, 1e-12);
  EXPECT_NEAR(depth(planes, {3, 0, 10}), 0, 1e-12);
  EXPECT_NEAR(depth(planes, {3, -3, 10}), 0, 1e-12);
  EXPECT_GT(depth(planes, {2.9, -2.9, 10}), 0);
  EXPECT_LT(depth(planes, {3.1, 0, 10}), 0);
  EXPECT_LT(depth(planes, {0, 0, 4.9}), 0);
}

}  // namespace
}  // namespace vantage
