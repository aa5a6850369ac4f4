// Which files can be read as maps, and what is said of those that cannot.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>
#include <vector>

#include "support/osm_maps.h"
#include "support/shared_data.h"
#include "support/wording.h"

namespace vantage::internal::osm {
namespace {

using testing::expect_map_error;
using testing::osm_node;
using testing::osm_ring;
using testing::osm_square;
using testing::osm_tag;
using testing::osm_way;
using testing::osm_xml;
using testing::read_bytes;
using testing::shared_data;
using testing::TemporaryDirectory;
using testing::write_bytes;

const std::string kHouse = osm_square(1, 8.5, 47.25, 0.001) + osm_way(10, osm_ring(1), osm_tag("building", "yes"));

TEST(OsmRead, TellsTheFormatByTheContent) {
  VANTAGE_REQUIRE_OSMIUM();
  const TemporaryDirectory directory;
  write_bytes(directory / "map.osm", osm_xml(kHouse));
  const std::string expected = testing::describe(read_extract(directory / "map.osm"));
  EXPECT_NE(expected.find("way/10 [building=yes] outer"), std::string::npos) << expected;
  for (const std::string format : {"osm.gz", "osm.bz2", "osm.pbf", "osm.pbf,pbf_dense_nodes=false", "osm"}) {
    const std::string file = (directory / "named.like.nothing").string();
    testing::osmium({"cat", "--overwrite", "-f", format, "-o", file, (directory / "map.osm").string()});
    EXPECT_EQ(testing::describe(read_extract(file)), expected) << format;
  }
}

TEST(OsmRead, AllFormatsOfARealMapGiveTheSame) {
  VANTAGE_REQUIRE_OSMIUM();
  VANTAGE_REQUIRE_SHARED("osm/empire-state-600m.osm.pbf");
  const std::filesystem::path map = shared_data("osm/empire-state-600m.osm.pbf");
  const std::string expected = testing::describe(read_extract(map));
  const TemporaryDirectory directory;
  for (const std::string name : {"map.osm", "map.osm.gz", "map.osm.bz2", "map.osm.pbf"}) {
    testing::osmium({"cat", "-o", (directory / name).string(), map.string()});
    EXPECT_EQ(testing::describe(read_extract(directory / name)), expected) << name;
  }
}

TEST(OsmRead, AnUnsortedMapGivesTheSameAsTheSortedOne) {
  VANTAGE_REQUIRE_OSMIUM();
  VANTAGE_REQUIRE_SHARED("osm/new-york-unsorted.osm.pbf");
  const std::filesystem::path map = shared_data("osm/new-york-unsorted.osm.pbf");
  const TemporaryDirectory directory;
  testing::osmium({"sort", "-o", (directory / "sorted.osm.pbf").string(), map.string()});
  const Extract unsorted = read_extract(map), sorted = read_extract(directory / "sorted.osm.pbf");
  EXPECT_FALSE(unsorted.sorted);
  EXPECT_TRUE(sorted.sorted);
  EXPECT_GT(sorted.areas.size(), 1000u);
  EXPECT_EQ(testing::describe(unsorted, false), testing::describe(sorted, false));
}

TEST(OsmRead, ObjectsMayComeInAnyOrder) {
  const std::string nodes = osm_square(1, 8.5, 47.25, 0.001), hole = osm_square(5, 8.5002, 47.2502, 0.0005);
  const std::string ways = osm_way(11, {1, 2, 3, 4, 1}) + osm_way(12, {5, 6, 7, 8, 5});
  const std::string relation = testing::osm_relation(20, {"way 11 outer", "way 12 inner"},
                                                     osm_tag("type", "multipolygon") + osm_tag("building", "yes"));
  const Extract sorted = testing::extract_of(nodes + hole + ways + relation);
  const Extract reversed =
      testing::extract_of(relation + osm_way(12, {5, 6, 7, 8, 5}) + osm_way(11, {1, 2, 3, 4, 1}) + hole + nodes);
  ASSERT_EQ(sorted.areas.size(), 1u);
  EXPECT_EQ(sorted.areas[0].polygons[0].holes.size(), 1u);
  EXPECT_TRUE(sorted.sorted);
  EXPECT_FALSE(reversed.sorted);
  EXPECT_EQ(testing::describe(sorted, false), testing::describe(reversed, false));
}

TEST(OsmRead, RefusesWhatIsNoFile) {
  const TemporaryDirectory directory;
  expect_map_error(directory / "none.osm.pbf", "does not exist", "none.osm.pbf");
  expect_map_error(directory.path(), "is a directory", directory.path().string());
  ASSERT_EQ(::mkfifo((directory / "pipe.osm").c_str(), 0600), 0);
  expect_map_error(directory / "pipe.osm", "not a regular file", "pipe.osm");
}

TEST(OsmRead, RefusesWhatIsNoMap) {
  const TemporaryDirectory directory;
  const std::vector<std::pair<std::string, std::string>> contents = {
      {"", "the file is empty"},
      {"\xff\xd8\xff\xe0\x01\x02JFIF", "it looks like a JPEG picture"},
      {"\x89PNG\r\n\x1a\n", "it looks like a PNG picture"},
      {"PK\x03\x04zip", "it looks like a ZIP archive"},
      {"<!DOCTYPE html>\n<html><body>404</body></html>", "it looks like an HTML page"},
      {"\n <html><body>404</body></html>", "it looks like an HTML page"},
      {"<?xml version='1.0'?><osmChange version='0.6'/>", "it looks like an OpenStreetMap change file"},
      {"<?xml version='1.0'?><!-- <osm> --><gpx/>", "it looks like XML about <gpx>"},
      {"{\"type\": \"FeatureCollection\"}", "it looks like JSON"},
      {std::string("\xff\xe0\x04o5m2", 7), "it looks like an o5m file"},
      {"n1 v1 x8.5 y47.2\n", "it looks like something else"},
      {"<?xml version='1.0'", "it looks like something else"}};
  for (const auto& [bytes, problem] : contents) {
    write_bytes(directory / "map.osm.pbf", bytes);
    expect_map_error(directory / "map.osm.pbf", problem, "map.osm.pbf");
  }
}

TEST(OsmRead, RefusesAnEmptyMap) {
  const TemporaryDirectory directory;
  write_bytes(directory / "empty.osm", osm_xml(""));
  expect_map_error(directory / "empty.osm", "the map is empty", "empty.osm");
  write_bytes(directory / "empty.osm", osm_xml("<bounds minlat='1' minlon='1' maxlat='2' maxlon='2'/>"));
  expect_map_error(directory / "empty.osm", "the map is empty", "empty.osm");
}

TEST(OsmRead, NamesTheLineOfBrokenXml) {
  const TemporaryDirectory directory;
  const auto expect_broken = [&directory](const std::string& content, const std::string& problem,
                                          const std::string& where) {
    write_bytes(directory / "map.osm", content);
    expect_map_error(directory / "map.osm", problem, where);
  };
  const std::string whole = osm_xml(kHouse);
  expect_broken(osm_xml(osm_node(1, 8, 47) + "<way id='3'><nd ref='1'></way>\n"), "the XML is broken: mismatched tag",
                "map.osm, line 4");
  expect_broken(whole.substr(0, whole.size() - 8), "the file ends too early", "map.osm, line");
  expect_broken(whole.substr(0, whole.find("<way") + 12), "the file ends too early", "map.osm, line 7");
  expect_broken(osm_xml(osm_node(1, 8, 47) + "<way id='3'><node/></way>\n"), "Unknown element in <way>: node",
                "map.osm");
  expect_broken(osm_xml("<node id='x' lon='1' lat='1'/>\n"), "garbled: illegal id: 'x'", "map.osm");
  expect_broken(osm_xml("<node id='1' lon='12345' lat='1'/>\n"), "wrong format for coordinate: '12345'", "map.osm");
  expect_broken("<?xml version='1.0'?><!DOCTYPE osm [<!ENTITY a 'b'>]><osm version='0.6'>&a;</osm>",
                "XML with a DOCTYPE", "map.osm");
  expect_broken("<osm version='0.5'/>", "0.5", "map.osm");
}

TEST(OsmRead, SaysWhatIsWrongWithARealMapOfOthers) {
  VANTAGE_REQUIRE_SHARED("osm-fixtures/josmTest01.osm");
  expect_map_error(shared_data("osm-fixtures/josmTest01.osm"), "illegal user id: '4368547324346'", "josmTest01.osm");
}

/// Each cut must be noticed, wherever it is, but where it happens to end between two blocks.
TEST(OsmRead, NoticesFilesThatAreCutOff) {
  VANTAGE_REQUIRE_OSMIUM();
  VANTAGE_REQUIRE_SHARED("osm/empire-state-600m.osm.pbf");
  const TemporaryDirectory directory;
  for (const std::string name : {"map.osm.pbf", "map.osm.gz", "map.osm.bz2", "map.osm"}) {
    const std::filesystem::path map = directory / name;
    testing::osmium({"cat", "-o", map.string(), shared_data("osm/empire-state-600m.osm.pbf").string()});
    const std::string whole = read_bytes(map);
    std::vector<std::size_t> cuts = {whole.size() - 2, whole.size() - 7, 20};
    for (std::size_t i = 1; i < 8; ++i) cuts.push_back(whole.size() * i / 8);
    for (const std::size_t cut : cuts) {
      SCOPED_TRACE(name + " cut to " + std::to_string(cut) + " of " + std::to_string(whole.size()));
      write_bytes(map, whole.substr(0, cut));
      expect_map_error(map, name == "map.osm.pbf" ? "cut off or garbled" : "", name);
    }
  }
}

TEST(OsmRead, NoticesGarbledBytes) {
  VANTAGE_REQUIRE_SHARED("osm/empire-state-600m.osm.pbf");
  const TemporaryDirectory directory;
  const std::string whole = read_bytes(shared_data("osm/empire-state-600m.osm.pbf"));
  std::size_t refused = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    std::string bytes = whole;
    const std::size_t at = 15 + (bytes.size() - 15) * i / 60;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x55);
    write_bytes(directory / "map.osm.pbf", bytes);
    try {
      read_extract(directory / "map.osm.pbf");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, 50u);  // blocks have checksums; only names in the header do not matter
}

TEST(OsmRead, ReportsProgressAndStops) {
  const TemporaryDirectory directory;
  std::string content;
  for (long i = 0; i < 20000; ++i) content += osm_node(i + 1, 8 + 1e-5 * static_cast<double>(i), 47);
  write_bytes(directory / "map.osm", osm_xml(content));
  std::vector<std::string> stages;
  double last = 0;
  const auto follow = [&](std::string_view stage, double fraction) {
    if (stages.empty() || stages.back() != stage) {
      stages.emplace_back(stage);
      last = 0;
    }
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    return true;
  };
  read_extract(directory / "map.osm", {}, follow);
  EXPECT_EQ(stages.size(), 3U);
  testing::expect_wording(stages);
  for (const std::string& stop : stages) {
    const Progress stopping = [&](std::string_view stage, double) { return stage != stop; };
    testing::expect_code([&] { read_extract(directory / "map.osm", {}, stopping); }, ErrorCode::cancelled);
  }
}

TEST(OsmRead, NamesObjects) {
  EXPECT_EQ(text(testing::way_id(265517)), "way/265517");
  EXPECT_EQ(text(ObjectId{ObjectType::node, -3}), "node/-3");
  EXPECT_EQ(parse_object_id("way/265517"), testing::way_id(265517));
  EXPECT_EQ(parse_object_id("w265517"), testing::way_id(265517));
  EXPECT_EQ(parse_object_id("relation/-7"), testing::relation_id(-7));
  EXPECT_EQ(parse_object_id("n1"), (ObjectId{ObjectType::node, 1}));
  for (const char* const bad : {"", "w", "way/", "way", "way/1x", "way/ 1", "way/1.5", "x5", "5",
                                "way/99999999999999999999", "w/5", "Way/5", "+5", "w+5"}) {
    EXPECT_FALSE(parse_object_id(bad)) << bad;
  }
}

}  // namespace
}  // namespace vantage::internal::osm
