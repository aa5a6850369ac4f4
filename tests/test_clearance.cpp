// The clearance from obstacles: grown polygons, the cut, the answers for points and the check, against distances by
// brute force.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "core/grown_polygon.h"
#include "solid/convex_hull.h"
#include "solid/grown_hull.h"
#include "solid/obstacle_shape.h"
#include "solid/surface_turn.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/verify.h"
#include "vantage/volume.h"
#include "verify/obstacle_probe.h"

namespace vantage {
namespace {

using testing::first_open_edge;
using testing::holds;
using testing::make_hemisphere;
using testing::Random;
using testing::SceneBuilder;

/// How far the polytope about a grown polygon reaches too far: beside edges, and round corners.
constexpr double kBesideEdges = 0.083, kRoundCorners = 0.16;

/// To a triangle, by its barycentric coordinates: of all points of a corner, a side or the plane.
double distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_side = [&](const Vec3& from, const Vec3& to) {
    const double length = (to - from).squaredNorm();
    const double t = length > 0 ? std::clamp((p - from).dot(to - from) / length, 0.0, 1.0) : 0;
    return (p - from - t * (to - from)).norm();
  };
  double nearest = std::min({to_side(a, b), to_side(b, c), to_side(c, a)});
  Eigen::Matrix<double, 3, 2> sides;
  sides << b - a, c - a;
  const Eigen::Vector2d at = sides.colPivHouseholderQr().solve(p - a);
  if (at.minCoeff() >= 0 && at.sum() <= 1) nearest = std::min(nearest, (sides * at - (p - a)).norm());
  return nearest;
}

double distance(const Vec3& p, const Mesh& mesh) {
  double nearest = INFINITY;
  for (const auto& [a, b, c] : mesh.triangles) {
    nearest = std::min(nearest, distance(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  }
  return nearest;
}

double distance_to_polygon(const Vec3& p, const std::vector<Vec3>& corners) {
  double nearest = INFINITY;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    nearest = std::min(nearest, distance(p, corners[0], corners[i], corners[(i + 1) % corners.size()]));
  }
  return nearest;
}

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
      Vec3 on_polygon = corners[0];
      for (const Vec3& corner : corners) on_polygon += random.uniform(0, 1) * (corner - on_polygon);
      const Vec3& from = random.chance(0.5) ? corners[static_cast<std::size_t>(i) % corners.size()] : on_polygon;
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
      Vec3 on_polygon = corners[0];
      for (const Vec3& corner : corners) on_polygon += random.uniform(0, 1) * (corner - on_polygon);
      const Vec3& from = random.chance(0.5) ? corners[static_cast<std::size_t>(i) % corners.size()] : on_polygon;
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
      Vec3 in_hull = points[0];
      for (const Vec3& point : points) in_hull += random.uniform(0, 1) * (point - in_hull);
      const Vec3& from = random.chance(0.5) ? points[static_cast<std::size_t>(i) % points.size()] : in_hull;
      EXPECT_TRUE(holds(grown, from + (radius * (1 - 1e-9) - rounding) * random.direction())) << round;
    }
    for (const Vec3& vertex : grown.vertices) {
      EXPECT_GT(distance(vertex, hull), radius - rounding) << round;
      farthest = std::max(farthest, (distance(vertex, hull) - 100 * rounding) / radius);
    }
  }
  EXPECT_LT(farthest, 1 + kRoundCorners);
}

