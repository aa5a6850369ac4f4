// Zones in mission files: their keys, and what becomes of them in a scene with a place on the earth.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "app/mission_parser.h"
#include "app/zone_places.h"
#include "geo/local_frame.h"
#include "query/limits.h"
#include "support/internals.h"
#include "support/map_text.h"
#include "support/random.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "support/zones.h"
#include "vantage/mission.h"

namespace vantage::testing {
namespace {

const std::string kRest =
    "scene: {mesh: city.obj}\ntarget: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}\n"
    "sensor: {max_range: 100}\nnavigation:\n";

MissionFile parsed(const std::string& limits) {
  return app::parse_mission(kRest + "  " + limits + "\n", "/data/mission.yaml");
}

void expect_refused(const std::string& limits, ErrorCode code, const std::string& where) {
  SCOPED_TRACE(limits);
  const Error error = expect_error([&] { parsed(limits); }, code);
  const std::string line = "/data/mission.yaml:5:";
  EXPECT_EQ(error.where(), line + where) << error.what();
}

TEST(MissionZones, ReadsBoxesAndPolygonsFromOneList) {
  const MissionFile mission = parsed(
      "keep_in: [{polygon: [[0, 0], [9, 0], [5, 5], [0, 9]], z: [-1, 20], holes: [[[1, 1], [2, 1], [1, 2]]]}, "
      "{min: [0, 1, 2], max: [3, 4, 5]}]\n"
      "  keep_out: [{polygon: [[0, 0], [9, 0], [0, 9]], heights: any}]");
  const Navigation& navigation = mission.navigation;
  ASSERT_EQ(navigation.keep_in.size(), 2u);
  EXPECT_TRUE(navigation.keep_in[1].is_box);
  EXPECT_EQ(navigation.keep_in[1].box().max, Vec3(3, 4, 5));
  EXPECT_EQ(navigation.keep_in[1].name, "1");
  const Zone& kept = navigation.keep_in[0];
  EXPECT_EQ(kept.outer, (Zone::Ring{{0, 0}, {9, 0}, {5, 5}, {0, 9}}));
  ASSERT_EQ(kept.holes.size(), 1u);
  EXPECT_EQ(kept.holes[0][2], Eigen::Vector2d(1, 2));
  EXPECT_EQ(kept.min_z_m, -1);
  EXPECT_EQ(kept.max_z_m, 20);
  EXPECT_EQ(kept.name, "0");
  ASSERT_EQ(navigation.keep_out.size(), 1u);
  EXPECT_EQ(navigation.keep_out[0].min_z_m, -INFINITY);
  EXPECT_EQ(navigation.keep_out[0].max_z_m, INFINITY);
  const std::string place = "/data/mission.yaml:5:13";
  EXPECT_EQ(mission.places.keep_in_zones.at(0), place);
  EXPECT_FALSE(navigation.empty());
}

TEST(MissionZones, BoxesIsTheOldNameOfKeepIn) {
  const std::string box = "[{min: [0, 1, 2], max: [3, 4, 5]}]";
  const std::string polygon = "boxes: [{polygon: [[0, 0], [9, 0], [0, 9]], z: [0, 1]}]";
  EXPECT_EQ(parsed("boxes: " + box).navigation.keep_in[0].box().min,
            parsed("keep_in: " + box).navigation.keep_in[0].box().min);
  EXPECT_EQ(parsed(polygon).navigation.keep_in.size(), 1u);
  expect_error([&] { parsed("keep_in: " + box + "\n  boxes: " + box); }, ErrorCode::conflicting_keys,
               "/data/mission.yaml:6:10");
}

TEST(MissionZones, RefusesWhatIsNoZone) {
  const std::string ring = "polygon: [[0, 0], [9, 0], [0, 9]]";
  expect_refused("keep_in: []", ErrorCode::nothing_given, "12");
  expect_refused("keep_in: [{" + ring + "}]", ErrorCode::missing_key, "13");
  expect_refused("keep_in: [{" + ring + ", z: [1, 2], heights: any}]", ErrorCode::conflicting_keys, "69");
  expect_refused("keep_in: [{" + ring + ", heights: some}]", ErrorCode::unknown_choice, "58");
  expect_refused("keep_in: [{" + ring + ", z: 5}]", ErrorCode::wrong_type, "52");
  expect_refused("keep_in: [{" + ring + ", z: [5]}]", ErrorCode::wrong_type, "52");
  expect_refused("keep_in: [{" + ring + ", z: [5, 4]}]", ErrorCode::limits_reversed, "13");
  expect_refused("keep_out: [{" + ring + ", z: [5, 5]}]", ErrorCode::limits_empty, "14");
  expect_refused("keep_out: [{" + ring + ", min: [0, 0, 0], z: [5, 6]}]", ErrorCode::conflicting_keys, "55");
  expect_refused("keep_out: [{min: [0, 0, 0], max: [1, 1, 1], z: [5, 6]}]", ErrorCode::conflicting_keys, "50");
  expect_refused("keep_out: [{polygon: [[0, 0], [9, 9], [9, 0], [0, 9]], z: [0, 1]}]", ErrorCode::zone_not_simple,
                 "14");
  expect_refused("keep_out: [{polygon: [[0, 0, 0], [9, 9, 0], [9, 0, 0]], z: [0, 1]}]", ErrorCode::wrong_type, "25");
  expect_refused("keep_out: [{polygon: 5, z: [0, 1]}]", ErrorCode::wrong_type, "24");
  expect_refused("keep_out: [{" + ring + ", holes: [[0, 0]], z: [0, 1]}]", ErrorCode::wrong_type, "59");
  expect_refused("keep_out: [[0, 1]]", ErrorCode::wrong_type, "14");
}

TEST(MissionZones, TextReadsBackAsTheSame) {
  const MissionFile read = parsed(
      "keep_in: [{min: [0, 1, 2], max: [3, 4, 5]}, {polygon: [[0.1, 0], [9, 0], [5, 5], [0, 9]], z: [-1, 20.5], "
      "holes: [[[1, 1], [2, 1], [1, 2]]]}]\n  keep_out: [{polygon: [[0, 0], [9, 0], [0, 9]], heights: any}]");
  const std::string text = mission_text(read, "/data");
  const MissionFile again = app::parse_mission(text, "/data/again.yaml");
  EXPECT_EQ(mission_text(again, "/data"), text);
  ASSERT_EQ(again.navigation.keep_in.size(), 2u);
  EXPECT_TRUE(again.navigation.keep_in[0].is_box);
  EXPECT_EQ(again.navigation.keep_in[1].outer, read.navigation.keep_in[1].outer);
  EXPECT_EQ(again.navigation.keep_in[1].holes, read.navigation.keep_in[1].holes);
  EXPECT_EQ(again.navigation.keep_in[1].max_z_m, 20.5);
  ASSERT_EQ(again.navigation.keep_out.size(), 1u);
  EXPECT_EQ(again.navigation.keep_out[0].max_z_m, INFINITY);
}

TEST(MissionZones, EachNumberOfAZoneIsInTheHash) {
  const auto hash = [](const std::string& limits) {
    const MissionFile file = parsed(limits);
    return mission_hash({file, {}, file.targets[0].target, {}, file.sensor, file.navigation, 0});
  };
  const std::string start = "keep_in: [{polygon: [[0, 0], [9, 0], [0, 9]], ";
  const std::vector<std::string> all = {
      start + "z: [0, 5]}]",
      start + "z: [0, 6]}]",
      start + "z: [1, 5]}]",
      start + "heights: any}]",
      start + "z: [0, 5], holes: [[[1, 1], [2, 1], [1, 2]]]}]",
      "keep_in: [{polygon: [[0, 0], [8, 0], [0, 9]], z: [0, 5]}]",
      "keep_out: [{polygon: [[0, 0], [9, 0], [0, 9]], z: [0, 5]}]",
      "keep_in: [{min: [0, 0, 0], max: [9, 9, 5]}]",
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(hash(all[i]), hash(all[k])) << all[i] << all[k];
  }
  const std::string old_name = "boxes: [{min: [0, 0, 0], max: [9, 9, 5]}]";
  EXPECT_EQ(hash(all.back()), hash(old_name));
}

/// The zone in longitudes and latitudes, straight between its corners.
bool holds(const Zone& zone, const Eigen::Vector2d& p) {
  bool odd = false;
  const auto count = [&](const Zone::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y())) {
        odd = !odd;
      }
    }
  };
  count(zone.outer);
  for (const Zone::Ring& hole : zone.holes) count(hole);
  return odd;
}

