// Targets on the ground that are not what they look like: indoors, with holes, far away; and boxes whose sides curve.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <string>

#include "geo/local_frame.h"
#include "support/map_text.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

using testing::MapText;
using testing::TemporaryDirectory;
using testing::write_bytes;

constexpr geo::LonLat kOrigin = {11.5755, 48.1374};

class GroundTargetTest : public ::testing::Test {
 protected:
  void SetUp() override {
    MapText map(kOrigin);
    map.box(-10, -10, 10, 10, {{"building", "yes"}, {"height", "12"}});  // way/1
    map.box(-40, -40, 40, 40, {{"name", "the border of the square"}});   // way/2
    map.relation({{"way", 2, "outer"}, {"way", 1, "inner"}}, {{"type", "multipolygon"}, {"place", "square"}});
    map.box(100, -5, 120, 5, {{"building", "roof"}, {"height", "5"}, {"name", "Shelter"}});  // way/3
    write_bytes(folder_ / "city.osm", map.text());
  }

  Mission placed(const std::string& text) {
    write_bytes(folder_ / "mission.yaml",
                "scene: {osm: city.osm, center: [48.1374, 11.5755], radius: 300}\n"
                "sensor: {max_range: 90}\n" +
                    text);
    return resolve_mission(read_mission(folder_ / "mission.yaml"));
  }

  void expect_refused(const std::string& text, ErrorCode code) {
    testing::expect_error([&] { placed(text); }, code, "mission.yaml:3:");
  }

  static std::string at(double east, double north) {
    const geo::LonLat place = geo::LocalFrame(kOrigin).to_lonlat({east, north});
    char text[64];
    std::snprintf(text, sizeof text, "[%.9f, %.9f]", place.latitude_deg, place.longitude_deg);
    return text;
  }

  TemporaryDirectory folder_;
};

double area_of(const Target& target) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < target.parts[0].size(); ++i) {
    sum += (target.parts[0][i] - target.parts[0][0]).cross(target.parts[0][i + 1] - target.parts[0][0]) / 2;
  }
  return sum.norm();
}

TEST_F(GroundTargetTest, IndoorsIsRefused) {
  expect_refused("target: {osm: way/1}\n", ErrorCode::target_inside_solid);
  expect_refused("target: {center: " + at(2, -3) + ", width: 4, length: 6, heading: 20}\n",
                 ErrorCode::target_inside_solid);
  const Mission below = placed("target: {center: " + at(110, 0) + ", width: 4, length: 6}\n");
  EXPECT_NEAR(area_of(below.target), 24, 1e-6) << "under a roof on posts is outdoors";
}

TEST_F(GroundTargetTest, HolesAreNoPartOfIt) {
  const Mission square = placed("target: {osm: relation/1}\n");
  double area = 0;
  for (std::size_t i = 0; i < square.target.parts.size(); ++i) area += area_of(square.target.part(i));
  EXPECT_NEAR(area, 80 * 80 - 20 * 20, 2);
  EXPECT_EQ(run_mission(square).volume.outcome, Outcome::no_common_view)
      << "the building in the middle hides some of it from everywhere within range";
}

TEST_F(GroundTargetTest, AWallRoundItFillsNoHole) {
  MapText map(kOrigin);
  const long outer = map.box(-40, -40, 40, 40, {}), inner = map.box(-10, -10, 10, 10, {});
  map.relation({{"way", outer, "outer"}, {"way", inner, "inner"}},
               {{"type", "multipolygon"}, {"leisure", "park"}, {"barrier", "fence"}});
  map.box(100, -5, 120, 5, {{"building", "yes"}});
  write_bytes(folder_ / "park.osm", map.text());
  write_bytes(folder_ / "mission.yaml",
              "scene: {osm: park.osm, without: [walls]}\nsensor: {max_range: 90}\ntarget: {osm: relation/1}\n");
  const Mission park = resolve_mission(read_mission(folder_ / "mission.yaml"));
  double area = 0;
  for (std::size_t i = 0; i < park.target.parts.size(); ++i) area += area_of(park.target.part(i));
  EXPECT_NEAR(area, 80 * 80 - 20 * 20, 2);
}

// ---- areas by their names

