// The bodies that obstacles grow to for the clearance, and cuts to them, against distances by brute force.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <vector>

#include "core/grown_polygon.h"
#include "solid/convex_hull.h"
#include "solid/grown_hull.h"
#include "solid/obstacle_shape.h"
#include "solid/surface_turn.h"
#include "support/internals.h"
#include "support/obstacles.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::Case;
using testing::distance;
using testing::distance_to_polygon;
using testing::first_open_edge;
using testing::holds;
using testing::kCases;
using testing::keeping;
using testing::kRoundCorners;
using testing::make_hemisphere;
using testing::make_town;
using testing::Random;

/// Corners on an ellipse that lies askew; 1 and 2 are a point and a line.
std::vector<Vec3> polygon(Random& random, double size, double flatness, const Vec3& centre) {
  const int count = random.integer(1, 9);
  const Vec3 u = random.direction(), v = u.cross(random.direction()).normalized();
  std::set<double> angles;
  while (static_cast<int>(angles.size()) < count) angles.insert(random.uniform(0, 2 * std::numbers::pi));
  std::vector<Vec3> corners;
  for (const double angle : angles) {
    corners.push_back(centre + size * (std::cos(angle) * u + flatness * std::sin(angle) * v));
  }
  return corners;
}

/// A point of the convex hull: a corner as often as not.
Vec3 corner_or_inside(Random& random, const std::vector<Vec3>& corners) {
  if (random.chance(0.5))
    return corners[static_cast<std::size_t>(random.integer(0, static_cast<int>(corners.size()) - 1))];
  Vec3 inside = corners[0];
  for (const Vec3& corner : corners) inside += random.uniform(0, 1) * (corner - inside);
  return inside;
}

TEST(GrownPolygons, HoldTheGrownPolygonAndLittleMore) {
  Random random(41);
  for (int round = 0; round < 3000; ++round) {
    const double size = std::pow(10.0, random.uniform(-3, 3)), radius = size * std::pow(10.0, random.uniform(-3, 2));
    const double flatness = random.chance(0.3) ? std::pow(10.0, random.uniform(-16, -6)) : random.uniform(0, 1);
    const Vec3 centre = random.chance(0.5) ? Vec3::Zero() : Vec3(580000.1, 4785000.2, 1000.3);
    const std::vector<Vec3> corners = polygon(random, size, flatness, centre);
    const Mesh grown = core::grow_polygon(corners, radius);
    ASSERT_EQ(first_open_edge(grown), "") << round;
    const double rounding = 1e-14 * (centre.norm() + size + radius);
    if (radius < 1e4 * rounding) continue;
    for (int i = 0; i < 40; ++i) {
      const Vec3 from = corner_or_inside(random, corners);
      const Vec3 p = from + (radius * (1 - 1e-9) - rounding) * random.direction();
      EXPECT_TRUE(holds(grown, p)) << round;
    }
    for (const Vec3& vertex : grown.vertices) {
      EXPECT_GT(distance_to_polygon(vertex, corners), radius - rounding) << round;
      EXPECT_LT(distance_to_polygon(vertex, corners), (1 + kRoundCorners) * radius + 100 * rounding) << round;
    }
  }
}

TEST(GrownPolygons, PrismsHoldWhatIsAcrossAndReachNoFarther) {
  Random random(42);
  for (int round = 0; round < 2000; ++round) {
    const double size = std::pow(10.0, random.uniform(-3, 3)), radius = size * std::pow(10.0, random.uniform(-3, 2));
    const double aside = radius * random.uniform(0, core::kMostAside);
    const Vec3 centre = random.chance(0.5) ? Vec3::Zero() : Vec3(580000.1, 4785000.2, 1000.3);
    const std::vector<Vec3> corners = polygon(random, size, random.uniform(0.01, 1), centre);
    if (corners.size() < 3) continue;
    const Mesh prism = core::grow_across(corners, radius, aside);
    ASSERT_EQ(first_open_edge(prism), "") << round;
    const double rounding = 1e-14 * (centre.norm() + size + radius);
    if (radius < 1e4 * rounding) continue;
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    for (int i = 0; i < 40; ++i) {
      const Vec3 from = corner_or_inside(random, corners);
      const Vec3 across = aside * random.direction().cross(normal);
      EXPECT_TRUE(holds(prism, from + (1 - 1e-7) * (across + random.uniform(-1, 1) * radius * normal))) << round;
    }
    for (const Vec3& vertex : prism.vertices) {
      EXPECT_LT(distance_to_polygon(vertex, corners), (1 + core::kMostGrownTooFar) * radius + 100 * rounding) << round;
    }
  }
}

