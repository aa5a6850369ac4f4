// Depth cube maps on the processor, against plain double-precision geometry.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "depth/cpu_depth.h"
#include "support/depth_probe.h"
#include "support/mesh_reading.h"
#include "support/random.h"
#include "support/scenes.h"

namespace vantage::testing {
namespace {

using depth::Sampling;

const Vec3 kMap(580000, 4785000, 1000);  // coordinates as maps have them

Scene shifted(Scene scene, const Vec3& by) {
  for (Vec3& v : scene.mesh.vertices) v += by;
  return scene;
}

DepthMap render_scene(const Scene& scene, const Vec3& viewpoint, int size, Sampling sampling, double range = 1e9) {
  const auto renderer = depth::make_cpu_depth_renderer(PreparedScene(scene));
  return render_one(*renderer, viewpoint, size, sampling, range);
}

TEST(CubeFaces, AreRightHandedAndCoverAllAxes) {
  Vec3 sum = Vec3::Zero();
  for (const depth::CubeFace& face : depth::cube_faces()) {
    EXPECT_EQ(face.right.cross(face.up), -face.forward);
    sum += face.forward.cwiseAbs();
  }
  EXPECT_EQ(sum, Vec3::Constant(2));
}

TEST(CpuDepth, SeesTheWallsOfARoom) {
  const Scene room = SceneBuilder().box("room", {-2, -3, -4}, {5, 6, 7});
  const std::array<double, 6> distance{5, 2, 6, 3, 7, 4};
  for (const Vec3& shift : {Vec3(0, 0, 0), kMap}) {
    for (const Sampling sampling : {Sampling::centers, Sampling::nearest}) {
      const DepthMap map = render_scene(shifted(room, shift), shift, 9, sampling);
      for (int face = 0; face < 6; ++face) EXPECT_NEAR(map.at(face, 4, 4) * distance[face], 1, 3e-7);
    }
    // Off the axis the nearest wall decides: along (1, u, v), x = 5 is met first only where |u| and |v| are small.
    const DepthMap map = render_scene(shifted(room, shift), shift, 200, Sampling::centers);
    for (int row = 0; row < 200; ++row) {
      for (int column = 0; column < 200; ++column) {
        const Vec3 d = direction_on_face(0, (2 * column + 1) / 200.0 - 1, (2 * row + 1) / 200.0 - 1);
        const double nearest =
            std::min({5 / d.x(), d.y() > 0 ? 6 / d.y() : 3 / -d.y(), d.z() > 0 ? 7 / d.z() : 4 / -d.z()});
        ASSERT_NEAR(map.at(0, row, column) * nearest, 1, 3e-7) << row << " " << column;
      }
    }
  }
}

TEST(CpuDepth, SeesNothingInEmptySpace) {
  const Scene scene = SceneBuilder().box("far", {1000, 1000, 1000}, {1010, 1010, 1010});
  for (const Sampling sampling : {Sampling::centers, Sampling::nearest}) {
    for (const float q : render_scene(scene, Vec3::Zero(), 16, sampling, 100).inverse_depths) ASSERT_EQ(q, 0);
  }
}

TEST(CpuDepth, SeesTheGroundAMicrometreBelow) {
  for (const double height : {1e-3, 1e-6}) {
    for (const double side : {1.0, -1.0}) {
      for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(3000, -2000, 512)}) {
        const Scene ground = shifted(SceneBuilder().ground("ground", 500), shift);
        const Vec3 eye = shift + Vec3(17.3, 40.1, side * height);
        const double true_height = std::abs(eye.z() - shift.z());
        for (const Sampling sampling : {Sampling::centers, Sampling::nearest}) {
          for (const int n : {64, 130}) {
            const DepthMap map = render_scene(ground, eye, n, sampling);
            for (int row = 0; row < n; ++row) {
              // Face 0 has the z axis as its up. What looks away from the ground sees nothing, the row at the horizon
              // too.
              const double v =
                  sampling == Sampling::centers ? (2 * row + 1.0) / n - 1 : (2.0 * (row + (side < 0))) / n - 1;
              const double q = std::max(-side * v, 0.0) / true_height;
              for (int column = 0; column < n; ++column) {
                if (q == 0) {
                  ASSERT_LT(map.at(0, row, column), 1e-2) << "row " << row;
                } else {
                  ASSERT_NEAR(map.at(0, row, column) / q, 1, 1e-5) << "row " << row;
                }
              }
            }
            ASSERT_NEAR(map.at(side > 0 ? 5 : 4, 10, 50) * true_height, 1, 1e-5);
            ASSERT_EQ(map.at(side > 0 ? 4 : 5, 10, 50), 0);
          }
        }
      }
    }
  }
}

