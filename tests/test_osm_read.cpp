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

// ---- what Overpass and editors write ----

Extract read_bytes_as_map(const std::string& bytes) {
  const TemporaryDirectory directory;
  write_bytes(directory / "answer", bytes);
  return read_extract(directory / "answer");
}

const std::string kJsonHouse =
    R"({"version": 0.6, "generator": "Overpass API", "osm3s": {"copyright": "\"nodes\": [1]"}, "elements": [
    {"type": "node", "id": 1, "lat": 47.25, "lon": 8.5}, {"type": "node", "id": 2, "lat": 47.25, "lon": 8.501},
    {"type": "node", "id": 3, "lat": 47.251, "lon": 8.501, "tags": {}},
    {"type": "node", "id": 4, "lat": 47.251, "lon": 8.5},
    {"type": "count", "id": 0, "tags": {"nodes": "4"}},
    {"type": "way", "id": 10, "nodes": [1, 2, 3, 4, 1], "tags": {"building": "yes"}}]})";

TEST(OsmRead, ReadsJsonOfOverpass) {
  const std::string expected = testing::describe(read_bytes_as_map(osm_xml(kHouse)));
  EXPECT_NE(expected.find("way/10 [building=yes] outer"), std::string::npos) << expected;
  EXPECT_EQ(testing::describe(read_bytes_as_map(kJsonHouse)), expected);
  EXPECT_EQ(testing::describe(read_bytes_as_map("\xef\xbb\xbf\n" + kJsonHouse + "\n")), expected);
  // Without the nodes: "out ids geom", and with the nodes' numbers "out geom". What lies outside of its box is null.
  const std::string corners =
      R"([{"lat": 47.25, "lon": 8.5}, {"lat": 47.25, "lon": 8.501}, {"lat": 47.251, "lon": 8.501}, )"
      R"({"lat": 47.251, "lon": 8.5}, {"lat": 47.25, "lon": 8.5}])";
  for (const std::string nodes : {"", R"("nodes": [1, 2, 3, 4, 1], )"}) {
    const Extract extract = read_bytes_as_map(
        R"({"elements": [{"type": "way", "id": 10, "bounds": {"minlat": 1}, "tags": {"building": "yes"}, )" + nodes +
        R"("geometry": )" + corners + "}]}");
    ASSERT_EQ(extract.areas.size(), 1u) << nodes;
    EXPECT_EQ(extract.areas[0].polygons.at(0).outer.size(), 4u);
    EXPECT_NEAR(testing::doubled_area(extract.areas[0].polygons[0].outer), 2e-6, 1e-12);
    EXPECT_TRUE(extract.problems.empty());
    EXPECT_NEAR(extract.bounds_deg[3], 47.251, 1e-9);
  }
  const Extract cut = read_bytes_as_map(
      R"({"elements": [{"type": "way", "id": 10, "tags": {"building": "yes"}, "nodes": [1, 2, 3, 4, 1], "geometry": [)"
      R"({"lat": 47.25, "lon": 8.5}, {"lat": 47.25, "lon": 8.501}, null, {"lat": 47.251, "lon": 8.5}, null]}]})");
  ASSERT_EQ(cut.areas.size(), 1u);
  ASSERT_EQ(cut.problems.size(), 1u);
  EXPECT_EQ(cut.problems[0].kind, Problem::Kind::missing_nodes);
}

