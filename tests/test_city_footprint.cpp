#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "maps/city/footprint.h"
#include "maps/city/grid_rings.h"
#include "support/random.h"
#include "support/rings.h"

namespace vantage::internal::city {
namespace {

using testing::inside;
using testing::inside_odd;
using testing::rectangle;

using vantage::testing::Random;

Ring reversed(Ring ring) { return {ring.rbegin(), ring.rend()}; }

bool inside(const Vec2& p, const std::vector<Footprint>& footprints) {
  for (const Footprint& footprint : footprints) {
    if (inside(p, footprint)) return true;
  }
  return false;
}

double distance_to(const Vec2& p, const Ring& ring) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 &a = ring[i], along = ring[(i + 1) % ring.size()] - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + t * along - p).norm());
  }
  return least;
}

/// What the header promises of every footprint.
void expect_sound(const std::vector<Footprint>& footprints, double least_bend = kGrid * 0.999) {
  for (const Footprint& footprint : footprints) {
    std::vector<GridRing> rings;
    const Grid grid(footprint);
    std::vector<const Ring*> own{&footprint.outer};
    for (const Ring& hole : footprint.holes) own.push_back(&hole);
    for (const Ring* ring : own) {
      ASSERT_GE(ring->size(), 3u);
      for (std::size_t i = 0; i < ring->size(); ++i) {
        const Vec2 &a = (*ring)[i], &b = (*ring)[(i + 1) % ring->size()], &c = (*ring)[(i + 2) % ring->size()];
        EXPECT_EQ(std::remainder(a.x(), kGrid), 0);
        EXPECT_EQ(std::remainder(a.y(), kGrid), 0);
        EXPECT_NE(a, b);
        const double off = std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / (c - a).norm();
        if ((a - b).dot(c - b) < 0) {
          EXPECT_GE(off, least_bend);
        }
      }
      rings.push_back(grid.to_grid(*ring));
      EXPECT_EQ(signed_area(rings.back()) > 0, ring == &footprint.outer);
    }
    EXPECT_FALSE(meeting_of(rings).crossing);
    EXPECT_GE(area_m2(footprint), 0.01);
  }
}

TEST(CityFootprint, ARectangleStaysAsItIs) {
  Repairs repairs;
  const std::vector<Footprint> result = clean({{reversed(rectangle(1, 2, 11, 7)), {}}}, repairs);
  ASSERT_EQ(result.size(), 1u);
  expect_sound(result);
  EXPECT_EQ(area_m2(result), 50);
  EXPECT_FALSE(repairs.self_crossing || repairs.nesting || repairs.beyond);
  EXPECT_EQ(repairs.slivers, 0u);
}

TEST(CityFootprint, PointsThatSayNothingGo) {
  Ring ring = {{0, 0}, {5, 0}, {5, 0}, {10, 0.00001}, {10, 0}, {10, 4}, {10, 9}, {10, 4}, {0, 4}, {0, 2}};
  Repairs repairs;
  const std::vector<Footprint> result = clean({{ring, {}}}, repairs);
  ASSERT_EQ(result.size(), 1u);
  EXPECT_EQ(result[0].outer.size(), 4u);
  EXPECT_EQ(area_m2(result), 40);
  EXPECT_FALSE(repairs.self_crossing);
}

TEST(CityFootprint, AFigureOfEightHoldsTheHullOfTheCornersNextToItsCrossing) {
  Repairs repairs;
  const std::vector<Footprint> result = clean({{{{0, 0}, {10, 10}, {10, 0}, {0, 10}}, {}}}, repairs);
  EXPECT_EQ(result.size(), 1u);
  expect_sound(result);
  EXPECT_NEAR(area_m2(result), 100, 1e-3);
  EXPECT_TRUE(repairs.self_crossing);
}

TEST(CityFootprint, AFigureOfEightThroughACornerCrossesItselfAndATouchDoesNot) {
  Repairs eight;
  EXPECT_NEAR(area_m2(clean({{{{0, 0}, {5, 5}, {10, 10}, {10, 0}, {5, 5}, {0, 10}}, {}}}, eight)), 100, 1e-3);
  EXPECT_TRUE(eight.self_crossing);
  Repairs touch;
  const Ring ring = {{0, 0}, {10, 0}, {10, 10}, {5, 0}, {0, 10}};
  const std::vector<Footprint> result = clean({{ring, {}}}, touch);
  EXPECT_NEAR(area_m2(result), 50, 1e-3);
  expect_sound(result);
  EXPECT_FALSE(touch.self_crossing);
}