class NamedAreaTest : public ::testing::Test {
 protected:
  void SetUp() override {
    MapText map(kOrigin);
    map.box(-40, -40, -20, -20, {{"leisure", "park"}, {"name", "Finsbury Square"}});  // way/1
    map.area({{-45, -45}, {-15, -45}, {-15, -15}, {-45, -15}},
             {{"highway", "residential"}, {"name", "Finsbury Square"}});       // way/2, the street around it
    map.box(20, 20, 30, 30, {{"leisure", "pitch"}, {"name", "North Pitch"}});  // way/3
    map.box(40, 20, 50, 30, {{"leisure", "pitch"}, {"name", "north pitch"}});  // way/4
    map.box(60, 20, 70, 30, {{"amenity", "parking"}, {"name", "Lot"}});        // way/5
    map.box(60, 40, 70, 50, {{"amenity", "parking"}, {"name", "Lot"}});        // way/6
    map.area({{60, 60}, {70, 60}, {70, 70}}, {{"highway", "service"}, {"name", "Loop"}});  // way/7
    map.box(-90, 60, -80, 70, {{"building", "yes"}});                                      // a scene needs one
    write_bytes(folder_ / "city.osm", map.text());
  }
  std::string name_of(const std::string& osm) {
    write_bytes(folder_ / "mission.yaml",
                "scene: {osm: city.osm, center: [48.1374, 11.5755], radius: 300}\nsensor: {max_range: 90}\n"
                "target: {osm: " +
                    osm + "}\n");
    return resolve_mission(read_mission(folder_ / "mission.yaml")).target.name;
  }
  void refuse(const std::string& osm) {
    testing::expect_error([&] { name_of(osm); }, ErrorCode::map_object_missing, "mission.yaml:3:");
  }
  TemporaryDirectory folder_;
};

TEST_F(NamedAreaTest, TheNameOfOneAreaIsEnough) {
  EXPECT_EQ(name_of("Finsbury Square"), "Finsbury Square (way/1)") << "and not the street around it";
  EXPECT_EQ(name_of("finsbury SQUARE"), "Finsbury Square (way/1)");
  EXPECT_EQ(name_of("North Pitch"), "North Pitch (way/3)") << "as it is written, before another case";
  EXPECT_EQ(name_of("north pitch"), "north pitch (way/4)");
  EXPECT_EQ(name_of("way/1"), "Finsbury Square (way/1)");
  EXPECT_EQ(name_of("Loop"), "Loop (way/7)") << "a closed street, where no area has the name";
}

TEST_F(NamedAreaTest, OtherNamesAreRefusedWithWhatIsThere) {
  refuse("Lot");
  refuse("NORTH PITCH");
  refuse("Finsbury Sqare");
  refuse("way/99");
}

double plan_area(const Mission& mission) {
  double area = 0;
  for (std::size_t i = 0; i < mission.target.parts.size(); ++i) area += area_of(mission.target.part(i));
  return area;
}

TEST_F(GroundTargetTest, OutlinesAreLaidOnTheGround) {
  const Mission bent = placed("target: {outline: [[50, 0], [80, 0], [80, 30], [70, 10]]}\n");
  EXPECT_GT(bent.target.parts.size(), 1u) << "it is not convex";
  EXPECT_NEAR(plan_area(bent), 300, 0.01);
  const Mission ring = placed(
      "target: {outline: [[-40, -40], [40, -40], [40, 40], [-40, 40]], holes: [[[-11, -11], [11, -11], [11, 11], "
      "[-11, 11]]]}\n");
  EXPECT_NEAR(plan_area(ring), 80 * 80 - 22 * 22, 0.01);
  for (const std::vector<Vec3>& part : ring.target.parts) {
    for (const Vec3& corner : part) EXPECT_EQ(corner.z(), 0);
  }
  write_bytes(folder_ / "again.yaml", mission_text(ring.as_written, folder_.path()));
  const Mission again = resolve_mission(read_mission(folder_ / "again.yaml"));
  EXPECT_EQ(mission_hash(again), mission_hash(ring));
}

TEST_F(GroundTargetTest, OutlinesMayBeGivenInDegrees) {
  const geo::LocalFrame frame(kOrigin);
  std::string corners;
  for (const auto& [east, north] : {std::pair{50.0, 0.0}, {80.0, 0.0}, {80.0, 30.0}}) {
    const geo::LonLat place = frame.to_lonlat({east, north});
    char text[64];
    std::snprintf(text, sizeof text, "[%.9f, %.9f]", place.longitude_deg, place.latitude_deg);
    corners += (corners.empty() ? "" : ", ") + std::string(text);
  }
  const Mission mission = placed("target: {outline: [" + corners + "]}\ncrs: EPSG:4326\n");
  EXPECT_NEAR(plan_area(mission), 450, 0.1);
}

