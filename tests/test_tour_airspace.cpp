// The airspace of a scene, beside the obvious distance from its boxes.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "support/random.h"
#include "support/scenes.h"
#include "support/simple_airspace.h"
#include "support/solids.h"
#include "support/tour_judge.h"
#include "support/wording.h"
#include "vantage/scene.h"
#include "vantage/tour.h"

namespace vantage {
namespace {

using testing::BoxAirspace;
using testing::NamedBox;

struct Town {
  Scene scene;
  std::vector<NamedBox> boxes;
};

Town random_town(testing::Random& random, const Vec3& offset) {
  Town town;
  testing::SceneBuilder builder;
  builder.add("ground", testing::make_box_mesh(offset + Vec3(-300, -300, -1), offset + Vec3(300, 300, 0)));
  for (int i = 0; i < 12; ++i) {
    const Vec3 low = offset + Vec3(random.uniform(-100, 90), random.uniform(-100, 90), 0);
    const Vec3 high = low + Vec3(random.uniform(2, 8), random.uniform(2, 8), random.uniform(5, 40));
    town.boxes.push_back({"block " + std::to_string(i), {low, high}});
    builder.box(town.boxes.back().name, low, high);
  }
  town.scene = builder.scene();
  town.scene.objects[0].kind = ObjectKind::ground;
  return town;
}

TEST(TourAirspace, KeepsAwayFromTheSceneAsFarAsItSays) {
  testing::Random random(51);
  int allowed = 0, refused = 0;
  for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(5e5, 5e6, 100)}) {
    const Town town = random_town(random, offset);
    const double clearance = random.uniform(0.5, 6);
    Navigation navigation;
    navigation.altitude = Navigation::Altitude{offset.z() + 1, offset.z() + 45};
    const auto airspace = make_airspace(PreparedScene(town.scene), clearance, navigation);
    for (int i = 0; i < 1500; ++i) {
      const Vec3 from = offset + Vec3(random.uniform(-120, 120), random.uniform(-120, 120), random.uniform(0, 46));
      const Leg leg = {from, random.chance(0.2) ? from : Vec3(from + random.direction() * random.uniform(0, 60))};
      const double deviation = random.chance(0.5) ? 0 : random.uniform(0, 2);
      double distance = std::numeric_limits<double>::infinity();
      for (const NamedBox& box : town.boxes) distance = std::min(distance, testing::distance_to(box.box, leg));
      const double low = std::min(leg.from.z(), leg.to.z()) - offset.z() - deviation;
      const double high = std::max(leg.from.z(), leg.to.z()) - offset.z() + deviation;
      const double spare = std::min({distance - clearance - deviation, low - 1, 45 - high});
      const bool is_allowed = airspace->allows(leg, deviation);
      EXPECT_EQ(is_allowed, airspace->obstacle(leg, deviation).empty());
      if (is_allowed) {
        ++allowed;
        EXPECT_GE(spare, -1e-6);
      } else {
        ++refused;
        EXPECT_LE(spare, 1e-6);
      }
    }
  }
  EXPECT_GT(allowed, 300);
  EXPECT_GT(refused, 300);
}

TEST(TourAirspace, NamesWhatIsInTheWay) {
  testing::SceneBuilder builder;
  builder.box("town hall", {-5, -5, 0}, {5, 5, 30});
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{2, 60};
  navigation.keep_out = {Box{{20, -5, 0}, {30, 5, 100}}};
  const auto airspace = make_airspace(PreparedScene(builder.scene()), 3, navigation);
  EXPECT_EQ(airspace->obstacle({{-50, 0, 10}, {15, 0, 10}}, 0), "town hall");
  EXPECT_EQ(airspace->obstacle({{15, 0, 10}, {50, 0, 10}}, 0), "keep_out zone 0");
  EXPECT_EQ(airspace->obstacle({{-50, 0, 1}, {-40, 0, 1}}, 0), "altitude min");
  EXPECT_EQ(airspace->obstacle({{-50, 0, 10}, {-40, 0, 10}}, 0), "");
  EXPECT_FALSE(airspace->allows({{-50, 0, 10}, {-40, 0, 10}}, 3));  // more than it can be sure of
  EXPECT_EQ(airspace->bounds().max.z(), 60);
  testing::expect_error([&] { make_airspace(PreparedScene(builder.scene()), -1); }, ErrorCode::value_out_of_range,
                        "tour.clearance");
}

