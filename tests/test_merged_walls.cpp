// Merging triangles into convex polygons where rims are all but straight and corners all but none: a merged polygon
// must hold its triangles, and what hides with them must hide with it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <string>

#include "scene/prepared_data.h"
#include "support/claimed_points.h"
#include "support/outlines.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "vantage/scene.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using testing::judge;
using testing::log_uniform;
using testing::OutlineDraw;
using testing::Random;
using testing::SceneBuilder;
using testing::target_of;
using testing::Verdict;

constexpr double kScales[] = {1e-3, 1e-1, 1, 1e2, 1e4};  // metres
const Vec3 kOnMap(4'512'345.6, 5'012'345.6, 812.3);

/// Cuts the polygon of the vertices [first, last] into triangles: a fan, or along random diagonals.
void cut_up(Random& random, std::uint32_t first, std::uint32_t last, bool is_fan, std::vector<Triangle>& triangles) {
  if (last - first < 2) return;
  const int least = static_cast<int>(first) + 1, most = static_cast<int>(last) - 1;
  const auto apex = static_cast<std::uint32_t>(is_fan ? most : random.integer(least, most));
  triangles.push_back({first, apex, last});
  if (random.chance(0.3)) std::swap(triangles.back()[0], triangles.back()[1]);
  cut_up(random, first, apex, is_fan, triangles);
  cut_up(random, apex, last, is_fan, triangles);
}

/// A planar wall about `centre`; in its plane `to_plane` gives the places of an outline.
struct Wall {
  Vec3 centre, u, v;
  Vec3 at(const Vector2d& p) const { return centre + p.x() * u + p.y() * v; }
};

Mesh mesh_of(Random& random, const Wall& wall, const std::vector<Vector2d>& outline) {
  Mesh mesh;
  for (const Vector2d& p : outline) mesh.vertices.push_back(wall.at(p));
  const int last = static_cast<int>(outline.size()) - 1;
  std::rotate(mesh.vertices.begin(), mesh.vertices.begin() + random.integer(0, last), mesh.vertices.end());
  cut_up(random, 0, static_cast<std::uint32_t>(last), random.chance(0.7), mesh.triangles);
  return mesh;
}

Wall random_wall(Random& random, double scale, bool on_map) {
  const Vec3 n = random.chance(0.3) ? Vec3::UnitY() : random.direction();
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  return {on_map ? kOnMap : Vec3(scale * random.point(-2, 2)), scale * u, scale * v};
}

using Point = Eigen::Matrix<long double, 3, 1>;

Point area_vector(const std::vector<Point>& polygon) {
  Point sum = Point::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]) / 2;
  return sum;
}

/// From a point to a convex polygon: to its nearest side, or, over its middle, to its plane. A polygon may be so thin
/// that only its sides say where it is.
long double distance_to(const std::vector<Point>& polygon, const Point& normal, const Point& point) {
  long double nearest = std::numeric_limits<long double>::infinity();
  bool is_over = true;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &from = polygon[i], side = polygon[(i + 1) % polygon.size()] - from;
    const long double share = std::clamp((point - from).dot(side) / side.squaredNorm(), 0.0L, 1.0L);
    nearest = std::min(nearest, (point - from - share * side).norm());
    is_over = is_over && (point - from).cross(side).dot(normal) <= 0;
  }
  return is_over ? std::min(nearest, std::abs(normal.dot(point - polygon[0]))) : nearest;
}

/// How far the worst triangle of a scene is from being held by some one polygon that was made of it, in metres, and how
/// much more area the polygons have.
struct Loss {
  long double farthest = 0, more_area = 0;
};

Loss loss_of(const Scene& scene) {
  const PreparedScene prepared(scene);
  const auto& data = prepared.data();
  std::vector<std::vector<Point>> polygons;
  std::vector<Point> normals;
  Loss loss;
  for (std::size_t i = 0; i < data.polygon_count(); ++i) {
    polygons.emplace_back();
    for (std::uint32_t k : data.corners_of(i)) polygons.back().push_back(data.vertices[k].cast<long double>());
    const Point area = area_vector(polygons.back());
    normals.push_back(area.normalized());
    loss.more_area += area.norm();
  }
  for (const Triangle& t : scene.mesh.triangles) {
    std::vector<Point> corners;
    for (std::uint32_t k : t) corners.push_back((scene.mesh.vertices[k] - data.origin).cast<long double>());
    loss.more_area -= area_vector(corners).norm();
    long double nearest = std::numeric_limits<long double>::infinity();
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      long double farthest = 0;
      for (const Point& corner : corners) farthest = std::max(farthest, distance_to(polygons[i], normals[i], corner));
      nearest = std::min(nearest, farthest);
    }
    loss.farthest = std::max(loss.farthest, nearest);
  }
  return loss;
}

TEST(MergedWalls, HoldTheirTriangles) {
  Random random(911);
  std::size_t walls = 0, triangles = 0, polygons = 0;
  for (const double scale : kScales) {
    for (const bool on_map : {false, true}) {
      if (on_map && scale < 1) continue;
      for (int draw = 0; draw < 200; ++draw) {
        SCOPED_TRACE(std::to_string(scale) + (on_map ? " m on the map, draw " : " m, draw ") + std::to_string(draw));
        const OutlineDraw outline(random, random.chance(0.5) ? 30 : 40);
        const Scene scene =
            SceneBuilder().add("wall", mesh_of(random, random_wall(random, scale, on_map), outline.outline()));
        const Loss loss = loss_of(scene);
        // 2^-46 of the half extent is the slack of a merged polygon; some more for the planes that are fitted here.
        // What is too thin to have a plane may be off by its width.
        ASSERT_LT(loss.farthest, 10 * 0x1p-46 * scale);
        ASSERT_LT(std::abs(loss.more_area), 100 * 0x1p-46 * scale * scale);
        const SceneStatistics& s = PreparedScene(scene).statistics();
        ++walls;
        triangles += s.triangles - s.degenerate_triangles;
        polygons += s.polygons;
      }
    }
  }
  std::cout << walls << " walls, " << triangles << " triangles, " << polygons << " polygons\n";
  EXPECT_LT(3 * polygons, 2 * triangles);
}