TEST(CpuDepth, AgreesWithRaysAgainstRandomCities) {
  Random random(4101);
  for (int round = 0; round < 12; ++round) {
    const Vec3 shift = round % 3 == 2 ? kMap : Vec3(0, 0, 0);
    const Scene city = shifted(random_city(random, 25, 2), shift);
    const Vec3 eye = shift + Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 60));
    const int n = round % 2 ? 256 : 48;  // rasterised and by rays
    const int step = n * n / 330;
    const DepthMap map = render_scene(city, eye, n, Sampling::centers);
    const SeenTriangles triangles = seen_from(city.mesh, eye);
    int compared = 0;
    for (int texel = 0; texel < 6 * n * n; texel += step) {
      const int face = texel / (n * n), row = texel / n % n, column = texel % n;
      const RayHit hit =
          first_hit(triangles, direction_on_face(face, (2 * column + 1.0) / n - 1, (2 * row + 1.0) / n - 1), 1e-4);
      if (!hit.is_clear) continue;
      ++compared;
      ASSERT_NEAR(map.at(face, row, column), hit.inverse, 2e-7 * hit.inverse)
          << "round " << round << " texel " << texel;
    }
    EXPECT_GT(compared, n * n * 6 / step / 2);
  }
}

TEST(CpuDepth, HasNoCracks) {
  // The walls of a room as grids of triangles, seen from its middle by rays along the very lines of the grids.
  Random random(4110);
  SceneBuilder builder;
  const int cells = 12;
  for (const depth::CubeFace& wall : depth::cube_faces()) {
    for (int cell = 0; cell < cells * cells; ++cell) {
      const int column = cell % cells, row = cell / cells;
      const auto corner = [&](int right, int up) {
        return Vec3(wall.forward + (2.0 * (column + right) / cells - 1) * wall.right +
                    (2.0 * (row + up) / cells - 1) * wall.up);
      };
      const bool turned = random.chance(0.5);  // each triangle its own object, or they are merged
      builder.polygon("a", {corner(0, 0), corner(1, 0), turned ? corner(0, 1) : corner(1, 1)});
      builder.polygon("b", {corner(1, 1), corner(0, 1), turned ? corner(1, 0) : corner(0, 0)});
    }
  }
  for (const Sampling sampling : {Sampling::centers, Sampling::nearest}) {
    for (const int n : {12, 36, 127, 129, 180, 255}) {
      for (const Vec3& eye : {Vec3(0, 0, 0), Vec3(0.25, -0.5, 0.125), Vec3(0.1, 0.2, 0.3)}) {
        for (const float q : render_scene(builder, eye, n, sampling).inverse_depths) ASSERT_GT(q, 0.5) << n;
      }
    }
  }
}

TEST(CpuDepth, IsAccurateAtSixHundredMetres) {
  // A wall 600 m away, askew: the distance along each ray is known in double precision.
  Random random(4102);
  double worst = 0;
  for (const Vec3& shift : {Vec3(0, 0, 0), kMap}) {
    for (int round = 0; round < 20; ++round) {
      const Vec3 normal = (Vec3(1, random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3))).normalized();
      const Vec3 a = normal.unitOrthogonal(), b = normal.cross(a), foot = 600 * normal;
      const Scene wall = shifted(
          SceneBuilder().polygon("wall", {foot + 900 * a, foot + 900 * b, foot - 900 * a, foot - 900 * b}), shift);
      const SeenTriangles triangles = seen_from(wall.mesh, shift);
      for (const Sampling sampling : {Sampling::centers, Sampling::nearest}) {
        const int n = round % 2 ? 65 : 131;
        const DepthMap map = render_scene(wall, shift, n, sampling);
        for (int texel = 0; texel < n * n; texel += 3) {
          const double half = sampling == Sampling::nearest ? 1.0 / n : 0;
          const double u = texel_centre(texel % n, n), v = texel_centre(texel / n, n);
          const Vec3 d = direction_on_face(0, u, v);
          const RayHit hit = first_hit(triangles, d, 3.0 / n);
          if (!hit.is_clear || hit.inverse == 0) continue;
          double expected = 0;
          for (const double du : {-half, half}) {
            for (const double dv : {-half, half}) {
              expected = std::max(expected, first_hit(triangles, direction_on_face(0, u + du, v + dv), 0).inverse);
            }
          }
          const double error =
              d.norm() * std::abs(1 / static_cast<double>(map.at(0, texel / n, texel % n)) - 1 / expected);
          worst = std::max(worst, error);
        }
      }
    }
  }
  std::cout << "largest radial error at 600 m and more: " << worst << " m\n";
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(worst, 0);
}

