// LegViews against PointQuery at dense points of legs and tubes, and where the borders are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/legs.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/query.h"

namespace vantage {
namespace {

using testing::hides;
using testing::holds;
using testing::kLegWorlds;
using testing::LegWorld;
using testing::place_on;
using testing::Random;
using testing::SceneBuilder;

/// Targets of one, two and no sides, in parts, with many corners.
Target some_target(Random& random, int kind) {
  const Vec3 centre(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(4, 8));
  if (kind == 0) return testing::random_target(random, 4, random.uniform(0.5, 4), centre, Vec3::UnitZ());
  if (kind == 1) return testing::random_target(random, 12, 2, centre, random.direction());
  if (kind == 2) return Target::point(centre);
  Target target = testing::random_target(random, 3, 2, centre, Vec3(1, 0, 0.3));
  target.parts.push_back(testing::random_target(random, 5, 1, centre + Vec3(0, 0, 3), Vec3(0.8, 0.3, 0.1)).parts[0]);
  return target;
}

Leg some_leg(Random& random) {
  const auto place = [&] { return Vec3(random.uniform(-80, 80), random.uniform(-80, 80), random.uniform(-2, 60)); };
  const Vec3 from = place();
  return {from, random.chance(0.05) ? from : place()};
}

/// Whether a point sees the target, and all points so near to it.
struct Around {
  bool all = true, any = false;
  std::vector<std::string> blocked_by;
};
Around around(PointQuery& query, const Vec3& point, double step) {
  std::vector<Vec3> points{point};
  for (int axis = 0; axis < 3; ++axis) {
    points.push_back(point + step * Vec3::Unit(axis));
    points.push_back(point - step * Vec3::Unit(axis));
  }
  Around result;
  for (const PointAnswer& answer : query.answer(points)) {
    result.all = result.all && answer.inside;
    result.any = result.any || answer.inside;
    result.blocked_by.insert(result.blocked_by.end(), answer.blocked_by.begin(), answer.blocked_by.end());
  }
  return result;
}

struct Case {
  PreparedTarget target;
  Leg leg;
};
template <typename Check>
void for_some_cases(Random& random, int targets, int legs, const Check& check) {
  for (const LegWorld& world : kLegWorlds) {
    for (int i = 0; i < targets; ++i) {
      SCOPED_TRACE("scale " + std::to_string(world.scale) + " target " + std::to_string(i));
      const PreparedScene scene(world.scene(testing::random_city(random, 25, 8)));
      const PreparedTarget target(scene, world.target(some_target(random, i % 4)), {.max_range_m = 60 * world.scale});
      const LegViews views(target);
      PointQuery query(target);
      for (int k = 0; k < legs; ++k) {
        const Leg leg = some_leg(random);
        check(world, views, query, Leg{world.at(leg.from), world.at(leg.to)});
        if (::testing::Test::HasFailure()) return;
      }
    }
  }
}

void expect_sound(const LegView& view) {
  EXPECT_TRUE(testing::is_sorted_and_disjoint(view.seen));
  EXPECT_TRUE(testing::is_sorted_and_disjoint(view.out_of_range));
  EXPECT_TRUE(testing::is_sorted_and_disjoint(view.behind_target));
  for (const LegBlocker& blocker : view.hidden_by) {
    EXPECT_FALSE(blocker.intervals.empty());
    EXPECT_TRUE(testing::is_sorted_and_disjoint(blocker.intervals));
  }
}

TEST(LegViews, AgreesWithPointsOfTheLeg) {
  Random random(20250310);
  std::size_t seen = 0, hidden = 0, borders = 0;
  for_some_cases(random, 8, 30, [&](const LegWorld& world, const LegViews& views, PointQuery& query, const Leg& leg) {
    const LegView view = views.look(leg);
    expect_sound(view);
    std::vector<double> shares;
    for (int i = 0; i <= 100; ++i) shares.push_back(i / 100.0);
    for (const LegInterval& part : view.seen) {
      shares.insert(shares.end(), {part.begin, part.end, 0.5 * (part.begin + part.end)});
      borders += part.begin > 0;
      for (const double step : {1e-9, 1e-6, 1e-4}) {
        shares.push_back(std::max(0.0, part.begin - step));
        shares.push_back(std::min(1.0, part.end + step));
      }
    }
    const double step = 3e-4 * world.scale + 100 * world.rounding();
    for (const double share : shares) {
      const Vec3 point = place_on(leg, share);
      const PointAnswer answer = query.answer(std::vector<Vec3>{point})[0];
      const bool is_seen = holds(view.seen, share);
      SCOPED_TRACE(::testing::Message() << "share " << share);
      if (is_seen) {
        ++seen;
        ASSERT_TRUE(answer.inside) << "claimed, but hidden";
      } else {
        ++hidden;
        ASSERT_FALSE(answer.inside && around(query, point, step).all) << "left out";
      }
      ASSERT_GE(holds(view.out_of_range, share), answer.out_of_range);
      ASSERT_GE(holds(view.behind_target, share), answer.behind_target);
      if (answer.out_of_range || answer.behind_target) continue;
      for (const std::string& name : answer.blocked_by) ASSERT_TRUE(hides(view, name, share)) << name;
      for (const LegBlocker& blocker : view.hidden_by) {
        if (!holds(blocker.intervals, share)) continue;
        const std::vector<std::string> names = around(query, point, step).blocked_by;
        ASSERT_TRUE(std::ranges::count(names, blocker.name)) << blocker.name << " hides nothing there";
      }
    }
  });
  EXPECT_GT(seen, 1000u);
  EXPECT_GT(hidden, 1000u);
  EXPECT_GT(borders, 100u);
}

// All of the tube is seen; and where a part of the leg is left out, something in the tube, or hardly beside it, is not.
TEST(LegViews, AgreesWithPointsOfTheTube) {
  Random random(20250311);
  std::size_t seen = 0, ends = 0, explained = 0;
  for_some_cases(random, 8, 15, [&](const LegWorld& world, const LegViews& views, PointQuery& query, const Leg& leg) {
    const double radius = world.scale * random.uniform(0.05, 6);
    const LegView view = views.look(leg, radius);
    expect_sound(view);
    const auto inside_all = [&](const std::vector<Vec3>& points) {
      const std::vector<PointAnswer> answers = query.answer(points);
      return std::all_of(answers.begin(), answers.end(), [](const PointAnswer& answer) { return answer.inside; });
    };
    for (const LegInterval& part : view.seen) {
      for (const double share : {part.begin, part.end, random.uniform(part.begin, part.end)}) {
        ++seen;
        ASSERT_TRUE(inside_all(testing::ball_points(random, place_on(leg, share), radius * (1 - 1e-9), 200)));
      }
      for (const double share : {part.begin, part.end}) {
        if (share == 0 || share == 1) continue;
        ++ends;
        explained += !inside_all(testing::ball_points(random, place_on(leg, share), radius * 1.03, 800));
      }
    }
  });
  EXPECT_GT(seen, 300u);
  EXPECT_GT(ends, 100u);
  EXPECT_GT(static_cast<double>(explained), 0.95 * static_cast<double>(ends)) << explained << " of " << ends;
}

// A screen beside the way: what it hides is known, and its grown shape round the edge too.
TEST(LegViews, MeetsKnownBorders) {
  for (const LegWorld& world : kLegWorlds) {
    // From x < 0 at height 10 the screen x = -5, z 4..6 hides part of the target |x| <= 1 where the line to (1, 0) or
    // (-1, 0) meets it: from z = 10 these are x = 1 - 6 * 10 / 4 = -14 and -1 - 4 * 10 / 6 = -7.666.
    const SceneBuilder builder =
        SceneBuilder().polygon("screen", {{-5, -50, 4}, {-5, 50, 4}, {-5, 50, 6}, {-5, -50, 6}});
    const PreparedScene scene(world.scene(builder));
    const PreparedTarget target(scene,
                                world.target(testing::target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}})),
                                {.max_range_m = 1000 * world.scale});
    const LegViews views(target);
    const Leg leg{world.at({-40, 0, 10}), world.at({10, 0, 10})};
    const double tolerance = 1e-8 + 10 * world.rounding() / world.scale;
    const LegView view = views.look(leg);
    ASSERT_EQ(view.seen.size(), 2u);
    EXPECT_EQ(view.seen[0].begin, 0);
    EXPECT_NEAR(view.seen[0].end * 50 - 40, -14, tolerance);
    EXPECT_NEAR(view.seen[1].begin * 50 - 40, -1 - 4.0 * 10 / 6, tolerance);
    EXPECT_LE(view.seen[0].end * 50 - 40, -14 + 1e-12);
    ASSERT_EQ(view.hidden_by.size(), 1u);
    EXPECT_EQ(view.hidden_by[0].name, "screen");
    EXPECT_TRUE(view.out_of_range.empty());
    EXPECT_TRUE(view.behind_target.empty());

