// The fewest positions that see all targets, and how many are necessary: boxes, where both are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/random.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/solid.h"
#include "vantage/tour.h"

namespace vantage {
namespace {

using testing::expect_error;
using testing::make_box_mesh;
using testing::Random;

constexpr double kMargin = 0.5;

/// A union of boxes that do not meet.
using Boxes = std::vector<Box>;

Mesh mesh_of(const Boxes& boxes) {
  Mesh mesh;
  for (const Box& box : boxes) testing::append(mesh, make_box_mesh(box.min, box.max));
  return mesh;
}

FewestTarget target_of(const std::string& name, const Boxes& boxes) {
  FewestTarget target{name, mesh_of(boxes)};
  target.outer = [mesh = target.volume](const Progress&) { return mesh; };
  return target;
}

FewestRequest request_of(const std::vector<Boxes>& volumes) {
  FewestRequest request;
  request.margin_m = kMargin;
  for (const Boxes& boxes : volumes) {
    request.targets.push_back(target_of("T" + std::to_string(request.targets.size()), boxes));
  }
  return request;
}

double depth_in(const Boxes& boxes, const Vec3& p) {
  double depth = -std::numeric_limits<double>::infinity();
  for (const Box& box : boxes) depth = std::max({depth, std::min((p - box.min).minCoeff(), (box.max - p).minCoeff())});
  return depth;
}

/// Whether the boxes, each made smaller by the margin on every side, have a common point, as closed sets.
bool have_common(const std::vector<Boxes>& volumes, unsigned group, double margin) {
  Boxes common = {{Vec3::Constant(-1e9), Vec3::Constant(1e9)}};
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if ((group >> i & 1U) == 0) continue;
    Boxes next;
    for (const Box& a : common) {
      for (const Box& b : volumes[i]) {
        const Vec3 more = Vec3::Constant(margin);
        const Box both = {a.min.cwiseMax(b.min + more), a.max.cwiseMin(b.max - more)};
        if (!both.empty()) next.push_back(both);
      }
    }
    common = std::move(next);
  }
  return !common.empty();
}

/// By all divisions into groups: the fewest of which each has a common point.
std::size_t fewest(const std::vector<Boxes>& volumes, double margin) {
  const unsigned all = (1U << volumes.size()) - 1;
  std::vector<std::size_t> least(all + 1, 99);
  least[0] = 0;
  for (unsigned held = 1; held <= all; ++held) {
    for (unsigned group = held; group > 0; group = (group - 1) & held) {
      if (have_common(volumes, group, margin)) least[held] = std::min(least[held], least[held & ~group] + 1);
    }
  }
  return least[all];
}

void judge(const std::vector<Boxes>& volumes, const FewestPositions& found, double margin = kMargin) {
  std::vector<int> assigned(volumes.size(), 0);
  for (const HoverPosition& one : found.positions) {
    EXPECT_FALSE(one.assigned.empty());
    double depth = std::numeric_limits<double>::infinity();
    for (const std::size_t i : one.assigned) {
      ++assigned[i];
      depth = std::min(depth, depth_in(volumes[i], one.position));
      EXPECT_TRUE(std::binary_search(one.sees.begin(), one.sees.end(), i));
    }
    EXPECT_GE(depth, margin - 1e-9);
    EXPECT_NEAR(depth, one.depth_m, 1e-9);
    for (std::size_t i = 0; i < volumes.size(); ++i) {
      EXPECT_EQ(std::binary_search(one.sees.begin(), one.sees.end(), i), depth_in(volumes[i], one.position) >= margin);
    }
  }
  for (const std::size_t i : found.unseen) ++assigned[i];
  EXPECT_EQ(assigned, std::vector<int>(volumes.size(), 1)) << "each target once";
  for (const std::size_t a : found.apart) {
    for (const std::size_t b : found.apart) {
      EXPECT_TRUE(a == b || !have_common(volumes, 1U << a | 1U << b, 0)) << a << " and " << b;
    }
  }
}

/// On a grid: sides that touch are drawn often.
Box random_box(Random& random, double spread, const Vec3& at) {
  const auto draw = [&](int low, int high) { return 0.5 * random.integer(2 * low, 2 * high); };
  const double x = draw(0, static_cast<int>(spread)), y = draw(0, static_cast<int>(spread)), z = draw(0, 4);
  const Vec3 min = at + Vec3(x, y, z);
  return {min, min + Vec3(draw(3, 12), draw(3, 12), draw(3, 12))};
}

TEST(FewestPositions, OfBoxesAreAsFewAsThereAre) {
  Random random(421);
  int proved = 0, more_than_apart = 0;
  for (int round = 0; round < 60; ++round) {
    const Vec3 at = round % 3 == 0 ? Vec3(691000, 5334000, 500) : Vec3(0, 0, 0);
    std::vector<Boxes> volumes;
    const int count = random.integer(1, 7), spread = random.integer(4, 40);
    for (int i = 0; i < count; ++i) {
      volumes.push_back({random_box(random, spread, at)});
      if (random.chance(0.3)) volumes.back().push_back(random_box(random, spread, at + Vec3(100, 0, 0)));
    }
    const FewestPositions found = fewest_positions(request_of(volumes));
    SCOPED_TRACE("round " + std::to_string(round));
    judge(volumes, found);
    EXPECT_TRUE(found.unseen.empty());
    EXPECT_GE(found.positions.size(), fewest(volumes, kMargin));
    // What is only just as wide as the margin may be missed.
    EXPECT_LE(found.positions.size(), fewest(volumes, kMargin + 0.2));
    EXPECT_EQ(found.necessary, std::min(found.positions.size(), fewest(volumes, 0))) << "boxes that touch meet";
    proved += found.is_proved() ? 1 : 0;
    more_than_apart += found.necessary > std::max<std::size_t>(1, found.apart.size()) ? 1 : 0;
    EXPECT_EQ(found.reason == FewestPositions::Reason::groups,
              found.necessary > std::max<std::size_t>(1, found.apart.size()));
  }
  EXPECT_GT(proved, 30);
  std::cout << proved << " proved, " << more_than_apart << " by groups\n";
}

TEST(FewestPositions, ThreeThatMeetInPairsNeedTwo) {
  const auto cube = [](double x) { return Box{{x, 0, 0}, {x + 4, 4, 4}}; };
  const std::vector<Boxes> volumes = {{cube(0), cube(10)}, {cube(0), cube(20)}, {cube(10), cube(20)}};
  const FewestPositions found = fewest_positions(request_of(volumes));
  judge(volumes, found);
  EXPECT_EQ(found.positions.size(), 2U);
  EXPECT_EQ(found.necessary, 2U);
  EXPECT_EQ(found.reason, FewestPositions::Reason::groups);
  EXPECT_TRUE(found.apart.empty()) << "each two of them meet";
}

TEST(FewestPositions, NothingIsKnownAgainstTargetsWithoutOuterMesh) {
  const std::vector<Boxes> volumes = {{{{0, 0, 0}, {4, 4, 4}}}, {{{10, 0, 0}, {14, 4, 4}}}};
  FewestRequest request = request_of(volumes);
  EXPECT_EQ(fewest_positions(request).necessary, 2U);
  request.targets[0].outer_rounding_m = 6.1;
  EXPECT_EQ(fewest_positions(request).necessary, 1U) << "positions may lie 6.1 m outside";
  request.targets[0].outer_rounding_m = 0;
  request.targets[1].outer = {};
  const FewestPositions found = fewest_positions(request);
  EXPECT_EQ(found.positions.size(), 2U);
  EXPECT_EQ(found.necessary, 1U);
  EXPECT_FALSE(found.is_proved());
}

TEST(FewestPositions, AreAskedByTheTargetItself) {
  // The volumes meet from x = 2 to 8; by the exact answer the first one ends at 3.
  const std::vector<Boxes> volumes = {{{{0, 0, 0}, {8, 8, 8}}}, {{{2, 0, 0}, {12, 8, 8}}}};
  FewestRequest request = request_of(volumes);
  request.targets[0].sees = [](const Vec3& p) { return p.x() <= 3; };
  const FewestPositions found = fewest_positions(request);
  ASSERT_EQ(found.positions.size(), 1U);
  EXPECT_LE(found.positions[0].position.x(), 3);
  EXPECT_GE(found.positions[0].position.x(), 2.5);
  request.targets[0].sees = [](const Vec3& p) { return p.x() <= 2.4; };
  EXPECT_EQ(fewest_positions(request).positions.size(), 2U);
  request.targets[0].sees = [](const Vec3&) { return false; };
  const FewestPositions none = fewest_positions(request);
  EXPECT_EQ(none.unseen, std::vector<std::size_t>{0});
  EXPECT_EQ(none.necessary, 1U) << "for the other one";
  request.targets[1].sees = request.targets[0].sees;
  const FewestPositions nothing = fewest_positions(request);
  EXPECT_TRUE(nothing.positions.empty());
  EXPECT_EQ(nothing.necessary, 0U);
}

class Above : public Airspace {
 public:
  explicit Above(double z) : z_(z) {}
  bool allows(const Leg& leg, double deviation_m) const override {
    return std::min(leg.from.z(), leg.to.z()) - deviation_m >= z_;
  }
  std::string obstacle(const Leg&, double) const override { return "floor"; }
  Box bounds() const override { return {Vec3::Constant(-1e4), Vec3::Constant(1e4)}; }

