// Listing the areas of a map: which are listed, how large they are, and what is said when there is none.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "support/osm_maps.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/city.h"
#include "vantage/target.h"

namespace vantage::testing {
namespace {

/// A lot with a hole, a named pitch, a pitch that crosses itself, a wall round a garden, and what bounds nothing.
std::string map_of_areas() {
  MapText map;
  map.box(0, 0, 40, 30, {{"amenity", "parking"}, {"access", "customers"}});
  map.box(100, 0, 120, 10, {{"leisure", "pitch"}, {"name", "North Field"}});
  map.area({{200, 0}, {220, 20}, {220, 0}, {200, 20}}, {{"leisure", "pitch"}});
  map.box(300, 0, 340, 30, {{"barrier", "wall"}});
  map.area({{400, 0}, {401, 0}, {402, 0}}, {{"amenity", "parking"}});
  map.line({{0, 100}, {50, 100}}, {{"amenity", "parking"}});
  map.node(0, 200, {{"amenity", "parking"}});
  map.box(500, 0, 540, 40, {});
  map.box(510, 10, 530, 30, {});
  map.relation({{"way", 7, "outer"}, {"way", 8, "inner"}},
               {{"type", "multipolygon"}, {"amenity", "parking"}, {"shop", "no"}});
  return map.text();
}

class Areas : public ::testing::Test {
 protected:
  void SetUp() override { write_bytes(file(), map_of_areas()); }

  std::filesystem::path file() const { return folder_ / "map.osm"; }

  std::vector<MapArea> of(const std::vector<std::string>& tags, bool named = false, CityRegion region = {}) const {
    AreaFilter filter{{}, named, region};
    for (const std::string& tag : tags) filter.tags.push_back(area_tag(tag, "test"));
    return read_areas(file(), filter);
  }

  std::vector<std::string> ids(const std::vector<std::string>& tags, bool named = false, CityRegion region = {}) const {
    std::vector<std::string> result;
    for (const MapArea& area : of(tags, named, region)) result.push_back(area.source_id);
    return result;
  }

  TemporaryDirectory folder_;
};

using Ids = std::vector<std::string>;

TEST_F(Areas, AreListedByTheirTags) {
  EXPECT_EQ(ids({"amenity=parking"}), (Ids{"way/1", "relation/1"}));
  EXPECT_EQ(ids({"leisure=*"}), (Ids{"way/2", "way/3"}));
  EXPECT_EQ(ids({"amenity=*", "access=customers"}), (Ids{"way/1"}));
  EXPECT_EQ(ids({}, true), (Ids{"way/2"}));
  EXPECT_EQ(ids({}), (Ids{"way/1", "way/2", "way/3", "relation/1"}));
}

TEST_F(Areas, SayWhatTheyAre) {
  const std::vector<MapArea> areas = of({});
  ASSERT_EQ(areas.size(), 4U);
  EXPECT_EQ(areas[1].name, "North Field");
  EXPECT_EQ(areas[1].tags,
            (std::vector<std::pair<std::string, std::string>>{{"leisure", "pitch"}, {"name", "North Field"}}));
  // Positions in the file are to a millimetre.
  EXPECT_NEAR(areas[0].area_m2, 40 * 30, 0.2);
  EXPECT_NEAR(areas[1].area_m2, 20 * 10, 0.1);
  EXPECT_NEAR(areas[2].area_m2, 20 * 20, 0.2) << "crossing itself: the hull of the corners next to it";
  EXPECT_NEAR(areas[3].area_m2, 40 * 40 - 20 * 20, 0.2) << "the hole is taken off";
  ASSERT_EQ(areas[3].polygons.size(), 1U);
  EXPECT_EQ(areas[3].polygons[0].outer.size(), 4U);
  ASSERT_EQ(areas[3].polygons[0].holes.size(), 1U);
  const geo::LocalFrame frame({11.5755, 48.1374});
  const Eigen::Vector2d middle = frame.to_local({areas[0].center_deg[1], areas[0].center_deg[0]});
  EXPECT_LT((middle - Eigen::Vector2d(20, 15)).norm(), 2e-3);
}

TEST_F(Areas, AreNotThereWhereMembersAreMissing) {
  MapText map;
  const long lot = map.box(0, 0, 40, 30, {});
  map.box(100, 0, 120, 10, {{"leisure", "pitch"}});
  map.relation({{"way", lot, "outer"}, {"way", 99, "outer"}}, {{"type", "multipolygon"}, {"amenity", "parking"}});
  write_bytes(file(), map.text());
  EXPECT_EQ(ids({}), (Ids{"way/2"}));
}

TEST_F(Areas, OfARegionReachIntoIt) {
  const geo::LonLat middle = geo::LocalFrame({11.5755, 48.1374}).to_lonlat({110, 5});
  CityRegion region;
  region.center_deg = {middle.latitude_deg, middle.longitude_deg};
  region.radius_m = 75;
  EXPECT_EQ(ids({}, false, region), (Ids{"way/1", "way/2"})) << "the lot ends 70 m from the centre";
  region.radius_m = 60;
  EXPECT_EQ(ids({}, false, region), (Ids{"way/2"}));
  const geo::LonLat in_hole = geo::LocalFrame({11.5755, 48.1374}).to_lonlat({520, 20});
  region.center_deg = {in_hole.latitude_deg, in_hole.longitude_deg};
  region.radius_m = 11;
  EXPECT_EQ(ids({}, false, region), (Ids{"relation/1"}));
  region.radius_m = 9;
  testing::expect_error([&] { of({}, false, region); }, ErrorCode::map_object_missing);
}

TEST_F(Areas, ThatAreNotThereAreExplained) {
  const auto expect_none = [&](const std::vector<std::string>& tags, bool named = false, CityRegion region = {}) {
    expect_error([&] { of(tags, named, region); }, ErrorCode::map_object_missing, "map.osm");
  };
  expect_none({"amenty=parking"});
  expect_none({"amenity=parkin"});
  expect_none({"amenity=parking", "leisure=pitch"});
  expect_none({"amenity=parking"}, true);
  expect_none({"shop=*"});
  CityRegion region;
  region.bbox_deg = {11.5756, 48.1376, 11.5757, 48.1377};
  expect_none({"leisure=pitch"}, false, region);
}

TEST_F(Areas, OfNoMapAreRefused) {
  expect_code([] { read_areas("no-such-file.osm"); }, ErrorCode::file_not_found, "no-such-file.osm");
  write_bytes(folder_ / "lines.osm",
              osm_xml(osm_node(1, 8, 47) + osm_node(2, 8.001, 47) + osm_way(1, {1, 2}, osm_tag("highway", "path"))));
  expect_error([&] { read_areas(folder_ / "lines.osm"); }, ErrorCode::map_object_missing, "lines.osm");
}

TEST(AreaTags, HaveAKeyAndAValue) {
  EXPECT_EQ(area_tag("amenity=parking", "").value, "parking");
  EXPECT_EQ(area_tag("note=a=b", "").value, "a=b");
  EXPECT_EQ(area_tag("leisure=*", "").value, "");
  for (const char* const bad : {"amenity", "=parking", "amenity=", "", "="}) {
    expect_error([&] { area_tag(bad, "the place"); }, ErrorCode::value_syntax, "the place");
  }
}

class CliAreas : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    write("map.osm", map_of_areas());
  }
};

