// Files of zones: GeoJSON, ED-269, ED-318, KML and plans of QGroundControl, and what becomes of them in a mission.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "app/zone_file.h"
#include "common/input.h"
#include "geo/local_frame.h"
#include "support/internals.h"
#include "support/map_text.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "support/zone_texts.h"
#include "vantage/ground.h"
#include "vantage/mission.h"

namespace vantage::testing {
namespace {

using app::HeightReference;
using app::ListedZone;
using app::ZoneList;

using namespace zone_texts;

ZoneList parsed(const std::string& text) { return app::parse_zones(text, "/data/zones"); }

TEST(ZoneFiles, ReadsAllAreasOfGeoJson) {
  const std::string hole =
      "[[11.0002, 48.0002], [11.0004, 48.0002], [11.0004, 48.0002], [11.0003, 48.0004], "
      "[11.0002, 48.0002]]";
  const std::string with_hole =
      "{\"type\": \"Polygon\", \"coordinates\": [" + kSquare.substr(1, kSquare.size() - 2) + ", " + hole + "]}";
  const std::string multi = "{\"type\": \"MultiPolygon\", \"coordinates\": [" + kSquare + ", " + kSquare + "]}";
  const std::string mixed = "{\"type\": \"GeometryCollection\", \"geometries\": [" + polygon() +
                            ", {\"type\": \"LineString\", \"coordinates\": [[1, 2], [3, 4]]}, "
                            "{\"type\": \"Point\", \"coordinates\": [1, 2]}]}";
  const ZoneList list =
      parsed("\xEF\xBB\xBF " + collection(feature(with_hole, "{\"name\": \"park\"}") + ", " + feature(multi) + ", " +
                                          feature(mixed, "{\"id\": 7}") + ", " + feature("null")));
  ASSERT_EQ(list.zones.size(), 4u);
  EXPECT_EQ(list.zones[0].name, "park");
  EXPECT_EQ(list.zones[0].outer, (Zone::Ring{{11, 48}, {11.001, 48}, {11.001, 48.001}, {11, 48.001}}));
  ASSERT_EQ(list.zones[0].holes.size(), 1u);
  EXPECT_EQ(list.zones[0].holes[0].size(), 3u);  // neither the corner that closes it nor the one that is there twice
  EXPECT_FALSE(list.zones[0].has_heights);
  EXPECT_EQ(list.zones[1].name, "1");
  EXPECT_EQ(list.zones[2].place, "features[1].coordinates[1]");
  EXPECT_EQ(list.zones[3].name, "7");
  EXPECT_EQ(list.left_out.at("line"), 1u);
  EXPECT_EQ(list.left_out.at("point"), 1u);
  EXPECT_EQ(list.left_out.at(app::kEmptyArea), 1u);
  EXPECT_EQ(parsed(feature(polygon())).zones.size(), 1u);
  EXPECT_EQ(parsed(polygon()).zones.size(), 1u);
}

TEST(ZoneFiles, ReadsHeightsAndCirclesOfUasZones) {
  const std::string layer =
      ", \"layer\": {\"upper\": 400, \"upperReference\": \"AMSL\", \"lower\": 10, "
      "\"lowerReference\": \"WGS84\", \"uom\": \"ft\"}";
  const ZoneList ed318 = parsed(collection(
      feature(polygon(layer), "{\"identifier\": \"NFZ1\"}") + ", " +
      feature(
          "{\"type\": \"Point\", \"coordinates\": [11, 48], \"extent\": {\"subType\": \"Circle\", \"radius\": 350}}")));
  ASSERT_EQ(ed318.zones.size(), 2u);
  EXPECT_EQ(ed318.zones[0].name, "NFZ1");
  EXPECT_TRUE(ed318.zones[0].has_heights);
  EXPECT_NEAR(ed318.zones[0].upper->metres, 121.92, 1e-9);
  EXPECT_EQ(ed318.zones[0].upper->from, HeightReference::sea_level);
  EXPECT_EQ(ed318.zones[0].lower->from, HeightReference::ellipsoid);
  EXPECT_EQ(ed318.zones[1].circle->radius_m, 350);
  EXPECT_EQ(ed318.zones[1].circle->least_radius_m, 350);
  EXPECT_EQ(ed318.zones[1].circle->centre, Eigen::Vector2d(11, 48));
  EXPECT_FALSE(ed318.zones[1].has_heights);

  const ZoneList ed269 = parsed(volume(polygon(), kMetres));
  ASSERT_EQ(ed269.zones.size(), 1u);
  EXPECT_EQ(ed269.zones[0].name, "Z1");
  EXPECT_EQ(ed269.zones[0].place, "features[0].geometry[0]");
  EXPECT_EQ(ed269.zones[0].lower->metres, 10);
  EXPECT_EQ(ed269.zones[0].lower->from, HeightReference::sea_level);
  EXPECT_EQ(ed269.zones[0].upper->from, HeightReference::ground);
  // Whether the radius is in the unit of the heights is not clear: both are kept.
  const ZoneList feet = parsed(volume("{\"type\": \"Circle\", \"center\": [11, 48], \"radius\": 100}",
                                      "\"uomDimensions\": \"FT\", \"lowerLimit\": null"));
  EXPECT_NEAR(feet.zones.at(0).circle->least_radius_m, 30.48, 1e-9);
  EXPECT_EQ(feet.zones[0].circle->radius_m, 100);
  EXPECT_TRUE(feet.zones[0].has_heights);
  EXPECT_FALSE(feet.zones[0].lower || feet.zones[0].upper);
}

TEST(ZoneFiles, ReadsFencesOfPlans) {
  const ZoneList list =
      parsed(plan("{\"inclusion\": true, \"polygon\": [[48, 11], [48, 11.001], [48.001, 11.001]]}, "
                  "{\"inclusion\": false, \"polygon\": [[48, 11], [48, 11.001], [48.001, 11.001]]}",
                  "{\"inclusion\": false, \"circle\": {\"center\": [48, 11], \"radius\": 463.7}}"));
  ASSERT_EQ(list.zones.size(), 3u);
  EXPECT_EQ(list.zones[0].outer[1], Eigen::Vector2d(11.001, 48));
  EXPECT_EQ(list.zones[0].is_inclusion, std::optional(true));
  EXPECT_EQ(list.zones[1].is_inclusion, std::optional(false));
  EXPECT_EQ(list.zones[2].circle->centre, Eigen::Vector2d(11, 48));
  EXPECT_EQ(list.zones[2].name, "circle 0");
  EXPECT_TRUE(list.has_no_heights);
}

TEST(ZoneFiles, ReadsPolygonsOfKml) {
  const ZoneList list =
      parsed(kml(placemark("<altitudeMode>clampToGround</altitudeMode>", ",5") +
                 placemark("<extrude>1</extrude><altitudeMode>absolute</altitudeMode>", ",120.5") +
                 placemark("<extrude>1</extrude><altitudeMode>relativeToGround</altitudeMode>", ",50") +
                 placemark("<altitudeMode>absolute</altitudeMode>", ",120") +
                 "<Placemark><Point><coordinates>11,48</coordinates></Point></Placemark>"
                 "<Placemark><MultiGeometry><Polygon><outerBoundaryIs><LinearRing><coordinates>1,2 3,2 3,4 1,2"
                 "</coordinates></LinearRing></outerBoundaryIs><innerBoundaryIs><LinearRing><coordinates>"
                 "2.1,2.1 2.2,2.1 2.2,2.2 2.1,2.1</coordinates></LinearRing></innerBoundaryIs></Polygon>"
                 "<LineString><coordinates>1,2 3,4</coordinates></LineString></MultiGeometry></Placemark>"));
  ASSERT_EQ(list.zones.size(), 5u);
  EXPECT_EQ(list.zones[0].name, "park");
  EXPECT_EQ(list.zones[0].outer, (Zone::Ring{{11, 48}, {11.001, 48}, {11.001, 48.001}}));
  EXPECT_FALSE(list.zones[0].has_heights);
  EXPECT_TRUE(list.zones[1].has_heights);
  EXPECT_FALSE(list.zones[1].lower);
  EXPECT_EQ(list.zones[1].upper->metres, 120.5);
  EXPECT_EQ(list.zones[1].upper->from, HeightReference::sea_level);
  EXPECT_FALSE(list.zones[2].has_heights);  // of the corners, not of what lies between them
  EXPECT_FALSE(list.zones[2].upper);
  EXPECT_FALSE(list.zones[3].has_heights);  // a surface at that height, not a space
  EXPECT_EQ(list.zones[4].name, "4");
  EXPECT_EQ(list.zones[4].holes.size(), 1u);
  EXPECT_EQ(list.left_out.at("point"), 1u);
  EXPECT_EQ(list.left_out.at("line"), 1u);
  const std::string prefixed =
      "<k:kml xmlns:k='a'><k:Placemark><k:Polygon><k:outerBoundaryIs><k:LinearRing><k:coordinates>1,2 3,2 3,4 1,2"
      "</k:coordinates></k:LinearRing></k:outerBoundaryIs></k:Polygon></k:Placemark></k:kml>";
  EXPECT_EQ(parsed(prefixed).zones.size(), 1u);
}

void refuse(const std::string& text, ErrorCode code, const std::string& where) {
  SCOPED_TRACE(text);
  const auto parse = [&] {
    const ZoneList list = parsed(text);
    if (!list.unread.empty()) throw list.unread.front().fault;
    for (const ListedZone& zone : list.zones) {
      if (zone.heights_fault) throw *zone.heights_fault;
    }
  };
  expect_error(parse, code, where);
}

constexpr ErrorCode kSyntax = ErrorCode::zone_file_syntax;

TEST(ZoneFiles, RefusesBrokenGeoJson) {
  refuse("", kSyntax, "/data/zones");
  refuse("PK\x03\x04", kSyntax, "/data/zones");
  refuse("[1, 2]", kSyntax, "/data/zones");
  refuse("{\"type\": \"Feature\",\n\"geometry\": nil}", kSyntax, "line 2");
  refuse("{\"a\": 1}", kSyntax, "/data/zones");
  refuse("{\"type\": \"Topology\"}", kSyntax, "/data/zones");
  refuse("{\"type\": 5}", kSyntax, "/data/zones");
  refuse("{\"type\": \"Feature\", \"type\": \"Feature\"}", kSyntax, "/data/zones");
  refuse(collection("5"), kSyntax, "features[0]");
  refuse(collection("{\"type\": \"Feature\"}"), kSyntax, "features[0]");
  refuse(collection(feature("5")), kSyntax, "features[0]");
  refuse(collection(feature("{\"type\": \"Polygon\"}")), kSyntax, "features[0]");
  refuse(collection(feature("{\"type\": \"Polygon\", \"coordinates\": [5]}")), kSyntax, "features[0]");
  refuse(collection(feature("{\"type\": \"Polygon\", \"coordinates\": [[[1, 2], [3, 2], [3, 4]]]}")), kSyntax,
         "features[0]");
  refuse(collection(feature("{\"type\": \"Polygon\", \"coordinates\": [[[1, 2], [3, 2], [3, 4], [2, 4]]]}")), kSyntax,
         "features[0]");
  refuse(collection(feature("{\"type\": \"Polygon\", \"coordinates\": [[[1, 2], [3, \"a\"], [3, 4], [1, 2]]]}")),
         kSyntax, "features[0]");
  refuse(collection(feature("{\"type\": \"Polygon\", \"coordinates\": [[[1, 2], [3, 92], [3, 4], [1, 2]]]}")),
         ErrorCode::not_on_earth, "features[0]");
  refuse("{\"type\": \"Polygon\", \"crs\": {\"properties\": {\"name\": \"EPSG:28992\"}}, \"coordinates\": []}",
         ErrorCode::value_unsupported, "crs");
}

TEST(ZoneFiles, RefusesBrokenUasZones) {
  const auto layer = [](const std::string& members) { return collection(feature(polygon(", \"layer\": " + members))); };
  refuse(layer("5"), kSyntax, "features[0]");
  refuse(layer("{\"upper\": 5}"), kSyntax, "features[0]");
  refuse(layer("{\"upper\": 65, \"upperReference\": \"STD\", \"uom\": \"FL\"}"), ErrorCode::value_unsupported,
         "features[0]");
  refuse(layer("{\"upper\": 65, \"upperReference\": \"STD\", \"uom\": \"m\"}"), ErrorCode::value_unsupported,
         "features[0]");
  refuse(layer("{\"upper\": 65, \"uom\": \"m\"}"), kSyntax, "features[0]");
  refuse(layer("{\"upper\": \"65 m\", \"upperReference\": \"AGL\", \"uom\": \"m\"}"), kSyntax, "features[0]");
  refuse(collection(feature("{\"type\": \"Point\", \"coordinates\": [1, 2], \"extent\": {\"subType\": \"Arc\"}}")),
         kSyntax, "features[0]");
  refuse(collection(feature("{\"type\": \"Point\", \"coordinates\": [1, 2], \"extent\": {\"subType\": \"Circle\", "
                            "\"radius\": 0}}")),
         ErrorCode::value_out_of_range, "features[0]");
  refuse(volume("{\"type\": \"Ellipse\"}", kMetres), kSyntax, "features[0].geometry[0]");
  refuse(volume("5", kMetres), kSyntax, "features[0].geometry[0]");
}

TEST(ZoneFiles, RefusesBrokenPlans) {
  refuse("{\"geoFence\": 5}", kSyntax, "geoFence");
  refuse("{\"geoFence\": {\"polygon\": [[1, 2]], \"version\": 1}}", ErrorCode::value_unsupported, "geoFence");
  refuse("{\"geoFence\": {\"polygons\": 1}}", kSyntax, "geoFence.polygons");
  refuse(plan("5"), kSyntax, "geoFence.polygons[0]");
  refuse(plan("{\"polygon\": []}"), kSyntax, "geoFence.polygons[0]");
  refuse(plan("{\"inclusion\": true}"), kSyntax, "geoFence.polygons[0]");
  refuse(plan("{\"inclusion\": true, \"polygon\": [5]}"), kSyntax, "geoFence.polygons[0]");
  refuse(plan("", "{\"inclusion\": true, \"circle\": {\"center\": [1, 2]}}"), kSyntax, "geoFence.circles[0]");
  refuse(plan("", "{\"inclusion\": true, \"circle\": {\"center\": [1, 2], \"radius\": -1}}"),
         ErrorCode::value_out_of_range, "geoFence.circles[0]");
  refuse("{\"geoFence\": {\"polygons\": [], \"circle\": [], \"version\": 2}}", kSyntax, "geoFence.circle");
  refuse("{\"geoFence\": {\"Polygons\": []}}", kSyntax, "geoFence.Polygons");
  const ZoneList empty = parsed(plan("{\"inclusion\": false, \"polygon\": []}"));
  EXPECT_TRUE(empty.zones.empty() && empty.unread.empty());
  EXPECT_EQ(empty.left_out.at(app::kEmptyArea), 1u);
}

TEST(ZoneFiles, RefusesBrokenKml) {
  refuse("<html></html>", kSyntax, "line 1");
  refuse("<!DOCTYPE kml [<!ENTITY a 'b'>]><kml/>", kSyntax, "line 1");
  refuse("<kml><Document>", kSyntax, "line 1");
  refuse(kml("<NetworkLink><Link><href>a.kml</href></Link></NetworkLink>"), ErrorCode::value_unsupported, "line 2");
  refuse(kml("<Polygon><outerBoundaryIs><LinearRing><coordinates>1,2 3, 4 5,6 1,2</coordinates></LinearRing>"
             "</outerBoundaryIs></Polygon>"),
         kSyntax, "line 2");
  refuse(kml("<Polygon><outerBoundaryIs><LinearRing><coordinates>1,2 3,4 5,6</coordinates></LinearRing>"
             "</outerBoundaryIs></Polygon>"),
         kSyntax, "line 2");
  const std::string corners = "1,2 3,4 5,6 1,2", inner = "1.1,2.1 1.2,2.1 1.2,2.2 1.1,2.1";
  refuse(kml("<Polygon><outerBoundaryIs><LinearRing><coordinates>9,9 <x/>" + corners +
             "</coordinates></LinearRing></outerBoundaryIs></Polygon>"),
         kSyntax, "line 2");
  refuse(kml("<Polygon><outerBoundaryIs><LinearRing><coordinates>" + corners +
             "</coordinates></LinearRing></outerBoundaryIs><LinearRing><coordinates>" + inner +
             "</coordinates></LinearRing></Polygon>"),
         kSyntax, "line 2");
  std::string deep;
  for (int i = 0; i < 200; ++i) deep += "<Folder>";
  refuse(kml(deep), kSyntax, "line 2");
}

TEST(ZoneFiles, ReadsAreasOfDocks) {
  const auto area = [](const std::string& type, const std::string& radius, const std::string& enable) {
    return "{\"type\": \"Feature\", \"id\": \"a\", \"geofence_type\": \"" + type +
           "\", \"geometry\": {\"type\": \"Point\", \"coordinates\": [11, 48]}, \"properties\": {\"subType\": "
           "\"Circle\", \"radius\": " +
           radius + ", \"enable\": " + enable + "}}";
  };
  const ZoneList list = parsed(collection(area("nfz", "60", "true") + ", " + area("dfence", "\"500\"", "true") + ", " +
                                          area("nfz", "70", "false")));
  ASSERT_EQ(list.zones.size(), 2u);
  EXPECT_EQ(list.zones[0].circle->radius_m, 60);
  EXPECT_EQ(list.zones[0].is_inclusion, std::optional(false));
  EXPECT_EQ(list.zones[1].circle->radius_m, 500);
  EXPECT_EQ(list.zones[1].is_inclusion, std::optional(true));
  EXPECT_EQ(list.left_out.at(app::kDisabledArea), 1u);
  refuse(collection(area("other", "60", "true")), ErrorCode::value_unsupported, "features[0]");
  refuse(collection(area("nfz", "60", "5")), kSyntax, "features[0]");
  refuse(collection(area("nfz", "0", "true")), ErrorCode::value_out_of_range, "features[0]");
  // A radius of what, and in which unit?
  refuse(collection(feature("{\"type\": \"Point\", \"coordinates\": [11, 48]}", "{\"radius\": 5}")), kSyntax,
         "features[0]");
}

TEST(ZoneFiles, AnAreaThatCannotBeReadIsNoFenceOfTheOneBefore) {
  const std::string fence =
      "{\"type\": \"Feature\", \"id\": \"a\", \"geofence_type\": \"dfence\", \"geometry\": " + polygon() +
      ", \"properties\": {}}";
  const ZoneList list = parsed(collection(fence + ", 5"));
  ASSERT_EQ(list.zones.size(), 1u);
  EXPECT_EQ(list.zones[0].is_inclusion, std::optional(true));
  ASSERT_EQ(list.unread.size(), 1u);
  EXPECT_FALSE(list.unread[0].zone.is_inclusion);
}

TEST(ZoneFiles, ReadsNumbersThatAreText) {
  const std::string circle =
      "{\"type\": \"Point\", \"coordinates\": [\"11\", \"48\"], \"extent\": {\"subType\": \"Circle\", \"radius\": "
      "\"30\"}, \"layer\": {\"upper\": \"120\", \"upperReference\": \"AGL\", \"uom\": \"m\"}}";
  const ZoneList list = parsed(collection(feature(circle)));
  ASSERT_EQ(list.zones.size(), 1u);
  EXPECT_EQ(list.zones[0].circle->centre, Eigen::Vector2d(11, 48));
  EXPECT_EQ(list.zones[0].circle->radius_m, 30);
  EXPECT_EQ(list.zones[0].upper->metres, 120);
}

TEST(ZoneFiles, ReadsListsOfZonesByOtherNames) {
  const std::string one = "{\"identifier\": \"Z1\", \"geometry\": {" + kMetres +
                          ", \"horizontalProjection\": " + polygon() + "}}";  // a volume, not a list of them
  for (const std::string& text :
       {"{\"UASZoneList\": [" + one + "]}", "{\"version\": [2], \"zones\": [" + one + "]}", "[" + one + "]"}) {
    const ZoneList list = parsed(text);
    ASSERT_EQ(list.zones.size(), 1u) << text;
    EXPECT_EQ(list.zones[0].name, "Z1");
    EXPECT_EQ(list.zones[0].lower->metres, 10);
  }
  refuse("{\"a\": [" + one + "], \"b\": [" + one + "]}", kSyntax, "/data/zones");
  const std::string features = "{\"type\": \"FeatureCollection\", \"features\": [" + feature(polygon()) + "]";
  refuse(features + ", \"UASZoneList\": [" + one + "]}", kSyntax, "/data/zones");
  refuse(features + ", \"geoFence\": {\"polygons\": []}}", kSyntax, "/data/zones");
}

TEST(ZoneFiles, AreasInMembersThatAreNotReadAreUnread) {
  const std::string one = feature(polygon());
  const auto beside = [](const std::string& object, const std::string& member) {
    return object.substr(0, object.size() - 1) + ", " + member + "}";
  };
  const auto unread = [&](const std::string& text) {
    const ZoneList list = parsed(text);
    EXPECT_EQ(list.zones.size(), 1u) << text;
    EXPECT_LE(list.unread.size(), 1u) << text;
    return list.unread.empty() ? "" : list.unread[0].zone.place;
  };
  const std::string circle = "\"coordinates\": [11, 48]}, \"properties\": {\"radius\": 50}}";
  EXPECT_EQ(unread(beside(collection(one), "\"more\": " + collection(one))), "more");
  EXPECT_EQ(unread(beside(collection(one), "\"zones\": [" + polygon() + "]")), "zones");
  EXPECT_EQ(unread(beside(collection(one), "\"geometry\": " + polygon())), "geometry");
  EXPECT_EQ(unread(beside(collection(one), "\"ring\": " + kSquare)), "ring");
  EXPECT_EQ(unread(beside(collection(one), "\"a\": {\"b\": {\"geometry\": {" + circle + "}")), "a");
  EXPECT_EQ(unread(collection(beside(one, "\"geometries\": [" + polygon() + "]"))), "features[0].geometries");
  EXPECT_EQ(unread(collection(feature(polygon(), "{\"old\": " + polygon() + "}"))), "features[0].properties.old");
  EXPECT_EQ(unread(collection(feature(polygon(", \"geometries\": [" + polygon() + "]")))), "features[0].geometries");
  EXPECT_EQ(unread(volume(polygon(", \"more\": " + polygon()), kMetres)), "features[0].geometry[0].more");
  EXPECT_EQ(unread(volume(polygon(), kMetres + ", \"more\": " + polygon())), "features[0].geometry[0].more");
  // What bounds nothing.
  const std::string place = "{\"type\": \"Point\", \"coordinates\": [11, 48]}";
  const std::string properties = "{\"radius\": 5, \"center\": [11, 48], \"centroid\": " + place + "}";
  const std::string line = "\"bbox\": [1, 2, 3, 4], \"line\": [[1, 2], [3, 4], [5, 6], [7, 8]], \"query\": ";
  EXPECT_EQ(unread(beside(collection(feature(polygon(), properties)), line + place)), "");
}

TEST(ZoneFiles, MisspeltMembersOfHeightsAndCirclesAreUnread) {
  for (const std::string extent : {"\"Extent\": {\"subType\": \"Circle\", \"radius\": 50}", "\"radius\": 50"}) {
    const std::string point = "{\"type\": \"Point\", \"coordinates\": [11, 48], " + extent + "}";
    EXPECT_EQ(parsed(collection(feature(point) + ", " + feature(polygon()))).unread.size(), 1u) << extent;
  }
  const ZoneList list = parsed(volume(polygon(), kMetres + ", \"UpperLimit\": 50"));
  ASSERT_EQ(list.zones.size(), 1u);
  EXPECT_TRUE(list.zones[0].heights_fault) << "they must be given, or be any";
}

TEST(ZoneFiles, RefusesPositionsOfAnotherSystem) {
  const auto crs = [](const std::string& name) {
    return ", \"crs\": {\"type\": \"name\", \"properties\": {\"name\": \"" + name + "\", \"was\": \"EPSG:4326\"}}";
  };
  for (const char* const name : {"urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:EPSG::4326", "EPSG:4326"}) {
    EXPECT_EQ(parsed(polygon(crs(name))).zones.size(), 1u) << name;
  }
  refuse(polygon(crs("EPSG:3857")), ErrorCode::value_unsupported, "crs");
  refuse(collection(feature(polygon(crs("EPSG:3857")))), ErrorCode::value_unsupported, "features[0].crs");
  refuse(collection(feature(polygon()).substr(0, feature(polygon()).size() - 1) + crs("EPSG:3857") + "}"),
         ErrorCode::value_unsupported, "features[0].crs");
}

TEST(ZoneFiles, APolygonWithoutItsOutlineIsNotEmpty) {
  refuse("{\"type\": \"Polygon\", \"coordinates\": [[], " + kSquare.substr(1) + "}", kSyntax, "/data/zones");
  const std::string corners = "<coordinates>11,48 11.001,48 11.001,48.001 11,48</coordinates>";
  const auto drawn = [](const std::string& inside) {
    return kml("<Placemark><name>Z</name><Polygon>" + inside + "</Polygon></Placemark>");
  };
  const std::vector<std::string> unread = {
      "<outerBoundaryIs><linearring>" + corners + "</linearring></outerBoundaryIs>",
      "<outerBoundaryIs><LinearRing><Coordinates>11,48 11.001,48</Coordinates></LinearRing></outerBoundaryIs>",
      "<innerBoundaryIs><LinearRing>" + corners + "</LinearRing></innerBoundaryIs>", "<outer>9</outer>",
      "<outerBoundaryIs/>"};
  for (const std::string& inside : unread) {
    const ZoneList list = parsed(drawn(inside));
    ASSERT_EQ(list.unread.size(), 1u) << inside;
    EXPECT_EQ(list.unread[0].zone.names, std::vector<std::string>{"Z"});
    EXPECT_TRUE(list.left_out.empty());
  }
  const ZoneList blank =
      parsed(drawn("<outerBoundaryIs><LinearRing><coordinates> </coordinates></LinearRing></outerBoundaryIs>"));
  EXPECT_TRUE(blank.unread.empty());
  EXPECT_EQ(blank.left_out.at(app::kEmptyArea), 1u);
}

TEST(ZoneFiles, AnUnknownGeometryOfAPlacemarkIsUnread) {
  const auto with = [](const std::string& part) {
    return parsed(kml("<Placemark><name>C</name>" + part +
                      "<Style><LineStyle><width>2</width></LineStyle></Style>"
                      "<Point><coordinates>11,48</coordinates></Point></Placemark>"));
  };
  const ZoneList list = with("<Circle><center>11,48</center><radius>50</radius></Circle>");
  ASSERT_EQ(list.unread.size(), 1u);
  EXPECT_EQ(list.unread[0].zone.name, "C");
  EXPECT_EQ(with("<MultiGeometry><Arc><a/></Arc></MultiGeometry>").unread.size(), 1u);
  EXPECT_TRUE(with("<number>5</number><wpml:action><wpml:x/></wpml:action>").unread.empty());
}

TEST(ZoneFiles, PositionsInNoGeometryOfKmlAreUnread) {
  const std::string list = "11,48 11.001,48 11.001,48.001 11,48",
                    ring = "<LinearRing><coordinates>" + list + "</coordinates>";
  const auto unread = [&](const std::string& more, const std::string& beside = "", const std::string& before = "") {
    return parsed(kml("<Placemark><Polygon>" + before + "<outerBoundaryIs>" + ring + more +
                      "</LinearRing></outerBoundaryIs>" + beside +
                      "</Polygon></Placemark><Placemark><Polygon><outerBoundaryIs>" + ring +
                      "</LinearRing></outerBoundaryIs></Polygon></Placemark>"))
        .unread.size();
  };
  EXPECT_EQ(unread(""), 0u);
  EXPECT_EQ(unread("<Coordinates>" + list + "</Coordinates>"), 1u);
  EXPECT_EQ(unread("", "<outerBoundary/>"), 1u);
  EXPECT_EQ(unread("", "<wpml:elevation>5</wpml:elevation>"), 0u);
  EXPECT_EQ(unread("", "<altitudeMode>absolute</altitudeMode>", "<gx:altitudeMode>absolute</gx:altitudeMode>"), 0u);
  EXPECT_EQ(unread("", "<altitudeMode>absolute</altitudeMode>", "<altitudeMode>clampToGround</altitudeMode>"), 1u);
  EXPECT_EQ(unread("", "<extrude>0</extrude>", "<extrude>1</extrude>"), 1u);
  EXPECT_EQ(unread("", "<altitudeOffset>2</altitudeOffset>", "<altitudeOffset>1</altitudeOffset>"), 1u);
  const std::string outside = "<Area><Ring><coordinates>" + list + "</coordinates></Ring></Area>";
  EXPECT_EQ(parsed(kml(placemark("") + outside)).unread.size(), 1u);
  EXPECT_EQ(
      parsed(kml(placemark("") + "<LineString><Coordinates>" + list + "</Coordinates></LineString>")).unread.size(),
      1u);
  EXPECT_TRUE(parsed(kml(placemark("") + "<GroundOverlay><gx:LatLonQuad><coordinates>" + list +
                         "</coordinates></gx:LatLonQuad></GroundOverlay>"))
                  .unread.empty());
}

TEST(ZoneFiles, AltitudeOffsetsCount) {
  const std::string before = "<extrude>1</extrude><altitudeMode>absolute</altitudeMode>";
  const std::string offset = "<gx:altitudeOffset>100</gx:altitudeOffset>", at = "<LinearRing>";
  const auto top = [](const std::string& text) { return parsed(kml(text)).zones.at(0).upper->metres; };
  EXPECT_EQ(top(placemark(before + offset, ",520")), 620);
  std::string of_ring = placemark(before, ",520");
  of_ring.insert(of_ring.find(at) + at.size(), offset);
  EXPECT_EQ(top(of_ring), 620);
  EXPECT_EQ(parsed(kml(of_ring)).zones[0].corner_z_m, std::vector<double>(3, 620.0));
  refuse(kml(placemark(before + "<altitudeOffset>a</altitudeOffset>", ",520")), kSyntax, "line 2");
}

TEST(ZoneFiles, OneAreaThatCannotBeReadLeavesTheOthers) {
  const std::string open = "{\"type\": \"Polygon\", \"coordinates\": [[[1, 2], [3, 2], [3, 4], [2, 4]]]}";
  const ZoneList list = parsed(collection(feature(open, "{\"name\": \"open\"}") + ", 5, " + feature(polygon()) + ", " +
                                          feature("{\"type\": \"Polygon\", \"coordinates\": []}") + ", " +
                                          feature("{\"type\": \"MultiPolygon\", \"coordinates\": [[]]}")));
  EXPECT_EQ(list.zones.size(), 1u);
  ASSERT_EQ(list.unread.size(), 2u);
  EXPECT_EQ(list.unread[0].zone.names, std::vector<std::string>{"open"});
  EXPECT_EQ(list.unread[1].zone.place, "features[1]");
  EXPECT_EQ(list.left_out.at(app::kEmptyArea), 2u);
  const ZoneList drawn =
      parsed(kml("<Placemark><name>open</name><Polygon><outerBoundaryIs><LinearRing><coordinates>1,2 "
                 "3,4 5,6</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>"
                 "<Placemark><Polygon></Polygon></Placemark>" +
                 placemark("")));
  EXPECT_EQ(drawn.zones.size(), 1u);
  ASSERT_EQ(drawn.unread.size(), 1u);
  EXPECT_EQ(drawn.unread[0].zone.name, "open");
  EXPECT_EQ(drawn.left_out.at(app::kEmptyArea), 1u);
}

TEST(ZoneFiles, ReadsFencesOfWaypoints) {
  const auto row = [](int command, const std::string& parameter, const std::string& place) {
    return "1\t0\t0\t" + std::to_string(command) + "\t" + parameter + "\t0\t0\t0\t" + place + "\t100\t1\n";
  };
  const std::string start = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t48\t11\t500\t1\n";
  const ZoneList list = parsed(
      start + row(5001, "3", "48\t11") + row(5001, "3", "48\t11.001") + row(5001, "3", "48.001\t11.001") +
      row(5002, "3", "48\t11") + row(5002, "3", "48\t11.001") + row(5002, "3", "48.001\t11.001") +
      row(5003, "400", "48\t11") + row(5004, "20.5", "48\t11.001") + row(5000, "0", "48\t11") + row(16, "0", "48\t11"));
  ASSERT_EQ(list.zones.size(), 4u);
  EXPECT_EQ(list.zones[0].outer, (Zone::Ring{{11, 48}, {11.001, 48}, {11.001, 48.001}}));
  EXPECT_EQ(list.zones[0].is_inclusion, std::optional(true));
  EXPECT_EQ(list.zones[1].name, "polygon 1");
  EXPECT_EQ(list.zones[1].is_inclusion, std::optional(false));
  EXPECT_EQ(list.zones[2].circle->radius_m, 400);
  EXPECT_EQ(list.zones[2].is_inclusion, std::optional(true));
  EXPECT_EQ(list.zones[3].circle->centre, Eigen::Vector2d(11.001, 48));
  EXPECT_EQ(list.zones[3].is_inclusion, std::optional(false));
  EXPECT_EQ(list.left_out, (std::map<std::string, std::size_t>{{"return point", 1}, {"waypoint", 1}}));
  EXPECT_TRUE(list.has_no_heights);
  refuse(start + row(5002, "3", "48\t11") + row(5002, "3", "48\t11.001"), kSyntax, "line 3");
  refuse(start + row(5002, "3", "48\t11") + row(5001, "1", "48\t11"), kSyntax, "line 3");
  refuse(start + row(5005, "3", "48\t11"), kSyntax, "line 3");
  refuse(start + row(5004, "-3", "48\t11"), kSyntax, "line 3");
  refuse(start + row(5004, "3", "98\t11"), ErrorCode::not_on_earth, "line 3");
  refuse(start + row(5004, "x", "48\t11"), kSyntax, "line 3");
  refuse(start + "1\t0\t0\t5004\n", kSyntax, "line 3");
}

/// A face of a solid over the triangle of placemark().
std::string face(const std::string& corners) {
  return "<Polygon><altitudeMode>absolute</altitudeMode><outerBoundaryIs><LinearRing><coordinates>" + corners +
         "</coordinates></LinearRing></outerBoundaryIs></Polygon>";
}
std::string level_face(const std::string& z) {
  return face("11,48," + z + " 11.001,48," + z + " 11.001,48.001," + z + " 11,48," + z);
}
std::string wall(const std::string& a, const std::string& b) {
  return face(a + ",520 " + b + ",520 " + b + ",560 " + a + ",560 " + a + ",520");
}

TEST(ZoneFiles, AFloorACeilingAndWallsAreOneZone) {
  const std::string walls =
      wall("11,48", "11.001,48") + wall("11.001,48", "11.001,48.001") + wall("11.001,48.001", "11,48");
  const auto solid = [](const std::string& faces) {
    return parsed(kml("<Placemark><name>CTR</name><MultiGeometry>" + faces + "</MultiGeometry></Placemark>"));
  };
  const ZoneList list = solid(level_face("520") + level_face("560") + walls);
  ASSERT_EQ(list.zones.size(), 1u);
  EXPECT_EQ(list.zones[0].name, "CTR");
  EXPECT_TRUE(list.zones[0].has_heights);
  EXPECT_EQ(list.zones[0].lower->metres, 520);
  EXPECT_EQ(list.zones[0].upper->metres, 560);
  EXPECT_EQ(list.zones[0].upper->from, HeightReference::sea_level);
  // A floor in between is not all of the solid's, and one of another shape not the same one.
  const ZoneList between = solid(level_face("520") + level_face("540") + walls);
  ASSERT_EQ(between.zones.size(), 1u);
  EXPECT_FALSE(between.zones[0].has_heights);
  const ZoneList alone = solid(walls);
  EXPECT_EQ(alone.zones.size(), 3u);
  EXPECT_FALSE(alone.zones[0].has_heights);
  const ZoneList elsewhere = solid(level_face("520") + level_face("560") + wall("11,48", "11.002,48"));
  EXPECT_EQ(elsewhere.zones.size(), 3u);
}

// Many may meet at one corner: neither is each wall held against all of them, nor is nobody asked meanwhile.
TEST(ZoneFiles, SolidsAtOneCornerAreFoundInTheirOrder) {
  constexpr std::size_t kCount = 300;
  std::string faces;
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::string x = shortest(11.001 + 1e-6 * static_cast<double>(i));
    faces += face("11,48,520 " + x + ",48,520 " + x + ",48.001,520 11,48,520") + wall("11,48", "12," + x);
  }
  const std::string begin = "<kml><Placemark><MultiGeometry>" + faces;
  const core::ProgressReporter::AskAlways always;
  std::size_t asked = 0;
  const Progress count = [&](std::string_view, double) { return ++asked > 0; };
  const auto parse = [&](const std::string& text) {
    asked = 0;
    return app::parse_zones(text, "/data/zones", core::ProgressReporter(count));
  };
  expect_code([&] { parse(begin); }, kSyntax);  // it ends too early
  const std::size_t before = asked;
  EXPECT_EQ(parse(begin + "</MultiGeometry></Placemark></kml>").zones.size(), 2 * kCount);
  EXPECT_GE(asked, before + 2 * kCount);
  EXPECT_LE(asked, before + 10 * kCount);
}

/// A mission in a map about 48 N, 11 E, with these files beside it.
class ZoneMission {
 public:
  ZoneMission() {
    MapText map({11, 48});
    map.box(30, 0, 40, 10, {{"building", "yes"}});
    write("city.osm", map.text());
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_.path() / name) << text; }
  MissionFile read(const std::string& limits, const std::string& scene = "") const {
    write("mission.yaml", "scene: {osm: city.osm, center: [48, 11], radius: 500" + scene +
                              "}\nsensor: {max_range: 80}\ntarget: {center: [48, 11], width: 5, length: 5}\n"
                              "navigation:\n  " +
                              limits + "\n");
    return read_mission(folder_.path() / "mission.yaml");
  }
  Mission resolve(const std::string& limits, const std::string& scene = "") const {
    return resolve_mission(read(limits, scene));
  }
  std::filesystem::path folder() const { return folder_.path(); }

