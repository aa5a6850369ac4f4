// Bounds of tours: never above a tour, tight where the shortest tour is known, over nothing but outer regions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>
#include <vector>

#include "flight/tour/cells.h"
#include "flight/tour/pairs_bound.h"
#include "flight/tour/tour_bound.h"
#include "flight/tour/touring_program.h"
#include "support/random.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"

namespace vantage::internal::flight::tour {
namespace {

using testing::append;
using testing::expect_code;
using testing::make_box_mesh;
using testing::Random;

OuterRegion box_region(const Vec3& min, const Vec3& max) { return OuterRegion::given(make_box_mesh(min, max), "box"); }

/// The shortest tour of convex regions, by trying all orders.
double shortest(const std::vector<OuterRegion>& regions, bool closed, std::vector<std::size_t>& best_order,
                std::vector<Vec3>& points, const std::vector<double>& dwell = {}) {
  const Cells cells(regions);
  // An open tour begins with the last region.
  std::vector<std::size_t> order(regions.size() - 1);
  std::iota(order.begin(), order.end(), std::size_t{0});
  double best = std::numeric_limits<double>::infinity();
  do {
    TouringProgram program;
    program.closed = closed;
    std::vector<std::size_t> all = {regions.size() - 1};
    all.insert(all.end(), order.begin(), order.end());
    for (const std::size_t r : all) {
      const double stay = dwell.empty() ? 0 : dwell[r];
      program.hulls.push_back(cells[r].hull.get());
      if (stay > 0) {
        program.hulls.push_back(cells[r].hull.get());
        program.at_least_m.push_back(stay);
      }
      program.at_least_m.push_back(0);
    }
    program.at_least_m.resize(program.leg_count());
    const TouringSolution solution = solve_touring(program, {1e-7, 1e-7, 30});
    std::vector<Vec3> inside;
    for (std::size_t k = 0; k < program.hulls.size(); ++k) {
      inside.push_back(program.hulls[k]->nearest(solution.points[k], 1e-9).point);
    }
    const double length = touring_length(program, inside);
    if (length < best) {
      best = length;
      best_order = all;
      points.clear();
      for (const Vec3& p : inside) points.push_back(p + cells.origin());
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(TourBound, OfRegionsThatAreKnown) {
  BoundProblem problem;
  problem.regions = {box_region({0, 0, 0}, {2, 2, 2})};
  EXPECT_EQ(bound_tour(problem).length_m, 0);
  problem.regions.push_back(box_region({8, 0, 0}, {9, 2, 2}));
  EXPECT_NEAR(bound_tour(problem).length_m, 12, 0.01);
  problem.start = Vec3(5, 1, 1);
  EXPECT_NEAR(bound_tour(problem).length_m, 12, 0.01);
  problem.closed = false;
  EXPECT_NEAR(bound_tour(problem).length_m, 9, 0.01);  // 3 there, 6 to the other one
  problem.finish = Vec3(5, 1, 1);
  EXPECT_NEAR(bound_tour(problem).length_m, 12, 0.01);
}

TEST(TourBound, IsTightForRandomConvexRegions) {
  Random random(21);
  for (int round = 0; round < 16; ++round) {
    SCOPED_TRACE(round);
    const int count = random.integer(2, 5);
    const Vec3 origin = random.chance(0.5) ? Vec3(5e5, 4.8e6, 300) : Vec3(0, 0, 0);
    const double size = random.chance(0.3) ? 0.01 : 100;
    std::vector<OuterRegion> regions;
    for (int i = 0; i < count; ++i) {
      const Vec3 min = origin + size * random.point(-1, 1);
      regions.push_back(box_region(min, min + size * random.point(0.01, 0.6)));
    }
    const bool closed = random.chance(0.5);
    BoundProblem problem;
    problem.regions = regions;
    problem.closed = closed;
    const Vec3 home = origin + size * random.point(-1, 1);
    if (!closed || random.chance(0.5)) {
      problem.start = home;
      regions.push_back(OuterRegion::point(home, "home"));
    }
    std::vector<std::size_t> order;
    std::vector<Vec3> points;
    Incumbent incumbent;
    incumbent.length_m = shortest(regions, closed, order, points);
    BoundOptions options;
    options.gap = 1e-4;
    options.by_pairs = false;
    const TourBound bound = bound_tour(problem, incumbent, options);
    EXPECT_LE(bound.length_m, incumbent.length_m + 1e-6 * size);
    EXPECT_GE(bound.length_m, incumbent.length_m * (1 - 2e-4) - 1e-5 * size);
    EXPECT_TRUE(bound.gap_reached || incumbent.length_m < 1e-3 * size);
  }
}

/// The bound by pairs, which takes new vectors along other tours: as tight as the hulls allow.
TEST(TourBound, ByPairsIsTightForRandomConvexRegions) {
  if (!has_pairs_bound()) GTEST_SKIP() << "built without a solver of linear programs";
  Random random(24);
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const Vec3 origin = random.chance(0.5) ? Vec3(5e5, 4.8e6, 300) : Vec3(0, 0, 0);
    const double size = random.chance(0.3) ? 0.01 : 100;
    const bool closed = random.chance(0.5), dwell = random.chance(0.3);
    std::vector<OuterRegion> regions;
    BoundProblem problem;
    for (int i = 0; i < 5; ++i) {
      const Vec3 min = origin + size * random.point(-1, 1);
      regions.push_back(box_region(min, min + size * random.point(0.01, 0.4)));
      if (dwell) problem.dwell_m.push_back(size * random.uniform(0, 0.2));
    }
    problem.regions = regions;
    problem.closed = closed;
    problem.start = origin + size * random.point(-1, 1);
    regions.push_back(OuterRegion::point(*problem.start, "home"));
    std::vector<double> dwells = problem.dwell_m;
    if (dwell) dwells.push_back(0);
    std::vector<std::size_t> order;
    std::vector<Vec3> points;
    Incumbent incumbent;
    incumbent.length_m = shortest(regions, closed, order, points, dwells);
    BoundOptions options;
    options.gap = 1e-4;
    options.by_insertion = false;
    const TourBound bound = bound_tour(problem, incumbent, options);
    EXPECT_EQ(bound.kind, BoundKind::pairs);
    EXPECT_LE(bound.length_m, incumbent.length_m + 1e-6 * size);
    EXPECT_GE(bound.length_m, dwell ? 0 : incumbent.length_m * (1 - 1e-3) - 1e-4 * size);
  }
}

TEST(TourBound, CountsDwellsOneByOne) {
  Random random(22);
  for (int round = 0; round < 6; ++round) {
    SCOPED_TRACE(round);
    std::vector<OuterRegion> regions;
    const int count = random.integer(2, 4);
    BoundProblem problem;
    for (int i = 0; i < count; ++i) {
      const Vec3 min = random.point(-20, 20);
      regions.push_back(box_region(min, min + random.point(1, 30)));
      problem.dwell_m.push_back(random.uniform(0, 30));
    }
    problem.regions = regions;
    std::vector<std::size_t> order;
    std::vector<Vec3> points;
    Incumbent incumbent;
    incumbent.length_m = shortest(regions, true, order, points, problem.dwell_m);
    BoundOptions options;
    options.gap = 1e-3;
    options.by_pairs = false;
    const TourBound bound = bound_tour(problem, incumbent, options);
    EXPECT_LE(bound.length_m, incumbent.length_m + 1e-6);
    EXPECT_TRUE(bound.gap_reached);
  }
}

/// A region of two boxes: its hull is met at once, the region is not.
TEST(TourBound, CutsRegionsThatAreNotConvex) {
  Mesh two = make_box_mesh({0, -60, 0}, {10, -50, 10});
  append(two, make_box_mesh({0, 50, 0}, {10, 60, 10}));
  BoundProblem problem;
  problem.regions = {box_region({-40, -1, 4}, {-38, 1, 6}), OuterRegion::given(two, "two"),
                     box_region({48, -1, 4}, {50, 1, 6})};
  // There and back over one of the boxes: from (-38, 1) over (0..10, 50) to (48, 1).
  const double side = std::hypot(38.0 + 5, 49.0), expected = 2 * side;
  Incumbent incumbent;
  incumbent.length_m = 86 + expected;
  BoundOptions options;
  options.gap = 1e-3;
  options.by_pairs = false;
  const TourBound bound = bound_tour(problem, incumbent, options);
  EXPECT_GT(bound.length_m, 86 + 2 * 43 + 20);
  EXPECT_LE(bound.length_m, incumbent.length_m);
  EXPECT_TRUE(bound.gap_reached) << bound.length_m << " of " << incumbent.length_m;
}

/// A stay along a region like a U begins on one side of every plane that tells its sides apart, and ends on the other.
TEST(TourBound, LetsAStayGoFromOnePartOfARegionToTheOther) {
  Mesh u = make_box_mesh({0, 0, 0}, {10, 60, 10});
  append(u, make_box_mesh({5, 0, 0}, {95, 10, 10}));
  append(u, make_box_mesh({90, 0, 0}, {100, 60, 10}));
  BoundProblem problem;
  problem.regions = {OuterRegion::given(u, "u"), box_region({70, 59, 4}, {72, 61, 6})};
  problem.start = Vec3(30, 60, 5);  // between the sides
  problem.closed = false;
  problem.dwell_m = {50 + 80 + 50, 0};  // along the inner side of the U
  const double shortest_m = 20 + problem.dwell_m[0] + 20;
  Incumbent incumbent;
  incumbent.length_m = 2 * shortest_m;  // a longer one is known: no bound is above that
  BoundOptions options;
  options.by_pairs = false;
  options.time_limit_s = 2;
  const double bound_m = bound_tour(problem, incumbent, options).length_m;
  EXPECT_LE(bound_m, shortest_m);
  EXPECT_GT(bound_m, 0.99 * problem.dwell_m[0]);
}

TEST(TourBound, IsOverOuterRegionsOnly) {
  static_assert(!std::is_constructible_v<OuterRegion, Mesh>);
  static_assert(!std::is_constructible_v<OuterRegion, Mesh, std::string>);
  static_assert(!std::is_constructible_v<OuterRegion, Volume>);
  static_assert(!std::is_constructible_v<OuterRegion, OuterRegion::Kind, Mesh, std::string>);
  static_assert(!std::is_default_constructible_v<OuterRegion>);
  Volume computed = volume_of_mesh(make_box_mesh({0, 0, 0}, {1, 1, 1}), "range");
  computed.provenance.emplace();
  computed.provenance->method = "exact";
  expect_code([&] { OuterRegion::given(computed, "planted"); }, ErrorCode::value_out_of_range);
  OuterVolume outer;
  outer.volume = computed;
  expect_code([&] { OuterRegion::of(outer, "planted"); }, ErrorCode::value_out_of_range);
  outer.volume.provenance.reset();
  EXPECT_EQ(OuterRegion::of(outer, "outer").kind(), OuterRegion::Kind::outer);
  outer.volume.mesh = {};
  expect_code([&] { OuterRegion::of(outer, "empty"); }, ErrorCode::mesh_empty);
}

/// Whoever gets an inner mesh past the type: a known tour gives it away.
TEST(TourBound, NoticesARegionThatIsTooSmall) {
  BoundProblem problem;
  problem.regions = {box_region({0, 0, 0}, {1, 1, 1}), box_region({8, 0, 0}, {9, 1, 1})};
  Incumbent incumbent{{0, 1}, {{1, 1, 1}, {7.9, 1, 1}}, 13.8};  // in the true second region, which is larger
  expect_code([&] { bound_tour(problem, incumbent); }, ErrorCode::internal_defect);
  incumbent = {};
  incumbent.length_m = 13.8;
  expect_code([&] { bound_tour(problem, incumbent); }, ErrorCode::internal_defect);
}

TEST(TourBound, RefusesWhatIsNoProblem) {
  expect_code([] { bound_tour({}); }, ErrorCode::nothing_given);
  BoundProblem problem;
  problem.regions = {box_region({0, 0, 0}, {1, 1, 1})};
  problem.closed = false;
  expect_code([&] { bound_tour(problem); }, ErrorCode::nothing_given);
  problem.closed = true;
  problem.dwell_m = {1, 2};
  expect_code([&] { bound_tour(problem); }, ErrorCode::array_sizes_differ);
  problem.dwell_m = {-1};
  expect_code([&] { bound_tour(problem); }, ErrorCode::value_out_of_range);
  problem.dwell_m = {};
  expect_code([&] { bound_tour(problem, {{1}, {{0, 0, 0}}, 5}); }, ErrorCode::array_sizes_differ);
  expect_code([] { OuterRegion::point({std::nan(""), 0, 0}, "home"); }, ErrorCode::coordinate_not_finite);
  expect_code([] { OuterRegion::given(Mesh(), "none"); }, ErrorCode::mesh_empty);
}

TEST(TourBound, StopsWhenAsked) {
  Random random(23);
  BoundProblem problem;
  for (int i = 0; i < 12; ++i) {
    const Vec3 min = random.point(-100, 100);
    problem.regions.push_back(box_region(min, min + random.point(1, 5)));
  }
  int calls = 0;
  expect_code([&] { bound_tour(problem, {}, {}, [&](std::string_view, double) { return ++calls < 3; }); },
              ErrorCode::cancelled);
  BoundOptions options;
  options.most_nodes = 20;
  options.by_pairs = false;
  const TourBound one = bound_tour(problem, {}, options);
  options.threads = 1;
  const TourBound other = bound_tour(problem, {}, options);
  EXPECT_EQ(one.length_m, other.length_m);  // whatever the number of threads
  EXPECT_GT(one.length_m, 0);
}

}  // namespace
}  // namespace vantage::internal::flight::tour
