// Fraction fields: what is told of a box of points against points drawn in it, and fields against
// PointQuery::fractions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "support/internals.h"
#include "support/progress_check.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/progress.h"
#include "vantage/query.h"

namespace vantage {
namespace {

using testing::Random;
using testing::SceneBuilder;
using testing::target_of;

constexpr double kFar = 1000;

Target ten_metre_square() { return target_of({{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}); }

PreparedTarget prepared(const Scene& scene, const Target& target) {
  return {PreparedScene(scene), target, Sensor{.max_range_m = kFar}};
}

Vec3 centre_of(const VoxelGrid& grid, std::size_t voxel) {
  const std::size_t row = voxel / grid.count[0];
  return grid.centre(voxel % grid.count[0], row % grid.count[1], row / grid.count[1]);
}

struct Tally {
  std::size_t none = 0, whole = 0, open = 0;
};

/// Looks from points in each voxel, corners among them, and from all centres.
Tally compare_with_points(const PreparedTarget& target, const VoxelGrid& grid, Random& random) {
  PointQuery query(target);
  const std::vector<KnownShare> known = query.known_shares(grid);
  Tally tally;
  std::vector<Vec3> points, centres;
  std::vector<KnownShare> expected;
  EXPECT_EQ(known.size(), grid.size());
  for (std::size_t v = 0; v < known.size(); ++v) {
    centres.push_back(centre_of(grid, v));
    if (known[v] == KnownShare::unknown) {
      ++tally.open;
      continue;
    }
    ++(known[v] == KnownShare::none ? tally.none : tally.whole);
    for (int k = 0; k < 6; ++k) {
      Vec3 aside = random.point(-0.5, 0.5);
      if (k < 3) aside = aside.cwiseSign() * 0.5;
      points.emplace_back(centres.back() + grid.step_m * aside);
      expected.push_back(known[v]);
    }
  }
  const std::vector<PointFraction> found = query.fractions(points);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double share = expected[i] == KnownShare::none ? 0 : 1;
    if (found[i].fraction == share) continue;
    if (++wrong <= 3) ADD_FAILURE() << found[i].fraction << " instead of " << share << " at " << points[i].transpose();
  }
  EXPECT_EQ(wrong, 0U);
  const FractionField field = query.fraction_field(grid);
  EXPECT_EQ(field.evaluated, tally.open);
  const std::vector<PointFraction> at_centres = PointQuery(target).fractions(centres);
  std::size_t different = 0;
  for (std::size_t v = 0; v < centres.size(); ++v) different += field.shares[v] == at_centres[v].fraction ? 0 : 1;
  EXPECT_EQ(different, 0U);
  return tally;
}

TEST(FractionField, IsWhatPointsOfRandomCitiesSee) {
  Random random(7301);
  Tally sum;
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const Scene scene = testing::random_city(random, 30, 12);
    const double turn = random.uniform(-0.6, 0.6);
    const Vec3 up = round % 3 == 0 ? Vec3::UnitZ() : Vec3(turn, random.uniform(-0.6, 0.6), 1);
    const Target target =
        testing::random_target(random, random.integer(3, 7), random.uniform(1, 6), {0, 0, random.uniform(4, 9)}, up);
    const VoxelGrid grid{{-80, -70, -2}, random.uniform(3, 4), {40, 37, 17}};
    const Tally tally = compare_with_points(prepared(scene, target), grid, random);
    sum.none += tally.none;
    sum.whole += tally.whole;
    sum.open += tally.open;
  }
  std::cout << sum.none << " voxels see nothing, " << sum.whole << " all, " << sum.open << " were looked from\n";
  EXPECT_GT(sum.none, 20'000U);
  EXPECT_GT(sum.whole, 20'000U);
}

// No corner of a box of 32^3 voxels is near to what the plate hides.
TEST(FractionField, MissesNoSmallRegion) {
  SceneBuilder scene;
  scene.polygon("plate", {{20.3, 20.3, 20}, {20.7, 20.3, 20}, {20.7, 20.7, 20}, {20.3, 20.7, 20}});
  const PreparedTarget target = prepared(scene, target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}));
  const FractionField field = PointQuery(target).fraction_field({{0, 0, 1}, 1, {32, 32, 32}});
  const auto hidden = static_cast<std::size_t>(
      std::count_if(field.shares.begin(), field.shares.end(), [](double share) { return share < 1; }));
  EXPECT_GT(hidden, 0U);
  EXPECT_LT(hidden, 100U);
  EXPECT_GE(field.evaluated, hidden);
  EXPECT_LT(field.evaluated, 400U) << "of 32768";
}

// Neither wall hides all of the square; no voxel behind them must be looked from.
TEST(FractionField, KnowsWhatWallsHideTogether) {
  SceneBuilder scene;
  Mesh walls;
  walls.vertices = {{10, 0, -1}, {20, -40, -1}, {20, 40, -1}, {10, 0, 50}, {20, -40, 50}, {20, 40, 50}};
  walls.triangles = {{0, 1, 4}, {0, 4, 3}, {0, 2, 5}, {0, 5, 3}};
  scene.add("walls", walls);
  const VoxelGrid grid{{30, -8, 2}, 2, {8, 8, 4}};
  PointQuery query(prepared(scene, ten_metre_square()));
  const std::vector<KnownShare> known = query.known_shares(grid);
  EXPECT_EQ(std::count(known.begin(), known.end(), KnownShare::none), 256);
  SceneBuilder apart;  // by a slit
  apart.polygon("left", {{10, 0.01, -1}, {20, 40, -1}, {20, 40, 50}, {10, 0.01, 50}})
      .polygon("right", {{10, -0.01, -1}, {20, -40, -1}, {20, -40, 50}, {10, -0.01, 50}});
  const FractionField field = PointQuery(prepared(apart, ten_metre_square())).fraction_field(grid);
  EXPECT_EQ(field.evaluated, 256U);
  EXPECT_EQ(std::count(field.shares.begin(), field.shares.end(), 0.0), 0);
}

TEST(FractionField, OfPartsAndOfPoints) {
  Random random(7302);
  const Scene scene = testing::random_city(random, 25, 12);
  Target parts = target_of({{-6, -6, 3}, {-2, -6, 3}, {-2, 6, 3}, {-6, 6, 3}});
  parts.parts.push_back({{2, -5, 4}, {7, -5, 6}, {7, 5, 6}, {2, 5, 4}});
  const VoxelGrid grid{{-60, -60, -3}, 4, {30, 30, 10}};
  const Tally of_parts = compare_with_points(prepared(scene, parts), grid, random);
  EXPECT_GT(of_parts.none, 0U);
  EXPECT_GT(of_parts.whole, 0U);
  Target point = Target::point({0.5, 0.25, 8});
  for (const bool is_seen_from_all_sides : {true, false}) {
    SCOPED_TRACE(is_seen_from_all_sides);
    if (!is_seen_from_all_sides) point.front = Vec3(1, 0, 1);
    const Tally tally = compare_with_points(prepared(scene, point), grid, random);
    EXPECT_GT(tally.none, 500U);
    EXPECT_GT(tally.whole, 1000U);
    EXPECT_LT(tally.open, grid.size() / 3);
  }
}

TEST(FractionField, EndsAtTheRange) {
  SceneBuilder scene;
  scene.ground("ground", 100, -1);
  PointQuery query(prepared(scene, ten_metre_square()));
  const VoxelGrid grid{{-40, -40, 0.5}, 2, {40, 40, 20}};
  const FractionField field = query.fraction_field(grid, {.max_range_m = 30});
  for (std::size_t v = 0; v < grid.size(); ++v) {
    const Vec3 p = centre_of(grid, v);
    const double farthest = Vec3(std::abs(p.x()) + 5, std::abs(p.y()) + 5, p.z()).norm();
    if (std::abs(farthest - 30) < 0.01) continue;  // the target is raised a little
    ASSERT_EQ(field.shares[v], farthest < 30 ? 1 : 0) << p.transpose();
  }
  EXPECT_EQ(field.evaluated, 0U);
}

TEST(FractionField, DoesNotDependOnThreadsOrOnWhatWasAsked) {
  Random random(7303);
  const PreparedTarget target = prepared(testing::random_city(random, 20, 12), ten_metre_square());
  const VoxelGrid grid{{-60, -60, 0.5}, 2.5, {48, 48, 16}};
  PointQuery asked(target);
  const std::vector<double> shares = asked.fraction_field(grid).shares;
  EXPECT_EQ(asked.fraction_field(grid).shares, shares);
  for (const int threads : {1, 4}) {
    with_threads(threads, [&] { EXPECT_EQ(PointQuery(target).fraction_field(grid).shares, shares); });
  }
}

TEST(FractionField, TellsItsProgress) {
  SceneBuilder scene;
  scene.box("house", {8, -5, -1}, {18, 5, 12});
  const PreparedTarget target = prepared(scene, ten_metre_square());
  const auto story = testing::check_progress([&](const Progress& progress) {
    PointQuery(target).fraction_field({{-40, -40, 0}, 2, {40, 40, 20}}, {}, progress);
  });
  EXPECT_EQ(story.last_fraction.at("dividing space"), 1);
  const char* const stage = "looking from voxels";
  EXPECT_EQ(story.last_fraction.at(stage), 1);
}

TEST(FractionField, RefusesBadGrids) {
  SceneBuilder scene;
  scene.ground("ground", 50, -1);
  PointQuery query(prepared(scene, ten_metre_square()));
  const auto refused = [&](const VoxelGrid& grid, ErrorCode code) {
    testing::expect_error([&] { query.fraction_field(grid); }, code, "grid of voxels");
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  refused({{0, 0, kNan}, 1, {2, 2, 2}}, ErrorCode::coordinate_not_finite);
  refused({{0, 0, 0}, 0, {2, 2, 2}}, ErrorCode::value_out_of_range);
  refused({{0, 0, 0}, kNan, {2, 2, 2}}, ErrorCode::value_out_of_range);
  refused({{0, 0, 0}, 1, {2, 0, 2}}, ErrorCode::value_out_of_range);
  refused({{0, 0, 0}, 1, {1u << 20, 1u << 20, 2}}, ErrorCode::value_out_of_range);
  refused({{0, 0, 0}, 1e9, {2, 1, 1}}, ErrorCode::coordinate_too_large);
  testing::expect_error([&] { query.fraction_field({}, {.max_range_m = -1}); }, ErrorCode::value_out_of_range,
                        "max_range");
  Sensor link{.max_range_m = 50};
  link.link.emplace();
  link.link->frequency_ghz = 2.4;
  PointQuery linked(PreparedTarget(PreparedScene(scene), Target::point({0, 0, 5}), link));
  testing::expect_error([&] { linked.known_shares({}); }, ErrorCode::not_applicable, "sensor.link");
}

}  // namespace
}  // namespace vantage
