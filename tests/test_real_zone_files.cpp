// Zones of files that others wrote.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include "app/zone_file.h"
#include "support/internals.h"
#include "support/shared_data.h"

namespace vantage::testing {
namespace {

using app::HeightReference;
using app::ListedZone;
using app::ZoneList;

ZoneList parsed(const std::string& text) { return app::parse_zones(text, "/data/zones"); }

std::string shared_text(const std::string& file) {
  std::ifstream stream(shared_data(file), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST(RealZoneFiles, OfUasZones) {
  VANTAGE_REQUIRE_SHARED("airspace/ed318_Example_Collection.json");
  const ZoneList all = parsed(shared_text("airspace/ed318_Example_Collection.json"));
  ASSERT_EQ(all.zones.size(), 3u);
  EXPECT_EQ(all.zones[0].name, "NFZ6547");
  EXPECT_EQ(all.zones[0].lower->metres, 50);
  EXPECT_EQ(all.zones[1].upper->from, HeightReference::ground);
  EXPECT_EQ(all.zones[2].circle->radius_m, 3500);
  const std::map<std::string, std::size_t> counts = {
      {"Example_GeoZone_2_Layers", 2},
      {"Example_GeoZone_Circle", 1},
      {"Example_GeoZone_with_extension", 1},
      {"InvalidExample_GeoZone_2_Layers", 2},  // a date and the name of a type are wrong in it, not its zones
  };
  for (const auto& [name, count] : counts) {
    EXPECT_EQ(parsed(shared_text("airspace/ed318_" + name + ".json")).zones.size(), count) << name;
  }
}

TEST(RealZoneFiles, OfPlannersAndMaps) {
  VANTAGE_REQUIRE_SHARED("missions/PolygonGood.kml");
  const ZoneList park = parsed(shared_text("missions/PolygonGood.kml"));
  ASSERT_EQ(park.zones.size(), 1u);
  EXPECT_EQ(park.zones[0].name, "Untitled Polygon");
  EXPECT_EQ(park.zones[0].outer.size(), 4u);
  EXPECT_FALSE(park.zones[0].has_heights);
  const ZoneList home = parsed(shared_text("airspace/qgroundcontrol_home_base.plan"));
  ASSERT_EQ(home.zones.size(), 2u);
  EXPECT_EQ(home.zones[0].outer.size(), 4u);
  EXPECT_EQ(home.zones[1].is_inclusion, std::optional(false));
  const ZoneList simple = parsed(shared_text("missions/simple.plan"));
  ASSERT_FALSE(simple.zones.empty());
  EXPECT_TRUE(std::any_of(simple.zones.begin(), simple.zones.end(), [](const ListedZone& zone) {
    return zone.circle && std::abs(zone.circle->radius_m - 463.7) < 0.1;
  }));
  const std::string without = "missions/qgroundcontrol_sample.plan";
  EXPECT_TRUE(parsed(shared_text(without)).zones.empty());
}

}  // namespace
}  // namespace vantage::testing
