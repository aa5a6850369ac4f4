// Volumes as tours ask them, beside slow and obvious answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flight/tour/tour_detour.h"
#include "flight/tour/tour_half_spaces.h"
#include "flight/tour/tour_region.h"
#include "support/random.h"
#include "support/solids.h"
#include "support/tour_judge.h"

namespace vantage {
namespace {

using internal::flight::tour::HalfSpaces;
using internal::flight::tour::TourRegion;
using internal::flight::tour::way_length;

/// A dome with deep lobes beside a box that overlaps it: not convex, two pieces.
Mesh lobes_and_box(const Vec3& centre, double size) {
  Mesh mesh = testing::make_dome(centre, 24, 6, [=](double azimuth, double elevation) {
                return size * (1 - 0.7 * std::cos(elevation) * std::pow(std::sin(1.5 * azimuth), 2));
              }).mesh;
  testing::append(mesh,
                  testing::make_box_mesh(centre + Vec3(3, 3, 0.2) * size / 2, centre + Vec3(4, 4.5, 1.4) * size / 2));
  return mesh;
}

TEST(TourRegion, TouchesAreInsideAndAboutAsShortAsTheyCanBe) {
  testing::Random random(41);
  double worst = 0;
  for (const double offset : {0.0, 5e6}) {
    for (const double size : {1e-2, 1.0, 50.0, 1e4}) {
      if (offset > 0 && size < 1) continue;  // below what such coordinates can tell
      SCOPED_TRACE(size);
      const Vec3 centre(offset, offset, 0);
      const Mesh mesh = lobes_and_box(centre, size);
      const double margin = random.chance(0.5) ? 0.02 * size : 0;
      const TourRegion region("lobes", mesh, margin);
      for (int i = 0; i < 40; ++i) {
        const Vec3 a = centre + random.point(-3, 3) * size, b = centre + random.point(-3, 3) * size;
        const Vec3 x = region.touch(a, b);
        EXPECT_GE(testing::slow_depth(mesh, x), margin);
        const double found = way_length(a, x, b, 0);
        EXPECT_GE(found, region.touch_bound_m(a, b) * (1 - 1e-9));
        // Many points of the mesh, drawn; those deep enough are no better, but for a little.
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 300; ++k) {
          const Vec3 p = random.in_box(region.box());
          if (way_length(a, p, b, 0) < std::min(least, found) && testing::slow_depth(mesh, p) >= margin) {
            least = way_length(a, p, b, 0);
          }
        }
        worst = std::max(worst, found / least - 1);
        EXPECT_LE(found, least * 1.05);
        // A point that is known and better is given back, or one that is better still.
        const Vec3 near = region.touch(x, x, 0, &x);
        EXPECT_LE((near - x).norm(), 1e-9 * size);
      }
    }
  }
  RecordProperty("worst", std::to_string(worst));
}

TEST(TourRegion, StretchesAreInsideAndMissLittle) {
  testing::Random random(42);
  double held = 0, found = 0;
  for (int i = 0; i < 60; ++i) {
    const double size = std::pow(10, random.uniform(-1, 3));
    const Mesh mesh = lobes_and_box(Vec3::Zero(), size);
    const double margin = random.uniform(0, 0.03) * size;
    const TourRegion region("lobes", mesh, margin);
    const Leg leg = {random.point(-2.5, 2.5) * size, random.point(-2.5, 2.5) * size};
    const std::vector<LegInterval> parts = region.stretches(leg);
    double before = -1;
    for (const LegInterval& part : parts) {
      EXPECT_GT(part.begin, before);
      EXPECT_LE(part.begin, part.end);
      before = part.end;
      found += (part.end - part.begin) * (leg.to - leg.from).norm() / size;
    }
    constexpr int kSamples = 200;
    for (int k = 0; k < kSamples; ++k) {
      const double share = (k + 0.5) / kSamples;
      const double depth = testing::slow_depth(mesh, leg.from + share * (leg.to - leg.from));
      const bool is_in = std::any_of(parts.begin(), parts.end(),
                                     [&](const LegInterval& p) { return share >= p.begin && share <= p.end; });
      if (is_in) {
        EXPECT_GE(depth, margin);
      } else {
        EXPECT_LE(depth, margin + 3 * TourRegion::kGrain * region.size_m());
      }
      if (depth >= margin) held += (leg.to - leg.from).norm() / size / kSamples;
    }
    EXPECT_EQ(region.holds_leg(leg), parts.size() == 1 && parts[0] == (LegInterval{0, 1}));
  }
  EXPECT_GT(found, 1);
  EXPECT_NEAR(found, held, 0.05 * held);
}

TEST(TourRegion, ThinVolumes) {
  // A plate of 400 m and 2.1 m: a margin of 1 m leaves a tenth of a metre of it.
  const TourRegion plate("plate", testing::make_box_mesh({-200, -200, 0}, {200, 200, 2.1}), 1);
  const Vec3 x = plate.touch({-300, 0, 50}, {300, 0, 50});
  EXPECT_GE(x.z(), 1);
  EXPECT_LE(x.z(), 1.1 + 1e-6);
  EXPECT_NEAR(x.x(), 0, 0.5);
}

TEST(HalfSpaces, GiveTheShortestWay) {
  testing::Random random(43);
  for (int i = 0; i < 200; ++i) {
    HalfSpaces spaces;
    std::vector<std::pair<Vec3, double>> all;
    for (int k = random.integer(1, 6); k > 0; --k) {
      all.emplace_back(random.direction(), random.uniform(-1, 0.5));
      spaces.add(all.back().first, all.back().second);
    }
    const Vec3 a = random.point(-3, 3), b = random.point(-3, 3);
    const auto holds = [&](const Vec3& p, double slack) {
      return std::all_of(all.begin(), all.end(), [&](const auto& s) { return s.first.dot(p) >= s.second - slack; });
    };
    const std::optional<Vec3> x = spaces.shortest_way(a, b, 0);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 4000; ++k) {
      const Vec3 p = random.point(-4, 4);
      if (holds(p, 0)) least = std::min(least, way_length(a, p, b, 0));
    }
    if (!x) {
      EXPECT_EQ(least, std::numeric_limits<double>::infinity());
      continue;
    }
    EXPECT_TRUE(holds(*x, 1e-9));
    EXPECT_LE(way_length(a, *x, b, 0), least * (1 + 1e-9));
  }
}

}  // namespace
}  // namespace vantage