    // The tube: beside a flat border by R / sin of the angle. The upper plane holds the line from (-1, 0) over (-5, 6),
    // the lower one that from (1, 0) over (-5, 4).
    const double radius = 0.5;
    const LegView tube = views.look(leg, radius * world.scale);
    ASSERT_EQ(tube.seen.size(), 2u);
    const double lower = std::sin(std::atan2(4, 6)), upper = std::sin(std::atan2(6, 4));
    EXPECT_NEAR(tube.seen[0].end * 50 - 40, -14 - radius / lower, tolerance);
    EXPECT_NEAR(tube.seen[1].begin * 50 - 40, -1 - 4.0 * 10 / 6 + radius / upper, tolerance);

    // Beside the screen's upper edge, between the normals of the two planes that meet there: the edge is round. Were
    // the planes but moved out, they would meet 1.045 radii from it.
    const double between = 0.5 * std::atan2(4, 6);
    const auto beside = [&](double y) {
      return world.at(Vec3(-5, y, 6) + 1.02 * radius * Vec3(std::cos(between), 0, std::sin(between)));
    };
    const Leg edge{beside(-5), beside(5)};
    EXPECT_EQ(views.look(edge, radius * world.scale).seen, (std::vector<LegInterval>{{0, 1}}));
    EXPECT_TRUE(views.look(edge, radius * world.scale * 1.0201).seen.empty());
  }
}