/// Houses, a wall that is open, a wire, over ground that does not count.
Scene make_town(Random& random, double scale, const Vec3& origin) {
  Scene scene;
  scene.objects = {{"ground", "", ObjectKind::ground}, {"town", "", ObjectKind::other}};
  const auto add = [&](const std::vector<Vec3>& corners, std::uint32_t object) {
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    for (const Vec3& corner : corners) scene.mesh.vertices.push_back(origin + scale * corner);
    for (std::uint32_t i = 2; i < corners.size(); ++i) {
      scene.mesh.triangles.push_back({first, first + i - 1, first + i});
      scene.object_of.push_back(object);
    }
  };
  add({{-60, -60, -1}, {60, -60, -1}, {60, 60, -1}, {-60, 60, -1}}, 0);
  for (int house = 0; house < 6; ++house) {
    const double x = random.uniform(-40, 40), y = random.uniform(-40, 40), z = random.uniform(4, 20);
    const double w = random.uniform(2, 8), d = random.uniform(2, 8);
    add({{x, y, z}, {x + w, y, z}, {x + w, y + d, z}, {x, y + d, z}}, 1);
    add({{x, y, 0}, {x + w, y, 0}, {x + w, y, z}, {x, y, z}}, 1);
    add({{x + w, y, 0}, {x + w, y + d, 0}, {x + w, y + d, z}, {x + w, y, z}}, 1);
    add({{x, y, 0}, {x, y + d, 0}, {x, y + d, z}, {x, y, z}}, 1);
  }
  add({{-30, 0, 15}, {30, 10, 22}, {30, 10, 22}}, 1);
  for (int i = 0; i < 4; ++i) {
    const Vec3 at = random.in_box({Vec3(-40, -40, 5), Vec3(40, 40, 30)});
    add({at, at + random.point(-6, 6), at + random.point(-6, 6)}, 1);
  }
  return scene;
}

struct Case {
  double scale;
  Vec3 origin;
};
const std::vector<Case> kCases = {
    {1, Vec3(0, 0, 0)}, {1, Vec3(580000.1, 4785000.2, 1000.3)}, {1e-4, Vec3(0, 0, 0)}, {100, Vec3(-3000, 500, 80)}};

Navigation keeping(const Scene& scene, double distance_m) {
  Navigation navigation;
  navigation.clearance = {distance_m, obstacles_of(scene)};
  return navigation;
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
    const Vec3 at(16.0 * (house % 3) - 22, 16.0 * (house / 3) - 22, 0);
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

// Preparing a scene drops what is narrower than its largest extent can be rounded by.
TEST(ClearanceLimit, IsKeptFromASpeckBesideAWallOfAnySize) {
  for (const Case& at : kCases) {
    for (const double wall_m : {1.0, 1e2, 1e4, 1e6}) {
      for (const double speck_m : {1e-16, 1e-13, 1e-9, 1e-3}) {
        SCOPED_TRACE(std::to_string(at.scale) + " wall " + std::to_string(wall_m) + " speck " +
                     std::to_string(speck_m));
        const auto place = [&](double x, double y, double z) { return Vec3(at.origin + at.scale * Vec3(x, y, z)); };
        const auto obstacles = std::make_shared<Mesh>();
        obstacles->vertices = {place(3, 3, 6),        place(3 + speck_m, 3, 6), place(3, 3 + speck_m, 6),
                               place(30, -wall_m, 0), place(30, wall_m, 0),     place(30, 0, wall_m)};
        obstacles->triangles = {{0, 1, 2}, {3, 4, 5}};
        Navigation navigation;
        navigation.clearance = {2 * at.scale, obstacles};
        const Volume cut = cut_to_navigation(make_hemisphere(at.origin, 35 * at.scale, 32, 8), navigation);
        ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
        EXPECT_FALSE(holds(cut.mesh, place(3, 3, 4.01)));
        EXPECT_FALSE(holds(cut.mesh, place(3, 3, 6.001)));
        EXPECT_TRUE(holds(cut.mesh, place(3, 3, 2)));
      }
    }
  }
}

// Booleans round to a part of the largest coordinate: with the whole of such a triangle in them sight was claimed from
// 4e-7 m beside a shadow.
TEST(ClearanceLimit, OfATriangleFarLargerThanTheVolumeCostsNoPrecision) {
  Random random(5);
  for (int round = 0; round < 24; ++round) {
    const double range = std::array{0.1, 10.0, 100.0}[static_cast<std::size_t>(round % 3)];
    const double far = range * std::pow(10, random.uniform(5, 6.5));
    SceneBuilder builder;
    builder.polygon("ground", {{-far, -far, -0.3 * range}, {far, -far, -0.3 * range}, {0, far, -0.3 * range}});
    for (int i = 0; i < 4; ++i) {
      const Vec3 at = range * Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(0.3, 0.5));
      builder.polygon("roof", {at, at + range * Vec3(0.1, 0, 0), at + range * Vec3(0, 0.1, 0.02)});
    }
    const Scene scene = builder;
    const Target target = Target::point({0, 0, 0.02 * range});
    const Sensor sensor{.max_range_m = range};
    Navigation navigation;
    navigation.clearance = Clearance{.distance_m = 0.005 * range, .obstacles = obstacles_of(scene)};
    const Volume volume =
        compute_volume(PreparedTarget(PreparedScene(scene), target, sensor), navigation, {.tolerance_m = 0.01 * range});
    const ProofReport report = prove_volume(scene, target, sensor, navigation, volume.mesh, {.lift_m = volume.lift_m});
    for (const ClaimProof& claim : report.claims) {
      EXPECT_NE(claim.verdict, ProofVerdict::wrong) << "round " << round << ": " << claim.text;
    }
  }
}