/// Every point of a surface must be bounded in every texel whose closed footprint holds it.
void expect_bounded(const DepthMap& map, const Vec3& point, const std::string& what, long& checked) {
  for (int face = 0; face < 6; ++face) {
    const Vec3 seen = on_face(face, point);
    if (!(seen.z() > 0) || seen.z() > 0.5e8 || std::abs(seen.x()) > 1 || std::abs(seen.y()) > 1) continue;
    for (int row = 0; row < map.size; ++row) {
      if (std::abs(seen.y() - ((2 * row + 1.0) / map.size - 1)) > 1.0 / map.size) continue;
      for (int column = 0; column < map.size; ++column) {
        if (std::abs(seen.x() - ((2 * column + 1.0) / map.size - 1)) > 1.0 / map.size) continue;
        ++checked;
        ASSERT_GE(map.at(face, row, column), seen.z())
            << what << ": face " << face << " row " << row << " column " << column << " point " << point.transpose();
      }
    }
  }
}

/// Random points of a triangle, its corners and points of its sides among them.
Vec3 point_of(Random& random, const std::array<Vec3, 3>& t) {
  const int kind = random.integer(0, 9);
  if (kind == 0) return t[random.integer(0, 2)];
  double a = random.uniform(0, 1), b = random.uniform(0, 1) * (1 - a);
  if (kind <= 3) b = 0;
  if (kind == 4) {
    a = std::pow(10, random.uniform(-9, 0));
    b = 0;
  }
  const int first = random.integer(0, 2);
  const Vec3 &p = t[first], &q = t[(first + 1) % 3], &r = t[(first + 2) % 3];
  return p + a * (q - p) + b * (r - p);
}

using TriangleMaker = std::function<std::array<Vec3, 3>(Random&)>;

std::array<Vec3, 3> any_triangle(Random& random) {
  const double size = std::pow(10, random.uniform(-2, 3));
  return {random.point(-size, size), random.point(-size, size), random.point(-size, size)};
}

std::array<Vec3, 3> sliver(Random& random) {
  const Vec3 a = random.point(-50, 50), b = random.point(-50, 50);
  return {a, b,
          random.chance(0.5) ? Vec3(a + 1e-4 * random.direction()) : Vec3(0.5 * (a + b) + 1e-5 * random.direction())};
}

std::array<Vec3, 3> tiny_triangle(Random& random) {
  const Vec3 a = random.point(-30, 30);
  return {a, a + 1e-3 * random.direction(), a + 1e-3 * random.direction()};
}

/// In a plane through the viewpoint, or nearly.
std::array<Vec3, 3> edge_on(Random& random) {
  const Vec3 normal = random.chance(0.3) ? Vec3(Vec3::Unit(random.integer(0, 2))) : random.direction();
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  const double offset = random.chance(0.3) ? 0 : std::pow(10, random.uniform(-13, -3));
  const auto draw = [&] { return Vec3(random.uniform(-40, 40) * u + random.uniform(-40, 40) * v + offset * normal); };
  return {draw(), draw(), draw()};
}

/// Close by on one side of a coordinate plane, with corners behind the viewpoint.
std::array<Vec3, 3> just_beside(Random& random) {
  const int axis = random.integer(0, 2);
  const double offset = (random.chance(0.5) ? 1 : -1) * std::pow(10, random.uniform(-6, -2));
  std::array<Vec3, 3> t{random.point(-100, 100), random.point(-100, 100), random.point(-100, 100)};
  for (Vec3& p : t) p[axis] = offset;
  return t;
}

/// With corners on the lines between texels and faces.
std::array<Vec3, 3> on_grid(Random& random) {
  const auto draw = [&] { return Vec3(random.integer(-8, 8), random.integer(-8, 8), random.integer(-8, 8)); };
  return {draw(), draw(), draw()};
}

bool too_thin(const std::array<Vec3, 3>& t) {
  const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
  return (t[1] - t[0]).cross(t[2] - t[0]).norm() <= 1e-8 * longest;
}

