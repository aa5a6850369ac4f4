// Whether a camera can have all of a target in one picture: the check's search over orientations.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "support/random.h"
#include "verify/frame_search.h"

namespace vantage::internal::verify {
namespace {

constexpr double kOneDegree = std::numbers::pi / 180;

Pinhole picture(double half_width, double half_height) {
  Pinhole camera;
  camera.half_width = half_width;
  camera.half_height = half_height;
  return camera;
}

std::string text(const Mount& mount) {
  return "yaw " + (mount.yaw_deg ? std::to_string(*mount.yaw_deg) : "any") + ", pitch " +
         std::to_string(mount.min_pitch_deg) + " to " + std::to_string(mount.max_pitch_deg) + ", roll " +
         std::to_string(mount.roll_deg);
}

Mount fixed(double yaw_deg, double pitch_deg, double roll_deg = 0) {
  return {.yaw_deg = yaw_deg, .min_pitch_deg = pitch_deg, .max_pitch_deg = pitch_deg, .roll_deg = roll_deg};
}

/// The axes of a camera, written out: ahead, and right and up in the picture. Radians.
struct Axes {
  Axes(double yaw, double pitch, double roll)
      : ahead(std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), std::sin(pitch)) {
    const Vec3 level(std::cos(yaw), -std::sin(yaw), 0);
    const Vec3 above(-std::sin(yaw) * std::sin(pitch), -std::cos(yaw) * std::sin(pitch), std::cos(pitch));
    right = std::cos(roll) * level - std::sin(roll) * above;
    up = std::sin(roll) * level + std::cos(roll) * above;
  }

  /// At these tangents to the right and up.
  Vec3 direction(double x, double y) const { return (ahead + x * right + y * up).normalized(); }

  /// The smallest sine of an angle inside an edge, over all directions.
  double margin(const std::vector<Vec3>& directions, const Pinhole& camera) const {
    double least = 1;
    for (const Vec3& d : directions) {
      const double x = (camera.half_width * d.dot(ahead) - std::abs(d.dot(right))) / std::hypot(1, camera.half_width);
      const double y = (camera.half_height * d.dot(ahead) - std::abs(d.dot(up))) / std::hypot(1, camera.half_height);
      least = std::min({least, x, y});
    }
    return least;
  }