TEST(GrownHulls, HoldTheGrownHullAndLittleMore) {
  Random random(46);
  double farthest = 0;
  for (int round = 0; round < 400; ++round) {
    const double size = std::pow(10.0, random.uniform(-3, 3)), radius = size * std::pow(10.0, random.uniform(-2, 1));
    const Vec3 centre = random.chance(0.5) ? Vec3::Zero() : Vec3(580000.1, 4785000.2, 1000.3);
    const Vec3 flatness(1, random.uniform(0.05, 1), random.uniform(0.05, 1));
    const bool is_box = random.chance(0.3);
    std::vector<Vec3> points;
    for (int i = 0; i < (is_box ? 8 : random.integer(4, 40)); ++i) {
      const Vec3 at = is_box ? Vec3(i & 1, i >> 1 & 1, i >> 2) : random.point(-1, 1);
      points.push_back(centre + size * flatness.cwiseProduct(at));
    }
    const Mesh grown = internal::solid::grow_hull(points, radius), hull = internal::solid::convex_hull(points);
    ASSERT_EQ(first_open_edge(grown), "") << round;
    const double rounding = 1e-14 * (centre.norm() + size + radius);
    if (radius < 1e4 * rounding) continue;
    for (int i = 0; i < 40; ++i) {
      const Vec3 from = corner_or_inside(random, points);
      EXPECT_TRUE(holds(grown, from + (radius * (1 - 1e-9) - rounding) * random.direction())) << round;
    }
    for (const Vec3& vertex : grown.vertices) {
      EXPECT_GT(distance(vertex, hull), radius - rounding) << round;
      farthest = std::max(farthest, (distance(vertex, hull) - 100 * rounding) / radius);
    }
  }
  EXPECT_LT(farthest, 1 + kRoundCorners);
}

/// Hills with spikes and holes: most of its triangles turn little to their neighbours.
Scene make_hills(Random& random, double scale, const Vec3& origin) {
  constexpr int kPosts = 21;
  Scene scene;
  scene.objects = {{"hills", "", ObjectKind::other}};
  const double phase = random.uniform(0, 6), spacing = 120.0 / (kPosts - 1), rough = random.uniform(0, 1);
  for (int j = 0; j < kPosts; ++j) {
    for (int i = 0; i < kPosts; ++i) {
      const double x = i * spacing - 60, y = j * spacing - 60;
      double z = 8 + 6 * std::sin(x / 25 + phase) * std::cos(y / 18 - phase) + rough * random.uniform(-0.5, 0.5);
      if (random.chance(0.03)) z += random.uniform(-8, 12);
      const double aside = rough * spacing / 4;
      scene.mesh.vertices.push_back(
          origin + scale * Vec3(x + random.uniform(-aside, aside), y + random.uniform(-aside, aside), z));
    }
  }
  for (std::uint32_t j = 0; j + 1 < kPosts; ++j) {
    for (std::uint32_t i = 0; i + 1 < kPosts; ++i) {
      const std::uint32_t a = j * kPosts + i, b = a + 1, c = b + kPosts, d = a + kPosts;
      const bool turned = random.chance(0.5);
      for (const Triangle& t :
           {turned ? Triangle{a, b, d} : Triangle{a, b, c}, turned ? Triangle{b, c, d} : Triangle{a, c, d}}) {
        if (random.chance(0.02)) continue;
        scene.mesh.triangles.push_back(random.chance(0.01) ? Triangle{t[1], t[0], t[2]} : t);
        scene.object_of.push_back(0);
      }
    }
  }
  return scene;
}

