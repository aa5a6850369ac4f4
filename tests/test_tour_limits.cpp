// Tours whose limits are met exactly, or within a rounding: what is returned keeps them all the same, and no tour is
// an internal defect.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/progress_reporter.h"
#include "flight/tour/tour_obstacles.h"
#include "flight/tour/tour_random.h"
#include "flight/tour/tour_region.h"
#include "flight/tour/tour_schedule.h"
#include "support/random.h"
#include "support/simple_airspace.h"
#include "support/solids.h"
#include "support/tour_judge.h"
#include "vantage/tour.h"

namespace vantage {
namespace {

using internal::flight::tour::TourRegion;
using testing::BoxAirspace;
using testing::make_box_mesh;

TEST(TourLimits, ARegionHoldsEveryPointThatItGives) {
  testing::Random random(71);
  int on_the_way = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 middle = random.point(-1, 1) * (random.chance(0.2) ? 5e6 : 300.0);
    const Vec3 half(random.uniform(2, 60), random.uniform(2, 60), random.uniform(2, 60));
    Mesh mesh = make_box_mesh(middle - half, middle + half);
    if (random.chance(0.5)) {
      const Vec3 beside(2.5 * half.x(), random.uniform(-20, 20), random.uniform(-20, 20));
      testing::append(mesh, make_box_mesh(middle + beside - half, middle + beside + half));
    }
    const TourRegion region("boxes", mesh, random.chance(0.3) ? 0 : random.uniform(0.1, 1.9));
    for (const Vec3& anchor : region.anchors()) ASSERT_TRUE(region.holds(anchor));
    for (int k = 0; k < 20; ++k) {
      const Vec3 a = middle + random.point(-150, 150), b = middle + random.point(-150, 150);
      const Vec3 x = region.touch(a, b);
      ASSERT_TRUE(region.holds(x)) << i << " " << k << ": " << region.depth_m(x) - region.margin_m();
      if ((a - x).norm() + (x - b).norm() <= (a - b).norm() * (1 + 1e-9)) ++on_the_way;
    }
  }
  EXPECT_GT(on_the_way, 400);
}

TEST(TourLimits, ARegionHoldsEveryPartOfAStretch) {
  testing::Random random(72);
  int parts = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 middle = random.point(-300, 300);
    const Vec3 half(random.uniform(2, 60), random.uniform(2, 60), random.uniform(2, 60));
    const TourRegion region("box", make_box_mesh(middle - half, middle + half), random.uniform(0, 1.5));
    Vec3 from = middle + random.point(-1, 1) * 90, to = middle + random.point(-1, 1) * 90;
    if (random.chance(0.5)) {
      // At a right angle to a face: the depth grows by a metre in a metre.
      to = from = middle + random.uniform(-0.4, 0.4) * half;
      const int axis = random.integer(0, 2);
      from[axis] -= 70;
      to[axis] += 70;
    }
    const double length = (to - from).norm();
    for (const LegInterval& stretch : region.stretches({from, to})) {
      for (int k = 0; k < 20; ++k) {
        double begin = k < 5 ? stretch.begin : random.uniform(stretch.begin, stretch.end);
        double end = k % 5 == 0 ? stretch.end : random.uniform(stretch.begin, stretch.end);
        if (k == 6) begin = stretch.end - 1e-6 / length;
        if (begin > end) std::swap(begin, end);
        const Leg part = {from + begin * (to - from), from + end * (to - from)};
        ASSERT_TRUE(region.holds_leg(part))
            << i << ": " << begin << " to " << end << " of " << stretch.begin << " to " << stretch.end;
        ++parts;
      }
    }
  }
  EXPECT_GT(parts, 2000);
}

TEST(TourLimits, OfVolumesThatAreFoundByTheirMargin) {
  // The second piece of the one is met in the first piece of the other: as deep as the margin, to the last digit.
  TourRequest request;
  Mesh first = make_box_mesh({186.22760148158204, 116.1119302574938, 25.878245792441707},
                             {237.89896577898023, 242.85189968799224, 112.94259903997956});
  testing::append(first, make_box_mesh({-15.790503460287633, 181.95086505957752, 27.890220116759476},
                                       {113.68719400753066, 265.8639855388911, 130.162478870098}));
  Mesh second = make_box_mesh({-165.5566226325434, 139.94528528763217, 50.283813355853944},
                              {-31.6401149008162, 223.01637508701498, 111.78049371910839});
  testing::append(second, make_box_mesh({7.2748160412314204, 212.4732724502891, 32.76826016832978},
                                        {148.50843593086142, 277.4966328355491, 175.69645763822837}));
  request.targets = {{"first", first},
                     {"second", second},
                     {"third", make_box_mesh({141.73607436669016, 162.65442283519562, 41.12918912993557},
                                             {260.5183291586818, 269.35305327456945, 187.40065654675385})}};
  request.settings.margin_m = 1.2666612411982825;
  request.settings.dwell_s = 0;
  request.settings.simultaneous = true;
  const Tour tour = plan_tour(request);
  testing::judge(request, tour, nullptr);
  EXPECT_EQ(tour.visits.size(), 3);
}