// Sides along parallels of up to 40 km, at 70 degrees of latitude: they leave their chords by 90 m.
TEST(MissionZones, KeepInNeverGrowsAndKeepOutNeverShrinks) {
  Random random(53);
  const geo::LonLat place{11, 70};
  const geo::LocalFrame frame(place);
  const app::ToFrame to_frame = [&](const Eigen::Vector2d& p) { return frame.to_local({p.x(), p.y()}); };
  for (const double size : {1e-4, 0.01, 0.5}) {  // degrees
    for (int draw = 0; draw < 6; ++draw) {
      Zone zone = zone_of({{place.longitude_deg - size, place.latitude_deg - size * random.uniform(0.1, 0.5)},
                           {place.longitude_deg + size, place.latitude_deg - size * random.uniform(0.1, 0.5)},
                           {place.longitude_deg + 0.2 * size, place.latitude_deg + size * random.uniform(0, 0.1)},
                           {place.longitude_deg + size, place.latitude_deg + size * random.uniform(0.2, 0.5)},
                           {place.longitude_deg - size, place.latitude_deg + size * random.uniform(0.2, 0.5)}},
                          0, 10);
      zone.holes = {{{place.longitude_deg - 0.8 * size, place.latitude_deg},
                     {place.longitude_deg - 0.2 * size, place.latitude_deg},
                     {place.longitude_deg - 0.4 * size, place.latitude_deg + 0.1 * size}}};
      if (random.chance(0.5)) std::reverse(zone.outer.begin(), zone.outer.end());
      const Zone kept = app::placed_zone(zone, app::ZoneUse::keep_in, to_frame, "");
      const Zone out = app::placed_zone(zone, app::ZoneUse::keep_out, to_frame, "");
      std::vector<Zone::Ring> rings = zone.holes;
      rings.push_back(zone.outer);
      for (int i = 0; i < 2000; ++i) {
        // Near a side, by more and by less than what it is moved by.
        const Zone::Ring& ring = rings[static_cast<std::size_t>(random.integer(0, 1))];
        const auto side = static_cast<std::size_t>(random.integer(0, static_cast<int>(ring.size()) - 1));
        const Eigen::Vector2d a = ring[side], b = ring[(side + 1) % ring.size()];
        const Eigen::Vector2d on_side = a + random.uniform(0.02, 0.98) * (b - a);
        const double off_m = std::pow(10, random.uniform(-7, -1)) * (random.chance(0.5) ? 1 : -1);
        const Eigen::Vector2d at = to_frame(on_side) + Eigen::Vector2d(0.3, 0.95) * off_m;
        const geo::LonLat degrees = frame.to_lonlat(at);
        const bool held = holds(zone, {degrees.longitude_deg, degrees.latitude_deg});
        EXPECT_TRUE(held || !holds(kept, at)) << size << ", " << off_m;
        EXPECT_TRUE(holds(out, at) || !held) << size << ", " << off_m;
        if (std::abs(off_m) > 0.03) {
          EXPECT_EQ(holds(kept, at), held) << size << ", " << off_m;
          EXPECT_EQ(holds(out, at), held) << size << ", " << off_m;
        }
      }
    }
  }
}

