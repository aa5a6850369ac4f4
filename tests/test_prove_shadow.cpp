// What polygons hide, for the proof of volumes: against a loop over triangles in extended precision.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numeric>
#include <vector>

#include "prove/flat_polygons.h"
#include "prove/shadow.h"
#include "prove/view.h"
#include "support/exact_crossings.h"
#include "support/hidden_point.h"
#include "support/random.h"
#include "support/scenes.h"

namespace vantage {
namespace {

using internal::prove::FlatPolygon;
using internal::prove::FlatPolygons;
using internal::prove::Hit;
using internal::prove::ShadowTarget;
using internal::prove::View;
using testing::hidden_point;
using testing::Random;

std::vector<std::uint32_t> all_triangles(const Scene& scene) {
  std::vector<std::uint32_t> numbers(scene.mesh.triangles.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

double area_of_polygon(const FlatPolygon& polygon) {
  double area = 0;
  for (std::size_t i = 2; i < polygon.corners.size(); ++i) {
    area += (polygon.corners[i - 1] - polygon.corners[0]).cross(polygon.corners[i] - polygon.corners[0]).norm() / 2;
  }
  return area;
}

double area_of_triangles(const Scene& scene, const std::vector<std::uint32_t>& triangles) {
  Mesh some{scene.mesh.vertices, {}};
  for (const std::uint32_t t : triangles) some.triangles.push_back(scene.mesh.triangles[t]);
  return surface_area(some);
}

/// Polygons with corners on a circle, cut to triangles by fans, turned anyhow; each triangle with vertices of its own.
TEST(FlatPolygons, FindTheWholeOfAConvexPolygon) {
  Random random(301);
  for (int round = 0; round < 200; ++round) {
    const Vec3 offset = round % 2 == 0 ? Vec3::Zero() : random.point(-5e6, 5e6);
    const Target shape = testing::random_target(random, random.integer(3, 12), random.uniform(0.1, 50),
                                                random.point(-40, 40), random.direction());
    const std::vector<Vec3>& corners = shape.parts[0];
    Scene scene;
    const std::size_t first = static_cast<std::size_t>(random.integer(0, static_cast<int>(corners.size()) - 1));
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const auto at = static_cast<std::uint32_t>(scene.mesh.vertices.size());
      for (const std::size_t k : {std::size_t{0}, i - 1, i}) {
        scene.mesh.vertices.push_back(corners[(first + k) % corners.size()] + offset);
      }
      scene.mesh.triangles.push_back({at, at + 1, at + 2});
      if (random.chance(0.5)) std::swap(scene.mesh.triangles.back()[0], scene.mesh.triangles.back()[1]);
    }
    const FlatPolygons polygons(scene, offset, all_triangles(scene));
    for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      const FlatPolygon* const polygon = polygons.around(t);
      ASSERT_TRUE(polygon);
      EXPECT_EQ(polygon->triangles.size(), scene.mesh.triangles.size()) << round;
      EXPECT_EQ(polygon->corners.size(), corners.size()) << round;
    }
  }
}

/// Whatever is grown in a city covers no more than its triangles do, and has no corner outside of a side.
TEST(FlatPolygons, AreConvexAndCoveredByTheirTriangles) {
  for (std::uint64_t seed = 302; seed < 306; ++seed) {
    Random random(seed);
    Scene scene = testing::random_city(random, 40, 5);
    // Some corners off the plane, by what may and what may not be forgiven.
    for (Vec3& vertex : scene.mesh.vertices) {
      if (random.chance(0.1)) vertex += std::pow(10.0, random.uniform(-15, -6)) * random.direction();
    }
    const FlatPolygons polygons(scene, Vec3(1, 2, 3), all_triangles(scene));
    for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      const FlatPolygon* const polygon = polygons.around(t);
      ASSERT_TRUE(polygon);
      EXPECT_LT(polygon->slack_m, 1e-10);
      EXPECT_TRUE(std::binary_search(polygon->triangles.begin(), polygon->triangles.end(), t));
      EXPECT_NEAR(area_of_polygon(*polygon), area_of_triangles(scene, polygon->triangles), 1e-8);
      for (std::size_t i = 0; i < polygon->corners.size(); ++i) {
        for (const Vec3& corner : polygon->corners) {
          EXPECT_GE(polygon->inward[i].dot(corner - polygon->corners[i]), -1e-10);
        }
      }
      for (const std::uint32_t of : polygon->triangles) {
        for (const std::uint32_t v : scene.mesh.triangles[of]) {
          const Vec3 at = scene.mesh.vertices[v] - Vec3(1, 2, 3);
          EXPECT_LE(std::abs(polygon->normal.dot(at - polygon->corners[0])), polygon->slack_m + 1e-13);
        }
      }
    }
  }
}

/// An L of three squares: what is grown about a triangle of it goes on to a neighbouring square, and not round the
/// corner.
TEST(FlatPolygons, StopAtACorner) {
  Scene scene;
  for (const Vec3& at : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    for (const Vec3& step : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}) {
      scene.mesh.vertices.push_back(at + step);
    }
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
    scene.mesh.triangles.push_back({first, first + 2, first + 3});
  }
  const FlatPolygons polygons(scene, Vec3::Zero(), all_triangles(scene));
  for (std::uint32_t t = 0; t < 6; ++t) {
    const FlatPolygon* const polygon = polygons.around(t);
    EXPECT_GE(polygon->triangles.size(), 3U) << t;
    EXPECT_LE(polygon->triangles.size(), 4U) << t;
    EXPECT_NEAR(area_of_polygon(*polygon), area_of_triangles(scene, polygon->triangles), 1e-12);
    EXPECT_TRUE(polygon->is_exactly_flat);
  }
}