  Vec3 ahead, right, up;
};

Finding search(const Pinhole& camera, const Mount& mount, const std::vector<Vec3>& directions) {
  return FrameSearch(camera, mount).search(directions).finding;
}

bool fits(const Pinhole& camera, const Mount& mount, const Vec3& direction) {
  return search(camera, mount, {direction.normalized()}) == Finding::kept;
}

const Pinhole kWide = picture(1, 0.1);

// ---- single orientations ----

TEST(VerifyFrame, YawIsClockwiseFromNorth) {
  const Mount east = fixed(90, 0);
  EXPECT_TRUE(fits(kWide, east, {1, 0, 0}));
  EXPECT_FALSE(fits(kWide, east, {-1, 0, 0})) << "behind";
  EXPECT_FALSE(fits(kWide, east, {0, 1, 0}));
  EXPECT_TRUE(fits(kWide, east, {1, 1, 0})) << "the border";
  EXPECT_TRUE(fits(kWide, east, {1, -1, 0}));
  EXPECT_FALSE(fits(kWide, east, {1, 1 + 1e-9, 0}));
  EXPECT_FALSE(fits(kWide, east, {1, -1 - 1e-9, 0}));
  EXPECT_TRUE(fits(kWide, fixed(-270, 0), {1, 0, 0}));
}

TEST(VerifyFrame, PitchIsUpFromLevel) {
  const Mount up = fixed(0, 30);
  const double highest = 30 * kOneDegree + std::atan(0.1);
  EXPECT_TRUE(fits(kWide, up, {0, std::cos(highest), std::sin(highest)}));
  EXPECT_FALSE(fits(kWide, up, {0, std::cos(highest + 1e-9), std::sin(highest + 1e-9)}));
  const double lowest = 30 * kOneDegree - std::atan(0.1);
  EXPECT_TRUE(fits(kWide, up, {0, std::cos(lowest), std::sin(lowest)}));
  EXPECT_FALSE(fits(kWide, up, {0, std::cos(lowest - 1e-9), std::sin(lowest - 1e-9)}));
}

TEST(VerifyFrame, StraightDownTheTopOfThePictureIsWhereTheYawPoints) {
  const Vec3 east(0.5, 0, -1), north(0, 0.5, -1);
  EXPECT_TRUE(fits(kWide, fixed(0, -90), east));
  EXPECT_FALSE(fits(kWide, fixed(0, -90), north));
  EXPECT_TRUE(fits(kWide, fixed(90, -90), north));
  EXPECT_FALSE(fits(kWide, fixed(90, -90), east));
}

TEST(VerifyFrame, APositiveRollLowersTheRightEdge) {
  const double turn = 25 * kOneDegree;
  const Vec3 lower_right(0.9 * std::cos(turn), 1, -0.9 * std::sin(turn)),
      upper_right(0.9 * std::cos(turn), 1, 0.9 * std::sin(turn));
  EXPECT_TRUE(fits(kWide, fixed(0, 0, 25), lower_right));
  EXPECT_FALSE(fits(kWide, fixed(0, 0, 25), upper_right));
  EXPECT_TRUE(fits(kWide, fixed(0, 0, -25), upper_right));
}

// ---- searches with a known answer ----

/// A target that looks exactly like the picture does from one orientation fits in no other one: a picture has no room
/// for a cone of the same solid angle but in its own place. So a picture smaller by a hair has no room for it at all.
TEST(VerifyFrame, FindsTheOneOrientationThatFits) {
  testing::Random random(3);
  for (int i = 0; i < 400; ++i) {
    Pinhole camera = picture(std::exp(random.uniform(-4, 1)), std::exp(random.uniform(-4, 1)));
    const double yaw = random.uniform(-180, 180), pitch = random.chance(0.2) ? -90 : random.uniform(-89, 89);
    Mount mount{.roll_deg = random.chance(0.5) ? 0 : random.uniform(-180, 180)};
    if (random.chance(0.3)) mount.yaw_deg = yaw + (random.chance(0.5) ? 360 : 0);
    if (random.chance(0.3)) {
      mount.min_pitch_deg = std::max(-90.0, pitch - random.uniform(0, 20));
      mount.max_pitch_deg = pitch + (random.chance(0.5) ? 0 : std::min(90 - pitch, 10.0));
    }
    SCOPED_TRACE(::testing::Message() << i << ": " << camera.half_width << " by " << camera.half_height << ", yaw "
                                      << yaw << " pitch " << pitch << "; " << text(mount));
    const Axes axes(yaw * kOneDegree, pitch * kOneDegree, mount.roll_deg * kOneDegree);
    std::vector<Vec3> corners;
    for (const double x : {-camera.half_width, camera.half_width}) {
      for (const double y : {-camera.half_height, camera.half_height}) corners.push_back(axes.direction(x, y));
    }
    for (const double hair : {1e-6, 1e-8}) {
      const Pinhole larger = picture(camera.half_width * (1 + hair), camera.half_height * (1 + hair));
      EXPECT_EQ(search(larger, mount, corners), Finding::kept) << hair;
      const Pinhole smaller = picture(camera.half_width * (1 - hair), camera.half_height * (1 - hair));
      EXPECT_EQ(search(smaller, mount, corners), Finding::broken) << hair;
    }
  }
}

/// As the picture shrinks past the one orientation that fits, the answers are "kept", at most a few times "undecided",
/// and "broken".
TEST(VerifyFrame, IsUndecidedOnlyNextToTangency) {
  const Axes axes(0.4, -0.7, 0);
  std::vector<Vec3> corners;
  for (const double x : {-0.3, 0.3}) {
    for (const double y : {-0.2, 0.2}) corners.push_back(axes.direction(x, y));
  }
  int last = 0, undecided = 0;
  for (int i = 0; i <= 400; ++i) {
    const double hair = i * 5e-14;
    const Finding finding = search(picture(0.3 * (1 - hair), 0.2 * (1 - hair)), {}, corners);
    const int order = finding == Finding::kept ? 0 : (finding == Finding::undecided ? 1 : 2);
    EXPECT_GE(order, last) << hair;
    last = order;
    undecided += order == 1;
  }
  EXPECT_EQ(last, 2);
  EXPECT_GT(undecided, 0);
  EXPECT_LT(undecided, 100);
}

/// Where many orientations are almost as good as the best one: what makes a search long.
TEST(VerifyFrame, DecidesWhereManyOrientationsAreAlmostTheBest) {
  // A circle from above: every yaw is alike. The polygon's incircle needs half the picture's side, and at a yaw where
  // sides are parallel the polygon needs no more.
  constexpr int kCorners = 64;
  for (const double radius : {0.02, 0.3, 2.0}) {
    std::vector<Vec3> corners;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.3) / kCorners;
      corners.push_back(Vec3(radius * std::cos(angle), radius * std::sin(angle), -1).normalized());
    }
    const double least = radius * std::cos(std::numbers::pi / kCorners);
    for (const double hair : {1e-4, 1e-6, 1e-8}) {
      const double larger = least * (1 + hair), smaller = least * (1 - hair);
      EXPECT_EQ(search(picture(larger, larger), {}, corners), Finding::kept) << hair;
      EXPECT_EQ(search(picture(smaller, smaller), {}, corners), Finding::broken) << hair;
    }
  }
  // Two points at the same height: the higher the picture, the more pitches do.
  for (const double half : {0.02, 0.3, 1.0}) {
    const std::vector<Vec3> ends = {Vec3(half, 1, 0).normalized(), Vec3(-half, 1, 0).normalized()};
    for (const double hair : {1e-5, 1e-7, 1e-9}) {
      EXPECT_EQ(search(picture(half * (1 + hair), 1), {}, ends), Finding::kept) << half;
      EXPECT_EQ(search(picture(half * (1 - hair), 1), {}, ends), Finding::broken) << half;
    }
  }
}