/// An L whose inner corner is rounded by `count` vertices.
std::vector<Vector2d> rounded_l(double radius, int count) {
  std::vector<Vector2d> outline{{-1, -1}, {1, -1}, {1, 0}};
  for (int k = 0; k < count; ++k) {
    const double angle = -std::numbers::pi / 2 - std::numbers::pi / 2 * k / (count - 1);
    outline.emplace_back(radius + radius * std::cos(angle), radius + radius * std::sin(angle));
  }
  outline.emplace_back(0, 1);
  outline.emplace_back(-1, 1);
  return outline;
}

TEST(MergedWalls, InnerCornersStayOpen) {
  Random random(919);
  for (const double scale : kScales) {
    for (const int count : {2, 5, 12, 25}) {
      for (const double radius : {1e-9, 1e-8, 1e-7, 1e-5, 1e-2}) {
        SCOPED_TRACE(std::to_string(scale) + " m, radius " + std::to_string(radius) + ", " + std::to_string(count));
        const Wall wall = random_wall(random, scale, false);
        Mesh mesh;
        for (const Vector2d& p : rounded_l(radius, count)) mesh.vertices.push_back(wall.at(p));
        for (std::uint32_t i = 1; i + 1 < mesh.vertices.size(); ++i) mesh.triangles.push_back({0, i, i + 1});
        const Loss loss = loss_of(SceneBuilder().add("wall", mesh));
        EXPECT_LT(loss.farthest, 10 * 0x1p-46 * scale);
        EXPECT_LT(std::abs(loss.more_area), 100 * 0x1p-46 * scale * scale);
      }
    }
  }
}

TEST(MergedWalls, ASmallChamferIsACorner) {
  Mesh wall;
  wall.vertices = {{10, -10, 0}, {10, 10, 0}, {10, 10, 19.9999999991}, {10, 9.9999999991, 20}, {10, -10, 20}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  const Scene scene = SceneBuilder().add("wall", wall);
  const Target target = target_of({{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}});
  const Volume volume = compute_visibility(PreparedTarget(PreparedScene(scene), target, {100}));
  EXPECT_EQ(PreparedScene(scene).statistics().polygons, 1U);
  VerifyOptions options;
  options.points = 4000;
  options.tolerance_m = volume.tolerance_m;
  const VerifyReport report = verify_volume(scene, target, {100}, {}, volume.mesh, options);
  EXPECT_GT(report.inside, 1000U);
  EXPECT_EQ(report.over_claimed, 0U) << report.worst_over_depth_m;
}

TEST(MergedWalls, HideWhatTheirTrianglesHide) {
  Random random(929);
  std::size_t volumes = 0, looked = 0;
  for (const double scale : kScales) {
    for (const bool on_map : {false, true}) {
      if (on_map && scale < 1) continue;
      for (int draw = 0; draw < 25; ++draw) {
        SCOPED_TRACE(std::to_string(scale) + (on_map ? " m on the map, draw " : " m, draw ") + std::to_string(draw));
        const Vec3 n = random.direction(), u = n.unitOrthogonal(), v = n.cross(u);
        const Vec3 centre = on_map ? kOnMap : Vec3(scale * random.point(-3, 3));
        Target target;
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
          target.parts[0].push_back(centre + 0.3 * scale * (x * u + y * v));
        target.front = n;
        SceneBuilder builder;
        const double low = -5 * scale, far = 20 * scale;  // so that no wall over the target is its ground
        builder.polygon("ground",
                        {centre + Vec3(-far, -far, low), centre + Vec3(far, -far, low), centre + Vec3(0, far, low)});
        for (int k = 0; k < 3; ++k) {
          // Beside the target, standing up more or less, in front of its plane.
          const double angle = random.uniform(0, 2 * std::numbers::pi), size = scale * log_uniform(random, 0.1, 0.6);
          const Vec3 out = std::cos(angle) * u + std::sin(angle) * v, side = n.cross(out);
          const Vec3 up = (n + 0.3 * random.direction()).normalized(), along = (side - side.dot(up) * up).normalized();
          const Wall wall{centre + random.uniform(1, 2) * scale * out + 1.1 * size * n, size * along, size * up};
          builder.add("wall " + std::to_string(k), mesh_of(random, wall, OutlineDraw(random, 40).outline()));
        }
        const Scene scene = builder;
        const Volume volume =
            compute_visibility(PreparedTarget(PreparedScene(scene), target, {10 * scale}), {0.1 * scale, 0});
        if (volume.outcome != Outcome::computed) continue;
        ++volumes;
        const double rounding = 1e-15 * (10 * scale + centre.cwiseAbs().maxCoeff());
        const Verdict verdict = judge(volume, scene.mesh, target.parts[0], 250, rounding, random);
        looked += verdict.looked;
        EXPECT_EQ(verdict.hidden, 0U) << "of " << verdict.looked << ", deepest " << verdict.deepest;
      }
    }
  }
  std::cout << volumes << " volumes, " << looked << " points\n";
  EXPECT_GT(volumes, 150U);
}

}  // namespace
}  // namespace vantage
