// LegLimits against PointQuery at dense points of legs and tubes, and where amounts are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "query/limits.h"
#include "sensor/viewed.h"
#include "support/grounds.h"
#include "support/internals.h"
#include "support/legs.h"
#include "support/limit_samples.h"
#include "support/wording.h"
#include "support/zones.h"
#include "vantage/error.h"
#include "vantage/query.h"

namespace vantage {
namespace {

using testing::holds;
using testing::kLegWorlds;
using testing::LegWorld;
using testing::place_on;
using testing::Random;

Box box_in(const LegWorld& world, const Vec3& min, const Vec3& max) { return {world.at(min), world.at(max)}; }

Zone zone_in(const LegWorld& world, Zone zone) {
  const auto move = [&](Zone::Ring& ring) {
    for (Eigen::Vector2d& corner : ring) corner = world.at({corner.x(), corner.y(), 0}).head<2>();
  };
  move(zone.outer);
  for (Zone::Ring& hole : zone.holes) move(hole);
  zone.min_z_m = world.at({0, 0, zone.min_z_m}).z();
  zone.max_z_m = world.at({0, 0, zone.max_z_m}).z();
  return zone;
}

Mesh mesh_in(const LegWorld& world, Mesh mesh) {
  for (Vec3& vertex : mesh.vertices) vertex = world.at(vertex);
  return mesh;
}

AboveGround above_in(const LegWorld& world, const Mesh& ground, double low, double high) {
  return {low * world.scale, high * world.scale, Ground{0, std::make_shared<const Mesh>(mesh_in(world, ground))}};
}

/// Of a ground with a hole, and a second piece over it.
Mesh some_ground(Random& random) {
  Mesh ground = testing::make_hills(random, 60, 4, 12, Vec3::Zero());
  ground.triangles.erase(ground.triangles.begin() + 100, ground.triangles.begin() + 106);
  testing::append(ground, testing::make_hills(random, 15, 1, 3, {10, 10, 8}));
  return ground;
}

const Zone::Ring kBent = {{-40, -30}, {-5, -30}, {-5, 0}, {-20, 10}, {-5, 25}, {-40, 30}};

enum class Kind { altitude, boxes, zones, ground, mesh, clearance, heights };
constexpr Kind kKinds[] = {Kind::altitude, Kind::boxes,     Kind::zones,  Kind::ground,
                           Kind::mesh,     Kind::clearance, Kind::heights};

Navigation some_navigation(Random& random, const LegWorld& world, Kind kind) {
  Navigation navigation;
  if (kind == Kind::altitude) navigation.altitude = {world.at({0, 0, 5}).z(), world.at({0, 0, 35}).z()};
  if (kind == Kind::boxes) {
    navigation.keep_in = {box_in(world, {-50, -50, 0}, {5, 50, 45}), box_in(world, {-10, -25, 2}, {55, 25, 30})};
    navigation.keep_out = {box_in(world, {-20, 5, 0}, {-5, 15, 20}), box_in(world, {6, -12, 8}, {20, -2, 50})};
  }
  if (kind == Kind::zones || kind == Kind::heights) {
    Zone with_hole = testing::zone_of({{0, -40}, {50, -40}, {50, 40}, {0, 40}}, -INFINITY, 40, "hole");
    with_hole.holes = {{{10, -10}, {30, -10}, {20, 20}}};
    Zone wide = testing::zone_of({{-60, -60}, {60, -60}, {0, 60}}, 0, 50, "wide");
    Zone bent = testing::zone_of(kBent, 5, 25, "bent");
    if (kind == Kind::heights) {
      const Mesh ground = some_ground(random);
      with_hole.above_ground = above_in(world, ground, 3, 25);
      wide.above_ground = above_in(world, ground, 2, 30);
      bent.above_ground = above_in(world, ground, 4, INFINITY);
    }
    navigation.keep_in = {zone_in(world, wide), zone_in(world, testing::zone_of(kBent, 0, 60, "kept"))};
    navigation.keep_out = {zone_in(world, with_hole), zone_in(world, bent)};
  }
  if (kind == Kind::ground) navigation.above_ground = above_in(world, some_ground(random), 3, 20);
  if (kind == Kind::mesh) {
    Mesh slanted = testing::make_box_mesh({-40, -30, -10}, {30, 40, 30});
    for (std::size_t v = 4; v < 8; ++v) slanted.vertices[v].x() += 15;
    navigation.meshes = {{mesh_in(world, slanted), "slanted"}};
  }
  if (kind == Kind::clearance) {
    const Scene city = testing::random_city(random, 8, 5);
    navigation.clearance = Clearance{4 * world.scale, std::make_shared<const Mesh>(mesh_in(world, city.mesh))};
  }
  return navigation;
}

Leg some_leg(Random& random, const LegWorld& world) {
  const auto place = [&] { return world.at(random.in_box({{-65, -65, -2}, {65, 65, 45}})); };
  const Vec3 from = place();
  if (random.chance(0.05)) return {from, from};
  if (random.chance(0.05)) return {from, from + Vec3(0, 0, 20 * world.scale)};
  return {from, place()};
}

std::set<std::string> broken_at(const std::vector<LegBreak>& breaks, double share) {
  std::set<std::string> names;
  for (const LegBreak& one : breaks) {
    if (holds(one.intervals, share)) names.insert(one.limit);
  }
  return names;
}

/// The names of each point, as PointAnswer::outside_of has them, without the margin that costs most.
class PointNames {
 public:
  PointNames(const PreparedTarget& target, const Navigation& navigation) : limits_(navigation, target) {}