TEST_F(GroundTargetTest, OutlinesThatAreNoneAreRefused) {
  expect_refused("target: {outline: [[0, 0], [9, 9], [9, 0], [0, 9]]}\n", ErrorCode::zone_not_simple);
  expect_refused("target: {outline: [[50, 0], [60, 0], [60, 0.001], [50, 0.001]]}\n", ErrorCode::target_without_area);
  expect_refused("target: {outline: [[-5, -5], [5, -5], [5, 5]]}\n", ErrorCode::target_inside_solid);
  expect_refused("target: {outline: [[50, 0, 0, 0], [60, 0, 0, 0], [60, 9, 0, 0]]}\n", ErrorCode::wrong_type);
  expect_refused("target: {outline: [[50, 0], [60, 0], [60, 9]], vertices: [[50, 0, 0], [60, 0, 0], [60, 9, 0]]}\n",
                 ErrorCode::conflicting_keys);
  expect_refused("target: {vertices: [[50, 0, 0], [60, 0, 0], [60, 9, 0]], holes: []}\n", ErrorCode::not_applicable);
  // The unit of a coordinate is that of its system.
  for (const std::string corner : {"[60 ft, 9]", "[60, 9 m]", "[60, 9, 1 ft]"}) {
    expect_refused("target: {outline: [[50, 0], [60, 0], " + corner + "]}\n", ErrorCode::value_syntax);
    expect_refused("target: {outline: [[0, 0], [90, 0], [90, 90]], holes: [[[60, 2], " + corner + ", [70, 9]]]}\n",
                   ErrorCode::value_syntax);
  }
}

TEST_F(GroundTargetTest, FarAwayIsMostLikelyTheWrongOrder) {
  expect_refused(
      "target: {vertices: [[48.1374, 11.5755, 0], [48.1375, 11.5755, 0], [48.1374, 11.5756, 0]]}\n"
      "crs: EPSG:4326\n",
      ErrorCode::too_far_away);
}

/// EPSG:6360 measures in feet of the US survey.
TEST_F(GroundTargetTest, HeightsAreInTheUnitOfTheSystem) {
  const auto height = [&](const char* system) {
    const std::string text =
        "target: {vertices: [[691000, 5334600, 10], [691010, 5334600, 10], [691000, 5334610, 10]]}\n";
    return placed(text + "crs: " + system + "\n").target.parts[0].at(0).z();
  };
  EXPECT_EQ(height("EPSG:25832"), 10);
  EXPECT_NEAR(height("EPSG:25832+6360"), 10 * 1200.0 / 3937, 1e-9);
}

/// A box of 8 km in longitude: its northern side, a parallel, lies 1.4 m further south in the middle than at its ends.
TEST_F(GroundTargetTest, BoxesHoldWithSidesThatCurve) {
  const geo::LocalFrame frame(kOrigin);
  const Mission mission = placed("target: {center: " + at(70, 0) +
                                 ", width: 4, length: 6}\ncrs: EPSG:4326\nnavigation:\n"
                                 "  boxes: [{min: [11.52, 48.13, 1], max: [11.63, 48.145, 80]}]\n"
                                 "  keep_out: [{min: [11.52, 48.13, 1], max: [11.63, 48.145, 80]}]\n");
  const Box in = mission.navigation.keep_in.at(0).box(), out = mission.navigation.keep_out.at(0).box();
  const double ends = frame.to_local({11.52, 48.145}).y(), middle = frame.to_local({kOrigin.longitude_deg, 48.145}).y();
  EXPECT_GT(ends - middle, 1);
  EXPECT_LE(in.max.y(), middle);
  EXPECT_NEAR(in.max.y(), middle, 0.01);
  EXPECT_GE(out.max.y(), ends);
  EXPECT_NEAR(out.max.y(), ends, 0.01);
  for (int i = 0; i <= 100; ++i) {
    const double longitude = 11.52 + 0.11 * i / 100;
    EXPECT_GE(in.min.y(), frame.to_local({longitude, 48.13}).y());
    EXPECT_LE(out.min.y(), frame.to_local({longitude, 48.13}).y());
  }
}

}  // namespace
}  // namespace vantage