TEST(LegViews, TellsRangeAndFront) {
  const PreparedScene scene(SceneBuilder().polygon("far", {{500, 0, 0}, {501, 0, 0}, {500, 1, 0}}));
  const PreparedTarget target(scene, testing::target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}), {50});
  const LegViews views(target);
  const LegView up = views.look({{0, 0, -50}, {0, 0, 150}}, 2);
  ASSERT_EQ(up.seen.size(), 1u);
  EXPECT_NEAR(up.seen[0].begin * 200 - 50, 2, 1e-7);
  EXPECT_GE(up.seen[0].begin * 200 - 50, 2);
  EXPECT_NEAR(up.seen[0].end * 200 - 50, std::sqrt(48.0 * 48 - 2), 1e-7);
  EXPECT_LE(up.seen[0].end * 200 - 50, std::sqrt(48.0 * 48 - 2));
  EXPECT_EQ(up.behind_target, (std::vector<LegInterval>{{0, up.seen[0].begin}}));
  ASSERT_EQ(up.out_of_range.size(), 2u);
  EXPECT_EQ(up.out_of_range[1], (LegInterval{up.seen[0].end, 1}));
  EXPECT_TRUE(up.hidden_by.empty());
  EXPECT_TRUE(views.look({{0, 0, 10}, {0, 0, 10}}, 10).seen.empty()) << "touches the target's plane";
  EXPECT_TRUE(views.look({{0, 0, 10}, {0, 0, 10}}, 60).seen.empty()) << "wider than the range";
  EXPECT_EQ(views.look({{0, 0, 10}, {0, 0, 10}}, 9).seen, (std::vector<LegInterval>{{0, 1}}));
}