 private:
  TemporaryDirectory folder_;
};

TEST(ZoneFiles, BecomeZonesOfTheMission) {
  const ZoneMission mission;
  const std::string layer =
      ", \"layer\": {\"upper\": 640, \"upperReference\": \"AMSL\", \"lower\": 500, "
      "\"lowerReference\": \"AMSL\", \"uom\": \"m\"}";
  mission.write("zones.json", collection(feature(polygon(layer), "{\"identifier\": \"A\"}") + ", " +
                                         feature(polygon(layer), "{\"identifier\": \"A\"}") + ", " +
                                         feature("{\"type\": \"Point\", \"coordinates\": [11, 48]}")));
  const Mission resolved =
      mission.resolve("keep_in: [{file: zones.json}]\n  keep_out: [{file: zones.json}]", ", sea_level: -520");
  ASSERT_EQ(resolved.navigation.keep_in.size(), 2u);
  const Zone& kept = resolved.navigation.keep_in[0];
  EXPECT_EQ(kept.name, "zones.json A");
  EXPECT_EQ(resolved.navigation.keep_in[1].name, "zones.json A (2)");
  EXPECT_EQ(kept.min_z_m, -20);
  EXPECT_EQ(kept.max_z_m, 120);
  const geo::LocalFrame frame({11, 48});
  const Eigen::Vector2d far = frame.to_local({11.001, 48.001});
  double nearest = 1e9;
  for (const Eigen::Vector2d& p : kept.outer) nearest = std::min(nearest, (p - far).norm());
  EXPECT_LT(nearest, 0.01);
  EXPECT_EQ(resolved.navigation.keep_out.size(), 2u);
  ASSERT_EQ(resolved.notes.size(), 2u);
  EXPECT_EQ(resolved.notes[0].code, WarningCode::zones_left_out);
  expect_wording({resolved.notes[0].text, resolved.notes[1].text});
  EXPECT_EQ(resolved.as_written.navigation.keep_in.size(), 0u);
}