 private:
  double z_;
};

TEST(FewestPositions, LieWhereFlyingIsAllowed) {
  const std::vector<Boxes> volumes = {{{{0, 0, 0}, {8, 8, 8}}}, {{{2, 0, 0}, {12, 8, 5}}}, {{{0, 0, 0}, {8, 8, 4}}}};
  FewestRequest request = request_of(volumes);
  EXPECT_EQ(fewest_positions(request).positions.size(), 1U);
  request.deviation_m = 0.4;
  request.airspace = std::make_shared<const Above>(4);
  const FewestPositions found = fewest_positions(request);
  judge(volumes, found);
  EXPECT_EQ(found.unseen, std::vector<std::size_t>{2});
  ASSERT_EQ(found.positions.size(), 1U);
  EXPECT_GE(found.positions[0].position.z(), 4.4);
  EXPECT_EQ(found.positions[0].assigned, (std::vector<std::size_t>{0, 1}));
}

TEST(FewestPositions, OfOneTargetIsDeepInside) {
  const FewestPositions found = fewest_positions(request_of({{{{0, 0, 0}, {20, 30, 10}}}}));
  ASSERT_EQ(found.positions.size(), 1U);
  EXPECT_GE(found.positions[0].depth_m, 0.9 * 5);
  EXPECT_TRUE(found.is_proved());
  EXPECT_TRUE(found.apart.empty());
}

TEST(FewestPositions, GivesTheBestSoFarWhenStopped) {
  Random random(422);
  std::vector<Boxes> volumes;
  for (int i = 0; i < 12; ++i) volumes.push_back({random_box(random, 30, {0, 0, 0})});
  for (const std::string_view last : {"outer meshes", "fewer positions"}) {
    const FewestPositions found =
        fewest_positions(request_of(volumes), [&](std::string_view stage, double) { return stage != last; });
    EXPECT_EQ(found.end, FewestPositions::End::cancelled);
    judge(volumes, found);
  }
  testing::expect_code([&] { fewest_positions(request_of(volumes), [](std::string_view, double) { return false; }); },
                       ErrorCode::cancelled);
  FewestRequest request = request_of(volumes);
  request.time_limit_s = 1e-9;
  const FewestPositions late = fewest_positions(request);
  EXPECT_EQ(late.end, FewestPositions::End::time_limit);
  judge(volumes, late);
  EXPECT_GE(late.positions.size(), late.necessary);
}

TEST(FewestPositions, AreTheSameWithAnyNumberOfThreads) {
  Random random(423);
  std::vector<Boxes> volumes;
  for (int i = 0; i < 10; ++i) volumes.push_back({random_box(random, 30, {0, 0, 0})});
  FewestRequest request = request_of(volumes);
  request.threads = 1;
  const FewestPositions one = fewest_positions(request);
  request.threads = 2;
  const FewestPositions two = fewest_positions(request);
  ASSERT_EQ(one.positions.size(), two.positions.size());
  for (std::size_t i = 0; i < one.positions.size(); ++i) {
    EXPECT_EQ(one.positions[i].position, two.positions[i].position);
    EXPECT_EQ(one.positions[i].assigned, two.positions[i].assigned);
  }
}

TEST(FewestPositions, BadRequestsAreRefused) {
  const Boxes box = {{{0, 0, 0}, {8, 8, 8}}};
  expect_error([] { fewest_positions({}); }, ErrorCode::nothing_given, "targets");
  const auto refused = [&](auto change, ErrorCode code, const std::string& where) {
    FewestRequest request = request_of({box, box});
    change(request);
    expect_error([&] { fewest_positions(request); }, code, where);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](FewestRequest& r) { r.margin_m = 0; }, ErrorCode::value_out_of_range, "margin_m");
  refused([&](FewestRequest& r) { r.deviation_m = nan; }, ErrorCode::value_out_of_range, "deviation_m");
  refused([&](FewestRequest& r) { r.time_limit_s = nan; }, ErrorCode::value_out_of_range, "time_limit_s");
  refused([](FewestRequest& r) { r.targets[1].outer_rounding_m = -1; }, ErrorCode::value_out_of_range, "T1");
  refused([](FewestRequest& r) { r.margin_m = 4.5; }, ErrorCode::limits_empty, "T0");
  refused([](FewestRequest& r) { r.targets[1].volume = {}; }, ErrorCode::mesh_empty, "T1");
  refused([](FewestRequest& r) { r.targets[1].volume.triangles.pop_back(); }, ErrorCode::mesh_not_closed, "T1");
}

}  // namespace
}  // namespace vantage