/// Each triangle an object of its own, so that none are merged.
Scene scene_of(Random& random, const TriangleMaker& make, int count) {
  SceneBuilder builder;
  for (int made = 0; made < count;) {
    const std::array<Vec3, 3> t = make(random);
    if (too_thin(t)) continue;
    builder.polygon(std::to_string(made++), {t[0], t[1], t[2]});
    if (random.chance(0.1)) builder.polygon(std::to_string(made++), {t[0], t[1], t[2] + 1e-7 * random.direction()});
  }
  return builder;
}

const std::vector<std::pair<std::string, TriangleMaker>>& makers() {
  static const std::vector<std::pair<std::string, TriangleMaker>> kMakers{
      {"any", any_triangle}, {"sliver", sliver},           {"tiny", tiny_triangle},
      {"edge on", edge_on},  {"just beside", just_beside}, {"on the grid", on_grid}};
  return kMakers;
}

TEST(NearestDepth, BoundsEverySurfacePoint) {
  Random random(4103);
  long checked = 0;
  for (const auto& [name, make] : makers()) {
    for (int round = 0; round < 40; ++round) {
      const Vec3 shift = round % 4 == 3 ? kMap : Vec3(0, 0, 0);
      const Scene scene = shifted(scene_of(random, make, random.integer(1, 12)), shift);
      const std::array<int, 5> sizes{1, 4, 7, 16, 40};
      const int n = sizes[random.integer(0, 4)];
      const DepthMap map = render_scene(scene, shift, n, Sampling::nearest);
      for (const auto& triangle : seen_from(scene.mesh, shift)) {
        for (int i = 0; i < 200; ++i) {
          expect_bounded(map, point_of(random, triangle), name + ", round " + std::to_string(round), checked);
          if (HasFatalFailure()) return;
        }
      }
    }
  }
  std::cout << checked << " points checked\n";
  EXPECT_GT(checked, 100000);
}

TEST(NearestDepth, BoundsRandomDirectionsInCities) {
  Random random(4104);
  for (int round = 0; round < 8; ++round) {
    const Vec3 shift = round % 2 ? kMap : Vec3(0, 0, 0);
    const Scene city = shifted(random_city(random, 30, 2), shift);
    const Vec3 eye = shift + Vec3(random.uniform(-1, 1), random.uniform(-1, 1), round % 3 ? 1e-6 : 20);
    const int n = 24;
    const DepthMap map = render_scene(city, eye, n, Sampling::nearest);
    const SeenTriangles triangles = seen_from(city.mesh, eye);
    for (int i = 0; i < 20000; ++i) {
      const int face = random.integer(0, 5), row = random.integer(0, n - 1), column = random.integer(0, n - 1);
      const double u = (2 * (column + random.uniform(0, 1))) / n - 1, v = (2 * (row + random.uniform(0, 1))) / n - 1;
      ASSERT_GE(map.at(face, row, column), first_hit(triangles, direction_on_face(face, u, v), 0).inverse * (1 - 1e-9))
          << "round " << round << " face " << face << " u " << u << " v " << v;
    }
  }
}

/// The largest inverse depth of a triangle in a square of a face: cut in extended precision.
double exact_in_square(const std::array<Vec3, 3>& triangle, int face, double u0, double u1, double v0, double v1) {
  using Point = std::array<long double, 3>;
  const depth::CubeFace& axes = depth::cube_faces()[face];
  std::vector<Point> points, next;
  for (const Vec3& p : triangle) points.push_back({axes.right.dot(p), axes.up.dot(p), axes.forward.dot(p)});
  const std::array<Point, 5> sides{{{0, 0, 1}, {1, 0, -u0}, {-1, 0, u1}, {0, 1, -v0}, {0, -1, v1}}};
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const auto height = [&](const Point& p) {
      return sides[k][0] * p[0] + sides[k][1] * p[1] + sides[k][2] * p[2] - (k == 0 ? 1e-8L : 0);
    };
    next.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point &a = points[i], &b = points[(i + 1) % points.size()];
      const long double at_a = height(a), at_b = height(b);
      if (at_a >= 0) next.push_back(a);
      if ((at_a >= 0) == (at_b >= 0)) continue;
      const long double t = at_a / (at_a - at_b);
      next.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])});
    }
    points.swap(next);
  }
  long double nearest = std::numeric_limits<long double>::infinity();
  for (const Point& p : points) nearest = std::min(nearest, p[2]);
  return points.empty() ? 0 : static_cast<double>(1 / nearest);
}