// Between corners that are lifted from the ground, KML does not say how high a zone is.
TEST(ZoneFiles, HeightsRelativeToTheGroundMustBeGiven) {
  const ZoneMission mission;
  mission.write("park.kml", kml(placemark("<extrude>1</extrude><altitudeMode>relativeToGround</altitudeMode>", ",50")));
  expect_error([&] { mission.resolve("keep_out: [{file: park.kml}]"); }, ErrorCode::missing_key, "park.kml");
  const Mission resolved = mission.resolve("keep_out: [{file: park.kml, agl: [0, 50]}]");
  ASSERT_EQ(resolved.navigation.keep_out.size(), 1u);
  EXPECT_EQ(resolved.navigation.keep_out[0].above_ground->max_m, 50);
}

TEST(ZoneFiles, WhatCannotBeReadStopsTheMissionByName) {
  const ZoneMission mission;
  const std::string open = "{\"type\": \"Polygon\", \"coordinates\": [[[11, 48], [11.1, 48], [11.1, 48.1]]]}";
  const std::string crossing =
      "{\"type\": \"Polygon\", \"coordinates\": [[[11, 48], [11.1, 48.1], [11.1, 48], [11, 48.1], [11, 48]]]}";
  const std::string levels = polygon(", \"layer\": {\"upper\": 65, \"upperReference\": \"FL\", \"uom\": \"m\"}");
  const std::string layer = ", \"layer\": {\"upper\": 64, \"upperReference\": \"AGL\", \"uom\": \"m\"}";
  for (const std::string& bad : {open, crossing, levels}) {
    SCOPED_TRACE(bad);
    mission.write("zones.json", collection(feature(bad, "{\"name\": \"BAD7\"}") + ", " + feature(polygon(layer))));
    const bool is_level = bad == levels;
    const std::string any = is_level ? "" : ", heights: any";
    {
      const std::string limits = "keep_out: [{file: zones.json" + any;
      const Error error = expect_error([&] { mission.resolve(limits + "}]"); },
                                       bad == open ? kSyntax
                                       : is_level  ? ErrorCode::value_unsupported
                                                   : ErrorCode::zone_not_simple,
                                       "features[0]");
      EXPECT_NE(error.problem().find("'BAD7'"), std::string::npos);
      EXPECT_NE(error.fix().find("skip: true"), std::string::npos);
      const Mission skipped = mission.resolve(limits + ", skip: true}]");
      EXPECT_EQ(skipped.navigation.keep_out.size(), 1u);
      ASSERT_EQ(skipped.notes.size(), 1u);
      EXPECT_EQ(skipped.notes[0].code, WarningCode::zones_left_out);
      expect_wording(skipped.notes[0].text);
    }
    // Without a zone to stay in nothing more is claimed.
    const Mission kept = mission.resolve("keep_in: [{file: zones.json" + any + "}]");
    EXPECT_EQ(kept.navigation.keep_in.size(), 1u);
    ASSERT_EQ(kept.notes.size(), 1u);
    EXPECT_EQ(kept.notes[0].code, WarningCode::zones_left_out);
  }
  mission.write(
      "zones.json",
      collection(feature("{\"type\": \"LineString\", \"coordinates\": " + kSquare.substr(1, kSquare.size() - 2) + "}") +
                 ", " + feature(polygon())));
  expect_error([&] { mission.resolve("keep_out: [{file: zones.json, heights: any}]"); }, ErrorCode::value_unsupported,
               "features[0]");
  EXPECT_EQ(mission.resolve("keep_in: [{file: zones.json, heights: any}]").navigation.keep_in.size(), 1u);
  mission.write("zones.json", collection(feature(levels)));
  EXPECT_EQ(mission.resolve("keep_out: [{file: zones.json, heights: any}]").navigation.keep_out.size(), 1u);
  expect_error([&] { mission.read("keep_out: [{file: zones.json, skip: 5}]"); }, ErrorCode::unknown_choice);
}