  std::set<std::string> of(const std::vector<Vec3>& points) const {
    std::set<std::string> names;
    for (const Vec3& point : points) {
      const std::vector<std::string> broken = limits_.broken(point);
      names.insert(broken.begin(), broken.end());
    }
    return names;
  }

  /// What all points near by break, and what any does.
  struct Around {
    std::set<std::string> all, any;
  };
  Around around(const Vec3& point, double step) const {
    std::vector<Vec3> points{point};
    for (int axis = 0; axis < 3; ++axis) {
      points.push_back(point + step * Vec3::Unit(axis));
      points.push_back(point - step * Vec3::Unit(axis));
    }
    std::map<std::string, std::size_t> counts;
    for (const Vec3& place : points) {
      for (const std::string& name : limits_.broken(place)) ++counts[name];
    }
    Around around;
    for (const auto& [name, count] : counts) {
      around.any.insert(name);
      if (count == points.size()) around.all.insert(name);
    }
    return around;
  }

 private:
  query::Limits limits_;
};

PreparedTarget far_target(const LegWorld& world) {
  const Target square = testing::target_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  return {PreparedScene(Scene{}), world.target(square), {.max_range_m = 1000 * world.scale}};
}

void expect_sound(const std::vector<LegBreak>& breaks) {
  for (const LegBreak& one : breaks) {
    EXPECT_FALSE(one.intervals.empty());
    EXPECT_TRUE(testing::is_sorted_and_disjoint(one.intervals)) << one.limit;
    EXPECT_TRUE(holds(one.intervals, one.worst_share)) << one.limit;
    EXPECT_GE(one.worst, 0);
    EXPECT_TRUE(std::isfinite(one.worst)) << one.limit;
  }
}

/// Legs against points of them: each name must be told where all points about have it, and may be where any has it.
struct Counts {
  std::map<std::string, std::size_t> told, ends, explained;
};
void compare_leg(const LegLimits& limits, const PointNames& points, const Leg& leg, double step, Counts& counts,
                 int places = 60, bool frame_is_gimbal = false) {
  const std::vector<LegBreak> breaks = limits.broken(leg);
  expect_sound(breaks);
  std::vector<double> shares;
  for (int i = 0; i <= places; ++i) shares.push_back(static_cast<double>(i) / places);
  for (const LegBreak& one : breaks) {
    for (const LegInterval& part : one.intervals) {
      for (const double away : {-1e-3, -1e-5, 0.0, 1e-5, 1e-3}) {
        shares.push_back(std::clamp(part.begin + away, 0.0, 1.0));
        shares.push_back(std::clamp(part.end + away, 0.0, 1.0));
      }
    }
  }
  for (const double share : shares) {
    SCOPED_TRACE(::testing::Message() << "share " << share);
    auto [all, any] = points.around(place_on(leg, share), step);
    std::set<std::string> told = broken_at(breaks, share);
    if (frame_is_gimbal) {
      for (std::set<std::string>* names : {&all, &any, &told}) {
        if (names->erase("gimbal") > 0) names->insert("frame");
      }
    }
    for (const std::string& name : all) ASSERT_TRUE(told.contains(name)) << name << " is not told";
    for (const std::string& name : told) {
      ++counts.told[name];
      ASSERT_TRUE(any.contains(name)) << name << " is kept there";
    }
  }
}

/// A tube against points in it: what is not told must be kept, and where a part begins a point hardly beside breaks it.
void compare_tube(Random& random, const LegLimits& limits, const PointNames& points, const Leg& leg, double radius,
                  Counts& counts) {
  const std::vector<LegBreak> breaks = limits.broken(leg, radius);
  expect_sound(breaks);
  std::vector<double> shares;
  for (int i = 0; i <= 10; ++i) shares.push_back(i / 10.0);
  for (const LegBreak& one : breaks) {
    for (const LegInterval& part : one.intervals) {
      for (const double share : {part.begin, part.end}) {
        if (share == 0 || share == 1) continue;
        shares.push_back(std::clamp(share + (share == part.begin ? -1e-7 : 1e-7), 0.0, 1.0));
        ++counts.ends[one.limit];
        counts.explained[one.limit] +=
            points.of(testing::ball_points(random, place_on(leg, share), radius * 1.05, 2000)).contains(one.limit);
      }
    }
  }
  for (const double share : shares) {
    SCOPED_TRACE(::testing::Message() << "share " << share << " radius " << radius);
    const std::set<std::string> told = broken_at(breaks, share);
    const auto found = points.of(testing::ball_points(random, place_on(leg, share), radius * (1 - 1e-6), 100));
    for (const std::string& name : found) ASSERT_TRUE(told.contains(name)) << name << " is not told";
  }
}

TEST(LegLimits, NavigationAgreesWithPointsOfTheLeg) {
  Random random(20250320);
  Counts counts;
  for (const LegWorld& world : kLegWorlds) {
    const PreparedTarget target = far_target(world);
    for (const Kind kind : kKinds) {
      SCOPED_TRACE(::testing::Message() << "scale " << world.scale << " kind " << static_cast<int>(kind));
      const Navigation navigation = some_navigation(random, world, kind);
      const LegLimits limits(navigation);
      const PointNames points(target, navigation);
      const double step = 1e-7 * world.scale + 20 * world.rounding();
      for (int i = 0; i < 25; ++i) compare_leg(limits, points, some_leg(random, world), step, counts);
      if (HasFatalFailure()) return;
    }
  }
  for (const char* name :
       {"altitude min", "altitude max", "keep_in", "keep_out zone 0", "keep_out zone 1", "ground edge",
        "keep_out zone hole", "keep_out zone bent", "mesh slanted", "clearance", "agl min", "agl max"}) {
    EXPECT_GT(counts.told[name], 10u) << name;
  }
}

TEST(LegLimits, NavigationAgreesWithPointsOfTheTube) {
  Random random(20250321);
  Counts counts;
  for (const LegWorld& world : kLegWorlds) {
    const PreparedTarget target = far_target(world);
    for (const Kind kind : kKinds) {
      SCOPED_TRACE(::testing::Message() << "scale " << world.scale << " kind " << static_cast<int>(kind));
      const Navigation navigation = some_navigation(random, world, kind);
      const LegLimits limits(navigation);
      const PointNames points(target, navigation);
      for (int i = 0; i < 12; ++i) {
        const double radius = world.scale * random.uniform(0.1, 5);
        compare_tube(random, limits, points, some_leg(random, world), radius, counts);
      }
      if (HasFatalFailure()) return;
    }
  }
  for (const auto& [name, ends] : counts.ends) {
    // Two that do it together, and zones with heights, count more than exactly.
    const bool is_of_polygon = name == "keep_out zone hole" || name == "keep_out zone bent";
    const bool is_exact = name != "keep_in" && !is_of_polygon;
    const double share = is_exact ? 0.9 : 0.5;
    EXPECT_GE(static_cast<double>(counts.explained[name]), share * static_cast<double>(ends) - 3) << name;
  }
}

Target some_target(Random& random) {
  Target target = testing::random_target(random, 4, 3, {0, 0, 1}, Vec3(0.2, 0.1, 1));
  target.parts.push_back(testing::random_target(random, 3, 1, {3, 2, 1}, Vec3(0, 0.3, 1)).parts[0]);
  return target;
}

// Every limit of the table, in the ways it is drawn: as a leg, and where there is no camera as a tube. Of "frame" and
// "gimbal" a position has one.
TEST(LegLimits, AgreeWithPointsForEveryLimit) {
  Random random(20250325);
  for (const testing::LimitSample& sample : testing::limit_samples()) {
    Counts counts;
    for (const testing::LimitDraw& draw : sample.draws) {
      for (const LegWorld& world : kLegWorlds) {
        SCOPED_TRACE(::testing::Message() << draw.name << ", scale " << world.scale);
        testing::LimitWorld drawn;
        drawn.scene = testing::random_city(random, 5, 8);
        drawn.target = some_target(random);
        drawn.sensor.max_range_m = 40;
        draw.add(drawn, random);
        const testing::Motion motion{draw.name, world.scale, Eigen::Matrix3d::Identity(), world.shift};
        const testing::LimitWorld there = testing::moved(drawn, motion);
        const PreparedTarget target(PreparedScene(Scene{}), there.target, there.sensor);
        const LegLimits limits(target, there.navigation);
        const PointNames points(target, there.navigation);
        const bool is_searched = there.sensor.camera.has_value();
        const double step = (is_searched ? 4e-3 : 4e-5) * world.scale + 100 * world.rounding();
        const Box legs{{-50, -50, -30}, {50, 50, 45}};
        for (int i = 0; i < 8; ++i) {
          const Leg leg{world.at(random.in_box(legs)), world.at(random.in_box(legs))};
          compare_leg(limits, points, leg, step, counts, 12, is_searched);
          if (!is_searched) compare_tube(random, limits, points, leg, world.scale * random.uniform(0.1, 4), counts);
        }
        if (HasFatalFailure()) return;
      }
    }
    std::size_t told = 0;
    for (const auto& [name, count] : counts.told) told += count;
    EXPECT_GT(told, 10u) << name_of(sample.limit);
  }
}

// PointQuery itself has the same names.
TEST(LegLimits, NamesLimitsAsPointAnswersDo) {
  Random random(20250324);
  const LegWorld world;
  const PreparedTarget target = far_target(world);
  for (const Kind kind : kKinds) {
    const Navigation navigation = some_navigation(random, world, kind);
    const LegLimits limits(navigation);
    PointQuery query(target, navigation);
    const Leg leg = some_leg(random, world);
    const std::vector<LegBreak> breaks = limits.broken(leg);
    for (int i = 0; i <= 20; ++i) {
      const double share = (i + 0.123) / 21;
      const PointAnswer answer = query.answer(std::vector<Vec3>{place_on(leg, share)})[0];
      EXPECT_EQ(broken_at(breaks, share), std::set<std::string>(answer.outside_of.begin(), answer.outside_of.end()));
    }
  }
}

struct Looking {
  const char* name;
  Sensor sensor;
  double step = 1e-6;  ///< of the scale
};
std::vector<Looking> some_sensors(double scale) {
  const Sensor far{.max_range_m = 1000 * scale};
  std::vector<Looking> all;
  const auto add = [&](const char* name, const auto& change, double step = 1e-6) {
    all.push_back({name, far, step});
    change(all.back().sensor);
  };
  const Pinhole camera = pinhole_of_fov(60, 40, 4000, 3000);
  add("min_range", [&](Sensor& s) { s.min_range_m = 20 * scale; });
  add("incidence", [](Sensor& s) { s.incidence_deg = 50; });
  add(
      "pixel",
      [&](Sensor& s) {
        s.camera = pinhole_of_fov(150, 150, 4000, 4000);
        s.pixel = PixelLimit{60 * scale / *s.camera->focal_px, PixelLimit::Kind::worst};
      },
      1e-4);
  add("sun", [](Sensor& s) { s.sun = SunLimit{{-1, 0.3, -1.5}, 25}; });
  add(
      "frame",
      [&](Sensor& s) {
        s.camera = camera;
        s.mount = {.yaw_deg = 30, .min_pitch_deg = -60, .max_pitch_deg = -60, .roll_deg = 10};
      },
      1e-4);
  add(
      "gimbal",
      [&](Sensor& s) {
        s.camera = camera;
        s.mount = {.yaw_deg = {}, .min_pitch_deg = -70, .max_pitch_deg = -20};
      },
      1e-4);
  return all;
}

// What a camera that turns leaves undecided is 1e-5 of a leg.
TEST(LegLimits, SensorsAgreeWithPointsOfTheLeg) {
  Random random(20250322);
  Counts counts;
  for (const LegWorld& world : kLegWorlds) {
    for (const Looking& looking : some_sensors(world.scale)) {
      SCOPED_TRACE(::testing::Message() << "scale " << world.scale << " " << looking.name);
      const PreparedTarget target(PreparedScene(Scene{}), world.target(some_target(random)), looking.sensor);
      const LegLimits limits(target, {});
      const PointNames points(target, {});
      const double step = looking.step * world.scale * 40 + 100 * world.rounding();
      for (int i = 0; i < 6; ++i) compare_leg(limits, points, some_leg(random, world), step, counts, 12);
      if (HasFatalFailure()) return;
    }
  }
  for (const char* name : {"min_range", "incidence", "pixel", "sun", "gimbal"}) {
    EXPECT_GT(counts.told[name], 20u) << name;
  }
}

TEST(LegLimits, SensorsAgreeWithPointsOfTheTube) {
  Random random(20250323);
  Counts counts;
  for (const LegWorld& world : kLegWorlds) {
    for (const Looking& looking : some_sensors(world.scale)) {
      SCOPED_TRACE(::testing::Message() << "scale " << world.scale << " " << looking.name);
      const PreparedTarget target(PreparedScene(Scene{}), world.target(some_target(random)), looking.sensor);
      const LegLimits limits(target, {});
      const PointNames points(target, {});
      for (int i = 0; i < 5; ++i) {
        const double radius = world.scale * random.uniform(0.1, 4);
        const Leg leg = some_leg(random, world);
        const std::vector<LegBreak> breaks = limits.broken(leg, radius);
        expect_sound(breaks);
        Counts of_leg;
        // Of "frame" and "gimbal" a position has one.
        for (int k = 0; k <= 10; ++k) {
          const double share = k / 10.0;
          const std::set<std::string> told = broken_at(breaks, share);
          for (const std::string& name :
               points.of(testing::ball_points(random, place_on(leg, share), radius * (1 - 1e-6), 100))) {
            ASSERT_TRUE(told.contains(name) || (name == "gimbal" && told.contains("frame"))) << name;
          }
        }
        for (const LegBreak& one : breaks) {
          for (const LegInterval& part : one.intervals) {
            for (const double share : {part.begin, part.end}) {
              if (share == 0 || share == 1) continue;
              if (one.limit == "frame") continue;  // seldom, and it may end where "gimbal" begins
              ++counts.ends[one.limit];
              const double wider = one.limit == "gimbal" ? 1.5 : 1.03;
              const auto beside = testing::ball_points(random, place_on(leg, share), radius * wider, 500);
              counts.explained[one.limit] += points.of(beside).contains(one.limit);
            }
          }
        }
      }
    }
  }
  for (const auto& [name, ends] : counts.ends) {
    EXPECT_GE(static_cast<double>(counts.explained[name]), 0.85 * static_cast<double>(ends) - 3) << name;
  }
}

TEST(LegLimits, KnowsAmountsAndPlaces) {
  Navigation navigation;
  navigation.altitude = {10, 50};
  navigation.keep_out = {Box{Vec3(20, -5, 0), Vec3(30, 5, 100)}};
  navigation.above_ground = {5, 100, Ground{8, {}}};
  const LegLimits limits(navigation);
  const std::vector<LegBreak> breaks = limits.broken({{0, 0, 4}, {100, 0, 54}});
  ASSERT_EQ(breaks.size(), 4u);
  const auto expect = [&](const LegBreak& one, const std::string& name, LegInterval part, double worst, double share) {
    EXPECT_EQ(one.limit, name);
    ASSERT_EQ(one.intervals.size(), 1u);
    EXPECT_NEAR(one.intervals[0].begin, part.begin, 1e-12);
    EXPECT_NEAR(one.intervals[0].end, part.end, 1e-12);
    EXPECT_NEAR(one.worst, worst, 1e-4);
    EXPECT_NEAR(one.worst_share, share, 1e-4);
    EXPECT_EQ(one.unit, LegBreak::Unit::metres);
  };
  expect(breaks[0], "altitude min", {0, 0.12}, 6, 0);
  expect(breaks[1], "altitude max", {0.92, 1}, 4, 1);
  expect(breaks[2], "agl min", {0, 0.18}, 9, 0);
  expect(breaks[3], "keep_out zone 0", {0.2, 0.3}, 5, 0.25);
  const std::vector<LegInterval> kept = kept_parts(breaks);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_NEAR(kept[0].begin, 0.18, 1e-12);
  EXPECT_NEAR(kept[1].end, 0.92, 1e-12);

  const std::vector<LegBreak> tube = limits.broken({{0, 0, 4}, {100, 0, 54}}, 1);
  expect(tube[0], "altitude min", {0, 0.14}, 7, 0);
  EXPECT_NEAR(tube[3].worst, 6, 1e-4);
  EXPECT_NEAR(tube[3].intervals[0].begin, 0.19, 1e-12);
}

// A zone with heights above ground is left upwards, too.
TEST(LegLimits, KnowsHowFarItIsInAZoneAboveGround) {
  Navigation navigation;
  Zone zone;
  zone.name = "low";
  zone.outer = {{-30, -30}, {30, -30}, {30, 30}, {-30, 30}};
  zone.above_ground = AboveGround{0, 20, Ground{8, {}}};
  navigation.keep_out = {zone};
  const std::vector<LegBreak> breaks = LegLimits(navigation).broken({{-60, 0, 27}, {60, 0, 27}});
  ASSERT_EQ(breaks.size(), 1U);
  EXPECT_NEAR(breaks[0].worst, 1, 1e-9);
}

// Borders are allowed, to the bit where heights and boxes are compared.
TEST(LegLimits, AllowsBorders) {
  Navigation navigation;
  navigation.altitude = {30, 120};
  navigation.keep_in = {Box{Vec3(-100, -100, 0), Vec3(100, 100, 200)}};
  navigation.keep_out = {Box{Vec3(0, 50, 0), Vec3(50, 100, 200)}};
  const Mesh flat = testing::make_box_mesh({-200, -200, -1}, {200, 200, 0});
  navigation.above_ground = {30, 120, Ground{0, std::make_shared<const Mesh>(flat)}};
  navigation.keep_out.push_back(testing::zone_of({{-80, -80}, {-40, -80}, {-40, -40}}, 0, 30, "low"));
  const LegLimits limits(navigation);
  // The flat box has a floor as well: the lowest piece of ground is 1 m down.
  for (const Leg& leg : {Leg{{-100, -100, 30}, {100, 50, 30}}, Leg{{-100, 50, 30}, {100, 50, 30}},
                         Leg{{-100, -100, 119}, {-100, 100, 119}}, Leg{{0, 50, 30}, {0, 100, 30}}}) {
    EXPECT_TRUE(limits.broken(leg).empty()) << limits.broken(leg)[0].limit;
  }
  EXPECT_EQ(limits.broken({{0, 0, 31}, {10, 0, 31}}, 1).size(), 0u);
  EXPECT_EQ(limits.broken({{0, 0, 31}, {10, 0, 31}}, 1.001).size(), 2u);
}

TEST(LegLimits, AngleAmountsAreInDegrees) {
  Sensor sensor{.max_range_m = 1000};
  sensor.incidence_deg = 30;
  sensor.camera = pinhole_of_fov(40, 40);
  sensor.mount = {.yaw_deg = 0, .min_pitch_deg = -90, .max_pitch_deg = -90};
  const PreparedTarget target(PreparedScene(Scene{}), Target::polygon({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}),
                              sensor);
  const std::vector<LegBreak> breaks = LegLimits(target, {}).broken({{0, 0, 50}, {50, 0, 50}});
  ASSERT_EQ(breaks.size(), 2u);
  EXPECT_EQ(breaks[0].limit, "incidence");
  EXPECT_EQ(breaks[0].unit, LegBreak::Unit::degrees);
  const double degree = std::numbers::pi / 180;
  EXPECT_NEAR(breaks[0].worst, std::atan2(std::hypot(51, 1), 50) / degree - 30, 1e-6);
  EXPECT_NEAR(breaks[0].intervals[0].begin, (std::sqrt(std::pow(50 * std::tan(30 * degree), 2) - 1) - 1) / 50, 1e-9);
  EXPECT_EQ(breaks[1].limit, "gimbal");
  EXPECT_NEAR(breaks[1].worst, std::atan2(51, 50) / degree - 20, 0.1);
  EXPECT_NEAR(breaks[1].intervals[0].begin, (50 * std::tan(20 * degree) - 1) / 50, 1e-9);
}

TEST(LegLimits, RefusesWrongLimits) {
  Navigation navigation;
  navigation.altitude = {5, 3};
  testing::expect_error([&] { LegLimits{navigation}; }, ErrorCode::limits_reversed);
  const LegLimits limits((Navigation()));
  testing::expect_error([&] { limits.broken({{0, 0, 0}, {0, 0, INFINITY}}); }, ErrorCode::coordinate_not_finite);
  EXPECT_TRUE(limits.broken(std::vector<Leg>{{{0, 0, 0}, {1, 1, 1}}}, 5)[0].empty());
}

}  // namespace
}  // namespace vantage