TEST(VerifyFrame, ARangeOfPitchesIsKept) {
  const Pinhole camera = picture(0.5, 0.5);
  const double half = std::atan(0.5) / kOneDegree;
  const auto down = [](double pitch_deg) {
    return std::vector<Vec3>{{0, std::cos(pitch_deg * kOneDegree), std::sin(pitch_deg * kOneDegree)}};
  };
  const Mount mount{.min_pitch_deg = -30, .max_pitch_deg = 10};
  EXPECT_EQ(search(camera, mount, down(-30 - half + 1e-7)), Finding::kept);
  EXPECT_EQ(search(camera, mount, down(-30 - half - 1e-7)), Finding::broken);
  EXPECT_EQ(search(camera, mount, down(10 + half - 1e-7)), Finding::kept);
  EXPECT_EQ(search(camera, mount, down(10 + half + 1e-7)), Finding::broken);
}

// ---- searches against a grid of orientations ----

struct FrameCase {
  Pinhole camera;
  Mount mount;
  std::vector<Vec3> directions;
};

/// Convex polygons seen from about where they fill the picture.
FrameCase random_case(testing::Random& random) {
  FrameCase drawn;
  drawn.camera.half_width = std::exp(random.uniform(-2, 1));
  drawn.camera.half_height = drawn.camera.half_width * random.uniform(0.4, 1);
  Mount& mount = drawn.mount;
  if (random.chance(0.5)) mount.roll_deg = random.uniform(-180, 180);
  if (random.chance(0.3)) mount.yaw_deg = random.uniform(-360, 360);
  if (random.chance(0.4)) {
    mount.min_pitch_deg = random.uniform(-90, 80);
    mount.max_pitch_deg = random.chance(0.2) ? mount.min_pitch_deg : std::min(90.0, mount.min_pitch_deg + 30);
  }
  const int corners = random.integer(1, 9);
  const Vec3 normal = random.direction(), u = normal.unitOrthogonal(), v = normal.cross(u);
  const Vec3 away = random.chance(0.2) ? Vec3(0, 0, 1) : random.direction();
  const Vec3 viewpoint = std::exp(random.uniform(-0.5, 0.7)) / drawn.camera.half_height * away;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random.uniform(-0.3, 0.3)) / corners;
    drawn.directions.push_back((std::cos(angle) * u + std::sin(angle) * v - viewpoint).normalized());
  }
  return drawn;
}