/// Cuts a dome to the clearance, and compares what is left with distances.
void expect_clearance(Random& random, const Case& at, const Scene& scene, double asked) {
  const Navigation navigation = keeping(scene, asked);
  const Volume dome = make_hemisphere(at.origin, 50 * at.scale);
  const Volume cut = cut_to_navigation(dome, navigation);
  ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
  EXPECT_EQ(first_open_edge(cut.mesh), "");
  const double rounding = 1e-9 * at.scale + 1e-14 * at.origin.norm();
  const std::size_t step = 1 + cut.mesh.vertices.size() / 500;
  for (std::size_t i = 0; i < cut.mesh.vertices.size(); i += step) {
    const Vec3& v = cut.mesh.vertices[i];
    EXPECT_GT(distance(v, *navigation.clearance->obstacles), asked - rounding) << v.transpose();
  }
  int inside = 0, cut_away = 0;
  for (int i = 0; i < 600; ++i) {
    const Vec3 p = at.origin + at.scale * random.in_box({Vec3(-50, -50, 0), Vec3(50, 50, 50)});
    if (!holds(dome.mesh, p)) continue;
    const double far = distance(p, *navigation.clearance->obstacles);
    if (std::abs(far - asked) < rounding) continue;
    const bool is_left = holds(cut.mesh, p);
    EXPECT_FALSE(is_left && far < asked) << p.transpose() << " is " << far;
    const bool is_in_solid = holds(scene.mesh, p);
    EXPECT_FALSE(!is_left && !is_in_solid && far > (1 + kRoundCorners) * asked + rounding)
        << p.transpose() << " is " << far;
    inside += is_left;
    cut_away += !is_left;
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(cut_away, 3);
}

TEST(ClearanceLimit, TheCutKeepsTheDistance) {
  Random random(43);
  for (const Case& at : kCases) {
    SCOPED_TRACE(at.scale);
    const Scene town = make_town(random, at.scale, at.origin);
    ASSERT_EQ(obstacles_of(town)->triangles.size(), town.mesh.triangles.size() - 2);
    expect_clearance(random, at, town, 4 * at.scale);
  }
}

TEST(ClearanceLimit, TheCutKeepsTheDistanceFromHills) {
  Random random(44);
  for (const Case& at : kCases) {
    SCOPED_TRACE(at.scale);
    expect_clearance(random, at, make_hills(random, at.scale, at.origin), at.scale * random.uniform(1.5, 12));
  }
}

/// A surface as lidar sees it: roofs, walls between two posts, trees. It turns too much for prisms.
Scene make_raster(Random& random, const Vec3& origin) {
  constexpr std::uint32_t kPosts = 76;
  Scene scene;
  scene.objects = {{"surface", "", ObjectKind::other}};
  for (std::uint32_t j = 0; j < kPosts; ++j) {
    for (std::uint32_t i = 0; i < kPosts; ++i) {
      const bool is_house = (i / 12) % 2 == 1 && (j / 9) % 2 == 1, is_tree = i % 24 > 17 && j % 18 < 7;
      double z = random.uniform(0, 0.2);
      if (is_house) z += 9;
      if (is_tree) z += random.uniform(2, 6);
      scene.mesh.vertices.push_back(origin + Vec3(0.8 * i - 30, 0.8 * j - 30, z));
    }
  }
  for (std::uint32_t j = 0; j + 1 < kPosts; ++j) {
    for (std::uint32_t i = 0; i + 1 < kPosts; ++i) {
      const std::uint32_t a = j * kPosts + i, b = a + 1, c = b + kPosts, d = a + kPosts;
      scene.mesh.triangles.insert(scene.mesh.triangles.end(), {{a, b, c}, {a, c, d}});
    }
  }
  scene.object_of.resize(scene.mesh.triangles.size(), 0);
  return scene;
}

TEST(ClearanceLimit, TheCutKeepsTheDistanceFromARoughRaster) {
  Random random(48);
  const Case at{1, Vec3(580000.1, 4785000.2, 1000.3)};
  expect_clearance(random, at, make_raster(random, at.origin), 4);
}

/// Adds a closed solid over a footprint that all of its first corner sees, from z = 0 to `height`.
void add_house(const std::vector<Vec3>& footprint, double height, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size()),
             count = static_cast<std::uint32_t>(footprint.size());
  for (const Vec3& corner : footprint) mesh.vertices.push_back(corner);
  for (const Vec3& corner : footprint) mesh.vertices.emplace_back(corner.x(), corner.y(), height);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = first + i, b = first + (i + 1) % count;
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, b + count}, {a, b + count, a + count}});
    if (i < 2) continue;
    mesh.triangles.insert(mesh.triangles.end(), {{first, a, a - 1}, {first + count, a + count - 1, a + count}});
  }
}