TEST(ZoneFiles, FlightLevelsOutOfReachAreLeftOut) {
  const ZoneMission mission;
  const std::string far =
      "{\"type\": \"Polygon\", \"coordinates\": [[[2.3, 48.8], [2.4, 48.8], [2.4, 48.9], [2.3, 48.8]]], \"layer\": "
      "{\"upper\": 95, \"upperReference\": \"FL\", \"uom\": \"m\"}}";
  const std::string layer = ", \"layer\": {\"upper\": 64, \"upperReference\": \"AGL\", \"uom\": \"m\"}";
  mission.write("zones.json", collection(feature(far) + ", " + feature(polygon(layer))));
  const Mission resolved = mission.resolve("keep_out: [{file: zones.json}]");
  EXPECT_EQ(resolved.navigation.keep_out.size(), 1u);
  EXPECT_EQ(resolved.notes.size(), 1u);
}

TEST(ZoneFiles, AFileOfEmptyAreasKeepsOutOfNothing) {
  const ZoneMission mission;
  mission.write("zones.json", collection(feature("{\"type\": \"Polygon\", \"coordinates\": []}")));
  const Mission resolved = mission.resolve("keep_out: [{file: zones.json}]");
  EXPECT_TRUE(resolved.navigation.keep_out.empty());
  ASSERT_EQ(resolved.notes.size(), 1u);
  expect_wording(resolved.notes[0].text);
  expect_error([&] { mission.resolve("keep_in: [{file: zones.json}]"); }, ErrorCode::nothing_given, "zones.json");
}