TEST(CityFootprint, CornersThatWereSwappedOnALineHoldTheirHull) {
  // Rectangles of 20 by 10 with a corner in a side: the ring runs back along that side, exactly or nearly.
  for (const double off : {0.0, 0.01}) {
    Repairs repairs;
    EXPECT_NEAR(area_m2(clean({{{{0, 0}, {20, 0}, {10, off}, {20, 10}, {0, 10}}, {}}}, repairs)), 200, 0.2);
    EXPECT_TRUE(repairs.self_crossing);
  }
  Repairs there_and_back;
  EXPECT_EQ(area_m2(clean({{{{0, 0}, {20, 0}, {10, 0}, {10, 10}, {0, 10}}, {}}}, there_and_back)), 150);
  Repairs spur;  // to where it came from: nothing is lost
  EXPECT_EQ(area_m2(clean({{{{0, 0}, {10, 0}, {20, 0}, {10, 0}, {10, 10}, {0, 10}}, {}}}, spur)), 100);
  EXPECT_FALSE(spur.self_crossing);
  // A side passes through a corner of another part.
  Repairs through;
  EXPECT_NEAR(area_m2(clean({{{{0, 0}, {10, 10}, {10, 0}, {5, 5}, {0, 9}}, {}}}, through)), 95, 0.1);
  EXPECT_TRUE(through.self_crossing);
}

TEST(CityFootprint, HolesThatDoNotNest) {
  Repairs inside;
  EXPECT_EQ(area_m2(clean({{rectangle(0, 0, 10, 10), {rectangle(2, 2, 4, 4), rectangle(6, 6, 8, 8)}}}, inside)), 92);
  EXPECT_FALSE(inside.nesting);
  Repairs outside;
  EXPECT_EQ(area_m2(clean({{rectangle(0, 0, 10, 10), {rectangle(12, 2, 14, 4)}}}, outside)), 100);
  EXPECT_TRUE(outside.nesting);
  Repairs overlapping;
  const Footprint twice{rectangle(0, 0, 10, 10), {rectangle(2, 2, 6, 6), reversed(rectangle(4, 4, 8, 8))}};
  EXPECT_EQ(area_m2(clean({twice}, overlapping)), 100) << "both are filled";
  EXPECT_TRUE(overlapping.nesting);
  Repairs across;
  EXPECT_EQ(area_m2(clean({{rectangle(0, 0, 10, 10), {rectangle(8, 2, 12, 4)}}}, across)), 100);
  EXPECT_TRUE(across.nesting);
  Repairs crossed;  // by one that is not sound itself
  EXPECT_EQ(area_m2(clean({{rectangle(0, 0, 10, 10), {rectangle(2, 2, 6, 6), rectangle(5, 3, 12, 4)}}}, crossed)), 100);
  Repairs through;  // the outline, where both have corners
  const Ring outline = {{0, 0}, {10, 0}, {10, 5}, {10, 10}, {5, 10}, {0, 10}};
  const Ring hole = {{5, 10}, {5, 5}, {10, 5}, {12, 12}};
  EXPECT_EQ(area_m2(clean({{outline, {hole}}}, through)), 100);
  EXPECT_TRUE(crossed.nesting && through.nesting);
  Repairs touching;  // two courtyards that share a wall of no width
  EXPECT_EQ(area_m2(clean({{rectangle(0, 0, 10, 10), {rectangle(2, 2, 4, 4), rectangle(4, 2, 6, 4)}}}, touching)), 100);
  EXPECT_TRUE(touching.nesting);
  EXPECT_FALSE(touching.self_crossing);
}

TEST(CityFootprint, NothingWithoutAnArea) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Ring& ring :
       {Ring{}, Ring{{0, 0}}, Ring{{0, 0}, {1, 1}}, Ring{{0, 0}, {5, 5}, {10, 10}},
        Ring{{0, 0}, {0, 0}, {0, 0}, {0, 0}}, rectangle(0, 0, 100, 0.005), rectangle(0, 0, 0.05, 0.05)}) {
    Repairs repairs;
    EXPECT_TRUE(clean({{ring, {}}}, repairs).empty());
    EXPECT_EQ(repairs.slivers, 1u);
  }
  for (const Ring& ring : {Ring{{0, 0}, {nan, 0}, {1, 1}}, rectangle(-3e5, 0, 3e5, 10), rectangle(0, 0, 1e300, 1)}) {
    Repairs repairs;
    EXPECT_TRUE(clean({{ring, {}}}, repairs).empty());
    EXPECT_TRUE(repairs.beyond);
  }
  Repairs repairs;
  EXPECT_EQ(area_m2(clean({{rectangle(0, 0, 1e4, 1e4), {}}}, repairs)), 1e8);
  EXPECT_FALSE(repairs.beyond);
}

TEST(CityFootprint, PiecesOfOneObjectBecomeOneWhereTheyMeet) {
  Repairs repairs;
  const std::vector<Footprint> meeting =
      clean({{rectangle(0, 0, 5, 5), {}}, {rectangle(5, 0, 9, 5), {}}, {rectangle(20, 0, 21, 1), {}}}, repairs);
  EXPECT_EQ(meeting.size(), 2u);
  EXPECT_EQ(area_m2(meeting), 46);
}

