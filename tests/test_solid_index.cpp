// How deep points lie in closed meshes, and how near these come to each other.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/random.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/solid.h"

namespace vantage {
namespace {

using testing::expect_code;
using testing::make_box_mesh;
using testing::Random;

TEST(SolidIndex, TellsHowDeepPointsLie) {
  for (const Vec3& at : {Vec3(0, 0, 0), Vec3(5e5, 4.8e6, 100)}) {
    const SolidIndex box(make_box_mesh(at, at + Vec3(4, 6, 8)));
    const std::vector<Vec3> places = {at + Vec3(1, 3, 4), at + Vec3(2, 3, 4), at + Vec3(4, 3, 4), at + Vec3(7, 10, 4)};
    const std::vector<double> expected = {1, 2, 0, -5};
    const std::vector<double> depths = box.depths_m(places);
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(depths[i], expected[i], 1e-8);
  }
  EXPECT_EQ(SolidIndex(Mesh()).depths_m(std::vector<Vec3>{Vec3::Zero()})[0], -std::numeric_limits<double>::infinity());
}

/// Moving to the middle of the box rounds, so that they lie beside it.
TEST(SolidIndex, TellsTheDepthOfPointsOfTheSurface) {
  Random random(51);
  for (int i = 0; i < 300; ++i) {
    const Vec3 low = random.point(-200, 200), high = low + random.point(1, 90);
    const SolidIndex box(make_box_mesh(low, high));
    Vec3 point = random.in_box({low, high});
    for (int axis = 0; axis < 3; ++axis) {
      if (const int end = random.integer(axis == 0 ? 1 : 0, 2); end > 0)
        point[axis] = end == 1 ? low[axis] : high[axis];
    }
    EXPECT_NEAR(box.depths_m({&point, 1})[0], 0, 1e-11) << i;
  }
}

TEST(SolidIndex, ClosedSetsThatTouchAreNotApart) {
  const SolidIndex box(make_box_mesh({0, 0, 0}, {1, 1, 1}));
  const auto comes_near = [&](const Vec3& min, const Vec3& max, double within_m = 0) {
    const SolidIndex other(make_box_mesh(min, max));
    EXPECT_EQ(box.comes_near(other, within_m), other.comes_near(box, within_m));
    return box.comes_near(other, within_m);
  };
  EXPECT_TRUE(comes_near({1, 0, 0}, {2, 1, 1}));              // a face
  EXPECT_TRUE(comes_near({1, 1, 0.2}, {2, 2, 0.8}));          // a part of an edge
  EXPECT_TRUE(comes_near({1, 1, 1}, {2, 2, 2}));              // a corner
  EXPECT_TRUE(comes_near({0.2, 0.2, 0.2}, {0.4, 0.4, 0.4}));  // inside, without touching the surface
  EXPECT_TRUE(comes_near({-1, 0.4, 0.4}, {2, 0.6, 0.6}));     // through it: no corner of either is in the other
  EXPECT_FALSE(comes_near({1.001, 0, 0}, {2, 1, 1}));
  EXPECT_TRUE(comes_near({1.001, 0, 0}, {2, 1, 1}, 0.0011));
  EXPECT_FALSE(comes_near({1.001, 1.001, 1.001}, {2, 2, 2}, 0.0017));
  EXPECT_TRUE(comes_near({1.001, 1.001, 1.001}, {2, 2, 2}, 0.0018));
}

/// Against the distance of boxes in any position, which is known by axes.
TEST(SolidIndex, AgreesWithTheDistanceOfBoxes) {
  Random random(81);
  int near = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto draw = [&] { return std::round(4 * random.uniform(-2, 2)) / 4; };
    const auto box = [&] {
      const Vec3 min(draw(), draw(), draw());
      return Box{min, min + Vec3(0.25, 0.25, 0.25) * random.integer(1, 6)};
    };
    const Box a = box(), b = box();
    const Vec3 gap = (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0);
    const double within = 0.25 * random.integer(0, 3);
    if (std::abs(gap.norm() - within) < 1e-9 && within > 0) continue;
    const bool is_near =
        SolidIndex(make_box_mesh(a.min, a.max)).comes_near(SolidIndex(make_box_mesh(b.min, b.max)), within);
    EXPECT_EQ(is_near, gap.norm() <= within) << i;
    near += is_near;
  }
  EXPECT_GT(near, 200);
  EXPECT_LT(near, 1800);
}

TEST(SolidIndex, RefusesOpenMeshesAndPointsThatAreNotFinite) {
  Mesh open = make_box_mesh({0, 0, 0}, {1, 1, 1});
  const SolidIndex box(open);
  open.triangles.pop_back();
  expect_code([&] { SolidIndex index(open); }, ErrorCode::mesh_not_closed, "mesh");
  open.triangles.push_back({0, 1, 99});
  expect_code([&] { SolidIndex index(open); }, ErrorCode::index_out_of_range, "mesh");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_code([&] { box.depths_m(std::vector<Vec3>{{0, nan, 0}}); }, ErrorCode::coordinate_not_finite, "points");
  expect_code([&] { box.comes_near(box, -1); }, ErrorCode::value_out_of_range, "within_m");
}

}  // namespace
}  // namespace vantage