/// Houses with corners that look in, gables, trees; walls without thickness at their corners.
Mesh make_village(Random& random) {
  Mesh mesh;
  for (int house = 0; house < 9; ++house) {
    const int column = house % 3, row = house / 3;
    const Vec3 at(16.0 * column - 22, 16.0 * row - 22, 0);
    const double w = random.uniform(2, 8), d = random.uniform(2, 8), height = random.uniform(4, 20);
    const double angle = random.chance(0.5) ? 0 : random.uniform(0, 1);
    const auto place = [&](double x, double y, double z) {
      return Vec3(at + Vec3(std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y, z));
    };
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const int kind = random.integer(0, 3);
    if (kind == 0) {
      const double x = random.uniform(0.5, w), y = random.uniform(0.5, d);
      add_house({place(0, 0, 0), place(w, 0, 0), place(w, y, 0), place(x, y, 0), place(x, d, 0), place(0, d, 0)},
                height, mesh);
    } else if (kind == 1) {
      add_house({place(0, 0, 0), place(w, 0, 0), place(w, d, 0), place(0, d, 0)}, height, mesh);
      mesh.triangles.resize(mesh.triangles.size() - 1);  // the roof becomes a gable, its ends pentagons
      mesh.vertices.push_back(place(w / 2, 0, height + 2));
      mesh.vertices.push_back(place(w / 2, d, height + 2));
      std::erase_if(mesh.triangles, [&](const Triangle& t) { return std::min({t[0], t[1], t[2]}) >= first + 4; });
      const std::uint32_t a = first + 4, b = first + 5, c = first + 6, e = first + 7, f = first + 8, g = first + 9;
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, f}, {c, e, g}, {b, c, g}, {b, g, f}, {e, a, f}, {e, f, g}});
    } else {
      // A crown on the corner of a trunk.
      add_house({place(0, 0, 0), place(0.6, 0, 0), place(0.6, 0.6, 0), place(0, 0.6, 0)}, height / 3, mesh);
      const auto top = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(place(0, 0, height));
      for (int i = 0; i < 8; ++i) {
        const double turn = std::numbers::pi / 4 * i;
        mesh.vertices.push_back(place(w / 3 * std::cos(turn), w / 3 * std::sin(turn), height * 2 / 3));
      }
      for (std::uint32_t i = 0; i < 8; ++i) {
        const std::uint32_t a = top + 1 + i, b = top + 1 + (i + 1) % 8;
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, top}, {b, a, first + 4}});
      }
    }
    if (kind == 3 || random.chance(0.5)) continue;
    // A fin: two triangles that face each other, or one.
    const Vec3 aside(random.uniform(-9, -2), random.uniform(-9, -2), 0);
    mesh.vertices.push_back(mesh.vertices[first] + aside);
    mesh.vertices.push_back(mesh.vertices[first] + aside + Vec3(0, 0, height));
    const auto fin = static_cast<std::uint32_t>(mesh.vertices.size() - 2);
    mesh.triangles.push_back({first, fin, fin + 1});
    if (random.chance(0.8)) mesh.triangles.push_back({fin, first, fin + 1});
  }
  return mesh;
}

