// The search for the flight of a fixed wing: when it ends.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "support/solids.h"
#include "vantage/tour.h"

namespace vantage {
namespace {

/// Everywhere is free. At one of its calls it lets time pass, and counts the calls from then on.
class PausingAirspace : public Airspace {
 public:
  PausingAirspace(int pause_at, double pause_s) : pause_at_(pause_at), pause_s_(pause_s) {}

  bool allows(const Leg&, double) const override {
    if (++calls_ == pause_at_) std::this_thread::sleep_for(std::chrono::duration<double>(pause_s_));
    return true;
  }
  std::string obstacle(const Leg&, double) const override { return {}; }
  Box bounds() const override { return {Vec3(-1e4, -1e4, -1e4), Vec3(1e4, 1e4, 1e4)}; }

  int calls() const { return calls_; }
  int calls_after_pause() const { return calls_ < pause_at_ ? 0 : calls_ - pause_at_; }

 private:
  int pause_at_;
  double pause_s_;
  mutable std::atomic<int> calls_ = 0;
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

TEST(TourOfAFixedWing, LooksAtTheClockWithinEachStep) {
  constexpr double kLimit = 1;
  TourRequest request = climbing_tour(1e-9);
  const auto first = std::make_shared<PausingAirspace>(0, 0);
  request.airspace = first;
  const Tour at_once = plan_tour(request);
  ASSERT_EQ(at_once.order.size(), 3u);
  EXPECT_EQ(at_once.end, Tour::End::time_limit);
  int paused = 0;
  for (const int more : {1, 500, 20'000}) {  // another order is looked at, then it is made shorter
    request = climbing_tour(kLimit);
    const auto airspace = std::make_shared<PausingAirspace>(first->calls() + more, kLimit);
    request.airspace = airspace;
    const Tour tour = plan_tour(request);
    EXPECT_EQ(tour.order.size(), 3u);
    EXPECT_EQ(tour.end, Tour::End::time_limit);
    // The path that is being looked at, the drawing of some views, and the whole flight once more.
    const auto legs = static_cast<int>(tour.flight.leg_count() + at_once.flight.leg_count());
    EXPECT_LE(airspace->calls_after_pause(), 1000 + 2 * legs) << more;
    std::cout << first->calls() << " " << airspace->calls() << " " << airspace->calls_after_pause() << " " << legs
              << "\n";
    paused += airspace->calls_after_pause() > 0;
  }
  EXPECT_GE(paused, 1);
}

}  // namespace
}  // namespace vantage
