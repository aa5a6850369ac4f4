// OverClaimBound: how far blockers rise above facets, against looking at many places.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>

#include "exact/collect.h"
#include "exact/gauge.h"
#include "exact/over_claim_bound.h"
#include "scene/prepared_data.h"
#include "support/random.h"
#include "support/scenes.h"

namespace vantage::internal::exact {
namespace {

using testing::Random;

/// A target in the middle of a small city, and what may hide it.
class RiseOverFacets : public ::testing::Test {
 protected:
  RiseOverFacets() {
    Target target;
    target.parts[0] = {{-1, -1, 0.5}, {1, -1, 0.5}, {0, 1, 0.5}};
    const TargetFrame frame = make_target_frame(target);
    const PreparedScene prepared(testing::random_city(random_, 30, 3));
    const target::LocalTarget local = target::make_local_target(frame.polygon, 1e-9, 0);
    range_.emplace(frame.polygon, 90);
    tree_.emplace(blockers_, *range_);
    collect_blockers(prepared.data(), frame, local, *range_, blockers_, *tree_, {});
  }

  GaugeValue gauge_at(const OctahedralPoint& p) const { return evaluate_gauge(blockers_, *tree_, *range_, p); }

  OctahedralPoint draw(int quadrant) {
    for (;;) {
      const double a = random_.uniform(0, 1), b = random_.uniform(0, 1);
      if (a + b < 1) return {quadrant & 1 ? -a : a, quadrant & 2 ? -b : b};
    }
  }

  /// A triangle about a random place, small ones as often as large ones.
  std::array<OctahedralPoint, 3> draw_triangle(int quadrant) {
    const OctahedralPoint about = draw(quadrant);
    const double size = random_.chance(0.5) ? 0.02 : 0.5;
    std::array<OctahedralPoint, 3> points;
    for (OctahedralPoint& p : points) p = about + size * (draw(quadrant) - about);
    return points;
  }

  /// The greatest rise of a blocker over the facet at the places of a fine grid.
  double looked_up(const std::array<OctahedralPoint, 3>& points, const std::array<double, 3>& gauges) const {
    constexpr int kSteps = 60;
    double greatest = 0;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const double a = static_cast<double>(i) / kSteps, b = static_cast<double>(j) / kSteps, c = 1 - a - b;
        const GaugeValue gauge = gauge_at(a * points[0] + b * points[1] + c * points[2]);
        if (gauge.blocker == GaugeValue::kRange) continue;
        greatest = std::max(greatest, gauge.value / (a * gauges[0] + b * gauges[1] + c * gauges[2]) - 1);
      }
    }
    return greatest;
  }

  Random random_{3};
  BlockerSet blockers_;
  std::optional<target::RangeRegion> range_;
  std::optional<DirectionTree> tree_;
};

TEST_F(RiseOverFacets, IsNeverLessThanWhatIsSeen) {
  OverClaimBound check(blockers_, *tree_);
  int risen = 0, level = 0;
  for (int round = 0; round < 800; ++round) {
    const int quadrant = round % 4;
    const std::array<OctahedralPoint, 3> points = draw_triangle(quadrant);
    std::array<double, 3> gauges;
    for (std::size_t i = 0; i < 3; ++i)
      gauges[i] = gauge_at(points[i]).value * (random_.chance(0.3) ? random_.uniform(1, 1.5) : 1);
    const double seen = looked_up(points, gauges), found = check.greatest_rise(quadrant, points, gauges, 1e-9);
    EXPECT_GE(found, seen - 1e-9) << round;
    risen += seen > 1e-9;
    level += found == 0;
    if (found == 0) continue;
    // Covered, nothing rises any more.
    for (double& gauge : gauges) gauge *= 1 + found;
    EXPECT_EQ(check.greatest_rise(quadrant, points, gauges, 1e-9), 0) << round;
  }
  EXPECT_GT(risen, 100);
  EXPECT_GT(level, 100);
}

TEST_F(RiseOverFacets, IsCloseToWhatIsSeen) {
  OverClaimBound check(blockers_, *tree_);
  double bounds = 0, seen = 0;
  for (int round = 0; round < 400; ++round) {
    const std::array<OctahedralPoint, 3> points = draw_triangle(round % 4);
    std::array<double, 3> gauges;
    for (std::size_t i = 0; i < 3; ++i) gauges[i] = gauge_at(points[i]).value;
    bounds += check.greatest_rise(round % 4, points, gauges, 1e-9);
    seen += looked_up(points, gauges);
  }
  EXPECT_GT(seen, 1);
  EXPECT_LT(bounds, 2 * seen);
}

}  // namespace
}  // namespace vantage::internal::exact