TEST(NearestDepth, IsTheTrueMaximumButForRounding) {
  Random random(4105);
  long seen = 0;
  for (const auto& [name, make] : makers()) {
    for (int round = 0; round < 25; ++round) {
      const Vec3 shift = round % 4 == 3 ? kMap : Vec3(0, 0, 0);
      const Scene scene = shifted(scene_of(random, make, random.integer(1, 4)), shift);
      const int n = random.integer(1, 12);
      const DepthMap map = render_scene(scene, shift, n, Sampling::nearest);
      const SeenTriangles triangles = seen_from(scene.mesh, shift);
      for (int texel = 0; texel < 6 * n * n; ++texel) {
        const int face = texel / (n * n), row = texel / n % n, column = texel % n;
        const auto bound = [&](double grow) {
          double largest = 0;
          for (const auto& t : triangles) {
            largest = std::max(largest,
                               exact_in_square(t, face, 2.0 * column / n - 1 - grow, 2.0 * (column + 1) / n - 1 + grow,
                                               2.0 * row / n - 1 - grow, 2.0 * (row + 1) / n - 1 + grow));
          }
          return largest;
        };
        const double value = map.at(face, row, column);
        ASSERT_GE(value, bound(-1e-12) * (1 - 1e-12)) << name << " round " << round << " n " << n << " texel " << texel;
        // Margins that grow the square: rounding of a scene of 1 km, seen from as near as the surface is.
        const bool is_tight = value <= bound(1e-5) * (1 + 1e-5) || (value > 1e6 && value <= bound(1e-3) * (1 + 1e-3));
        ASSERT_TRUE(is_tight) << value << " beyond " << bound(1e-5) << ": " << name << " round " << round << " n " << n
                              << " texel " << texel;
        seen += value > 0;
      }
    }
  }
  EXPECT_GT(seen, 5000);
}

TEST(NearestDepth, MergedPolygonsAreBoundedToo) {
  Random random(4106);
  long checked = 0;
  for (int round = 0; round < 20; ++round) {
    const Vec3 shift = round % 2 ? kMap : Vec3(0, 0, 0);
    // A regular polygon of many corners in a random plane: coplanar but for rounding, so it is merged.
    const Vec3 normal = random.direction(), u = normal.unitOrthogonal(), v = normal.cross(u),
               centre = random.point(-5, 5);
    std::vector<Vec3> corners;
    for (int i = 0; i < 16; ++i) {
      corners.emplace_back(centre + 9 * std::cos(i * std::numbers::pi / 8) * u +
                           9 * std::sin(i * std::numbers::pi / 8) * v);
    }
    const Scene scene = shifted(SceneBuilder().polygon("disc", corners), shift);
    const DepthMap map = render_scene(scene, shift, 20, Sampling::nearest);
    for (const auto& triangle : seen_from(scene.mesh, shift)) {
      for (int i = 0; i < 200; ++i) expect_bounded(map, point_of(random, triangle) * (1 + 1e-9), "disc", checked);
    }
  }
  EXPECT_GT(checked, 10000);
}

TEST(NearestDepth, IsNeverFartherThanTheCentre) {
  Random random(4107);
  const Scene city = random_city(random, 40, 2);
  const auto renderer = depth::make_cpu_depth_renderer(PreparedScene(city));
  for (int round = 0; round < 5; ++round) {
    const Vec3 eye(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 50));
    const DepthMap nearest = render_one(*renderer, eye, 100, Sampling::nearest);
    const DepthMap centers = render_one(*renderer, eye, 100, Sampling::centers);
    // Rays are in single precision: on a silhouette one may hit what it should just miss.
    int farther = 0;
    for (std::size_t i = 0; i < nearest.inverse_depths.size(); ++i) {
      farther += nearest.inverse_depths[i] < centers.inverse_depths[i] * (1 - 1e-6F);
    }
    EXPECT_LE(farther, 2);
  }
}