struct Drawn {
  explicit Drawn(Random& random) {
    const double radius = std::pow(10.0, random.uniform(-2, 1));
    target = testing::random_target(random, random.integer(3, 6), radius, Vec3(0, 0, 0), Vec3(0, 0, 1));
    frame = make_target_frame(target);
    view = internal::prove::make_view(target, 0, 0);
    looked_at = internal::prove::shadow_target(view, 0);
    const Vec3 place(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(0, 20));
    for (int k = 0; k < 3; ++k) {
      Vec3 corner = place + random.point(-6, 6);
      if (random.chance(0.3)) corner = Vec3(std::round(corner.x()), std::round(corner.y()), std::round(corner.z()));
      scene.mesh.vertices.push_back(corner);
    }
    scene.mesh.triangles = {{0, 1, 2}};
    scene.objects.push_back({"only"});
  }
  /// A position from which a point of the triangle is seen before one of the target, or one beside that.
  Vec3 position(Random& random) const {
    const auto& v = scene.mesh.vertices;
    double a = random.uniform(-0.1, 1.1), b = random.uniform(-0.1, 1.1);
    if (random.chance(0.3)) a = 0;
    const Vec3 on = v[0] + a * (v[1] - v[0]) + b * (v[2] - v[0]);
    const double share = random.chance(0.3) ? 1 : random.uniform(0, 1.05);
    const Vec3 to = share * target.parts[0][static_cast<std::size_t>(random.integer(0, 2))];
    // Often on the border of what is hidden, to within rounding.
    return on + std::pow(10.0, random.uniform(random.chance(0.3) ? -17 : -7, 1)) * (on - to);
  }
  std::array<Vec3, 3> triangle() const {
    return {scene.mesh.vertices[0], scene.mesh.vertices[1], scene.mesh.vertices[2]};
  }

  Target target;
  TargetFrame frame;
  View view;
  ShadowTarget looked_at;
  Scene scene;
};

/// A position that is called hidden has a hidden point; one that has a hidden point by far is called so.
TEST(ProveShadow, HitsAreWhatIsHidden) {
  Random random(311);
  int hits = 0, misses = 0, found = 0;
  for (int round = 0; round < 60000; ++round) {
    const Drawn drawn(random);
    const FlatPolygons polygons(drawn.scene, drawn.view.origin, {0});
    const FlatPolygon* const polygon = polygons.around(0);
    if (!polygon) continue;
    const Vec3 position = drawn.position(random) - drawn.view.origin;
    const auto hit = internal::prove::find_hit(position, *polygon, drawn.looked_at);
    const auto hidden = hidden_point(position + drawn.view.origin, drawn.triangle(), drawn.frame);
    const bool is_sure =
        hit && internal::prove::hides(*polygon, drawn.looked_at, {*hit, *hit, *hit}, position.norm(), 100);
    if (is_sure) {
      ASSERT_TRUE(hidden) << "round " << round;
      ++hits;
    } else if (hidden) {
      ++misses;
    } else {
      ++found;
    }
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GT(found, 3000);
  EXPECT_LT(misses, hits / 5);  // those within rounding of the border
}

/// Of three hidden positions the polygon hides something from all that lies between them, and beyond.
TEST(ProveShadow, WhatIsHiddenIsConvexAndGoesOn) {
  Random random(312);
  int tried = 0;
  for (int round = 0; round < 20000; ++round) {
    const Drawn drawn(random);
    const FlatPolygons polygons(drawn.scene, drawn.view.origin, {0});
    const FlatPolygon* const polygon = polygons.around(0);
    if (!polygon) continue;
    std::array<Vec3, 3> at;
    std::array<std::optional<Hit>, 3> hit;
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] = drawn.position(random) - drawn.view.origin;
      hit[k] = internal::prove::find_hit(at[k], *polygon, drawn.looked_at);
    }
    if (!hit[0] || !hit[1] || !hit[2]) continue;
    if (!internal::prove::hides(*polygon, drawn.looked_at, {*hit[0], *hit[1], *hit[2]}, 1000, 1000)) continue;
    ++tried;
    const double a = random.uniform(0.1, 0.6), b = random.uniform(0.1, 0.9 - a);
    const Vec3 between = a * at[0] + b * at[1] + (1 - a - b) * at[2];
    for (const double by : {1.0, 1.3}) {
      EXPECT_TRUE(hidden_point(by * between + drawn.view.origin, drawn.triangle(), drawn.frame)) << round;
    }
  }
  EXPECT_GT(tried, 500);
}