TEST(TourAirspace, KeepsAwayFromLinesOverhead) {
  Scene scene = testing::SceneBuilder().ground("ground", 200);
  scene.objects[0].kind = ObjectKind::ground;
  scene.overhead = {{{"volt"}, testing::make_box_mesh({0, -50, 0}, {0, 50, 45})}};
  const auto airspace = make_airspace(PreparedScene(scene), 3);
  EXPECT_EQ(airspace->obstacle({{-20, 0, 30}, {20, 0, 30}}, 0), "volt");
  EXPECT_EQ(airspace->obstacle({{-20, 0, 30}, {-2.9, 0, 30}}, 0), "volt");
  EXPECT_TRUE(airspace->allows({{-20, 0, 30}, {-3.1, 0, 30}}, 0));
  EXPECT_TRUE(airspace->allows({{-20, 0, 49}, {20, 0, 49}}, 0));
  EXPECT_FALSE(make_airspace(PreparedScene(scene), 0)->allows({{-20, 0, 30}, {20, 0, 30}}, 0));
}

TEST(TourAirspace, ATubeIsADeviationThatIsAlwaysAsked) {
  testing::Random random(52);
  const Town town = random_town(random, Vec3(0, 0, 0));
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{1, 45};
  const PreparedScene scene(town.scene);
  const auto plain = make_airspace(scene, 2, navigation), tube = make_airspace(scene, 2, navigation, 1.5);
  int refused_by_tube = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 from(random.uniform(-120, 120), random.uniform(-120, 120), random.uniform(0, 46));
    const Leg leg = {from, from + random.direction() * random.uniform(0, 60)};
    EXPECT_EQ(tube->allows(leg, 0.25), plain->allows(leg, 1.75));
    EXPECT_EQ(tube->obstacle(leg, 0.25), plain->obstacle(leg, 1.75));
    if (plain->allows(leg, 0) && !tube->allows(leg, 0)) ++refused_by_tube;
  }
  EXPECT_GT(refused_by_tube, 20);
  const Leg over = {{-200, 0, 4}, {-150, 0, 4}};
  EXPECT_TRUE(make_airspace(scene, 2, {}, 3.5)->allows(over, 0)) << "also more than a leg may deviate";
  EXPECT_FALSE(make_airspace(scene, 2, {}, 4.5)->allows(over, 0)) << "it meets the ground";
  testing::expect_error([&] { make_airspace(scene, 1, {}, -1); }, ErrorCode::value_out_of_range, "tour.tube");
}

TEST(TourAirspace, NothingFliesThroughAHill) {
  // A ridge of the ground, 20 m high, and no clearance from it: over it, but not through it.
  testing::SceneBuilder builder;
  builder.polygon("west", {{-50, -50, 0}, {0, -50, 20}, {0, 50, 20}, {-50, 50, 0}});
  builder.polygon("east", {{0, -50, 20}, {50, -50, 0}, {50, 50, 0}, {0, 50, 20}});
  Scene scene = builder.scene();
  for (SceneObject& object : scene.objects) object.kind = ObjectKind::ground;
  const auto airspace = make_airspace(PreparedScene(scene), 5);
  const Leg through = {{-40, 0, 10}, {40, 0, 10}}, over = {{-40, 0, 21}, {40, 0, 21}};
  EXPECT_FALSE(airspace->allows(through, 0));
  EXPECT_FALSE(airspace->obstacle(through, 0).empty());
  EXPECT_TRUE(airspace->allows(over, 0.5));
  EXPECT_FALSE(airspace->allows(over, 1.5));
}

TEST(TourAirspace, ToursFlyRoundBuildings) {
  testing::Random random(52);
  int visits = 0, targets = 0;
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    const Town town = random_town(random, Vec3::Zero());
    TourRequest request;
    Navigation navigation;
    navigation.altitude = Navigation::Altitude{3, 30};
    request.airspace = make_airspace(PreparedScene(town.scene), 2, navigation);
    for (int t = 0; t < 4; ++t) {
      const Vec3 low(random.uniform(-110, 90), random.uniform(-110, 90), random.uniform(3, 10));
      request.targets.push_back({"T" + std::to_string(t), testing::make_box_mesh(low, low + Vec3(20, 20, 10))});
    }
    request.rounds = 15;
    const Tour tour = plan_tour(request);
    const BoxAirspace same(town.boxes, 2, Box{Vec3(-1e9, -1e9, 3), Vec3(1e9, 1e9, 30)});
    testing::judge(request, tour, &same);
    visits += static_cast<int>(tour.visits.size());
    targets += 4;
  }
  EXPECT_GE(visits, targets * 9 / 10);
}

}  // namespace
}  // namespace vantage