// Of a house with a gable, and a wall without thickness at its corner, columns hold what is under the roof. The ends
// and that wall are under no single polygon of the roof.
TEST(ObstacleColumns, LeaveOutWallsThatAreUnderNoOneRoof) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(4, 6, 0), d(0, 6, 0), up(0, 0, 5), f(2, 0, 7), g(2, 6, 7), fin(-3, -3, 0);
  std::vector<std::vector<Vec3>> polygons = {
      {d, c, b, a},           {a, b, b + up, f, a + up}, {c, d, d + up, g, c + up},
      {b, c, c + up, b + up}, {d, a, a + up, d + up},    {b + up, c + up, g, f},
      {d + up, a + up, f, g}, {a, fin, fin + up},        {fin, a, fin + up}};
  const std::vector<std::uint32_t> all = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  const internal::solid::Columns found = internal::solid::columns_of(polygons, all);
  EXPECT_EQ(found.columns.size(), 2u);
  EXPECT_EQ(found.others, (std::vector<std::uint32_t>{1, 2, 7, 8}));
  std::swap(polygons[0][0], polygons[0][2]);  // a bottom that faces up
  EXPECT_TRUE(internal::solid::columns_of(polygons, all).columns.empty());
  EXPECT_TRUE(internal::solid::columns_of(polygons, {1, 2, 3, 4, 5, 6}).columns.empty());  // none
  std::swap(polygons[0][0], polygons[0][2]);
  const Vec3 far(-9, 0, 0);  // a floor beside it without height
  polygons.insert(polygons.end(), {{a, far, fin}, {fin, far, a}});
  EXPECT_TRUE(internal::solid::columns_of(polygons, {0, 1, 2, 3, 4, 5, 6, 9, 10}).columns.empty());
}

// What is between two walls without thickness that meet in a corner is no solid, and in a house with a gable there is
// room, also where the volume begins right under its ridge.
TEST(ObstacleShape, IsNoSolidWhereThereIsRoom) {
  const Vec3 o(0, 0, 0), y(0, 10, 0), yz(0, 10, 10), z(0, 0, 10), x(10, 0, 0), xz(10, 0, -10), low(0, 0, -10);
  const std::vector<std::vector<Vec3>> walls = {{o, y, yz, z}, {z, yz, y, o}, {o, x, xz, low}, {low, xz, x, o}};
  EXPECT_FALSE(internal::solid::is_nearly_convex(walls, {0, 1, 2, 3}, 1));
  Scene house;
  house.mesh.vertices = {{-5, -8, 0}, {5, -8, 0}, {5, 8, 0},  {-5, 8, 0}, {-5, -8, 4},
                         {5, -8, 4},  {5, 8, 4},  {-5, 8, 4}, {0, -8, 7}, {0, 8, 7}};
  house.mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 8}, {0, 8, 4}, {2, 3, 7}, {2, 7, 9}, {2, 9, 6},
                          {1, 2, 6}, {1, 6, 5}, {3, 0, 4}, {3, 4, 7}, {5, 6, 9}, {5, 9, 8}, {4, 8, 9}, {4, 9, 7}};
  house.object_of.assign(house.mesh.triangles.size(), 0);
  house.objects = {{"house", "", ObjectKind::other}};
  for (const double aside : {0.0, 0.5}) {
    Volume room = make_hemisphere({aside, 0, 2}, 1.5);
    room.frame.origin = Vec3(aside, 0, 2);
    EXPECT_EQ(cut_to_navigation(room, keeping(house, 0.5)).outcome, Outcome::computed) << aside;
  }
}

// Every other face of an octahedron, twice: as large as all of it, and open.
TEST(ObstacleShape, FacesThatAreDrawnTwiceCoverNothingElse) {
  const Vec3 x(20, 0, 0), y(0, 20, 0), z(0, 0, 20);
  std::vector<std::vector<Vec3>> faces;
  std::vector<std::uint32_t> all;
  for (const auto& [a, b, c] : {std::array{x, y, z}, {-x, -y, z}, {-x, y, -z}, {x, -y, -z}}) {
    const Vec3 middle = (a + b + c) / 3;
    for (const auto& face : {std::vector<Vec3>{a, b, c}, {b, a, middle}, {c, b, middle}, {a, c, middle}}) {
      all.push_back(static_cast<std::uint32_t>(faces.size()));
      faces.push_back(face);
    }
  }
  EXPECT_FALSE(internal::solid::is_nearly_convex(faces, all, 0.5));
}

