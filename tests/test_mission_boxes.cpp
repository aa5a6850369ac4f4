// Boxes between meridians and parallels, whose sides curve in the scene frame: limits never allow what lies outside.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "geo/local_frame.h"
#include "support/map_text.h"
#include "support/temporary_directory.h"
#include "vantage/mission.h"

namespace vantage::testing {
namespace {

constexpr geo::LonLat kNorth = {11, 70};
constexpr double kHalfWidth = 0.05, kHalfHeight = 0.01;  // degrees: 3.8 km by 2.2 km

std::string box_text() {
  char text[160];
  std::snprintf(text, sizeof text, "{min: [%.9f, %.9f, 5], max: [%.9f, %.9f, 60]}", kNorth.longitude_deg - kHalfWidth,
                kNorth.latitude_deg - kHalfHeight, kNorth.longitude_deg + kHalfWidth,
                kNorth.latitude_deg + kHalfHeight);
  return text;
}

Mission placed(const std::string& rest) {
  const TemporaryDirectory folder;
  MapText map(kNorth);
  map.box(30, 0, 40, 10, {{"building", "yes"}});
  map.box(-10, -10, 10, 10, {{"leisure", "pitch"}});
  std::ofstream(folder.path() / "city.osm") << map.text();
  std::ofstream(folder.path() / "mission.yaml")
      << "scene: {osm: city.osm, center: [70, 11], radius: 500}\nsensor: {max_range: 80}\n"
      << rest;
  return resolve_mission(read_mission(folder.path() / "mission.yaml"));
}

TEST(MissionBoxes, KeepInLiesWithinCurvedSidesAndKeepOutRoundThem) {
  const Mission mission =
      placed("crs: EPSG:4326\ntarget: {center: [70, 11], width: 5, length: 5}\nnavigation:\n  boxes: [" + box_text() +
             "]\n  keep_out: [" + box_text() + "]\n");
  const Box keep = mission.navigation.keep_in.at(0).box(), avoid = mission.navigation.keep_out.at(0).box();
  const geo::LocalFrame frame(kNorth);
  constexpr double kRounding = 1e-7;  // degrees
  for (int k = 0; k <= 1000; ++k) {
    const double share = k / 1000.0, x = keep.min.x() + share * (keep.max.x() - keep.min.x());
    for (const double y : {keep.min.y(), keep.max.y()}) {
      const geo::LonLat at = frame.to_lonlat({x, y});
      EXPECT_LE(std::abs(at.latitude_deg - kNorth.latitude_deg), kHalfHeight + kRounding) << "at " << x << " " << y;
      EXPECT_LE(std::abs(at.longitude_deg - kNorth.longitude_deg), kHalfWidth + kRounding) << "at " << x << " " << y;
    }
    for (const double side : {-kHalfHeight, kHalfHeight}) {
      const Eigen::Vector2d p =
          frame.to_local({kNorth.longitude_deg + (2 * share - 1) * kHalfWidth, kNorth.latitude_deg + side});
      EXPECT_GE(p.y(), avoid.min.y() - 0.01);
      EXPECT_LE(p.y(), avoid.max.y() + 0.01);
    }
  }
  // A parallel bends by (half its length)^2 tan(latitude) / 2 R: 0.8 m here.
  const double north = frame.to_local({kNorth.longitude_deg, kNorth.latitude_deg + kHalfHeight}).y();
  EXPECT_NEAR(keep.max.y(), north, 0.01);
  EXPECT_NEAR(avoid.max.y() - keep.max.y(), 0.79, 0.05);
  EXPECT_EQ(keep.min.z(), 5);
  EXPECT_EQ(avoid.max.z(), 60);
}

TEST(MissionBoxes, ATargetOfTheMapIsCalledByItsId) {
  const Mission unnamed = placed("target: {osm: way/2}\n"), named = placed("target: {osm: way/2, name: pitch}\n");
  EXPECT_EQ(unnamed.target.name, "way/2");
  EXPECT_EQ(named.target.name, "pitch");
}

}  // namespace
}  // namespace vantage::testing