// A triangle of 556 km that is 10 micrometres wide: its normal, of rounded differences, was off by so much that a point
// 2.02 m away, nearly over it, was said to be nearer than 2 m.
TEST(ClearanceLimit, OfALongSliverIsNotTakenForLess) {
  const auto obstacles = std::make_shared<Mesh>();
  obstacles->vertices = {{-217783.2636958597, 55083.14226547446, -163677.38823644427},
                         {217756.87473871495, -55079.55276912332, 163713.70223210863},
                         {-13.194476467964437, 1.7947581192826134, 18.156998378535143}};
  obstacles->triangles = {{0, 1, 2}};
  Navigation navigation;
  navigation.clearance = Clearance{2, obstacles};
  const Vec3 point(-23.160455658615472, 4.453905735856816, 8.146349940796853);  // 2.0205165 m, by exact numbers
  const Scene scene = SceneBuilder().ground("ground", 100, -1);
  const PreparedTarget target(PreparedScene(scene), Target::point({0, 0, 0}), Sensor{.max_range_m = 40});
  EXPECT_TRUE(query_points(target, navigation, {point})[0].outside_of.empty());
  EXPECT_FALSE(verify::ObstacleProbe(*navigation.clearance).is_too_near(point, 0));
  EXPECT_TRUE(verify::ObstacleProbe(*navigation.clearance).is_too_near(point, 0.0103));
  navigation.clearance->distance_m = 2.0206;
  EXPECT_EQ(query_points(target, navigation, {point})[0].outside_of, std::vector<std::string>{"clearance"});
}