TEST(CpuDepth, DoesNotDependOnTheNumberOfThreads) {
  Random random(4108);
  const Scene city = random_city(random, 40, 2);
  const auto renderer = depth::make_cpu_depth_renderer(PreparedScene(city));
  const std::vector<Vec3> eyes{{0, 0, 1}, {1, 1, 30}, {0, 0, 1e-6}};
  for (const auto& [sampling, n] :
       {std::pair(Sampling::centers, 100), {Sampling::centers, 150}, {Sampling::nearest, 150}}) {
    const int size = n;
    const Sampling how = sampling;
    std::vector<std::vector<float>> images;
    for (const int threads : {1, 2, 5}) {
      std::size_t next = 0;
      std::vector<float> all;
      parallel::with_threads(threads, [&] {
        renderer->render({eyes, size, how, 200}, [&](std::size_t i, std::span<const float> image) {
          EXPECT_EQ(i, next++);
          all.insert(all.end(), image.begin(), image.end());
        });
      });
      EXPECT_EQ(all.size(), eyes.size() * 6 * size * size);
      images.push_back(std::move(all));
    }
    EXPECT_TRUE(images[0] == images[1]);
    EXPECT_TRUE(images[0] == images[2]);
  }
}

TEST(CpuDepth, KeepsWhatIsInRange) {
  Random random(4109);
  const Scene city = random_city(random, 40, 2);
  const auto renderer = depth::make_cpu_depth_renderer(PreparedScene(city));
  const Vec3 eye(0, 0, 2);
  for (const Sampling sampling : {Sampling::centers, Sampling::nearest}) {
    const int n = 64;
    const DepthMap all = render_one(*renderer, eye, n, sampling), some = render_one(*renderer, eye, n, sampling, 30);
    int left_out = 0;
    for (int texel = 0; texel < 6 * n * n; ++texel) {
      const Vec3 d =
          direction_on_face(texel / (n * n), (2 * (texel % n) + 1.0) / n - 1, (2 * (texel / n % n) + 1.0) / n - 1);
      if (d.norm() < 30 * all.inverse_depths[texel] * 0.9) {
        ASSERT_EQ(some.inverse_depths[texel], all.inverse_depths[texel]);
      } else {
        ASSERT_LE(some.inverse_depths[texel], all.inverse_depths[texel]);
        left_out += some.inverse_depths[texel] < all.inverse_depths[texel];
      }
    }
    EXPECT_GT(left_out, 0);
  }
}

TEST(CpuDepth, SurfacesThatTouchTheViewpointHideNothing) {
  const Scene ground = SceneBuilder().ground("ground", 100);
  for (const Sampling sampling : {Sampling::centers, Sampling::nearest}) {
    const DepthMap map = render_scene(ground, {3, 4, 0}, 16, sampling);
    for (int face = 0; face < 4; ++face) {
      for (int row = 0; row < 16; ++row) {
        if (row == 7 || row == 8) continue;  // grazing
        EXPECT_EQ(map.at(face, row, 3), 0) << face << " " << row;
      }
    }
    EXPECT_EQ(map.at(4, 3, 3), 0);
    EXPECT_EQ(map.at(5, 3, 3), 0);
  }
}

TEST(CpuDepth, RefusesBadRequests) {
  const auto renderer = depth::make_cpu_depth_renderer(PreparedScene(SceneBuilder().ground("ground", 100)));
  const auto render = [&](const Vec3& eye, int size, double range) {
    renderer->render({{&eye, 1}, size, Sampling::centers, range}, [](std::size_t, std::span<const float>) { FAIL(); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_error([&] { render({0, 0, 1}, 0, 10); }, ErrorCode::value_out_of_range, "CPU");
  expect_error([&] { render({0, 0, 1}, 100000, 10); }, ErrorCode::value_out_of_range, "CPU");
  expect_error([&] { render({0, nan, 1}, 4, 10); }, ErrorCode::coordinate_not_finite, "viewpoint 0");
  expect_error([&] { render({0, 0, 1e12}, 4, 10); }, ErrorCode::coordinate_too_large, "viewpoint 0");
  expect_error([&] { render({0, 0, 1}, 4, 0); }, ErrorCode::value_out_of_range, "range");
  expect_error([&] { render({0, 0, 1}, 4, nan); }, ErrorCode::value_out_of_range, "range");
}

TEST(CpuDepth, TakesASceneWithoutSurfaces) {
  Scene scene;
  scene.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  scene.mesh.triangles = {{0, 1, 2}};  // without area: dropped
  for (const Sampling sampling : {Sampling::centers, Sampling::nearest}) {
    for (const float q : render_scene(scene, {0, 0, 1}, 4, sampling).inverse_depths) ASSERT_EQ(q, 0);
  }
}

}  // namespace
}  // namespace vantage::testing