TEST(MissionZones, SharpTipsOfZonesToStayOutOfAreNotCutOff) {
  const geo::LonLat place{11, 70};
  const geo::LocalFrame frame(place);
  const app::ToFrame to_frame = [&](const Eigen::Vector2d& p) { return frame.to_local({p.x(), p.y()}); };
  for (const double width : {1e-2, 1e-4, 1e-6, 1e-8}) {  // of 0.1 degrees
    const Zone zone = zone_of({{11, 70}, {11.1, 70}, {11.1, 70 + width}}, 0, 1);
    const Zone out = app::placed_zone(zone, app::ZoneUse::keep_out, to_frame, "");
    for (const Eigen::Vector2d& corner : zone.outer) EXPECT_TRUE(holds(out, to_frame(corner))) << width;
    for (const Eigen::Vector2d& p : out.outer) EXPECT_LT((p - to_frame({11.05, 70})).norm(), 3000) << width;
  }
}

Mission with_zones(const std::string& rest) {
  const TemporaryDirectory folder;
  MapText map({11, 48});
  map.box(30, 0, 40, 10, {{"building", "yes"}});
  std::ofstream(folder.path() / "city.osm") << map.text();
  std::ofstream(folder.path() / "mission.yaml") << "scene: {osm: city.osm, center: [48, 11], radius: 500}\n"
                                                << "sensor: {max_range: 80}\ncrs: EPSG:4326\n"
                                                << "target: {center: [48, 11], width: 5, length: 5}\n"
                                                << "navigation:\n  " << rest << "\n";
  return resolve_mission(read_mission(folder.path() / "mission.yaml"));
}