TEST(ClearanceLimit, ObstaclesAreAllOfASceneWithoutObjects) {
  Scene scene;
  scene.mesh = testing::make_box_mesh({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(obstacles_of(scene)->triangles.size(), 12u);
  scene.object_of.assign(11, 0);
  EXPECT_EQ(testing::code_of([&] { obstacles_of(scene); }), ErrorCode::array_sizes_differ);
  scene.object_of.assign(12, 0);
  EXPECT_EQ(obstacles_of(scene)->triangles.size(), 12u);
  scene.object_of[5] = 1;
  EXPECT_EQ(testing::code_of([&] { obstacles_of(scene); }), ErrorCode::index_out_of_range);
  EXPECT_EQ(testing::code_of([&] { ground_of(scene); }), ErrorCode::index_out_of_range);
  scene.object_of[5] = 0;
  scene.mesh.triangles[3][1] = 8;
  EXPECT_EQ(testing::code_of([&] { obstacles_of(scene); }), ErrorCode::index_out_of_range);
  const auto surface = std::make_shared<Mesh>(scene.mesh);
  EXPECT_EQ(testing::code_of([&] { GroundLevels({0, surface}); }), ErrorCode::index_out_of_range);
}

// Blocks that stand askew, far from the origin: their hulls are made of coordinates that are rounded there.
TEST(ClearanceLimit, IsKeptFromTurnedBlocksAtMapCoordinates) {
  Random random(2243);
  const Vec3 origin(-3e6, 4.7e6, 0);
  constexpr double kAsked = 2.01;
  for (int round = 0; round < 5; ++round) {
    SCOPED_TRACE(round);
    Mesh blocks;
    for (int block = 0; block < 6; ++block) {
      const Vec3 half(random.uniform(1, 6), random.uniform(1, 6), random.uniform(2, 14));
      const Vec3 at = 25 * Vec3(std::cos(block), std::sin(block), 0) + random.point(-3, 3);
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(random.uniform(0, 1.5), Vec3::UnitZ()).toRotationMatrix();
      Mesh box = testing::make_box_mesh(-half, half);
      for (Vec3& vertex : box.vertices) vertex = origin + at + turn * vertex;
      testing::append(blocks, box);
    }
    Navigation navigation;
    navigation.clearance = {kAsked, std::make_shared<const Mesh>(blocks)};
    const Volume cut = cut_to_navigation(make_hemisphere(origin, 60), navigation);
    ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
    EXPECT_EQ(first_open_edge(cut.mesh), "");
    constexpr double kRounding = 1e-7;
    for (const auto& [a, b, c] : cut.mesh.triangles) {
      const Vec3 &p = cut.mesh.vertices[a], &q = cut.mesh.vertices[b], &r = cut.mesh.vertices[c];
      for (const Vec3& on : {p, Vec3((p + q) / 2), Vec3((p + q + r) / 3)}) {
        ASSERT_GT(distance(on, blocks), kAsked - kRounding) << (on - origin).transpose();
      }
    }
  }
}

TEST(ClearanceLimit, IsExactOverAFlatWallAndBoundedBesideItsEdge) {
  Scene scene;
  scene.objects = {{"wall", "", ObjectKind::wall}};
  scene.mesh = {{{10, -200, -200}, {10, 200, -200}, {10, 200, 20}, {10, -200, 20}}, {{0, 1, 2}, {0, 2, 3}}};
  scene.object_of = {0, 0};
  Navigation navigation = keeping(scene, 5);
  navigation.altitude = {0, 15};
  const Volume cut = cut_to_navigation(make_hemisphere(Vec3::Zero(), 60), navigation);
  Box before;
  for (const Vec3& v : cut.mesh.vertices) {
    if (v.x() < 10) before.extend(v);
  }
  EXPECT_NEAR(before.max.x(), 5, 1e-9);
  double nearest_above = INFINITY;
  const Volume over = cut_to_navigation(make_hemisphere(Vec3::Zero(), 60), keeping(scene, 5));
  for (const Vec3& v : over.mesh.vertices) nearest_above = std::min(nearest_above, distance(v, scene.mesh));
  double highest = 0;
  for (const Vec3& v : over.mesh.vertices) {
    if (std::abs(v.x() - 10) < 4 && v.z() < 26) highest = std::max(highest, distance(v, scene.mesh));
  }
  EXPECT_GT(nearest_above, 5 - 1e-9);
  EXPECT_LT(highest, 5 * (1 + kBesideEdges));
  EXPECT_GT(highest, 5);
  bool is_told = false;
  for (const Cause& cause : over.causes) is_told = is_told || (cause.name == "clearance" && cause.area_m2 > 100);
  EXPECT_TRUE(is_told);
}

TEST(ClearanceLimit, PointsAreAnsweredByTheirDistance) {
  Random random(47);
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(580000.1, 4785000.2, 1000.3)}) {
    const Scene town = make_town(random, 1, origin);
    const PreparedScene scene(town);
    const Target at = Target::polygon({origin + Vec3(-1, -1, 31), origin + Vec3(1, -1, 31), origin + Vec3(0, 1, 31)});
    Target down = at;
    down.front = Vec3(0, 0, -1);
    const PreparedTarget target(scene, down, Sensor{.max_range_m = 60});
    const Navigation navigation = keeping(town, 4);
    std::vector<Vec3> points;
    for (int i = 0; i < 2000; ++i) points.push_back(origin + random.in_box({Vec3(-40, -40, 0), Vec3(40, 40, 30)}));
    PointQuery query(target, navigation);
    const std::vector<PointAnswer> answers = query.answer(points);
    int inside = 0, too_near = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double far = distance(points[i], *navigation.clearance->obstacles);
      const std::vector<std::string>& names = answers[i].outside_of;
      const bool is_near = std::find(names.begin(), names.end(), "clearance") != names.end();
      if (std::abs(far - 4) > 1e-6) {
        EXPECT_EQ(is_near, far < 4) << far;
      }
      inside += answers[i].inside;
      too_near += is_near;
      const Vec3 line = target.frame(0).origin - points[i], to_centre = line.normalized();
      const double margin = answers[i].margin_m;
      if (!answers[i].inside || !(margin > 0.01) || margin > 0.9 * line.norm()) continue;
      const std::vector<PointAnswer> near = query.answer(
          std::vector<Vec3>{points[i] + (1 - 1e-6) * margin * to_centre, points[i] - (1 - 1e-6) * margin * to_centre,
                            points[i] + (1 + 1e-6) * margin * to_centre, points[i] - (1 + 1e-6) * margin * to_centre});
      EXPECT_TRUE(near[0].inside && near[1].inside);
      EXPECT_FALSE(near[2].inside && near[3].inside);
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(too_near, 100);
  }
}