bool passes_through(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  using testing::exact_side;
  if (exact_side(a, b, c, from) * exact_side(a, b, c, to) >= 0) return false;
  const int first = exact_side(from, to, a, b);
  return first != 0 && exact_side(from, to, b, c) == first && exact_side(from, to, c, a) == first;
}

/// From far along a wall, past its edge near the target, by so little that doubles do not tell: nothing is hidden that
/// exact numbers do not hide, and far more is found than without more digits.
TEST(ProveShadow, WhatIsHiddenAtAFlatAngleIsFoundWithMoreDigits) {
  Random random(331);
  int roughly = 0, finely = 0, not_hidden = 0;
  for (int round = 0; round < 4000; ++round) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(random.uniform(0, 6), random.direction()).toRotationMatrix();
    Target target;
    target.parts[0] = {turn * Vec3(-1, -1, 0), turn * Vec3(1, -1, 0), turn * Vec3(1, 1, 0), turn * Vec3(-1, 1, 0)};
    const View view = internal::prove::make_view(target, 0, 0);
    const ShadowTarget looked_at = internal::prove::shadow_target(view, 0);
    // An edge that hangs so low over the target's border; the line of sight past it to the far side rises so slowly.
    const double low = std::pow(10.0, random.uniform(-4, -1)), beside = random.uniform(0.5, 1.5), far = 600;
    const std::array<Vec3, 3> wall = {turn * Vec3(-9, beside, low), turn * Vec3(9, beside, low),
                                      turn * Vec3(0, beside + random.uniform(0, 0.1), 9)};
    Scene scene;
    scene.mesh.vertices = {wall.begin(), wall.end()};
    scene.mesh.triangles = {{0, 1, 2}};
    scene.objects.push_back({"wall"});
    const FlatPolygons polygons(scene, Vec3::Zero(), {0});
    const FlatPolygon* const polygon = polygons.only(0);
    ASSERT_TRUE(polygon);
    std::array<Vec3, 3> at;
    std::array<Hit, 3> hits;
    bool are_hit = true;
    for (std::size_t k = 0; k < 3 && are_hit; ++k) {
      const double rise = std::pow(10.0, random.uniform(-9, -6));
      at[k] = turn * Vec3(random.uniform(-2, 2), far, low * (far + 1) / (beside + 1) * (1 + rise));
      const auto hit = internal::prove::find_hit(at[k], *polygon, looked_at);
      are_hit = hit.has_value();
      if (hit) hits[k] = *hit;
    }
    if (!are_hit) continue;
    // What was found to be hit need not be from here.
    if (random.chance(0.5)) at[0] -= turn * Vec3(0, 0, std::pow(10.0, random.uniform(-14, -6)));
    roughly += internal::prove::hides(*polygon, looked_at, hits, far + 9, far) ? 1 : 0;
    const bool is_finely = internal::prove::hides_finely(*polygon, looked_at, at, hits, far + 9, far);
    bool is_exactly = true;
    for (std::size_t k = 0; k < 3; ++k) is_exactly = is_exactly && passes_through(at[k], hits[k].target_point, wall);
    if (is_finely) {
      EXPECT_TRUE(is_exactly) << round;
    }
    finely += is_finely ? 1 : 0;
    not_hidden += is_exactly ? 0 : 1;
  }
  std::cout << roughly << " roughly, " << finely << " finely, " << not_hidden << " not hidden\n";
  EXPECT_GT(finely, roughly + 500);
  EXPECT_GT(finely, 500);
  EXPECT_GT(not_hidden, 100);
}

/// No triangle that hides something is left out.
TEST(ProveShadow, AllThatMayHideIsCollected) {
  for (std::uint64_t seed = 321; seed < 324; ++seed) {
    Random random(seed);
    const Scene scene = testing::random_city(random, 40, 8);
    const Target target = testing::random_target(random, 5, 2, Vec3(0, 0, 0.5), Vec3(0.1, 0, 1));
    const View view = internal::prove::make_view(target, 0, 0);
    const ShadowTarget looked_at = internal::prove::shadow_target(view, 0);
    const auto tree = internal::prove::obstacles_in_front(scene, view, Box{Vec3::Constant(-500), Vec3::Constant(500)});
    const FlatPolygons polygons(scene, view.origin, all_triangles(scene));
    std::vector<std::uint32_t> found;
    std::size_t hiding = 0;
    for (int i = 0; i < 500; ++i) {
      Vec3 position = random.point(-120, 120);
      position.z() = std::abs(position.z());
      if (view.normal.dot(position) < 0.01) continue;
      internal::prove::collect_hiding(position, looked_at, tree, found);
      for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
        const FlatPolygon* const only = polygons.only(t);
        if (!only || !internal::prove::find_hit(position, *only, looked_at)) continue;
        ++hiding;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), t)) << seed << ": " << t;
      }
    }
    EXPECT_GT(hiding, 300u);
  }
}

}  // namespace
}  // namespace vantage