TEST(MissionZones, FollowTheCrs) {
  const Mission mission = with_zones(
      "keep_in: [{polygon: [[10.999, 47.999], [11.001, 47.999], [11.001, 48.001]], z: [5, 60]}]\n"
      "  keep_out: [{polygon: [[10.9995, 47.9995], [11.0005, 47.9995], [11, 48]], heights: any}]");
  const geo::LocalFrame frame({11, 48});
  ASSERT_EQ(mission.navigation.keep_in.size(), 1u);
  const Zone& kept = mission.navigation.keep_in[0];
  const auto has_corner_near = [&](const Zone& zone, double longitude, double latitude) {
    const Eigen::Vector2d at = frame.to_local({longitude, latitude});
    return std::any_of(zone.outer.begin(), zone.outer.end(), [&](const auto& p) { return (p - at).norm() < 0.01; });
  };
  EXPECT_TRUE(has_corner_near(kept, 10.999, 47.999));
  EXPECT_TRUE(has_corner_near(kept, 11.001, 48.001));
  EXPECT_EQ(kept.min_z_m, 5);
  EXPECT_EQ(kept.max_z_m, 60);
  const Zone& out = mission.navigation.keep_out.at(0);
  EXPECT_TRUE(has_corner_near(out, 11, 48));
  EXPECT_EQ(out.max_z_m, INFINITY);
}

// All corners near the scene once longitude and latitude change places.
TEST(MissionZones, SayWhenLongitudeAndLatitudeSeemSwapped) {
  const auto problem_of = [](const std::string& zone) {
    return expect_error([&] { with_zones("keep_out: [" + zone + "]"); }, ErrorCode::too_far_away).problem();
  };
  const auto says = [](const std::string& problem) { return problem.find("swapped") != std::string::npos; };
  EXPECT_TRUE(says(problem_of("{polygon: [[48, 11], [48.001, 11], [48, 11.001]], z: [0, 1]}")));
  EXPECT_FALSE(says(problem_of("{polygon: [[2.33, 48.85], [2.34, 48.85], [2.34, 48.86]], z: [0, 1]}")));  // Paris
  EXPECT_TRUE(says(problem_of("{min: [48, 11, 0], max: [48.001, 11.001, 1]}")));
  EXPECT_FALSE(says(problem_of("{min: [2.33, 48.85, 0], max: [2.34, 48.86, 1]}")));
}

TEST(MissionZones, RefusesZonesOfAnotherCity) {
  const auto refuse = [](const std::string& key, const std::string& ring, ErrorCode code) {
    expect_error([&] { with_zones(key + ": [{polygon: " + ring + ", z: [0, 1]}]"); }, code, "mission.yaml:6:");
  };
  refuse("keep_in", "[[2.33, 48.85], [2.34, 48.85], [2.34, 48.86]]", ErrorCode::too_far_away);         // Paris
  refuse("keep_out", "[[48, 11], [48.001, 11], [48, 11.001]]", ErrorCode::too_far_away);               // swapped
  refuse("keep_out", "[[10, 47], [12, 47], [11, 80]]", ErrorCode::too_far_away);                       // too large
  refuse("keep_in", "[[11, 48], [11.001, 48], [11.001, 48.0000000001]]", ErrorCode::zone_not_simple);  // too narrow
}

}  // namespace
}  // namespace vantage::testing