TEST(ClearanceLimit, VerifyFindsWhatIsTooNear) {
  Random random(53);
  const Scene town = make_town(random, 1, Vec3::Zero());
  Target at = Target::polygon({Vec3(-1, -1, 31), Vec3(1, -1, 31), Vec3(0, 1, 31)});
  at.front = Vec3(0, 0, -1);
  const PreparedTarget target(PreparedScene(town), at, Sensor{.max_range_m = 60});
  const auto judged = [&](const Navigation& cut_to) {
    const Volume volume = compute_volume(target, cut_to);
    VerifyOptions options;
    options.points = 6000;
    options.lift_m = volume.lift_m;
    return verify_volume(town, at, Sensor{.max_range_m = 60}, keeping(town, 4), volume.mesh, options);
  };
  const VerifyReport right = judged(keeping(town, 4));
  EXPECT_EQ(right.over_claimed, 0u) << right.worst_over_cause;
  EXPECT_EQ(right.under_claimed, 0u);
  EXPECT_GT(right.inside, 500u);
  EXPECT_GT(judged({}).over_claimed, 100u);
  const VerifyReport loose = judged(keeping(town, 3.9));
  EXPECT_GT(loose.over_claimed, 0u);
  EXPECT_EQ(loose.worst_over_cause, "clearance");
  EXPECT_GT(judged(keeping(town, 5)).under_claimed, 0u);
}

TEST(ClearanceLimit, LeavesNothingOfWhatItCovers) {
  Random random(3);
  const Scene town = make_town(random, 1, Vec3::Zero());
  const Volume none = cut_to_navigation(make_hemisphere(Vec3::Zero(), 20), keeping(town, 100));
  EXPECT_EQ(none.outcome, Outcome::outside_limits);
  testing::expect_wording(none.reason + "\n" + none.hint);
}

TEST(ClearanceLimit, WrongOnesAreRefused) {
  Random random(3);
  const Scene town = make_town(random, 1, Vec3::Zero());
  const Volume dome = make_hemisphere(Vec3::Zero(), 20);
  for (const double distance : {0.0, -1.0, 2e9, static_cast<double>(INFINITY), static_cast<double>(NAN)}) {
    testing::expect_error([&] { cut_to_navigation(dome, keeping(town, distance)); }, ErrorCode::value_out_of_range,
                          "navigation.clearance");
  }
  Navigation navigation;
  navigation.clearance = {4, nullptr};
  testing::expect_error([&] { cut_to_navigation(dome, navigation); }, ErrorCode::nothing_given, "navigation.clearance");
}

/// Without a word on what is ground.
constexpr const char* kBlocks =
    "v -50 -50 0\nv 50 -50 0\nv 50 50 0\no field\nf 1 2 3\n"
    "v 5 5 0\nv 9 5 0\nv 9 5 8\no block\nf 4 5 6\n";

class ClearanceMission : public ::testing::Test {
 protected:
  ClearanceMission() { testing::write_bytes(folder_ / "blocks.obj", kBlocks); }

  MissionFile read(const std::string& navigation) const {
    const std::string text =
        "scene: {mesh: blocks.obj}\ntarget: {vertices: [[0, 0, 6], [2, 0, 6], [0, 2, 6]]}\nsensor: {max_range: 40}\n"
        "navigation: " +
        navigation + "\n";
    return read_mission_text(text, folder_ / "mission.yaml");
  }
  Mission resolve(const std::string& navigation) const { return resolve_mission(read(navigation)); }

