// query_points against the mesh that compute_visibility makes of the same target.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>
#include <random>

#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

Scene walls() {
  Scene scene;
  scene.objects = {"east wall", "roof"};
  scene.mesh.vertices = {{10, -5, 0},   {10, 5, 0},   {10, 5, 8},  {10, -5, 8},
                         {-20, -4, 12}, {-8, -4, 12}, {-8, 4, 12}, {-20, 4, 12}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  scene.object_of = {0, 0, 1, 1};
  return scene;
}

Target square() {
  Target target;
  target.vertices = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
  return target;
}

TEST(Query, NamesWhatHidesAndByHowMuch) {
  const PreparedScene scene(walls());
  const auto answers =
      query_points(scene, square(), {50}, {}, {{0, 0, 20}, {20, 0, 1}, {-30, 0, 20}, {0, 0, 60}, {0, 0, -1}});
  EXPECT_TRUE(answers[0].inside);
  // Straight up the range ends where the corners are 50 m away.
  EXPECT_NEAR(answers[0].margin_m, std::sqrt(50.0 * 50 - 50) - 20, 1e-9);
  EXPECT_FALSE(answers[1].inside);
  EXPECT_EQ(answers[1].blocked_by, std::vector<std::string>{"east wall"});
  EXPECT_NEAR(answers[1].margin_m, std::hypot(10, 0.5) - std::hypot(20, 1), 1e-9);
  EXPECT_EQ(answers[2].blocked_by, std::vector<std::string>{"roof"});
  EXPECT_TRUE(answers[3].out_of_range);
  EXPECT_TRUE(answers[4].behind_target);
  EXPECT_LT(answers[4].margin_m, 0);
}

TEST(Query, NamesTheLimitsThatArePassed) {
  Navigation navigation;
  navigation.altitude = {5, 30};
  navigation.boxes = {{Vec3(-10, -10, 0), Vec3(10, 10, 40)}};
  navigation.keep_out = {{Vec3(-1, -1, 15), Vec3(1, 1, 25)}};
  const PreparedScene scene(walls());
  const auto answers =
      query_points(scene, square(), {50}, navigation, {{0, 0, 10}, {0, 0, 20}, {0, 0, 35}, {0, 12, 20}, {0, 3, 2}});
  EXPECT_TRUE(answers[0].inside);
  EXPECT_EQ(answers[1].outside_of, std::vector<std::string>{"keep_out 0"});
  EXPECT_EQ(answers[2].outside_of, std::vector<std::string>{"altitude max"});
  EXPECT_EQ(answers[3].outside_of, std::vector<std::string>{"boxes"});
  EXPECT_EQ(answers[4].outside_of, std::vector<std::string>{"altitude min"});
}

TEST(Query, AgreesWithTheMesh) {
  const PreparedScene scene(walls());
  const Volume volume = compute_visibility(scene, square(), {50}, {0.05, 0});
  const unsigned seed = 20240817;
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> side(-50, 50), up(0.01, 50);
  std::vector<Vec3> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(side(random), side(random), up(random));
  const auto answers = query_points(scene, square(), {50}, {}, points);
  int inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(answers[i].margin_m) < 0.1) continue;  // the mesh's own tolerance
    double winding = 0;
    for (const Triangle& t : volume.mesh.triangles) {
      const Vec3 a = volume.mesh.vertices[t[0]] - points[i], b = volume.mesh.vertices[t[1]] - points[i],
                 c = volume.mesh.vertices[t[2]] - points[i];
      winding += std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                   b.dot(c) * a.norm() + c.dot(a) * b.norm());
    }
    EXPECT_EQ(answers[i].inside, winding > M_PI) << points[i].transpose();
    EXPECT_EQ(answers[i].inside, answers[i].margin_m > 0) << points[i].transpose();
    inside += answers[i].inside;
  }
  EXPECT_GT(inside, 200);
}

TEST(Query, RefusesPointsThatAreNotNumbers) {
  EXPECT_THROW(query_points(PreparedScene(walls()), square(), {50}, {}, {{NAN, 0, 0}}), Error);
}

TEST(Query, OutOfReachOfEveryone) {
  const auto answers = query_points(PreparedScene(walls()), square(), {6}, {}, {{0, 0, 1}});
  EXPECT_TRUE(answers[0].out_of_range);
  EXPECT_FALSE(answers[0].inside);
}

}  // namespace
}  // namespace vantage
