// The search for the flight of a fixed wing: when it ends.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "core/progress_reporter.h"
#include "support/solids.h"
#include "vantage/tour.h"

namespace vantage {
namespace {

/// Everywhere is free.
class CountingAirspace : public Airspace {
 public:
  bool allows(const Leg&, double) const override {
    ++calls_;
    return true;
  }
  std::string obstacle(const Leg&, double) const override { return {}; }
  Box bounds() const override { return {Vec3(-1e4, -1e4, -1e4), Vec3(1e4, 1e4, 1e4)}; }

  std::size_t calls() const { return calls_; }

 private:
  mutable std::atomic<std::size_t> calls_ = 0;
};

/// It climbs so slowly that it circles many times between the volumes: each path takes long to look at.
TourRequest climbing_tour(double time_limit_s) {
  TourRequest request;
  for (const Vec3& centre : {Vec3(300, 0, 100), Vec3(-300, 100, 160), Vec3(0, -300, 60)}) {
    const Vec3 half(60, 60, 15);
    request.targets.push_back(
        {"T" + std::to_string(request.targets.size()), testing::make_box_mesh(centre - half, centre + half), {}});
  }
  request.settings.vehicle = {TourVehicle::Kind::fixed_wing, 15, 2, 30, -1, 1};
  request.settings.dwell_s = 1;
  request.settings.time_limit_s = time_limit_s;
  request.home = Vec3(0, 0, 30);
  return request;
}

/// Only the paths of one flight are looked at: of all that might be shorter there are hundreds.
TEST(TourOfAFixedWing, TakesTheFirstFlightWhenTheTimeIsOver) {
  TourRequest request = climbing_tour(1e-9);
  const auto airspace = std::make_shared<CountingAirspace>();
  request.airspace = airspace;
  const Tour tour = plan_tour(request);
  EXPECT_EQ(tour.order.size(), 3u);
  EXPECT_EQ(tour.end, Tour::End::time_limit);
  constexpr std::size_t kOfDrawing = 1000;
  EXPECT_LE(airspace->calls(), 4 * tour.flight.leg_count() + kOfDrawing);
}

/// There is time for the first flight, and for a part of what makes it shorter, which asks in each of its rounds.
TEST(TourOfAFixedWing, LooksAtTheClockInEachRound) {
  constexpr double kLimit = 1.5;
  const internal::core::ProgressReporter::AskAlways always;
  int calls = 0, after = 0;
  plan_tour(climbing_tour(1e-9), [&](std::string_view, double) { return ++calls > 0; });
  const int pause_at = calls + 1000;
  calls = 0;
  const Tour tour = plan_tour(climbing_tour(kLimit), [&](std::string_view, double) {
    if (++calls == pause_at) std::this_thread::sleep_for(std::chrono::duration<double>(kLimit));
    after += calls > pause_at;
    return true;
  });
  EXPECT_EQ(tour.end, Tour::End::time_limit);
  EXPECT_LE(after, 50);
}

}  // namespace
}  // namespace vantage