/// "out geom" of a relation alone: its ways are no elements, but their positions are in its members.
TEST(OsmRead, BuildsMembersWhosePositionsTheRelationHas) {
  const auto nodes = [](double west, double south, double size) {
    std::string text;
    for (const auto& [x, y] : std::vector<std::pair<double, double>>{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}) {
      text += "<nd lat='" + std::to_string(south + y * size) + "' lon='" + std::to_string(west + x * size) + "'/>";
    }
    return text;
  };
  const std::string tags = osm_tag("type", "multipolygon") + osm_tag("building", "yes");
  const auto relation = [&](const std::string& outer, const std::string& inner) {
    return "<relation id='5'><bounds minlat='1' minlon='1' maxlat='2' maxlon='2'/><member type='way' ref='1' "
           "role='outer'>" +
           outer + "</member><member type='way' ref='2' role='inner'>" + inner +
           "</member><member type='node' ref='3' role='label' lat='47' lon='8'/>" + tags + "</relation>\n";
  };
  const std::string given = relation(nodes(8, 47, 0.001), nodes(8.0003, 47.0003, 0.0004));
  for (const std::string& xml : {given, given + given.substr(0, 14) + "6" + given.substr(15)}) {
    const Extract extract = read_bytes_as_map(osm_xml(xml));
    ASSERT_GE(extract.areas.size(), 1u);
    EXPECT_EQ(extract.areas[0].id, testing::relation_id(5));
    ASSERT_EQ(extract.areas[0].polygons.size(), 1u);
    EXPECT_EQ(extract.areas[0].polygons[0].outer.size(), 4u);
    EXPECT_EQ(extract.areas[0].polygons[0].holes.size(), 1u);
    EXPECT_EQ(extract.problems.size(), 0u);
    EXPECT_EQ(extract.ways, 0u);
    EXPECT_EQ(extract.superseded, 0u);
  }
  // In JSON, and where the outer ring is a way of the file: that counts.
  const Extract json = read_bytes_as_map(
      R"({"elements": [{"type": "relation", "id": 5, "members": [)"
      R"({"type": "way", "ref": 1, "role": "outer", "geometry": [)"
      R"({"lat": 47, "lon": 8}, {"lat": 47, "lon": 8.001}, {"lat": 47.001, "lon": 8.001}, {"lat": 47, "lon": 8}]}, )"
      R"({"type": "node", "ref": 3, "role": "label", "lat": 47, "lon": 8}], )"
      R"("tags": {"type": "multipolygon", "building": "yes"}}]})");
  ASSERT_EQ(json.areas.size(), 1u);
  EXPECT_NEAR(testing::doubled_area(json.areas[0].polygons.at(0).outer), 1e-6, 1e-12);
  const Extract both = read_bytes_as_map(osm_xml(osm_square(1, 8, 47, 0.002) + osm_way(1, osm_ring(1)) + given));
  ASSERT_EQ(both.areas.size(), 1u);
  EXPECT_NEAR(testing::doubled_area(both.areas[0].polygons.at(0).outer), 8e-6, 1e-12);
  EXPECT_EQ(both.ways, 1u);
}

TEST(OsmRead, WhatAnEditorHasDeletedIsNotThere) {
  const std::string deleted =
      "<way id='11' action='delete' visible='true'><nd ref='1'/><nd ref='2'/><nd ref='3'/>"
      "<nd ref='1'/>" +
      osm_tag("building", "yes") + "</way>\n";
  EXPECT_EQ(testing::describe(read_bytes_as_map(osm_xml(kHouse + deleted))),
            testing::describe(read_bytes_as_map(osm_xml(kHouse))));
  std::string changed = deleted;
  changed.replace(changed.find("delete"), 6, "modify");
  EXPECT_EQ(read_bytes_as_map(osm_xml(kHouse + changed)).areas.size(), 2u);
}

TEST(OsmRead, NoticesRemarksOnErrors) {
  const std::string error = "runtime error: Query timed out in \"query\" at line 3 after 26 seconds.";
  EXPECT_EQ(read_bytes_as_map(osm_xml("<remark> " + error + " </remark>" + kHouse)).remark, error);
  EXPECT_EQ(read_bytes_as_map(osm_xml(kHouse + "<remark>runtime remark: 3 areas are old.</remark>")).remark, "");
  EXPECT_EQ(read_bytes_as_map(osm_xml(kHouse + "<note>an error</note>")).remark, "");
  std::string json = kJsonHouse;
  json.insert(json.rfind('}'), ", \"remark\": \"runtime error: out of memory\"");
  EXPECT_EQ(read_bytes_as_map(json).remark.rfind("runtime error", 0), 0U);
}