// Legs that touch what is hidden, run along its border or have no length: hidden, and never a claim that points deny.
TEST(LegViews, DegenerateLegsAreHidden) {
  for (const LegWorld& world : kLegWorlds) {
    SCOPED_TRACE(world.scale);
    const SceneBuilder builder = SceneBuilder().polygon("wall", {{5, -5, 0}, {5, 5, 0}, {5, 5, 8}, {5, -5, 8}});
    const PreparedScene scene(world.scene(builder));
    const PreparedTarget target(scene,
                                world.target(testing::target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}})),
                                {.max_range_m = 1000 * world.scale});
    const LegViews views(target);
    const auto seen = [&](const Vec3& from, const Vec3& to) { return views.look({world.at(from), world.at(to)}).seen; };
    const std::vector<LegInterval> all = {{0, 1}};
    EXPECT_TRUE(seen({5, 0, 4}, {5, 0, 4}).empty()) << "in the wall";
    EXPECT_TRUE(seen({5, -4, 1}, {5, 4, 7}).empty()) << "along the wall";
    EXPECT_TRUE(seen({5, -5, 8}, {5, 5, 8}).empty()) << "along its upper edge";
    EXPECT_TRUE(seen({20, 0, 1}, {20, 0, 1}).empty()) << "behind it";
    EXPECT_EQ(seen({5 - 1e-6, -4, 1}, {5 - 1e-6, 4, 7}), all) << "in front of it";
    EXPECT_EQ(seen({0, 0, 5}, {0, 0, 5}), all);
    // Through a corner of the wall and down its edge.
    const std::vector<LegInterval> through = seen({5, 5, 9}, {5, 5, 7});
    ASSERT_EQ(through.size(), 1u);
    EXPECT_NEAR(through[0].end, 0.5, 1e-7 + world.rounding() / world.scale);
    // On the plane from the target's edge over the wall's upper edge: (1, 0) over (5, 8).
    const Vec3 over = Vec3(1, 0, 0) + 3 * (Vec3(5, 0, 8) - Vec3(1, 0, 0));
    EXPECT_TRUE(seen(over, over).empty());
    EXPECT_TRUE(seen(over, over + 2 * (over - Vec3(1, 0, 0))).empty()) << "along the line of sight";
    EXPECT_EQ(seen(over + Vec3(0, 0, 1e-4), over + Vec3(0, 0, 1e-4)), all);
  }
}

TEST(LegViews, AnswersForAPointFromAllSides) {
  const PreparedScene scene(SceneBuilder().box("block", {3, -1, 4}, {4, 1, 6}));
  const PreparedTarget target(scene, Target::point({0, 0, 5}), {100});
  const LegViews views(target);
  // Round the block, and through the plane that halves what the point sees.
  const LegView across = views.look({{10, -40, 5}, {10, 40, 5}});
  ASSERT_EQ(across.seen.size(), 2u);
  EXPECT_NEAR(across.seen[0].end * 80 - 40, -10.0 / 3, 0.01);
  EXPECT_NEAR(across.seen[1].begin * 80 - 40, 10.0 / 3, 0.01);
  EXPECT_TRUE(across.behind_target.empty());
  EXPECT_EQ(views.look({{-10, -40, -50}, {-10, 40, 60}}).seen, (std::vector<LegInterval>{{0, 1}}));
}

TEST(LegViews, JoinsListsOfTargets) {
  const PreparedScene scene(
      SceneBuilder().box("left", {-21, -1, 0}, {-19, 1, 10}).box("right", {19, -1, 0}, {21, 1, 10}));
  const auto target = [&](double x, double range) {
    return PreparedTarget(scene, testing::target_of({{x - 1, -1, 1}, {x + 1, -1, 1}, {x + 1, 1, 1}, {x - 1, 1, 1}}),
                          {range});
  };
  const Leg leg{{-60, 0, 12}, {60, 0, 12}};
  const PreparedTarget a = target(-30, 50), b = target(30, 50);
  const LegView of_a = LegViews(a).look(leg), of_b = LegViews(b).look(leg);
  const LegView either = LegViews({{a, b}}).look(leg), both = LegViews({{a}, {b}}).look(leg);
  for (int i = 0; i <= 1000; ++i) {
    const double share = i / 1000.0;
    EXPECT_EQ(holds(either.seen, share), holds(of_a.seen, share) || holds(of_b.seen, share));
    EXPECT_EQ(holds(both.seen, share), holds(of_a.seen, share) && holds(of_b.seen, share));
    EXPECT_EQ(holds(both.out_of_range, share), holds(of_a.out_of_range, share) || holds(of_b.out_of_range, share));
    EXPECT_EQ(holds(either.out_of_range, share), holds(of_a.out_of_range, share) && holds(of_b.out_of_range, share));
    EXPECT_EQ(hides(both, "left", share), hides(of_a, "left", share) || hides(of_b, "left", share));
  }
  EXPECT_EQ(either.hidden_by.size() + both.hidden_by.size() > 0, true);
  const std::vector<LegView> many = LegViews({{a, b}}).look(std::vector<Leg>{leg, {leg.to, leg.from}});
  EXPECT_EQ(many[0].seen, either.seen);
  EXPECT_EQ(many[1].seen.size(), either.seen.size());
  const auto stop = [](std::string_view, double) { return false; };
  testing::expect_code([&] { LegViews(a).look(std::vector<Leg>{leg}, 0, stop); }, ErrorCode::cancelled);
}

