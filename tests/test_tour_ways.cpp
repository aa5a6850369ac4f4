// Ways of tours round obstacles: drawn again and again, they come near to the shortest one.
#include <gtest/gtest.h>

#include <cstdint>
#include <string_view>

#include "core/progress_reporter.h"
#include "flight/tour/tour_obstacles.h"
#include "flight/tour/tour_random.h"
#include "support/simple_airspace.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using internal::core::ProgressReporter;
using internal::flight::tour::Course;
using internal::flight::tour::CourseLimits;
using internal::flight::tour::draw_ways_anew;
using internal::flight::tour::fly_clear;
using internal::flight::tour::join_bends;
using internal::flight::tour::SplitMix64;
using internal::flight::tour::Stop;
using testing::BoxAirspace;

const internal::flight::tour::Regions kNoRegions;
const Vec3 kFrom(-50, 0, 0), kTo(50, 0, 0);

/// A wall across the straight way, as high as the airspace. It ends nearer on the right.
BoxAirspace walled() {
  return {{{"wall", {Vec3(-5, -20, -10), Vec3(5, 60, 10)}}}, 1, {Vec3(-100, -100, -0.4), Vec3(100, 100, 0.4)}};
}

bool never() { return false; }

/// There and back.
Course flown_once(const CourseLimits& limits, SplitMix64& draw) {
  const Course straight = {true, {{Stop::kFixed, kFrom}, {Stop::kFixed, kTo}}};
  return fly_clear(straight, limits, draw, ProgressReporter(), never).course;
}

void expect_allowed(const Course& course, const BoxAirspace& airspace) {
  for (std::size_t i = 0; i < course.stops.size(); ++i) {
    EXPECT_EQ(airspace.obstacle({course.stops[i].point, *course.after(i)}, 0), "");
  }
}

TEST(TourWays, DrawnAnewComeNearToTheShortestOne) {
  const BoxAirspace airspace = walled();
  const CourseLimits limits = {kNoRegions, &airspace};
  // Round the corners of the wall, farther from them by the clearance.
  const Vec3 a(-6, -21, 0), b(6, -21, 0);
  const double there_and_back = 2 * ((a - kFrom).norm() + (b - a).norm() + (kTo - b).norm());
  int shortened = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SplitMix64 draw(seed);
    Course course = flown_once(limits, draw);
    const double once = course.length_m();
    for (int round = 0; round < 20; ++round) {
      const double before = course.length_m();
      draw_ways_anew(course, limits, draw, ProgressReporter(), never);
      ASSERT_LE(course.length_m(), before) << seed << " " << round;
      expect_allowed(course, airspace);
    }
    EXPECT_LT(course.length_m(), 1.003 * there_and_back) << seed;
    EXPECT_EQ(course.stops.front().point, kFrom);
    if (course.length_m() < 0.999 * once) ++shortened;
  }
  EXPECT_GT(shortened, 2);
}

TEST(TourWays, BendsAreJoinedWhereThatMakesThemLittleLonger) {
  const BoxAirspace airspace = walled();
  const CourseLimits limits = {kNoRegions, &airspace};
  std::size_t bends = 0, joined = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SplitMix64 draw(seed);
    Course course = flown_once(limits, draw);
    for (int round = 0; round < 6; ++round) draw_ways_anew(course, limits, draw, ProgressReporter(), never);
    const double before = course.length_m();
    bends += course.stops.size() - 2;
    join_bends(course, limits);
    joined += course.stops.size() - 2;
    EXPECT_LE(course.length_m(), before * (1 + 1.0001e-3)) << seed;
    EXPECT_EQ(course.stops.front().point, kFrom);
    expect_allowed(course, airspace);
  }
  EXPECT_LT(joined, 0.9 * static_cast<double>(bends)) << joined << " of " << bends;
}

TEST(TourWays, AreLeftAsTheyAreWhenTimeIsUp) {
  const BoxAirspace airspace = walled();
  const CourseLimits limits = {kNoRegions, &airspace};
  SplitMix64 draw(1);
  Course course = flown_once(limits, draw);
  const std::uint64_t next = SplitMix64(draw).bits();
  draw_ways_anew(course, limits, draw, ProgressReporter(), [] { return true; });
  EXPECT_EQ(draw.bits(), next);
}

TEST(TourWays, AreAllowedWhenTheSearchIsStopped) {
  const BoxAirspace airspace = walled();
  const CourseLimits limits = {kNoRegions, &airspace};
  const ProgressReporter::AskAlways always;
  for (int allowed = 1; allowed < 2000; allowed += 397) {
    SplitMix64 draw(static_cast<std::uint64_t>(allowed));
    Course course = flown_once(limits, draw);
    int asked = 0;
    const Progress progress = [&](std::string_view, double) { return ++asked <= allowed; };
    const ProgressReporter reporter(progress);
    try {
      for (int round = 0; round < 10; ++round) draw_ways_anew(course, limits, draw, reporter, never);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    EXPECT_GE(course.stops.size(), 4);
    expect_allowed(course, airspace);
  }
}

}  // namespace
}  // namespace vantage
