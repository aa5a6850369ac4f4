// What turning adds to bounds of tours: never more than a tour that turns needs, and not much less where it is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "flight/tour/tour_bound.h"
#include "flight/tour/turning.h"
#include "support/random.h"
#include "support/solids.h"
#include "vantage/dubins.h"

namespace vantage::internal::flight::tour {
namespace {

using testing::make_box_mesh;
using testing::Random;

constexpr double kPi = std::numbers::pi;

/// Of regions one each.
struct Poses {
  std::vector<PlanePose> at;
  std::vector<double> heights;
  double home_rad = 0;  // how a closed tour from a home comes back to it
};

enum class Ends { none, home, open };

double length_of(const Poses& poses, const std::vector<std::size_t>& order, double radius_m, Ends ends) {
  double length = 0;
  for (std::size_t k = 0; k + (ends == Ends::open ? 1 : 0) < order.size(); ++k) {
    const std::size_t from = order[k], to = order[(k + 1) % order.size()];
    PlanePose pose = poses.at[to];
    if (ends == Ends::home && to == order[0]) pose.heading_rad = poses.home_rad;
    const double level = shortest_dubins(poses.at[from], pose, radius_m).length_m();
    length += std::hypot(level, poses.heights[to] - poses.heights[from]);
  }
  return length;
}

/// A short tour through the boxes, by small changes of a pose at a time, in any order: what bounds must stay below.
double short_tour(const std::vector<Box>& boxes, double radius_m, Ends ends, Random& random) {
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  double best = std::numeric_limits<double>::infinity();
  do {
    for (int start = 0; start < 3; ++start) {
      Poses poses;
      for (const Box& box : boxes) {
        const Vec3 p = (box.min + box.max) / 2;
        poses.at.push_back({p.x(), p.y(), random.uniform(-kPi, kPi)});
        poses.heights.push_back(p.z());
      }
      double length = length_of(poses, order, radius_m, ends), share = 1;
      for (int i = 0; i < 300; ++i, share *= 0.985) {
        Poses other = poses;
        const auto k = static_cast<std::size_t>(random.integer(0, static_cast<int>(boxes.size()) - 1));
        const Vec3 size = boxes[k].max - boxes[k].min;
        other.at[k].heading_rad += share * random.uniform(-kPi, kPi);
        if (ends == Ends::home && random.chance(0.3)) other.home_rad += share * random.uniform(-kPi, kPi);
        other.at[k].x_m =
            std::clamp(other.at[k].x_m + share * size.x() * random.uniform(-1, 1), boxes[k].min.x(), boxes[k].max.x());
        other.at[k].y_m =
            std::clamp(other.at[k].y_m + share * size.y() * random.uniform(-1, 1), boxes[k].min.y(), boxes[k].max.y());
        other.heights[k] =
            std::clamp(other.heights[k] + share * size.z() * random.uniform(-1, 1), boxes[k].min.z(), boxes[k].max.z());
        const double changed = length_of(other, order, radius_m, ends);
        if (changed >= length) continue;
        length = changed;
        poses = other;
      }
      best = std::min(best, length);
    }
  } while (std::next_permutation(order.begin() + 1, order.end()));
  return best;
}

TEST(TourTurning, IsNeverAboveATourThatTurns) {
  Random random(57);
  int by_turning = 0;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const Ends ends = std::array{Ends::none, Ends::home, Ends::none, Ends::open}[static_cast<std::size_t>(round) % 4];
    const int count = round % 5 == 0 ? 5 : random.integer(2, 4);
    const double radius = std::exp(random.uniform(std::log(0.5), std::log(60.0)));  // of boxes some 100 m apart
    const double width = random.chance(0.5) ? 0.01 : random.uniform(1, 60);
    const Vec3 origin = random.chance(0.3) ? Vec3(5e5, 4.8e6, 300) : Vec3(0, 0, 0);
    std::vector<Box> boxes;
    BoundProblem problem;
    for (int i = 0; i < count; ++i) {
      Vec3 min = 100 * random.point(-1, 1);
      min.z() *= 0.2;
      Box box;
      box.min = min;
      box.max = min + width * random.point(0.2, 1);
      boxes.push_back(box);
      problem.regions.push_back(OuterRegion::given(make_box_mesh(origin + box.min, origin + box.max), "box"));
    }
    problem.turn_radius_m = radius;
    problem.closed = ends != Ends::open;
    if (ends != Ends::none) {  // a place to begin at, in any direction: now and then between two boxes
      const Vec3 home = random.chance(0.5) ? boxes[0].min : Vec3((boxes[0].min + boxes[1].min) / 2);
      boxes.insert(boxes.begin(), Box{});
      boxes[0].min = boxes[0].max = home;
      problem.start = origin + home;
    }
    const double tour = short_tour(boxes, radius, ends, random);
    for (const bool by_pairs : {false, true}) {
      BoundOptions options;
      options.by_pairs = by_pairs;
      options.by_insertion = !by_pairs || !has_pairs_bound();
      options.gap = 1e-4;
      options.time_limit_s = 20;
      options.most_nodes = 200;
      const double bound = bound_tour(problem, {}, options).length_m;
      EXPECT_LE(bound, tour * (1 + 1e-9));
      BoundProblem on_the_spot = problem;
      on_the_spot.turn_radius_m = 0;
      const double without = bound_tour(on_the_spot, {}, options).length_m;
      if (bound > without + 1e-3) ++by_turning;
    }
  }
  EXPECT_GT(by_turning, 60);
}

TEST(TourTurning, IsTightForRightAngles) {
  BoundProblem problem;
  const double side = 1000, radius = 20, size = 0.001;
  for (const Vec3& at : {Vec3(0, 0, 50), Vec3(side, 0, 50), Vec3(side, side, 50), Vec3(0, side, 50)}) {
    problem.regions.push_back(OuterRegion::given(make_box_mesh(at, at + Vec3(size, size, size)), "box"));
  }
  problem.turn_radius_m = radius;
  std::vector<Box> boxes;
  for (const OuterRegion& region : problem.regions) {
    Box box;
    for (const Vec3& v : region.mesh().vertices) box.extend(v);
    boxes.push_back(box);
  }
  Random random(3);
  const double tour = short_tour(boxes, radius, Ends::none, random);
  const double bound = bound_tour(problem).length_m;
  EXPECT_LE(bound, tour);
  const double turn = 2 * (kPi / 4 - std::sin(kPi / 4));
  EXPECT_NEAR(bound, 4 * side + 4 * radius * turn, 0.1);
  EXPECT_NEAR(bound, tour, 2e-4 * tour);
}

/// Out and back, along one line: at the home nobody need turn.
TEST(TourTurning, IsFreeWhereToursBeginAndEnd) {
  BoundProblem problem;
  problem.regions = {OuterRegion::given(make_box_mesh({1000, 0, 0}, {1000.001, 0.001, 0.001}), "box")};
  problem.start = Vec3(0, 0, 0);
  problem.turn_radius_m = 20;
  const double turn = 2 * 20 * (kPi / 2 - 1), bound = bound_tour(problem).length_m;
  EXPECT_LE(bound, 2000 + turn);
  EXPECT_GE(bound, 2000 + 0.9 * turn);
  problem.start.reset();
  problem.regions.push_back(OuterRegion::given(make_box_mesh({0, 0, 0}, {0.001, 0.001, 0.001}), "box"));
  EXPECT_GE(bound_tour(problem).length_m, 2000 + 1.8 * turn);
}

/// A home inside the first of three boxes: a flight from it need not close smoothly, so no turn there may count,
/// whether the search had to visit the home or meets it on the way.
TEST(TourTurning, KnowsNothingOfAHomeThatIsMetOnTheWay) {
  const double radius = 100;
  std::vector<Box> boxes(1);
  boxes[0].min = boxes[0].max = Vec3(0, 0, 100);
  BoundProblem problem;
  problem.start = boxes[0].min;
  problem.turn_radius_m = radius;
  for (const Vec3& at : {Vec3(0, 0, 100), Vec3(1000, 0, 100), Vec3(500, 800, 100)}) {
    Box box;
    box.min = at - Vec3(0.5, 0.5, 0.5);
    box.max = at + Vec3(0.5, 0.5, 0.5);
    boxes.push_back(box);
    problem.regions.push_back(OuterRegion::given(make_box_mesh(box.min, box.max), "box"));
  }
  Random random(5);
  // At the first box it is at home: nothing is flown there.
  std::vector<Box> flown = {boxes[0], boxes[2], boxes[3]};
  const double tour = short_tour(flown, radius, Ends::home, random);
  BoundOptions options;
  options.by_pairs = false;
  const double bound = bound_tour(problem, {}, options).length_m;
  EXPECT_LE(bound, tour);
  EXPECT_GT(bound, 0.99 * tour);
  const double closed = short_tour({boxes[1], boxes[2], boxes[3]}, radius, Ends::none, random);
  EXPECT_GT(closed, tour + 10) << "so that a bound of tours without a home would be told apart";
}

TEST(TourTurning, NeedsRoom) {
  const Direction east = direction_of({1, 0, 0}), north = direction_of({0, 1, 0}), up = direction_of({0, 0, 1});
  const double turn = 20 * 2 * (kPi / 4 - std::sin(kPi / 4));
  EXPECT_NEAR(turning_part(east, north, 1000, 1000, 20), turn, 1e-3 * turn);
  EXPECT_LE(turning_part(east, north, 1000, 1000, 20), turn);
  EXPECT_EQ(turning_part(east, north, 1000, 0, 20), 0);
  EXPECT_EQ(turning_part(east, north, 0, 1000, 20), 0);
  EXPECT_EQ(turning_part(east, north, 1000, -5, 20), 0);
  EXPECT_EQ(turning_part(east, north, 1000, 1000, 0), 0);
  EXPECT_EQ(turning_part(east, up, 1000, 1000, 20), 0);
  EXPECT_EQ(turning_part(east, east, 1000, 1000, 20), 0);
  // 10 m over ground are half a radian in circles of 20 m: two of them, one on each side, are less than the turn.
  EXPECT_NEAR(turning_part(east, north, 1000, 20, 20), 20 * (0.5 - std::sin(0.5)), 1e-4);
  // Steeper legs are worth less: only what is level of them turns.
  const Direction climbs = direction_of({std::cos(0.5), 0, std::sin(0.5)});
  EXPECT_NEAR(turning_part(climbs, north, 1000, 1000, 20), turn * std::cos(0.5), 1e-3 * turn);
}

/// At a home on the way a flight may begin in another direction than it came in: no turn reaches past it.
TEST(TourTurning, EndsAtAHomeOnTheWay) {
  const auto cube = [](const Vec3& at) {
    return Hull({at, at + Vec3(1, 0, 0), at + Vec3(0, 1, 0), at + Vec3(0, 0, 1)});
  };
  const Hull one = cube({0, 0, 0}), other = cube({40, 0, 0}), far = cube({20, 2000, 0}), home({{20, 0, 0}});
  const Direction east = direction_of({1, 0, 0}), there = direction_of({-20, 2000, 0}),
                  back = direction_of({-20, -2000, 0});
  TouringProgram program;
  program.hulls = {&one, &other, &far};
  const double without = turning_bound(program, std::vector<Direction>{east, there, back}, 20);
  program.hulls = {&one, &home, &other, &far};
  const double with = turning_bound(program, std::vector<Direction>{east, east, there, back}, 20);
  EXPECT_LT(with, without - 1);
  // A box on the way changes nothing.
  const Hull box = cube({20, 0, 0});
  program.hulls[1] = &box;
  EXPECT_EQ(turning_bound(program, std::vector<Direction>{east, east, there, back}, 20), without);
}

}  // namespace
}  // namespace vantage::internal::flight::tour