/// Targets between towers, for a fixed wing.
TourRequest town(std::uint64_t seed, std::vector<testing::NamedBox>& towers) {
  testing::Random random(seed);
  TourRequest request;
  request.settings.vehicle.kind = TourVehicle::Kind::fixed_wing;
  request.settings.vehicle.turn_radius_m = random.uniform(8, 25);
  request.settings.vehicle.min_climb_deg = -20;
  request.settings.vehicle.max_climb_deg = 20;
  request.settings.dwell_s = 0.5;
  request.settings.simultaneous = true;
  const int targets = random.integer(3, 5);
  for (int t = 0; t < targets; ++t) {
    const Vec3 centre(random.uniform(-120, 120), random.uniform(-120, 120), random.uniform(20, 40));
    request.targets.push_back(
        {"T" + std::to_string(t), make_box_mesh(centre - Vec3::Constant(15), centre + Vec3::Constant(15))});
  }
  for (int k = 0; k < 6; ++k) {
    const Vec3 corner(random.uniform(-120, 120), random.uniform(-120, 120), 0);
    towers.push_back({"tower", {corner, corner + Vec3(random.uniform(5, 50), random.uniform(5, 50), 75)}});
  }
  request.settings.time_limit_s = 600;
  request.rounds = 10;
  return request;
}

TEST(TourLimits, AWingFliesRoundWhatStandsWhereATargetWasMovedFrom) {
  // A target is put to another place of the order, and the way past its old place leads through a tower.
  std::vector<testing::NamedBox> towers;
  TourRequest request = town(82, towers);
  const auto airspace = std::make_shared<BoxAirspace>(towers, 2, Box{Vec3(-400, -400, 5), Vec3(400, 400, 80)});
  request.airspace = airspace;
  const Tour tour = plan_tour(request);
  testing::judge(request, tour, airspace.get());
  EXPECT_TRUE(tour.problems.empty());
}

TEST(TourLimits, PointsThatDifferAreAtDifferentStations) {
  // The step is lost in a million metres.
  const internal::flight::tour::Polyline way({{0, 0, 0}, {1e6, 0, 0}, {1e6, 1e-13, 0}, {1e6, 1e-13, 0}, {1e6, 5, 0}});
  EXPECT_LT(way.station(1), way.station(2));
  EXPECT_EQ(way.station(2), way.station(3));
  EXPECT_EQ(way.at(way.station(1)), way.points()[1]);
  EXPECT_EQ(way.at(way.station(2)), way.points()[2]);
}

/// Flat, so that ways lead round. Allows a third of all legs, and not the same ones the other way: as rounding does
/// where a limit is met exactly.
class CoinAirspace : public Airspace {
 public:
  bool allows(const Leg& leg, double /*deviation_m*/) const override {
    if (leg.from == leg.to) return true;
    std::uint64_t hash = 14695981039346656037u;
    for (const double x : {leg.from.x(), leg.from.y(), leg.from.z(), leg.to.x(), leg.to.y(), leg.to.z()}) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 1099511628211u;
      hash ^= hash >> 29;
    }
    return hash % 3 == 0;
  }
  std::string obstacle(const Leg& leg, double deviation_m) const override {
    return allows(leg, deviation_m) ? "" : "coin";
  }
  Box bounds() const override { return {Vec3(-200, -200, -0.4), Vec3(200, 200, 0.4)}; }
};

TEST(TourLimits, WaysAreAllowedAsTheyAreFlown) {
  const CoinAirspace airspace;
  testing::Random random(73);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    internal::flight::tour::SplitMix64 draw(static_cast<std::uint64_t>(i + 1));
    std::vector<Vec3> points = {Vec3(-50, random.uniform(-50, 50), 0), Vec3(50, random.uniform(-50, 50), 0)};
    const auto bends =
        internal::flight::tour::find_way(airspace, {points[0], points[1]}, draw, internal::core::ProgressReporter());
    if (!bends) continue;
    ++found;
    points.insert(points.begin() + 1, bends->begin(), bends->end());
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      ASSERT_TRUE(airspace.allows({points[k], points[k + 1]}, 0)) << i << " leg " << k;
    }
  }
  EXPECT_GT(found, 100);
}