TEST(ZoneFiles, MasksOfTheWorldAreCutToWhatIsNear) {
  const ZoneMission mission;
  const std::string world = "[[-180, -90], [0, -90], [180, -90], [180, 90], [-180, 90], [-180, -90]]";
  const auto resolve = [&](const std::string& rings) {
    mission.write("zones.json", "{\"type\": \"Polygon\", \"coordinates\": [" + rings + "]}");
    return mission.resolve("keep_out: [{file: zones.json, heights: any}]").navigation.keep_out;
  };
  const geo::LocalFrame frame({11, 48});
  for (const double half : {0.12, 2.5, 6.0}) {
    const auto at = [&](double x, double y) {
      return "[" + shortest(11 + half * x) + ", " + shortest(48 + half * y) + "]";
    };
    const std::string country =
        "[" + at(-1, -1) + ", " + at(-1, 1) + ", " + at(1, 1) + ", " + at(1, -1) + ", " + at(-1, -1) + "]";
    const std::string elsewhere = "[[100, 10], [101, 10], [101, 11], [100, 10]]";
    const std::vector<Zone> zones = resolve(world + ", " + country + ", " + elsewhere);
    ASSERT_EQ(zones.size(), 1u);
    ASSERT_EQ(zones[0].holes.size(), 1u);
    double nearest = INFINITY, farthest = 0;
    for (const Eigen::Vector2d& p : zones[0].outer) nearest = std::min(nearest, p.norm());
    for (const Eigen::Vector2d& p : zones[0].holes[0]) farthest = std::max(farthest, p.norm());
    EXPECT_GT(nearest, geo::kFarthestM);  // no viewpoint is farther
    const double corner = frame.to_local({11 - half, 48 - half}).norm();
    EXPECT_LT(farthest, corner);
    EXPECT_GT(farthest, 0.999 * corner);
  }
  EXPECT_EQ(resolve(world).size(), 1u);
}