TEST_F(CliAreas, AreListed) {
  expect_wording(output_of({"inspect", "-q", "map.osm", "--areas", "leisure=pitch"}));
  const auto areas = nlohmann::json::parse(output_of({"inspect", "-q", "map.osm", "--named", "--json"}));
  EXPECT_EQ(areas.at("type"), "FeatureCollection");
  ASSERT_EQ(areas.at("features").size(), 1U);
  const auto& feature = areas["features"][0];
  EXPECT_EQ(feature.at("properties").at("osm"), "way/2");
  EXPECT_EQ(feature.at("properties").at("tags").at("leisure"), "pitch");
  EXPECT_EQ(feature.at("geometry").at("type"), "Polygon");
  const auto& ring = feature["geometry"]["coordinates"][0];
  EXPECT_EQ(ring.size(), 5U);
  EXPECT_EQ(ring.front(), ring.back());
}

TEST_F(CliAreas, OfWhatIsNoMapAreRefused) {
  expect_bad({"inspect", "city.obj", "--areas", "leisure=pitch"}, "--areas");
  expect_bad({"inspect", "city.obj", "--named"}, "--named");
  expect_bad({"inspect", "map.osm", "--areas", "leisure"}, "--areas");
  expect_bad({"inspect", "map.osm", "--areas", "sport=chess"}, "map.osm");
}

/// Many objects in one scene: each one's faces are those that it has by itself.
TEST(Faces, OfManyObjectsAreThoseOfEach) {
  Scene scene;
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    const double x = 20.0 * i, z = 5 + i;
    for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {10.0, 0.0}, {10.0, 8.0}, {0.0, 8.0}}) {
      scene.mesh.vertices.emplace_back(x + dx, dy, 0);
      scene.mesh.vertices.emplace_back(x + dx, dy, z);
    }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      scene.mesh.triangles.push_back({first + a, first + b, first + c});
      scene.mesh.triangles.push_back({first + a, first + c, first + d});
    };
    add(1, 3, 5, 7);
    for (std::uint32_t k = 0; k < 4; ++k) add(2 * k, (2 * k + 2) % 8, (2 * k + 3) % 8, 2 * k + 1);
    scene.objects.push_back({"box " + std::to_string(i), "", ObjectKind::building});
    scene.object_of.resize(scene.mesh.triangles.size(), i);
    all.push_back(i);
  }
  const FaceFinder finder(scene);
  const std::vector<Face> faces = finder.faces(all, FaceKind::roof);
  ASSERT_EQ(faces.size(), all.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(faces[i].object, i);
    EXPECT_NEAR(faces[i].area_m2, 80, 1e-9);
    const std::vector<Face> alone = finder.faces({&i, 1}, FaceKind::roof);
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_EQ(alone[0].parts, faces[i].parts);
  }
}

}  // namespace
}  // namespace vantage::testing