TEST(TourLimits, AMultirotorKeepsLimitsThatRoundingDecides) {
  TourRequest request;
  testing::Random random(74);
  for (int t = 0; t < 6; ++t) {
    const Vec3 centre(random.uniform(-80, 80), random.uniform(-80, 80), 0);
    request.targets.push_back(
        {"T" + std::to_string(t), make_box_mesh(centre - Vec3(20, 20, 20), centre + Vec3(20, 20, 20))});
  }
  const CoinAirspace airspace;
  request.airspace = std::make_shared<CoinAirspace>();
  request.settings.dwell_s = 1;
  request.rounds = 15;
  for (request.seed = 1; request.seed < 12; ++request.seed) {
    const Tour tour = plan_tour(request);
    testing::judge(request, tour, nullptr);
    for (std::size_t i = 0; i < tour.flight.leg_count(); ++i) EXPECT_TRUE(airspace.allows(tour.flight.leg(i), 0));
    EXPECT_GE(tour.visits.size(), 3);
  }
}

/// Says yes to all, until it has been asked so often; then no to what comes near one place.
class ChangingAirspace : public Airspace {
 public:
  ChangingAirspace(long allowed, const Box& closed) : allowed_(allowed), closed_(closed) {}
  bool allows(const Leg& leg, double /*deviation_m*/) const override {
    return ++asked_ <= allowed_ || testing::distance_to(closed_, leg) > 0;
  }
  std::string obstacle(const Leg& /*leg*/, double /*deviation_m*/) const override { return "gate"; }
  Box bounds() const override { return {Vec3::Constant(-2000), Vec3::Constant(2000)}; }
  long asked() const { return asked_; }

 private:
  long allowed_;
  Box closed_;
  mutable std::atomic<long> asked_ = 0;
};

/// Targets in a ring; of the third one the place is closed.
TourRequest ring(TourVehicle::Kind kind) {
  TourRequest request;
  for (const Vec3& centre : {Vec3(0, 0, 50), Vec3(300, 0, 50), Vec3(300, 300, 50), Vec3(0, 300, 50)}) {
    request.targets.push_back({"T" + std::to_string(request.targets.size()),
                               make_box_mesh(centre - Vec3(40, 40, 20), centre + Vec3(40, 40, 20))});
  }
  request.settings.vehicle.kind = kind;
  request.settings.vehicle.turn_radius_m = 20;
  request.settings.vehicle.min_climb_deg = -15;
  request.settings.vehicle.max_climb_deg = 15;
  request.settings.dwell_s = 1;
  request.settings.time_limit_s = 600;
  request.rounds = 5;
  return request;
}

class ToursOfAll : public ::testing::TestWithParam<TourVehicle::Kind> {};
INSTANTIATE_TEST_SUITE_P(Vehicles, ToursOfAll,
                         ::testing::Values(TourVehicle::Kind::multirotor, TourVehicle::Kind::fixed_wing));

TEST_P(ToursOfAll, LeaveOutWhatBreaksALimitAtTheEnd) {
  // Whatever the search overlooks: the last check leaves out the target, and says what stands there.
  TourRequest request = ring(GetParam());
  const Box closed = {Vec3(255, 255, 0), Vec3(345, 345, 100)};
  const auto open = std::make_shared<ChangingAirspace>(1'000'000'000, closed);
  request.airspace = open;
  const Tour all = plan_tour(request);
  EXPECT_EQ(all.visits.size(), 4);
  // It closes before the last check.
  request.airspace =
      std::make_shared<ChangingAirspace>(open->asked() - static_cast<long>(all.flight.leg_count()), closed);
  const Tour tour = plan_tour(request);
  testing::judge(request, tour, nullptr);
  ASSERT_EQ(tour.problems.size(), 1);
  EXPECT_EQ(tour.problems[0].target, 2);
  EXPECT_EQ(tour.problems[0].obstacle, "gate");
  for (std::size_t i = 0; i < tour.flight.leg_count(); ++i) {
    EXPECT_GT(testing::distance_to(closed, tour.flight.leg(i)), 0);
  }
}

}  // namespace
}  // namespace vantage
