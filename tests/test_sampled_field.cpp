// Fraction fields from depth images, against exact ones, and one device against the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "support/internals.h"
#include "support/opengl.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/fraction.h"
#include "vantage/progress.h"
#include "vantage/query.h"

namespace vantage {
namespace {

using testing::Random;
using testing::SceneBuilder;

SampleOptions options_of(std::size_t samples, int cubemap, DeviceChoice::Kind device = DeviceChoice::Kind::cpu) {
  SampleOptions options;
  options.samples = samples;
  options.cubemap = cubemap;
  options.device.kind = device;
  return options;
}

/// A city, and a square above its ground.
PreparedTarget in_random_city(Random& random) {
  const Target target = testing::random_target(random, 5, 6, {0, 0, 3}, {0.1, -0.2, 1});
  return {PreparedScene(testing::random_city(random, 30, 12)), target, Sensor{.max_range_m = 300}};
}

constexpr std::size_t kSamples = 144;

/// No centre of a voxel is on a wall: these have whole and half metres.
VoxelGrid around() { return {{-60.13, -60.17, 0.1}, 3, {40, 40, 15}}; }

TEST(SampledField, SamplesLieEvenlyOnTheTarget) {
  SceneBuilder scene;
  scene.ground("ground", 100, -1);
  Target target = testing::target_of({{0, 0, 0}, {8, 0, 0}, {8, 4, 0}, {0, 4, 0}});
  target.parts.push_back({{10, 0, 0}, {14, 0, 0}, {14, 4, 0}, {10, 4, 0}});
  const PreparedTarget prepared(PreparedScene(scene), target, Sensor{.max_range_m = 100});
  const std::vector<Vec3> samples = target_samples(prepared, 600);
  ASSERT_EQ(samples.size(), 600U);
  const auto in = [&](double x0, double x1, double y0, double y1) {
    return std::count_if(samples.begin(), samples.end(), [&](const Vec3& s) {
      return s.x() >= x0 && s.x() <= x1 && s.y() >= y0 && s.y() <= y1 && std::abs(s.z()) < 3e-3;
    });
  };
  EXPECT_EQ(in(0, 8, 0, 4) + in(10, 14, 0, 4), 600);
  EXPECT_NEAR(static_cast<double>(in(10, 14, 0, 4)), 200, 3);
  for (int x : {0, 2, 4, 6, 10, 12}) {
    for (int y : {0, 2}) EXPECT_NEAR(static_cast<double>(in(x, x + 2, y, y + 2)), 50, 8) << x << " " << y;
  }
  const std::vector<Vec3> fewer = target_samples(prepared, 17);
  EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), samples.begin())) << "the first ones of more";
}

TEST(SampledField, IsNearToTheExactOne) {
  Random random(7311);
  const PreparedTarget target = in_random_city(random);
  const std::vector<double> exact = PointQuery(target).fraction_field(around()).shares;
  const std::vector<KnownShare> known = PointQuery(target).known_shares(around());
  const SampledField sampled = estimate_fraction_field(target, around(), options_of(kSamples, 256));
  EXPECT_EQ(sampled.device.kind, DeviceKind::cpu);
  std::vector<double> errors;
  double mean = 0;
  for (std::size_t v = 0; v < exact.size(); ++v) {
    const double error = std::abs(sampled.field.shares[v] - exact[v]);
    if (known[v] != KnownShare::unknown) {
      ASSERT_EQ(error, 0);
    } else {
      errors.push_back(error);
      mean += error;
    }
  }
  ASSERT_GT(errors.size(), 2000U);
  ASSERT_EQ(errors.size(), sampled.field.evaluated);
  std::sort(errors.begin(), errors.end());
  const double of_most = errors[errors.size() * 95 / 100], allowed = 1 / std::sqrt(static_cast<double>(kSamples));
  std::cout << errors.size() << " voxels: mean error " << mean / static_cast<double>(errors.size()) << ", 95 % "
            << of_most << ", worst " << errors.back() << "\n";
  EXPECT_LT(of_most, allowed);
  EXPECT_LT(mean / static_cast<double>(errors.size()), 0.5 * allowed);
}

TEST(SampledField, DoesNotDependOnThreads) {
  Random random(7312);
  const PreparedTarget target = in_random_city(random);
  const auto shares = [&] { return estimate_fraction_field(target, around(), options_of(20, 64)).field.shares; };
  const std::vector<double> all = shares();
  with_threads(1, [&] { EXPECT_EQ(shares(), all); });
}

TEST(SampledField, IsTheSameByOpenGl) {
  VANTAGE_REQUIRE_OPENGL();
  Random random(7313);
  const PreparedTarget target = in_random_city(random);
  const auto shares = [&](DeviceChoice::Kind kind) {
    const SampledField sampled = estimate_fraction_field(target, around(), options_of(kSamples, 128, kind));
    std::cout << sampled.device.name << "\n";
    EXPECT_EQ(sampled.device.kind == DeviceKind::cpu, kind == DeviceChoice::Kind::cpu);
    return sampled.field.shares;
  };
  const std::vector<double> cpu = shares(DeviceChoice::Kind::cpu), opengl = shares(DeviceChoice::Kind::opengl);
  double decisions = 0, worst = 0;
  for (std::size_t v = 0; v < cpu.size(); ++v) {
    const double samples = std::abs(cpu[v] - opengl[v]) * kSamples;
    decisions += samples;
    worst = std::max(worst, samples);
  }
  std::cout << decisions << " samples of " << cpu.size() * kSamples << " differ, " << worst << " in one voxel\n";
  EXPECT_LT(decisions, 1e-4 * static_cast<double>(cpu.size() * kSamples));
  EXPECT_LE(worst, 3);
}

TEST(SampledField, RefusesWhatItCannotDo) {
  SceneBuilder scene;
  scene.ground("ground", 100, -1);
  const PreparedScene prepared(scene);
  const PreparedTarget square(prepared, testing::target_of({{0, 0, 0}, {8, 0, 0}, {8, 4, 0}}), {.max_range_m = 100});
  const auto refused = [&](const PreparedTarget& target, const SampleOptions& options, ErrorCode code,
                           const std::string& where) {
    testing::expect_error([&] { estimate_fraction_field(target, {}, options); }, code, where);
  };
  refused(square, options_of(0, 8), ErrorCode::value_out_of_range, "samples");
  refused(square, options_of(65536, 8), ErrorCode::value_out_of_range, "samples");
  refused(square, options_of(4, 0), ErrorCode::value_out_of_range, "cubemap");
  const PreparedTarget point(prepared, Target::point({0, 0, 5}), {.max_range_m = 100});
  refused(point, options_of(4, 8), ErrorCode::not_applicable, "samples");
}

}  // namespace
}  // namespace vantage
