// Tours of multirotors, flown by an independent judge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "flight/tour/tour_course.h"
#include "support/random.h"
#include "support/simple_airspace.h"
#include "support/solids.h"
#include "support/tour_judge.h"
#include "support/wording.h"
#include "vantage/tour.h"

namespace vantage {
namespace {

using testing::BoxAirspace;
using testing::NamedBox;

Mesh box_about(const Vec3& centre, double half) {
  return testing::make_box_mesh(centre - Vec3::Constant(half), centre + Vec3::Constant(half));
}

/// The shortest length over all orders, each settled.
double shortest_of_all(const internal::flight::tour::Regions& regions, bool closed, const std::optional<Vec3>& home) {
  using namespace internal::flight::tour;
  std::vector<int> order(regions.size());
  std::iota(order.begin(), order.end(), 0);
  double best = std::numeric_limits<double>::infinity();
  do {
    if (closed && !home && order[0] != 0) break;  // the same courses again
    Course course;
    course.closed = closed;
    if (home) course.stops.push_back({Stop::kFixed, *home});
    for (const int region : order) {
      course.stops.push_back({region, regions[static_cast<std::size_t>(region)]->anchors().front()});
    }
    best = std::min(best, settled(course, regions).length_m());
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(Tour, FindsTheBestOrderOfAll) {
  testing::Random random(23);
  double worst = 0;
  for (int i = 0; i < 8; ++i) {
    TourRequest request;
    internal::flight::tour::Regions regions;
    const int targets = i == 0 ? 7 : random.integer(3, 6);
    for (int t = 0; t < targets; ++t) {
      const Vec3 centre(random.uniform(-100, 100), random.uniform(-100, 100), random.uniform(0, 40));
      request.targets.push_back({"T" + std::to_string(t), box_about(centre, random.uniform(3, 30))});
      regions.push_back(std::make_unique<internal::flight::tour::TourRegion>("T", request.targets.back().volume, 1.0));
    }
    request.settings.closed = random.chance(0.6);
    if (random.chance(0.5)) request.home = random.point(-100, 100);
    const double best = shortest_of_all(regions, request.settings.closed, request.home);
    const double found = plan_tour(request).length_m;
    worst = std::max(worst, found / best - 1);
    EXPECT_LE(found, best * (1 + 1e-3)) << targets;
  }
  RecordProperty("worst", std::to_string(worst));
}

TEST(Tour, TouchesConvexVolumesWhereItIsShortest) {
  // Between two points and past a box: the way to its nearest edge, as calculus gives it.
  testing::Random random(24);
  for (int i = 0; i < 300; ++i) {
    const double half = random.uniform(5, 40), margin = random.uniform(0, 2);
    const internal::flight::tour::TourRegion region("box", box_about({0, 0, 0}, half), margin);
    const Vec3 a = random.point(-100, 100), b = random.point(-100, 100);
    const Vec3 x = region.touch(a, b);
    EXPECT_TRUE(region.holds(x));
    const double inner = half - margin, length = (a - x).norm() + (x - b).norm();
    // Dense search over the box's inside.
    double least = std::numeric_limits<double>::infinity();
    Vec3 low = Vec3::Constant(-inner), high = Vec3::Constant(inner), best = Vec3::Zero();
    for (int round = 0; round < 14; ++round) {
      for (int k = 0; k < 343; ++k) {
        const int across = k % 7, along = k / 7 % 7, up = k / 49;
        const Vec3 share = Vec3(across, along, up) / 6;
        const Vec3 p = low + share.cwiseProduct(high - low);
        const double way = (a - p).norm() + (p - b).norm();
        if (way < least) {
          least = way;
          best = p;
        }
      }
      const Vec3 reach = (high - low) * 0.3;
      low = (best - reach).cwiseMax(Vec3::Constant(-inner));
      high = (best + reach).cwiseMin(Vec3::Constant(inner));
    }
    EXPECT_LE(length, least + 1e-3);
  }
}

TEST(Tour, ViewsInPassingWhereTheLegIsLongEnough) {
  // 8 m/s for 2 s: 16 m. The volume between the others is 40 m long: no need to hover.
  TourRequest request;
  request.targets = {
      {"left", box_about({-100, 0, 0}, 5)}, {"middle", box_about({0, 0, 0}, 20)}, {"right", box_about({100, 0, 0}, 5)}};
  const Tour tour = plan_tour(request);
  testing::judge(request, tour, nullptr);
  const auto middle =
      std::find_if(tour.visits.begin(), tour.visits.end(), [](const TourVisit& v) { return v.target == 1; });
  EXPECT_LT(middle->first_point, middle->last_point);
  EXPECT_NEAR(middle->end_m - middle->begin_m, 16, 1e-6);
  EXPECT_NEAR(tour.length_m, 2 * (200 - 2 * 4), 1e-3);
  // From rest to rest over 192 m at 8 m/s and 2 m/s2: 192 / 8 + 8 / 2 seconds, both ways, and 2 s hovering at each end.
  EXPECT_NEAR(tour.time_s, 2 * (192 / 8.0 + 4) + 4, 1e-3);
}

TEST(Tour, OneHoverServesSeveralAtOnceOnlyIfAllowed) {
  TourRequest request;
  for (const char* name : {"a", "b", "c"}) request.targets.push_back({name, box_about({0, 0, 0}, 5)});
  request.home = Vec3(50, 0, 0);
  const auto held = [](const Tour& tour) {
    double sum = 0;
    for (const FlightPoint& point : tour.flight.points) sum += point.hold_s;
    return sum;
  };
  const Tour one_by_one = plan_tour(request);
  testing::judge(request, one_by_one, nullptr);
  EXPECT_NEAR(held(one_by_one), 6, 1e-9);
  request.settings.simultaneous = true;
  const Tour at_once = plan_tour(request);
  testing::judge(request, at_once, nullptr);
  EXPECT_NEAR(held(at_once), 2, 1e-9);
}

TEST(Tour, WaitsForTheCameraToTurn) {
  TourRequest request;
  request.targets = {{"a", box_about({0, 0, 0}, 5), Vec3(0, 100, 0)}, {"b", box_about({3, 0, 0}, 5), Vec3(0, -100, 0)}};
  request.home = Vec3(50, 0, 0);
  request.settings.gimbal_rate_deg_s = 30;
  const Tour tour = plan_tour(request);
  double held = 0;
  for (const FlightPoint& point : tour.flight.points) held += point.hold_s;
  EXPECT_GE(held, 4 + 180.0 / 30 - 1);  // half a turn, but for what it flies meanwhile
}

TEST(Tour, FliesOverAWallOrSaysWhatStandsThere) {
  TourRequest request;
  request.targets = {{"west", box_about({-60, 0, 10}, 5)}, {"east", box_about({60, 0, 10}, 5)}};
  const Box inside = {Vec3(-100, -50, 2), Vec3(100, 50, 60)};
  const auto wall = [&](double top) {
    return std::make_shared<BoxAirspace>(std::vector<NamedBox>{{"long wall", {Vec3(-1, -60, 0), Vec3(1, 60, top)}}}, 3,
                                         inside);
  };
  const auto low = wall(40);
  request.airspace = low;
  const Tour over = plan_tour(request);
  testing::judge(request, over, low.get());
  EXPECT_TRUE(over.problems.empty());
  // Up to 43 m over the wall and down again, there and back: 2 (56 ... 66) m a side.
  EXPECT_LE(over.length_m, 4 * std::hypot(56, 30) * 1.05);

  const auto high = wall(70);
  request.airspace = high;
  const Tour stopped = plan_tour(request);
  testing::judge(request, stopped, high.get());
  ASSERT_EQ(stopped.problems.size(), 1);
  EXPECT_EQ(stopped.problems[0].kind, TourProblem::Kind::no_way);
  EXPECT_EQ(stopped.problems[0].obstacle, "long wall");
  ASSERT_TRUE(stopped.problems[0].neighbour);
  EXPECT_EQ(*stopped.problems[0].neighbour + stopped.problems[0].target, 1);

  // A volume that lies in the wall wholly.
  request.targets.push_back({"in the wall", box_about({0, 0, 20}, 3)});
  request.airspace = low;
  const Tour without = plan_tour(request);
  testing::judge(request, without, low.get());
  ASSERT_EQ(without.problems.size(), 1);
  EXPECT_EQ(without.problems[0].kind, TourProblem::Kind::no_place);
  EXPECT_EQ(without.problems[0].target, 2);
}

TEST(Tour, IsTheSameAgain) {
  testing::Random random(25);
  TourRequest request;
  for (int i = 0; i < 7; ++i) request.targets.push_back({"T", box_about(random.point(-100, 100), 10)});
  request.airspace =
      std::make_shared<BoxAirspace>(std::vector<NamedBox>{{"block", {Vec3(-20, -20, -150), Vec3(20, 20, 150)}}}, 3,
                                    bounding_box(box_about({0, 0, 0}, 200)));
  const Tour a = plan_tour(request), b = plan_tour(request);
  ASSERT_EQ(a.flight.points.size(), b.flight.points.size());
  for (std::size_t i = 0; i < a.flight.points.size(); ++i) {
    EXPECT_EQ(a.flight.points[i].position, b.flight.points[i].position);
  }
}

TEST(Tour, GivesTheBestSoFarWhenStopped) {
  TourRequest request;
  testing::Random random(26);
  for (int i = 0; i < 12; ++i) {
    request.targets.push_back({"T" + std::to_string(i), box_about(random.point(-200, 200), 10)});
  }
  bool was_searching = false;
  const Tour tour = plan_tour(request, [&](std::string_view stage, double fraction) {
    was_searching = was_searching || (stage == "order of the tour" && fraction > 0);
    return !was_searching;
  });
  EXPECT_EQ(tour.end, Tour::End::cancelled);
  testing::judge(request, tour, nullptr);
  EXPECT_EQ(tour.visits.size(), 12);
  testing::expect_code([&] { plan_tour(request, [](std::string_view, double) { return false; }); },
                       ErrorCode::cancelled);
  request.settings.time_limit_s = 1e-9;
  const Tour late = plan_tour(request);
  EXPECT_EQ(late.end, Tour::End::time_limit);
  testing::judge(request, late, nullptr);
}

TEST(Tour, DegenerateVolumes) {
  // Nested, identical, touching at a face, at an edge and at a corner; tiny and huge; a cavity.
  TourRequest request;
  const Mesh block = box_about({0, 0, 0}, 10);
  request.targets = {{"one", block}, {"same", block}, {"inner", box_about({0, 0, 0}, 4)}};
  request.targets.push_back({"face", box_about({20, 0, 0}, 10)});
  request.targets.push_back({"edge", box_about({20, 20, 0}, 10)});
  request.targets.push_back({"corner", box_about({-20, -20, -20}, 10)});
  request.targets.push_back({"tiny", box_about({0, 0, 100}, 0.01)});
  request.targets.push_back({"huge", box_about({0, 0, 0}, 5000)});
  Mesh hollow = box_about({60, 0, 0}, 10);
  Mesh hole = box_about({60, 0, 0}, 6);
  for (Triangle& t : hole.triangles) std::swap(t[0], t[1]);
  testing::append(hollow, hole);
  request.targets.push_back({"hollow", hollow});
  request.settings.margin_m = 1e-3;
  for (const bool simultaneous : {false, true}) {
    request.settings.simultaneous = simultaneous;
    const Tour tour = plan_tour(request);
    testing::judge(request, tour, nullptr);
    EXPECT_EQ(tour.visits.size(), request.targets.size());
  }
}

TEST(Tour, ScalesFromMillimetresToKilometres) {
  for (const double scale : {1e-3, 1e-1, 1.0, 1e2, 1e4}) {
    SCOPED_TRACE(scale);
    TourRequest request;
    testing::Random random(27);
    for (int i = 0; i < 5; ++i) {
      request.targets.push_back({"T" + std::to_string(i), box_about(random.point(-10, 10) * scale, scale)});
    }
    request.settings.margin_m = 0.1 * scale;
    const Tour tour = plan_tour(request);
    EXPECT_EQ(tour.visits.size(), 5);
    for (const TourVisit& visit : tour.visits) {
      const Vec3& position = tour.flight.points[visit.first_point].position;
      EXPECT_GE(testing::slow_depth(request.targets[visit.target].volume, position), 0.1 * scale * (1 - 1e-9));
    }
    EXPECT_GT(tour.length_m, scale);
  }
}

TEST(Tour, RefusesWhatCannotBeFlown) {
  TourRequest request;
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::nothing_given, "tour");
  request.targets = {{"wide", box_about({0, 0, 0}, 50)}, {"narrow", box_about({0, 0, 0}, 0.5)}};
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::limits_empty, "narrow");
  request.targets[1] = {"empty", {}};
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::mesh_empty, "empty");
  request.targets[1] = {"open", box_about({0, 0, 0}, 50)};
  request.targets[1].volume.triangles.pop_back();
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::mesh_not_closed, "open");
  request.targets[1] = {"turned", box_about({0, 0, 0}, 50)};
  for (Triangle& t : request.targets[1].volume.triangles) std::swap(t[0], t[1]);
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::mesh_inside_out, "turned");
  request.targets.pop_back();
  request.home = Vec3(0, 0, std::numeric_limits<double>::quiet_NaN());
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::coordinate_not_finite, "tour.home");
  request.home = Vec3(0, 0, 10);
  request.airspace = std::make_shared<BoxAirspace>(
      std::vector<NamedBox>{{"town hall", {Vec3(-5, -5, 0), Vec3(5, 5, 20)}}}, 3, Box{{-100, -100, 0}, {100, 100, 90}});
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::value_out_of_range, "tour.home");
  request.home = Vec3(0, 0, 95);
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::value_out_of_range, "tour.home");
  request.home.reset();
  request.settings.vehicle.speed_m_s = 0;
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::value_out_of_range, "tour.vehicle.speed");
  request.settings.vehicle.speed_m_s = 8;
  const auto refuses = [&](double TourSettings::*member, double value, const char* where) {
    TourRequest absurd = request;
    absurd.settings.*member = value;
    testing::expect_error([&] { plan_tour(absurd); }, ErrorCode::value_out_of_range, where);
  };
  refuses(&TourSettings::dwell_s, 1e308, "tour.view.dwell");
  refuses(&TourSettings::dwell_s, 86'401, "tour.view.dwell");
  refuses(&TourSettings::margin_m, 1e5, "tour.view.margin");
  refuses(&TourSettings::clearance_m, 1e300, "tour.clearance");
  refuses(&TourSettings::gimbal_rate_deg_s, 1e-9, "tour.gimbal.rate");
  refuses(&TourSettings::time_limit_s, 1e9, "tour.time_limit");
  request.chord_error_m = 0;
  testing::expect_error([&] { plan_tour(request); }, ErrorCode::value_out_of_range, "tour");
}

}  // namespace
}  // namespace vantage
