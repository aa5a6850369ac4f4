// Ranges of longitudes: the shortest one that holds all of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "maps/osm/longitude_span.h"
#include "support/random.h"

namespace vantage::internal::geo {
namespace {

using osm::LongitudeSpan;

LongitudeRange range_of(const std::vector<double>& longitudes) {
  LongitudeSpan span;
  for (const double longitude : longitudes) span.add(longitude);
  return span.range();
}

TEST(Longitudes, FindTheShortestRange) {
  const auto expect = [](const std::vector<double>& longitudes, double west, double east) {
    const LongitudeRange range = range_of(longitudes);
    EXPECT_EQ(range.west, west);
    EXPECT_EQ(range.east, east);
  };
  expect({11.5}, 11.5, 11.5);
  expect({11.5, 11.25, 12}, 11.25, 12);
  expect({-10, 20}, -10, 20);
  expect({179.5, -179.25}, 179.5, -179.25);
  expect({180, -180}, 180, -180);  // the same place
  expect({-180, 180, 179, -179.5}, 179, -179.5);
  expect({-90, 90}, -90, 90);  // both are as long
  expect({-100, 100}, 100, -100);
  expect({0, 120, -120}, -120, 120);
  std::vector<double> all;
  for (int i = -360; i <= 360; ++i) all.push_back(i / 2.0);
  expect(all, -180, 180);
}

TEST(Longitudes, AreTheSortedOnesWithoutTheLargestGap) {
  testing::Random random(71);
  for (int i = 0; i < 300; ++i) {
    const double middle = random.uniform(-180, 180), half = std::pow(10, random.uniform(-7, 2.2));
    std::vector<double> longitudes;
    for (int k = 0; k < 12; ++k) longitudes.push_back(std::remainder(middle + random.uniform(-half, half), 360));
    std::vector<double> sorted = longitudes;
    std::sort(sorted.begin(), sorted.end());
    double widest = sorted.front() + 360 - sorted.back();
    for (std::size_t k = 1; k < sorted.size(); ++k) widest = std::max(widest, sorted[k] - sorted[k - 1]);
    const LongitudeRange range = range_of(longitudes);
    EXPECT_NEAR(range.width_deg(), 360 - widest, 1e-9);
    for (const double longitude : longitudes) EXPECT_TRUE(range.holds(longitude));
    EXPECT_TRUE(range.holds(range.middle_deg()));
    EXPECT_LE(std::abs(range.middle_deg()), 180);
  }
}

TEST(Longitudes, RangesMeetAcrossTheAntimeridian) {
  const LongitudeRange pacific{170, -170}, fiji{177, -178}, europe{-10, 30}, west_of_it{-175, -100};
  EXPECT_TRUE(pacific.meets(fiji));
  EXPECT_TRUE(fiji.meets(pacific));
  EXPECT_TRUE(pacific.meets(west_of_it));
  EXPECT_TRUE(west_of_it.meets(pacific));
  EXPECT_FALSE(fiji.meets(west_of_it));
  EXPECT_FALSE(pacific.meets(europe));
  EXPECT_FALSE(europe.meets(pacific));
  EXPECT_TRUE((LongitudeRange{-180, 180}).meets(fiji));
}

}  // namespace
}  // namespace vantage::internal::geo