/// The best margin of orientations at most `step` degrees apart.
double best_on_grid(const FrameCase& drawn, double step) {
  const Mount& mount = drawn.mount;
  const double span = mount.max_pitch_deg - mount.min_pitch_deg;
  const int pitches = static_cast<int>(std::ceil(span / step)), yaws = mount.yaw_deg ? 0 : static_cast<int>(360 / step);
  double best = -2;
  for (int i = 0; i <= pitches; ++i) {
    const double pitch = mount.min_pitch_deg + (pitches > 0 ? span * i / pitches : 0);
    for (int j = 0; j <= yaws; ++j) {
      const Axes axes(mount.yaw_deg.value_or(step * j) * kOneDegree, pitch * kOneDegree, mount.roll_deg * kOneDegree);
      best = std::max(best, axes.margin(drawn.directions, drawn.camera));
    }
  }
  return best;
}

TEST(VerifyFrame, AgreesWithAGridOfOrientations) {
  testing::Random random(11);
  constexpr double kStep = 2;
  int kept = 0, broken = 0, grid_tells = 0;
  for (int i = 0; i < 400; ++i) {
    const FrameCase drawn = random_case(random);
    SCOPED_TRACE(::testing::Message() << i << ": " << text(drawn.mount));
    const FrameSearch::Result result = FrameSearch(drawn.camera, drawn.mount).search(drawn.directions);
    const double best = best_on_grid(drawn, kStep);
    if (result.finding == Finding::kept) {
      ++kept;
      const Axes axes(result.orientation.yaw, result.orientation.pitch, drawn.mount.roll_deg * kOneDegree);
      EXPECT_GE(axes.margin(drawn.directions, drawn.camera), -1e-11);
      EXPECT_GT(best, -kStep * kOneDegree)
          << "the nearest orientation of the grid is half a step away in yaw and in pitch";
    }
    if (result.finding == Finding::broken) {
      ++broken;
      EXPECT_LT(best, 0);
    }
    grid_tells += best >= 0 || best < -kStep * kOneDegree;
  }
  EXPECT_GT(kept, 50);
  EXPECT_GT(broken, 50);
  EXPECT_GT(grid_tells, 250);
}

TEST(VerifyFrame, HardlyAnyPointStaysUndecided) {
  testing::Random random(5);
  constexpr int kCases = 100000;
  std::array<int, 3> count{};
  std::size_t cells = 0, most = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kCases; ++i) {
    const FrameCase drawn = random_case(random);
    const FrameSearch::Result result = FrameSearch(drawn.camera, drawn.mount).search(drawn.directions);
    ++count[static_cast<std::size_t>(result.finding)];
    cells += result.cells;
    most = std::max(most, result.cells);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cout << count[0] << " kept, " << count[1] << " broken, " << count[2] << " undecided; cells: mean "
            << static_cast<double>(cells) / kCases << ", most " << most << "; " << seconds * 1e6 / kCases
            << " us a point\n";
  EXPECT_LE(count[2], kCases / 10000);
  EXPECT_GT(count[0], kCases / 10);
  EXPECT_GT(count[1], kCases / 10);
}

}  // namespace
}  // namespace vantage::internal::verify