/// Of the facets that are due to the clearance.
double farthest_of_cut(const Volume& cut, const Mesh& obstacles) {
  double farthest = 0;
  for (std::size_t t = 0; t < cut.mesh.triangles.size(); ++t) {
    if (cut.causes[cut.cause_of[t]].name != "clearance") continue;
    const auto& [a, b, c] = cut.mesh.triangles[t];
    const Vec3 &p = cut.mesh.vertices[a], &q = cut.mesh.vertices[b], &r = cut.mesh.vertices[c];
    for (const Vec3& at : {p, q, r, Vec3((p + q) / 2), Vec3((p + q + r) / 3)}) {
      farthest = std::max(farthest, distance(at, obstacles));
    }
  }
  return farthest;
}

double farthest_of_cut(const Mesh& obstacles, double clearance_m, double half) {
  Volume all = volume_of_mesh(testing::make_box_mesh(Vec3::Constant(-half), Vec3::Constant(half)), "all");
  all.frame.origin = Vec3::Constant(-0.95 * half);
  Navigation navigation;
  navigation.clearance = {clearance_m, std::make_shared<const Mesh>(obstacles)};
  const Volume cut = cut_to_navigation(all, navigation);
  EXPECT_EQ(cut.outcome, Outcome::computed);
  return farthest_of_cut(cut, obstacles);
}

// A rectangle that lies askew is flat but for rounding: the normals of its hull's rim are rounding alone.
TEST(ClearanceLimit, ReachesNoFartherAboutARectangleThatLiesAskew) {
  Random random(49);
  for (int round = 0; round < 60; ++round) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(random.uniform(0, 3), random.direction()).toRotationMatrix();
    Mesh rectangle{{{-10, -5, 0}, {10, -5, 0}, {10, 5, 0}, {-10, 5, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    for (Vec3& corner : rectangle.vertices) corner = turn * corner + Vec3(3, 5, 7);
    if (random.chance(0.3)) std::swap(rectangle.triangles[0][0], rectangle.triangles[0][1]);
    const double clearance = random.chance(0.5) ? 0.5 : 0.02;
    EXPECT_LE(farthest_of_cut(rectangle, clearance, 30), (1 + kRoundCorners) * clearance) << round;
  }
}

TEST(ClearanceLimit, ReachesLittleTooFarOverDents) {
  for (const double depth : {0.05, 0.1, 0.12, 0.14, 0.29}) {
    const Mesh valley{{{-1, -1, 0}, {0, -1, -depth}, {1, -1, 0}, {1, 1, 0}, {0, 1, -depth}, {-1, 1, 0}},
                      {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}}};
    EXPECT_LE(farthest_of_cut(valley, 1, 9), 1 + kRoundCorners) << depth;
  }
  const double w = 1000;  // nearly flat: sides are not one
  const Mesh pyramid{{{-w, -w, 0}, {w, -w, 0}, {w, w, 0}, {-w, w, 0}, {0, 0, 4.9e-4 * w}},
                     {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 2, 1}, {0, 3, 2}}};
  EXPECT_LE(farthest_of_cut(pyramid, 1, 20), 1.02);
}