TEST(ZoneFiles, HolesMayTouchTheOutlineAndEachOther) {
  const ZoneMission mission;
  const auto at = [](double x, double y) {
    return "[" + shortest(11 + 0.001 * x) + ", " + shortest(48 + 0.001 * y) + "]";
  };
  const std::string square =
      "[" + at(-1, -1) + ", " + at(1, -1) + ", " + at(1, 1) + ", " + at(-1, 1) + ", " + at(-1, -1) + "]";
  const auto triangle = [&](double x, double tip) {  // its tip points west
    return "[" + at(tip, 0) + ", " + at(x, 0.3) + ", " + at(x, -0.3) + ", " + at(tip, 0) + "]";
  };
  const geo::LocalFrame frame({11, 48});
  for (const std::string& holes : {triangle(-0.5, -1), triangle(-0.5, -1) + ", " + triangle(0.5, -0.5)}) {
    mission.write("zones.json", "{\"type\": \"Polygon\", \"coordinates\": [" + square + ", " + holes + "]}");
    const std::size_t count = holes.size() > triangle(-0.5, -1).size() ? 2 : 1;
    const Mission out = mission.resolve("keep_out: [{file: zones.json, heights: any}]");
    ASSERT_EQ(out.navigation.keep_out.size(), 1u);
    ASSERT_EQ(out.navigation.keep_out[0].holes.size(), count);
    double nearest = INFINITY;  // of the hole's tip: it has come apart by centimetres, inward
    const Eigen::Vector2d tip = frame.to_local({10.999, 48});
    for (const Eigen::Vector2d& p : out.navigation.keep_out[0].holes[0]) nearest = std::min(nearest, (p - tip).norm());
    EXPECT_GT(nearest, 0.04);
    EXPECT_LT(nearest, 0.3);
    const Mission kept = mission.resolve("keep_in: [{file: zones.json, heights: any}]");
    ASSERT_EQ(kept.navigation.keep_in.size(), 1u);
    EXPECT_TRUE(kept.navigation.keep_in[0].holes.empty());
    EXPECT_EQ(kept.navigation.keep_out.size(), count);
    EXPECT_EQ(kept.navigation.keep_out[0].name, "zones.json 0 hole");
  }
  // One that crosses by more is none.
  mission.write("zones.json",
                "{\"type\": \"Polygon\", \"coordinates\": [" + square + ", " + triangle(-0.5, -1.1) + "]}");
  expect_error([&] { mission.resolve("keep_out: [{file: zones.json, heights: any}]"); }, ErrorCode::zone_not_simple);
}

TEST(ZoneFiles, FencesGoWhereTheyBelong) {
  const ZoneMission mission;
  mission.write("fence.plan",
                plan("{\"inclusion\": true, \"polygon\": [[47.999, 10.999], [47.999, 11.001], [48.001, 11.001]]}, "
                     "{\"inclusion\": false, \"polygon\": [[48, 11], [48, 11.001], [48.001, 11.001]]}",
                     "{\"inclusion\": false, \"circle\": {\"center\": [48, 11], \"radius\": 20}}"));
  const Mission kept = mission.resolve("keep_in: [{file: fence.plan}]"),
                out = mission.resolve("keep_out: [{file: fence.plan}]");
  ASSERT_EQ(kept.navigation.keep_in.size(), 1u);
  EXPECT_EQ(kept.navigation.keep_in[0].max_z_m, INFINITY);
  const std::string name = "fence.plan polygon 0", narrowed = "keep_in: [{file: fence.plan, z: [5, 50]}]";
  EXPECT_EQ(kept.navigation.keep_in[0].name, name);
  EXPECT_EQ(out.navigation.keep_out.size(), 2u);
  expect_wording({kept.notes.at(0).text, out.notes.at(0).text});
  const std::string both = "keep_in: [{file: fence.plan}]\n  keep_out: [{file: fence.plan}]";
  EXPECT_TRUE(mission.resolve(both).notes.empty());  // all of it is taken
  EXPECT_EQ(mission.resolve(narrowed).navigation.keep_in[0].min_z_m, 5);
}

TEST(ZoneFiles, FencesOfTheOtherUseThatCannotBeReadAreCounted) {
  const ZoneMission mission;
  const auto fence = [](const std::string& type, const std::string& geometry) {
    return "{\"type\": \"Feature\", \"geofence_type\": \"" + type + "\", \"geometry\": " + geometry +
           ", \"properties\": {}}";
  };
  const std::string open = "{\"type\": \"Polygon\", \"coordinates\": [[[11, 48], [11.1, 48], [11.1, 48.1]]]}";
  mission.write("fences.json", collection(fence("dfence", polygon()) + ", " + fence("nfz", open)));
  const Mission kept = mission.resolve("keep_in: [{file: fences.json, heights: any}]");
  EXPECT_EQ(kept.navigation.keep_in.size(), 1u);
  ASSERT_EQ(kept.notes.size(), 1u);
  EXPECT_EQ(kept.notes[0].code, WarningCode::zones_left_out);
  expect_wording(kept.notes[0].text);
}

TEST(ZoneFiles, CirclesAreInscribedToStayInAndCircumscribedToStayOutOf) {
  const ZoneMission mission;
  const geo::LocalFrame frame({11, 48});
  for (const Vec3& drawn :
       {Vec3(11, 48, 1), Vec3(11.001, 48.002, 463.7), Vec3(11.2, 48.1, 25000), Vec3(10.5, 48.3, 90000)}) {
    const double longitude = drawn.x(), latitude = drawn.y(), radius = drawn.z();
    const std::string circle = "{\"type\": \"Point\", \"coordinates\": [" + shortest(longitude) + ", " +
                               shortest(latitude) +
                               "], \"extent\": {\"subType\": \"Circle\", \"radius\": " + shortest(radius) + "}}";
    mission.write("circle.json", circle);
    const Mission resolved = mission.resolve(
        "keep_in: [{file: circle.json, heights: any}]\n  keep_out: [{file: circle.json, heights: any}]");
    const geo::LocalFrame about({longitude, latitude});
    const auto distance = [&](const Eigen::Vector2d& p) { return about.to_local(frame.to_lonlat(p)).norm(); };
    const auto for_each_point = [&](const Zone& zone, const auto& visit) {
      for (std::size_t i = 0; i < zone.outer.size(); ++i) {
        const Eigen::Vector2d a = zone.outer[i], b = zone.outer[(i + 1) % zone.outer.size()];
        for (const double share : {0.0, 0.25, 0.5, 0.75}) visit(distance(a + share * (b - a)));
      }
    };
    const double off = std::max(0.06, 1.1e-5 * radius);
    for_each_point(resolved.navigation.keep_in.at(0), [&](double d) {
      EXPECT_LE(d, radius);
      EXPECT_GE(d, radius - off);
    });
    for_each_point(resolved.navigation.keep_out.at(0), [&](double d) {
      EXPECT_GE(d, radius);
      EXPECT_LE(d, radius + off);
    });
  }
}