  testing::TemporaryDirectory folder_;
};

TEST_F(ClearanceMission, IsFromAllOrFromAllButTheNamedGround) {
  const Mission all = resolve("{clearance: 3}");
  EXPECT_EQ(all.navigation.clearance->distance_m, 3);
  EXPECT_EQ(all.navigation.clearance->obstacles->triangles.size(), 2u);
  ASSERT_EQ(all.notes.size(), 1u);
  EXPECT_EQ(all.notes[0].code, WarningCode::clearance_from_all);
  const Mission named = resolve("{clearance: 3, ground: field}");
  EXPECT_EQ(named.navigation.clearance->obstacles->triangles.size(), 1u);
  EXPECT_TRUE(named.notes.empty());
  testing::expect_error([&] { resolve("{clearance: 3, ground: feild}"); }, ErrorCode::object_missing,
                        "mission.yaml:4:");
}

TEST_F(ClearanceMission, WrongKeysAreRefused) {
  const auto refuse = [&](const std::string& navigation, ErrorCode code) {
    testing::expect_error([&] { read(navigation); }, code, "mission.yaml:4:");
  };
  refuse("{clearance: 0}", ErrorCode::value_out_of_range);
  refuse("{clearance: -2}", ErrorCode::value_out_of_range);
  refuse("{clearance: near}", ErrorCode::not_a_number);
  refuse("{clearence: 3}", ErrorCode::unknown_key);
  refuse("{clearance: 3, ground: 0}", ErrorCode::not_applicable);
}

TEST_F(ClearanceMission, TextAndHashHoldAllOfIt) {
  std::set<std::string> hashes, texts;
  for (const char* navigation :
       {"{clearance: 3}", "{clearance: 4}", "{clearance: 3, ground: field}", "{altitude: [1, 2]}"}) {
    const MissionFile mission = read(navigation);
    const std::string text = mission_text(mission, mission.file.parent_path());
    const MissionFile again = read_mission_text(text, mission.file);
    EXPECT_EQ(mission_text(again, mission.file.parent_path()), text);
    EXPECT_EQ(mission_hash(resolve_mission(again)), mission_hash(resolve_mission(mission)));
    hashes.insert(mission_hash(resolve_mission(mission)));
    texts.insert(text);
  }
  EXPECT_EQ(hashes.size(), 4u);
  EXPECT_EQ(texts.size(), 4u);
}

TEST(ClearanceMap, AVolumeAmongHousesKeepsItsDistance) {
  VANTAGE_REQUIRE_SHARED("osm/monaco.osm.pbf");
  const std::string text = "scene: {osm: '" + testing::shared_data("osm/monaco.osm.pbf").string() +
                           "', center: [43.7384, 7.4246], radius: 300}\n"
                           "target: {center: [43.7386, 7.4250], width: 6, length: 6, offset: 30}\n"
                           "sensor: {max_range: 150}\nnavigation: {clearance: 10}\n";
  const Mission mission = resolve_mission(read_mission_text(text, "mission.yaml"));
  EXPECT_TRUE(mission.notes.empty() || mission.notes[0].code != WarningCode::clearance_from_all);
  const Result result = run_mission(mission);
  ASSERT_EQ(result.volume.outcome, Outcome::computed) << result.volume.reason;
  const Mesh& obstacles = *mission.navigation.clearance->obstacles;
  double nearest = INFINITY;
  for (std::size_t i = 0; i < result.volume.mesh.vertices.size(); i += 50) {
    nearest = std::min(nearest, distance(result.volume.mesh.vertices[i], obstacles));
  }
  EXPECT_GT(nearest, 10 - 1e-6);
  VerifyOptions options;
  options.points = 2000;
  options.lift_m = result.volume.lift_m;
  const VerifyReport report =
      verify_volume(mission.scene(), mission.target, mission.sensor, mission.navigation, result.volume.mesh, options);
  EXPECT_TRUE(report.is_right()) << report.worst_over_cause;
  EXPECT_EQ(report.under_claimed, 0u);
}

}  // namespace
}  // namespace vantage