TEST(CityFootprint, SubtractAndIntersect) {
  const std::vector<Footprint> block = {{rectangle(0, 0, 10, 10), {}}};
  const std::vector<Footprint> parts = {
      {rectangle(2, 2, 5, 5), {}}, {rectangle(4, 4, 12, 12), {}}, {rectangle(100, 100, 101, 101), {}}};
  const std::vector<Footprint> rest = subtract(block, parts);
  expect_sound(rest);
  EXPECT_EQ(area_m2(rest), 100 - 9 - 36 + 1);
  EXPECT_EQ(area_m2(intersect(block, parts)), 9 + 36 - 1);
  EXPECT_TRUE(subtract(block, block).empty());
  EXPECT_EQ(area_m2(intersect(block, block)), 100);
  EXPECT_TRUE(intersect(block, {parts[2]}).empty());
  EXPECT_EQ(area_m2(subtract(block, {parts[2]})), 100);
  EXPECT_EQ(area_m2(subtract(block, {{rectangle(0, 0, 10, 9.995), {}}})), 0) << "a sliver";
}

TEST(CityFootprint, WidenedLines) {
  const std::vector<Footprint> straight = widen({{0, 0}, {10, 0}}, false, 0.5);
  ASSERT_EQ(straight.size(), 1u);
  EXPECT_NEAR(area_m2(straight), 5, 1e-3);
  const std::vector<Footprint> bent = widen({{0, 0}, {10, 0}, {10, 10}}, false, 0.5);
  ASSERT_EQ(bent.size(), 1u);
  EXPECT_EQ(bent[0].outer.size(), 6u);
  EXPECT_NEAR(area_m2(bent), 10, 1e-2);
  const std::vector<Footprint> round = widen(rectangle(0, 0, 10, 10), true, 0.5);
  ASSERT_EQ(round.size(), 1u);
  EXPECT_EQ(round[0].holes.size(), 1u);
  EXPECT_NEAR(area_m2(round), 10.5 * 10.5 - 9.5 * 9.5, 1e-2);
  expect_sound(round);
  EXPECT_TRUE(widen({{3, 3}, {3, 3}}, false, 0.5).empty());
  EXPECT_TRUE(widen({}, true, 0.5).empty());
}

TEST(CityFootprint, ConvexPieces) {
  EXPECT_EQ(convex_pieces({rectangle(0, 0, 4, 3), {}}).size(), 1u);
  const Ring ell = {{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}};
  EXPECT_EQ(convex_pieces({ell, {}}).size(), 2u);
  const std::vector<Ring> frame = convex_pieces({rectangle(0, 0, 10, 10), {reversed(rectangle(3, 3, 7, 7))}});
  EXPECT_LE(frame.size(), 5u);
  double area = 0;
  for (const Ring& piece : frame) area += area_m2({piece, {}});
  EXPECT_NEAR(area, 84, 1e-9);
}

// Against the even-odd rule, asked point by point.
TEST(CityFootprint, RandomTangles) {
  Random random(41);
  for (int round = 0; round < 400; ++round) {
    const double size = random.chance(0.3) ? 0.05 : random.chance(0.1) ? 5000 : 20;
    const Vec2 offset = random.chance(0.3) ? Vec2(81234.5, -345678.9) : Vec2(0, 0);
    const bool coarse = random.chance(0.5);  // many equal, collinear and touching points
    const auto draw = [&](int least, int most) {
      Ring ring;
      const int count = random.integer(least, most);
      for (int i = 0; i < count; ++i) {
        Vec2 p(random.uniform(-1, 1), random.uniform(-1, 1));
        if (coarse) p = (p * 4).array().round() / 4;
        ring.push_back(offset + size * p);
      }
      return ring;
    };
    Footprint rough{draw(3, 14), {}};
    for (int holes = random.integer(0, 2); holes > 0; --holes) rough.holes.push_back(draw(3, 6));
    Repairs repairs;
    const std::vector<Footprint> result = clean({rough}, repairs);
    // In a tangle, leaving out what is nearly straight makes sides cross.
    expect_sound(result, 1e-9);
    for (const Footprint& footprint : result) {
      double area = 0;
      for (const Ring& piece : convex_pieces(footprint)) {
        area += area_m2({piece, {}});
        for (std::size_t i = 0; i < piece.size(); ++i) {
          const Vec2 a = piece[(i + 1) % piece.size()] - piece[i], b = piece[(i + 2) % piece.size()] - piece[i];
          EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0);
        }
      }
      EXPECT_NEAR(area, area_m2(footprint), 1e-9 * size * size);
    }
    for (int k = 0; k < 40 && size > 1; ++k) {
      const Vec2 p = offset + size * Vec2(random.uniform(-1, 1), random.uniform(-1, 1));
      double distance = distance_to(p, rough.outer);
      bool wanted = inside_odd(p, rough.outer);
      for (const Ring& hole : rough.holes) {
        distance = std::min(distance, distance_to(p, hole));
        wanted = wanted && !inside_odd(p, hole);
      }
      // Slivers are left out, and rounding moves sides by a few units. What crosses itself only grows.
      if (distance < 0.02) continue;
      ASSERT_TRUE(inside(p, result) || !wanted) << "round " << round << " at " << (p - offset).transpose();
      if (repairs.self_crossing || repairs.nesting) continue;
      ASSERT_EQ(inside(p, result), wanted) << "round " << round << " at " << (p - offset).transpose();
    }
  }
}

}  // namespace
}  // namespace vantage::internal::city