TEST(ZoneFiles, HeightsAboveTheGroundAreMeasuredFromTheScenes) {
  const ZoneMission mission;
  mission.write("zones.json", polygon(", \"layer\": {\"upper\": 640, \"upperReference\": \"AGL\", \"uom\": \"m\"}"));
  const Mission resolved = mission.resolve("keep_in: [{file: zones.json}]");
  const Zone& zone = resolved.navigation.keep_in.at(0);
  ASSERT_TRUE(zone.above_ground);
  EXPECT_EQ(zone.above_ground->max_m, 640);
  EXPECT_TRUE(std::isinf(zone.above_ground->min_m));
  EXPECT_TRUE(std::isinf(zone.max_z_m));
  const auto ground = ground_of(resolved.scene());
  ASSERT_TRUE(ground);
  EXPECT_EQ(zone.above_ground->ground.plane_z_m, ground->plane_z_m);
}

TEST(ZoneFiles, RefusesZonesThatCannotBePlaced) {
  const ZoneMission mission;
  const auto refuse = [&](const std::string& text, const std::string& more, ErrorCode code, const std::string& where) {
    SCOPED_TRACE(text);
    mission.write("zones.json", text);
    expect_error([&] { mission.resolve("keep_in: [{file: zones.json" + more + "}]"); }, code, where);
  };
  const auto layer = [](const std::string& reference) {
    return polygon(", \"layer\": {\"upper\": 640, \"upperReference\": \"" + reference + "\", \"uom\": \"m\"}");
  };
  refuse(polygon(), "", ErrorCode::missing_key, "mission.yaml:5:20");
  refuse(layer("AMSL"), "", ErrorCode::heights_differ, "zones.json");
  refuse(layer("WGS84"), "", ErrorCode::heights_differ, "zones.json");
  refuse(layer("AGL"), ", z: [0, 5]", ErrorCode::conflicting_keys, "zones.json");
  refuse("{\"type\": \"Point\", \"coordinates\": [11, 48]}", ", heights: any", ErrorCode::nothing_given, "zones.json");
  refuse(plan("{\"inclusion\": false, \"polygon\": [[48, 11], [48, 11.001], [48.001, 11.001]]}"), "",
         ErrorCode::nothing_given, "zones.json");
  refuse(plan(""), "", ErrorCode::nothing_given, "zones.json");
  // Paris; and longitude and latitude swapped.
  refuse("{\"type\": \"Polygon\", \"coordinates\": [[[2.3, 48.8], [2.4, 48.8], [2.4, 48.9], [2.3, 48.8]]]}",
         ", heights: any", ErrorCode::too_far_away, "zones.json");
  refuse("{\"type\": \"Polygon\", \"coordinates\": [[[48, 11], [48.1, 11], [48.1, 11.1], [48, 11]]]}", ", heights: any",
         ErrorCode::too_far_away, "zones.json");
  refuse("{\"type\": \"Polygon\", \"coordinates\": [[[11, 48], [11.1, 48.1], [11.1, 48], [11, 48.1], [11, 48]]]}",
         ", heights: any", ErrorCode::zone_not_simple, "zones.json");
  refuse("{\"type\": \"Polygon\", \"coordinates\": [[[11, 48], [11, 48], [11.1, 48.1], [11, 48]]]}", ", heights: any",
         ErrorCode::zone_not_simple, "zones.json");
  refuse("{\"type\": \"Point\", \"coordinates\": [11, 48], \"extent\": {\"subType\": \"Circle\", \"radius\": 200000}}",
         ", heights: any", ErrorCode::value_out_of_range, "zones.json");
  refuse("{\"type\": \"Point\", \"coordinates\": [11, 48], \"extent\": {\"subType\": \"Circle\", \"radius\": 0.001}}",
         ", heights: any", ErrorCode::limits_empty, "zones.json");
}

TEST(ZoneFiles, ZonesOutOfReachAreLeftOut) {
  const ZoneMission mission;
  const std::string paris =
      "{\"type\": \"Polygon\", \"coordinates\": [[[2.3, 48.8], [2.4, 48.8], [2.4, 48.9], [2.3, 48.8]]]}";
  mission.write("zones.json", collection(feature(paris) + ", " + feature(polygon())));
  const Mission resolved = mission.resolve("keep_out: [{file: zones.json, heights: any}]");
  EXPECT_EQ(resolved.navigation.keep_out.size(), 1u);
  EXPECT_EQ(resolved.navigation.keep_out[0].name, "zones.json 1");
  ASSERT_EQ(resolved.notes.size(), 1u);
  expect_wording(resolved.notes[0].text);
}

TEST(ZoneFiles, SayWhenLongitudeAndLatitudeSeemSwapped) {
  const ZoneMission mission;
  const std::string swapped =
      "{\"type\": \"Polygon\", \"coordinates\": [[[48, 11], [48.1, 11], [48.1, 11.1], [48, 11]]]}";
  const std::string paris =
      "{\"type\": \"Polygon\", \"coordinates\": [[[2.3, 48.8], [2.4, 48.8], [2.4, 48.9], [2.3, 48.8]]]}";
  const auto says = [](const std::string& text) { return text.find("swapped") != std::string::npos; };
  const auto resolve = [&] { return mission.resolve("keep_out: [{file: zones.json, heights: any}]"); };
  for (const std::string& zone : {swapped, paris}) {
    mission.write("zones.json", collection(feature(zone)));
    EXPECT_EQ(says(expect_error(resolve, ErrorCode::too_far_away).problem()), zone == swapped);
    mission.write("zones.json", collection(feature(zone) + ", " + feature(polygon())));
    const Mission resolved = resolve();
    EXPECT_EQ(resolved.navigation.keep_out.size(), 1u);
    ASSERT_EQ(resolved.notes.size(), 1u);
    EXPECT_EQ(says(resolved.notes[0].text), zone == swapped) << resolved.notes[0].text;
  }
}

// 100,000 would take minutes. Those out of reach do not count.
TEST(ZoneFiles, TooManyZonesAreRefused) {
  const ZoneMission mission;
  const auto zones = [](std::size_t count, double latitude) {
    std::string list;
    for (std::size_t i = 0; i < count; ++i) {
      const double x = 11 + 1e-6 * static_cast<double>(i % 100), y = latitude + 1e-6 * static_cast<double>(i / 100);
      const auto place = [](double longitude, double north) {
        return "[" + shortest(longitude) + ", " + shortest(north) + "]";
      };
      list +=
          (i == 0 ? "" : ", ") + feature("{\"type\": \"Polygon\", \"coordinates\": [[" + place(x, y) + ", " +
                                         place(x + 5e-7, y) + ", " + place(x, y + 5e-7) + ", " + place(x, y) + "]]}");
    }
    return list;
  };
  const std::string limits = "keep_out: [{file: zones.json, heights: any}]";
  mission.write("zones.json", collection(zones(Navigation::kMostZones + 1, 48)));
  expect_error([&] { mission.resolve(limits); }, ErrorCode::value_out_of_range, "zones.json");
  mission.write("zones.json", collection(zones(Navigation::kMostZones + 1, 52) + ", " + feature(polygon())));
  EXPECT_EQ(mission.resolve(limits).navigation.keep_out.size(), 1u);
}

// A side along a parallel leaves the chord between its corners by 48 km.
TEST(ZoneFiles, LongSidesThatCurveTowardsTheSceneCount) {
  const ZoneMission mission;
  const auto zone = [](double south) {
    const std::string low = shortest(south), high = shortest(south + 5);
    return "{\"type\": \"Polygon\", \"coordinates\": [[[1, " + low + "], [21, " + low + "], [21, " + high + "], [1, " +
           high + "], [1, " + low + "]]]}";
  };
  const geo::LocalFrame frame({11, 48});
  // The nearest corners are more than 100 km away, and the side passes at 67 km.
  mission.write("zones.json", zone(48.6));
  ASSERT_GT(frame.to_local({1, 48.6}).norm(), 600e3);
  ASSERT_GT(frame.to_local({1, 48.6}).y(), 100e3);
  ASSERT_LT(frame.to_local({11, 48.6}).y(), 70e3);
  const std::string limits = "keep_out: [{file: zones.json, heights: any}]";
  EXPECT_EQ(mission.resolve(limits).navigation.keep_out.size(), 1u);
}

TEST(ZoneFiles, ReadingThemCanBeStopped) {
  const ZoneMission mission;
  mission.write("zones.json", polygon());
  mission.write("zones.kml", kml(placemark("")));
  for (const char* name : {"zones.json", "zones.kml"}) {
    const MissionFile read = mission.read("keep_out: [{file: " + std::string(name) + ", heights: any}]");
    bool was_reached = false;
    const Progress stop = [&](std::string_view stage, double) {
      was_reached = was_reached || stage == "zones";
      return !was_reached;
    };
    expect_code([&] { resolve_mission(read, stop); }, ErrorCode::cancelled);
    EXPECT_TRUE(was_reached);
  }
}

