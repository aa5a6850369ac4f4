// Random tours, flown in small steps by an independent judge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "support/random.h"
#include "support/simple_airspace.h"
#include "support/solids.h"
#include "support/tour_judge.h"
#include "vantage/tour.h"

namespace vantage {
namespace {

using testing::BoxAirspace;
using testing::NamedBox;

Mesh cube_about(const Vec3& centre, double half) {
  return testing::make_box_mesh(centre - Vec3::Constant(half), centre + Vec3::Constant(half));
}

/// A box, a dome, a dome with lobes, or two boxes apart.
Mesh random_volume(testing::Random& random, const Vec3& centre, double size) {
  switch (random.integer(0, 3)) {
    case 0:
      return testing::make_box_mesh(centre - Vec3(size, size / 2, size / 3), centre + Vec3(size / 2, size, size));
    case 1:
      return testing::make_hemisphere(centre, size, 12, 5).mesh;
    case 2: {
      const double phase = random.uniform(0, 6), lobes = random.integer(2, 4);
      return testing::make_dome(
                 centre, 20, 6,
                 [=](double azimuth, double elevation) {
                   return size * (1 - 0.6 * std::cos(elevation) * std::pow(std::sin(lobes * (azimuth + phase) / 2), 2));
                 })
          .mesh;
    }
    default: {
      Mesh mesh = cube_about(centre, size / 2);
      testing::append(mesh, cube_about(centre + size * Vec3(2, random.uniform(-1, 1), 0.5), size / 3));
      return mesh;
    }
  }
}

TourRequest random_request(testing::Random& random, const Vec3& offset) {
  TourRequest request;
  const int targets = random.integer(1, 7);
  for (int i = 0; i < targets; ++i) {
    const Vec3 centre = offset + Vec3(random.uniform(-150, 150), random.uniform(-150, 150), random.uniform(20, 60));
    request.targets.push_back({"T" + std::to_string(i), random_volume(random, centre, random.uniform(12, 60))});
    if (random.chance(0.5)) request.targets.back().look_at = centre;
  }
  request.settings.closed = random.chance(0.7);
  request.settings.dwell_s = random.chance(0.2) ? 0 : random.uniform(0.5, 6);
  request.settings.margin_m = random.chance(0.2) ? 0 : random.uniform(0.2, 2);
  request.settings.simultaneous = random.chance(0.3);
  request.rounds = 15;
  request.seed = static_cast<std::uint64_t>(random.integer(1, 1'000'000));
  return request;
}

std::shared_ptr<const BoxAirspace> random_airspace(testing::Random& random, const Vec3& offset) {
  std::vector<NamedBox> obstacles;
  const int count = random.integer(0, 8);
  for (int i = 0; i < count; ++i) {
    const Vec3 corner = offset + Vec3(random.uniform(-150, 130), random.uniform(-150, 130), 0);
    obstacles.push_back(
        {"block " + std::to_string(i),
         {corner, corner + Vec3(random.uniform(3, 30), random.uniform(3, 30), random.uniform(20, 90))}});
  }
  return std::make_shared<BoxAirspace>(obstacles, random.uniform(0.5, 5),
                                       Box{offset + Vec3(-400, -400, 5), offset + Vec3(400, 400, 130)});
}

void fly_random_tours(std::uint64_t seed, int tours, const Vec3& offset, double slack) {
  testing::Random random(seed);
  int obstructed = 0, visits = 0;
  for (int i = 0; i < tours; ++i) {
    SCOPED_TRACE("tour " + std::to_string(i));
    TourRequest request = random_request(random, offset);
    const auto airspace = random_airspace(random, offset);
    request.airspace = airspace;
    const Vec3 home = offset + Vec3(random.uniform(-200, 200), random.uniform(-200, 200), 100);
    if (random.chance(0.5) && airspace->allows({home, home}, 0)) request.home = home;
    const Tour tour = plan_tour(request);
    testing::judge(request, tour, airspace.get(), slack);
    if (::testing::Test::HasFatalFailure()) return;
    visits += static_cast<int>(tour.visits.size());
    TourRequest free = request;
    free.airspace = nullptr;
    if (length_m(plan_tour(free).flight) < tour.length_m * (1 - 1e-9)) ++obstructed;
  }
  EXPECT_GT(visits, tours);
  EXPECT_GT(obstructed, tours / 10);
}

TEST(RandomTours, KeepAllLimits) { fly_random_tours(21, 150, Vec3::Zero(), 1e-5); }
TEST(RandomTours, KeepAllLimitsOnAMap) { fly_random_tours(22, 30, Vec3(5e6, 4e6, 0), 1e-5); }

/// Curvature and climb of the chords, and the judge's limits. Chords leave the curve by their error.
void judge_wing(const TourRequest& request, const Tour& tour, const BoxAirspace* airspace) {
  testing::judge(request, tour, airspace, 1e-5);
  const TourVehicle& vehicle = request.settings.vehicle;
  const Flight& flight = tour.flight;
  for (std::size_t i = 0; i < flight.leg_count(); ++i) {
    const Vec3 along = flight.leg(i).to - flight.leg(i).from;
    if (along.norm() < 1) continue;
    const double climb = std::atan2(along.z(), along.head<2>().norm()) * 180 / std::numbers::pi;
    EXPECT_GE(climb, vehicle.min_climb_deg - 1);
    EXPECT_LE(climb, vehicle.max_climb_deg + 1);
  }
  for (const FlightPoint& point : flight.points) EXPECT_EQ(point.hold_s, 0);
  // Three points on a curve of radius r or more: so is the circle through them, but for what steps across joints do.
  for (std::size_t i = 0; i + 2 < flight.points.size(); ++i) {
    const Vec3 a = flight.points[i + 1].position - flight.points[i].position;
    const Vec3 b = flight.points[i + 2].position - flight.points[i + 1].position;
    const double turn = std::atan2(a.cross(b).norm(), a.dot(b));
    EXPECT_LE(turn, 1.02 * (a.norm() + b.norm()) / 2 / vehicle.turn_radius_m + 1e-6) << i;
  }
}

TEST(RandomTours, OfAFixedWingKeepAllLimits) {
  testing::Random random(31);
  int visits = 0, asked = 0;
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE("tour " + std::to_string(i));
    const Vec3 offset = random.chance(0.3) ? Vec3(5e6, 4e6, 0) : Vec3(0, 0, 0);
    TourRequest request;
    const int targets = random.integer(1, 5);
    for (int t = 0; t < targets; ++t) {
      const Vec3 centre = offset + Vec3(random.uniform(-300, 300), random.uniform(-300, 300), random.uniform(30, 60));
      request.targets.push_back({"T" + std::to_string(t), random_volume(random, centre, random.uniform(50, 90))});
    }
    request.settings.vehicle = {TourVehicle::Kind::fixed_wing, random.uniform(8, 20),  2,
                                random.uniform(15, 40),        -random.uniform(5, 20), random.uniform(5, 20)};
    request.settings.closed = random.chance(0.7);
    request.settings.dwell_s = random.chance(0.3) ? 0 : random.uniform(0.3, 1.5);
    request.settings.margin_m = random.uniform(0, 1);
    request.settings.simultaneous = random.chance(0.3);
    request.rounds = 10;
    std::shared_ptr<const BoxAirspace> airspace;
    if (random.chance(0.6)) {
      std::vector<NamedBox> obstacles;
      for (int k = random.integer(0, 5); k > 0; --k) {
        const Vec3 corner = offset + Vec3(random.uniform(-300, 270), random.uniform(-300, 270), 0);
        obstacles.push_back({"tower", {corner, corner + Vec3(20, 20, random.uniform(20, 70))}});
      }
      airspace = std::make_shared<BoxAirspace>(obstacles, random.uniform(1, 5),
                                               Box{offset + Vec3(-800, -800, 5), offset + Vec3(800, 800, 200)});
      request.airspace = airspace;
    }
    const Vec3 home = offset + Vec3(random.uniform(-400, 400), random.uniform(-400, 400), 100);
    if (random.chance(0.5)) request.home = home;
    const Tour tour = plan_tour(request);
    judge_wing(request, tour, airspace.get());
    if (::testing::Test::HasFatalFailure()) return;
    visits += static_cast<int>(tour.visits.size());
    asked += targets;
  }
  EXPECT_GT(visits, asked * 9 / 10);
}

}  // namespace
}  // namespace vantage