// A target on the wall of a room: what is between the walls is what is asked for.
TEST(ClearanceLimit, LeavesARoomThatIsSeenFromItsWall) {
  Scene box;
  box.mesh = testing::make_box_mesh({0, 0, 0}, {10, 8, 4});
  box.objects = {{"room", "", ObjectKind::other}};
  box.object_of.assign(box.mesh.triangles.size(), 0);
  Scene angle;  // its floor plan is an L
  for (const double z : {0.0, 4.0}) {
    angle.mesh.vertices.insert(angle.mesh.vertices.end(),
                               {{0, 0, z}, {12, 0, z}, {12, 5, z}, {5, 5, z}, {5, 12, z}, {0, 12, z}});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t a = i, b = (i + 1) % 6;
    angle.mesh.triangles.insert(angle.mesh.triangles.end(), {{a, b, b + 6}, {a, b + 6, a + 6}});
    if (i < 4) angle.mesh.triangles.insert(angle.mesh.triangles.end(), {{0, i + 2, i + 1}, {6, i + 7, i + 8}});
  }
  angle.mesh.triangles.resize(20);
  angle.objects = {{"room", "", ObjectKind::other}};
  angle.object_of.assign(20, 0);
  const auto left = [](const Scene& room, const Target& target) {
    return enclosed_volume(
        compute_volume(PreparedTarget(PreparedScene(room), target, {.max_range_m = 30}), keeping(room, 0.5)).mesh);
  };
  Target on_wall = testing::target_of({{4.5, 0, 1.5}, {5.5, 0, 1.5}, {5.5, 0, 2.5}, {4.5, 0, 2.5}});
  on_wall.front = Vec3(0, 1, 0);
  const Target on_floor = testing::target_of({{4, 4, 0}, {6, 4, 0}, {6, 5, 0}, {4, 5, 0}});
  EXPECT_NEAR(left(box, on_wall), 9 * 7 * 3, 0.1);
  EXPECT_NEAR(left(box, on_floor), 9 * 7 * 3, 0.1);
  Target on_long_wall = testing::target_of({{2, 0, 1.5}, {3, 0, 1.5}, {3, 0, 2.5}, {2, 0, 2.5}});
  on_long_wall.front = Vec3(0, 1, 0);
  EXPECT_GT(left(angle, on_long_wall), 200);
  Target outside = on_long_wall;
  outside.front = Vec3(0, -1, 0);  // the same wall from the street: the house is solid
  EXPECT_GT(left(angle, outside), 1000);
}

TEST(ClearanceLimit, TheCutKeepsTheDistanceFromHousesAndTrees) {
  Random random(47);
  for (int round = 0; round < 8; ++round) {
    const Case& at = kCases[static_cast<std::size_t>(round) % kCases.size()];
    Scene scene;
    scene.mesh = make_village(random);
    scene.objects = {{"village", "", ObjectKind::other}};
    scene.object_of.assign(scene.mesh.triangles.size(), 0);
    for (Vec3& vertex : scene.mesh.vertices) vertex = at.origin + at.scale * vertex;
    SCOPED_TRACE(round);
    expect_clearance(random, at, scene, at.scale * random.uniform(1, 9));
  }
}

// Points whose nearest polygon of a surface is one that turns little: each lies in that polygon's prism.
TEST(SurfaceTurn, BoundsHowFarAsideAPointIsOfWhatIsNearest) {
  Random random(45);
  int tried = 0;
  for (int round = 0; round < 20; ++round) {
    const Case& at = kCases[static_cast<std::size_t>(round) % kCases.size()];
    const Mesh hills = make_hills(random, at.scale, at.origin).mesh;
    std::vector<std::vector<Vec3>> polygons;
    for (const auto& [a, b, c] : hills.triangles) {
      polygons.push_back({hills.vertices[a], hills.vertices[b], hills.vertices[c]});
    }
    const std::vector<double> sines =
        internal::solid::sines_of_turns(polygons, std::vector<bool>(polygons.size(), true));
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = at.origin + at.scale * random.in_box({Vec3(-50, -50, -10), Vec3(50, 50, 40)});
      std::vector<double> distances;
      for (const std::vector<Vec3>& corners : polygons) distances.push_back(distance_to_polygon(p, corners));
      const double nearest = *std::min_element(distances.begin(), distances.end());
      for (std::size_t t = 0; t < polygons.size(); ++t) {
        if (distances[t] > nearest * (1 + 1e-12) || sines[t] > core::kMostAside - 1e-4) continue;
        EXPECT_TRUE(holds(core::grow_across(polygons[t], nearest * (1 + 1e-9), (sines[t] + 1e-4) * nearest), p))
            << round;
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 1000);
}

}  // namespace
}  // namespace vantage