// They would be lost with what they are in.
TEST(OsmRead, RefusesObjectsThatAreInNoMap) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& bytes, const std::string& problem) {
    write_bytes(directory / "answer", bytes);
    expect_map_error(directory / "answer", problem, "answer");
  };
  for (const std::string element : {"action", "create", "osm"}) {
    std::string text = osm_xml(kHouse);
    text.insert(text.find("<node"), "<" + element + ">");
    text.insert(text.find("</osm>"), "</" + element + ">");
    refused(text, "an element of the file is not of a map: " + element);
  }
  refused(osm_xml(kHouse + "<Way id='11'><nd ref='1'/></Way>"), "an element of the file is not of a map: Way");
  refused(osm_xml("<meta><way id='11'/></meta>" + kHouse),
          "objects lie in an element of the file that is not of a map");
  EXPECT_EQ(read_bytes_as_map(osm_xml("<note>free</note><meta osm_base='x'/>" + kHouse)).areas.size(), 1u);
  for (const std::string member : {R"("actions": [{"type": "way"}])", R"("actions": {"elements": []})"}) {
    std::string more = kJsonHouse;
    more.insert(more.rfind('}'), ", " + member);
    refused(more, "a member of the file is not of a map: actions");
  }
  std::string derived = kJsonHouse;
  derived.replace(derived.find("\"way\""), 5, "\"house\"");
  refused(derived, "an element is no node, way or relation: its type is house");
  derived = kJsonHouse;
  derived.replace(derived.find("\"way\""), 5, "\"area\"");
  refused(derived, "an area of Overpass has no outline; ask for ways and relations instead");
}

TEST(OsmRead, RefusesBrokenJson) {
  const TemporaryDirectory directory;
  const auto expect_broken = [&directory](const std::string& content, const std::string& problem) {
    write_bytes(directory / "map.json", content);
    expect_map_error(directory / "map.json", problem, "map.json");
  };
  for (std::size_t cut = 40; cut + 1 < kJsonHouse.size(); cut += 37) {
    expect_broken(kJsonHouse.substr(0, cut), "the file ends too early");
  }
  expect_broken(kJsonHouse + "}", "the JSON is broken");
  expect_broken(R"({"elements": {}})", "it looks like JSON");
  expect_broken(R"({"elements": []})", "the map is empty");
  expect_broken(R"({"elements": [{"type": "node", "id": 1.5, "lat": 1, "lon": 1}]})", "illegal id");
  expect_broken(R"({"elements": [{"type": "node", "id": 1, "lat": 1e99, "lon": 1}]})", "no longitude and latitude");
  expect_broken(R"({"elements": [{"type": "way", "id": 1, "geometry": [{"lat": 1}]}]})", "no longitude and latitude");
  expect_broken(R"({"elements": [{"type": "node", "id": 1, "tags": {"a": 3}}]})", "no text");
  expect_broken(R"({"elements": [{"type": "node", "id": 1, "tags": {"a\u0000b": "c"}}]})", "NUL");
  expect_broken(R"({"elements": [{"type": "relation", "id": 1, "members": [{"type": "star", "ref": 1}]}]})", "no node");
  expect_broken(R"({"elements": [], "a": )" + std::string(200, '[') + std::string(200, ']') + "}", "nested deeper");
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
  expect_broken(osm_xml(osm_node(1, 8, 47) + "<way id='3'><node/></way>\n"), "unknown element in <way>: 'node'",
                "map.osm, line 4");
  expect_broken(osm_xml("<node id='x' lon='1' lat='1'/>\n"), "garbled: illegal id: 'x'", "map.osm");
  expect_broken(osm_xml("<node id='1' lon='12345' lat='1'/>\n"), "wrong format for coordinate: '12345'", "map.osm");
  expect_broken("<?xml version='1.0'?><!DOCTYPE osm [<!ENTITY a 'b'>]><osm version='0.6'>&a;</osm>",
                "XML with a DOCTYPE", "map.osm");
  expect_broken("<osm version='0.5'/>", "0.5", "map.osm");
}

TEST(OsmRead, ReadsARealMapWithWrongUsers) {
  VANTAGE_REQUIRE_SHARED("osm-fixtures/josmTest01.osm");
  EXPECT_GT(read_extract(shared_data("osm-fixtures/josmTest01.osm")).nodes, 0u);  // the id of a user is out of range
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