// The zone of a link: by points of the leg, and for the tube by points in it. What is left out is entered by a way that
// is at most 2 mm longer.
TEST(LegViews, FollowsTheZoneOfALink) {
  Random random(20250312);
  std::size_t ends = 0, seen = 0;
  for (int i = 0; i < 6; ++i) {
    const PreparedScene scene(testing::random_city(random, 15, 8));
    Sensor sensor{.max_range_m = 120};
    sensor.link = RadioLink{2.4, 0.6};
    Sensor longer = sensor;
    const double excess = 0.5 * 0.36 * 0.299792458 / 2.4;
    longer.link->clear = 0.6 * std::sqrt(1 + 2.1e-3 / excess);
    const Target antenna = Target::point({0, 0, random.uniform(3, 8)});
    const PreparedTarget target(scene, antenna, sensor);
    const LegViews views(target);
    PointQuery query(target), query_longer(PreparedTarget(scene, antenna, longer));
    for (int k = 0; k < 8; ++k) {
      const Leg leg = some_leg(random);
      const double radius = k % 2 ? 0 : random.uniform(0, 1);
      const LegView view = views.look(leg, radius);
      expect_sound(view);
      for (const LegInterval& part : view.seen) {
        for (const double share : {part.begin, part.end, random.uniform(part.begin, part.end)}) {
          ++seen;
          const auto answers = query.answer(testing::ball_points(random, place_on(leg, share), radius, 30));
          for (const PointAnswer& answer : answers) ASSERT_TRUE(answer.inside);
        }
        if (radius > 0) continue;
        for (const double share : {part.begin - 1e-6, part.end + 1e-6}) {
          if (share <= 0 || share >= 1) continue;
          ++ends;
          EXPECT_FALSE(query_longer.answer(std::vector<Vec3>{place_on(leg, share)})[0].inside) << share;
        }
      }
    }
  }
  EXPECT_GT(seen, 20u);
  EXPECT_GT(ends, 5u);
}

TEST(LegViews, RefusesWhatItCannotTell) {
  const PreparedScene scene(SceneBuilder().ground("ground", 10));
  const Target square = testing::target_of({{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
  Sensor share{.max_range_m = 50};
  share.visible = VisibleShare{.share = 0.5};
  testing::expect_error([&] { LegViews{PreparedTarget(scene, square, share)}; }, ErrorCode::not_applicable);
  share.visible = VisibleShare{.share = 1};
  const LegViews views(PreparedTarget(scene, square, share));
  testing::expect_error([&] { views.look({{0, 0, NAN}, {0, 0, 1}}); }, ErrorCode::coordinate_not_finite);
  testing::expect_error([&] { views.look({{0, 0, 2e9}, {0, 0, 1}}); }, ErrorCode::coordinate_too_large);
  testing::expect_error([&] { views.look({{0, 0, 2}, {0, 0, 1}}, -1); }, ErrorCode::value_out_of_range);
  testing::expect_error([&] { LegViews{std::vector<std::vector<PreparedTarget>>{}}; }, ErrorCode::nothing_given);
  testing::expect_error([&] { any_of(std::vector<LegView>{}); }, ErrorCode::nothing_given);
}

}  // namespace
}  // namespace vantage