TEST(ZoneFiles, PointsFarAwayAreWithinReachToo) {
  const ZoneMission mission;
  const auto square = [](const std::string& west, const std::string& east) {
    return feature("{\"type\": \"Polygon\", \"coordinates\": [[[" + west + ", 47.9], [" + east + ", 47.9], [" + east +
                   ", 48.1], [" + west + ", 48.1], [" + west + ", 47.9]]]}");
  };
  mission.write("zones.json", collection(square("10.9", "11.1") + ", " + square("12.9", "13.1")));
  const std::string near = "{vertices: [[0, 0, 1], [4, 0, 1], [4, 4, 1]]}", far = "{point: [149000, 0, 5]}";
  const auto resolve = [&](const std::string& targets) {
    mission.write("mission.yaml",
                  "scene: {osm: city.osm, center: [48, 11], radius: 500}\nsensor: {max_range: 80}\ncombine: any\n"
                  "targets: [" +
                      targets + "]\nnavigation: {keep_out: [{file: zones.json, heights: any}]}\n");
    return resolve_mission(read_mission(mission.folder() / "mission.yaml"));
  };
  EXPECT_EQ(resolve(near).navigation.keep_out.size(), 1u);
  expect_code([&] { resolve(near + ", " + far); }, ErrorCode::too_far_away, "zones.json");
}

TEST(ZoneFiles, ZonesWiderThanHalfTheEarthAreRefused) {
  const ZoneMission mission;
  const std::string limits = "keep_out: [{file: zones.json, heights: any}]";
  for (const std::string ring : {"[-90, 40], [120, 40], [120, 50], [-90, 50], [-90, 40]",
                                 "[-90, 40], [0, 40], [120, 40], [120, 50], [0, 50], [-90, 50], [-90, 40]"}) {
    mission.write("zones.json", "{\"type\": \"Polygon\", \"coordinates\": [[" + ring + "]]}");
    expect_error([&] { mission.resolve(limits); }, ErrorCode::value_unsupported, "zones.json");
  }
}

// A frame from -179 to 179 degrees is two strips of two degrees, or all the rest of the world.
TEST(ZoneFiles, SidesThatMayGoEitherWayRoundAreNotFar) {
  const ZoneMission mission;
  const auto resolve = [&](const std::string& low, const std::string& high) {
    mission.write("zones.json",
                  collection(feature(polygon()) + ", " +
                             feature("{\"type\": \"Polygon\", \"coordinates\": [[[-179, " + low + "], [179, " + low +
                                     "], [179, " + high + "], [-179, " + high + "], [-179, " + low + "]]]}")));
    return mission.resolve("keep_out: [{file: zones.json, heights: any}]");
  };
  expect_error([&] { resolve("-80", "80"); }, ErrorCode::value_unsupported, "features[1]");
  EXPECT_EQ(resolve("-20", "-10").navigation.keep_out.size(), 1u);  // Fiji, either way
}

TEST(ZoneFiles, HeightsThatLeaveNothingAboveTheGroundAreRefused) {
  const ZoneMission mission;
  const auto resolve = [&](const std::string& lower, const std::string& upper) {
    mission.write("zones.json", volume(polygon(), "\"uomDimensions\": \"M\", \"lowerLimit\": " + lower +
                                                      ", \"lowerVerticalReference\": \"AMSL\", \"upperLimit\": " +
                                                      upper + ", \"upperVerticalReference\": \"AGL\""));
    return mission.resolve("keep_out: [{file: zones.json}]", ", sea_level: -500");  // the ground is 500 m high
  };
  expect_error([&] { resolve("600", "30"); }, ErrorCode::limits_reversed, "features[0].geometry[0]");
  EXPECT_EQ(resolve("600", "130").navigation.keep_out.size(), 1u);
}

TEST(ZoneFiles, NeedASceneOnTheEarth) {
  const ZoneMission mission;
  mission.write("zones.json", polygon());
  mission.write("city.obj", "v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n");
  mission.write("mission.yaml",
                "scene: {mesh: city.obj}\ntarget: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}\n"
                "sensor: {max_range: 9}\nnavigation: {keep_out: [{file: zones.json, heights: any}]}\n");
  expect_error([&] { resolve_mission(read_mission(mission.folder() / "mission.yaml")); }, ErrorCode::not_georeferenced,
               "mission.yaml:4:32");
}

/// Of a mission in a mesh in `crs`, whose middle is at these coordinates, with one zone up to 100 m above `reference`.
Mission resolved_in(const std::string& crs, const Eigen::Vector2d& middle, double unit, const std::string& reference) {
  const ZoneMission mission;
  const geo::CoordinateSystem system(crs, "test");
  const auto position = [&](double x, double y) {
    const geo::LonLat at = system.to_lonlat(middle + unit * Eigen::Vector2d(x, y));
    return "[" + shortest(at.longitude_deg) + ", " + shortest(at.latitude_deg) + "]";
  };
  mission.write("zones.json", "{\"type\": \"Polygon\", \"coordinates\": [[" + position(-20, -20) + ", " +
                                  position(20, -20) + ", " + position(0, 20) + ", " + position(-20, -20) +
                                  "]], \"layer\": {\"upper\": 100, \"upperReference\": \"" + reference +
                                  "\", \"uom\": \"m\"}}");
  const auto vertex = [&](double x, double y) {
    return "v " + shortest(middle.x() + unit * x) + " " + shortest(middle.y() + unit * y) + " 9\n";
  };
  mission.write("city.obj", vertex(-9, -9) + vertex(9, -9) + vertex(0, 9) + "f 1 2 3\n");
  mission.write("mission.yaml", "scene: {mesh: city.obj, crs: '" + crs +
                                    "'}\ntarget: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}\n"
                                    "sensor: {max_range: 9}\nnavigation: {keep_out: [{file: zones.json}]}\n");
  return resolve_mission(read_mission(mission.folder() / "mission.yaml"));
}

TEST(ZoneFiles, HeightsNeedAZeroThatIsKnown) {
  const Eigen::Vector2d delft(85000, 447000), degrees(4.36, 52.0);
  const auto top = [](const Mission& mission) { return mission.navigation.keep_out.at(0).max_z_m; };
  EXPECT_EQ(top(resolved_in("EPSG:7415", delft, 1, "AMSL")), 100);  // with heights above NAP
  EXPECT_EQ(top(resolved_in("EPSG:4979", degrees, 1e-5, "WGS84")), 100);
  const auto refuse = [&](const std::string& crs, const Eigen::Vector2d& middle, double unit, const std::string& from) {
    expect_error([&] { resolved_in(crs, middle, unit, from); }, ErrorCode::heights_differ, "mission.yaml:4:32");
  };
  refuse("EPSG:28992", delft, 1, "AMSL");  // without heights
  refuse("EPSG:7415", delft, 1, "WGS84");
  refuse("EPSG:4979", degrees, 1e-5, "AMSL");
}

TEST(ZoneFiles, AreInputsOfTheMissionAndStayInItsText) {
  const ZoneMission mission;
  mission.write("in.json", polygon());
  mission.write("out.json", polygon());
  const MissionFile read = mission.read(
      "keep_in: [{file: in.json, z: [1, 5]}]\n  keep_out: [{file: out.json, heights: any}, {file: in.json}]",
      ", sea_level: -12.5");
  const auto files = input_files(read);
  for (const char* name : {"in.json", "out.json"}) {
    EXPECT_TRUE(std::any_of(files.begin(), files.end(), [&](const auto& file) { return file.filename() == name; }));
  }
  const std::string text = mission_text(read, mission.folder());
  const MissionFile again = read_mission_text(text, mission.folder() / "again.yaml");
  EXPECT_EQ(mission_text(again, mission.folder()), text);
  EXPECT_EQ(again.sea_level_m, std::optional(-12.5));
  ASSERT_EQ(again.keep_in_files.size(), 1u);
  EXPECT_EQ(again.keep_in_files[0].file, read.keep_in_files[0].file);
  EXPECT_EQ(again.keep_in_files[0].z_m, (std::optional<std::array<double, 2>>({1, 5})));
  ASSERT_EQ(again.keep_out_files.size(), 2u);
  EXPECT_TRUE(again.keep_out_files[0].any_height);
  EXPECT_FALSE(again.keep_out_files[1].any_height);

  const auto refuse = [&](const std::string& limits, ErrorCode code) {
    expect_error([&] { mission.read(limits); }, code, "mission.yaml:5:");
  };
  refuse("keep_in: [{file: none.json}]", ErrorCode::file_not_found);
  refuse("keep_in: [{file: in.json, z: [5, 1]}]", ErrorCode::limits_reversed);
  refuse("keep_in: [{file: in.json, polygon: []}]", ErrorCode::conflicting_keys);
  refuse("keep_in: [{file: in.json, z: [1, 5], heights: any}]", ErrorCode::conflicting_keys);
  refuse("keep_in: [{file: [1]}]", ErrorCode::wrong_type);
}

}  // namespace
}  // namespace vantage::testing
