// Targets that lie in files: GeoJSON, KML and KMZ; and outlines with heights, or several of them.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

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

using Corners = std::vector<std::vector<double>>;  // east, north, and up where there is a third

/// Longitude and latitude, and the third number as it is.
std::string positions(const Corners& corners, const char* begin, const char* comma, const char* end, const char* next) {
  const geo::LocalFrame frame(kOrigin);
  std::string text;
  Corners closed = corners;
  closed.push_back(corners.front());
  for (const std::vector<double>& corner : closed) {
    const geo::LonLat at = frame.to_lonlat({corner[0], corner[1]});
    char place[96];
    std::snprintf(place, sizeof place, "%.10f%s%.10f", at.longitude_deg, comma, at.latitude_deg);
    text += (text.empty() ? "" : next) + (begin + std::string(place));
    if (corner.size() > 2) {
      std::snprintf(place, sizeof place, "%s%.6f", comma, corner[2]);
      text += place;
    }
    text += end;
  }
  return text;
}
std::string json_ring(const Corners& corners) { return "[" + positions(corners, "[", ", ", "]", ", ") + "]"; }

std::string feature(const std::string& coordinates, const std::string& properties = "{}",
                    const std::string& type = "Polygon") {
  return R"({"type": "Feature", "properties": )" + properties + R"(, "geometry": {"type": ")" + type +
         R"(", "coordinates": [)" + coordinates + "]}}";
}
std::string collection(const std::string& features) {
  return R"({"type": "FeatureCollection", "features": [)" + features + "]}";
}

std::string placemark(const std::string& name, const std::string& more, const Corners& corners,
                      const std::string& holes = "") {
  return "<Placemark><name>" + name + "</name><Polygon>" + more + "<outerBoundaryIs><LinearRing><coordinates>" +
         positions(corners, "", ",", "", " ") + "</coordinates></LinearRing></outerBoundaryIs>" + holes +
         "</Polygon></Placemark>";
}
std::string kml(const std::string& placemarks) {
  return "<?xml version=\"1.0\"?><kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>" + placemarks +
         "</Document></kml>";
}
std::string mode(const std::string& name) { return "<altitudeMode>" + name + "</altitudeMode>"; }

// ---- archives

std::string number(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 0xFF);
  return text;
}

std::string deflated(const std::string& text) {
  z_stream stream = {};
  deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

/// What an archive says of a file in it; a test may make it say something else.
struct ZipFile {
  std::string name, content;
  bool is_packed = true;
  std::uint32_t flags = 0, method = 8, said_bytes = UINT32_MAX, checksum = 0;
  std::uint32_t shift = 0;  ///< of where it begins
};

std::string zip(const std::vector<ZipFile>& files) {
  std::string text, directory;
  for (const ZipFile& file : files) {
    const std::string packed = file.is_packed ? deflated(file.content) : file.content;
    const auto bytes = static_cast<std::uint32_t>(file.content.size());
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(file.content.data()), bytes) ^ file.checksum;
    const std::uint32_t method = file.is_packed ? file.method : 0;
    const std::uint32_t said = file.said_bytes == UINT32_MAX ? bytes : file.said_bytes;
    const std::string about = number(method, 2) + number(0, 4) + number(static_cast<std::uint32_t>(sum), 4) +
                              number(static_cast<std::uint32_t>(packed.size()), 4) + number(said, 4) +
                              number(static_cast<std::uint32_t>(file.name.size()), 2);
    directory += "PK\1\2" + number(20, 2) + number(20, 2) + number(file.flags, 2) + about + number(0, 2) +
                 number(0, 2) + number(0, 2) + number(0, 2) + number(0, 4) +
                 number(static_cast<std::uint32_t>(text.size()) + file.shift, 4) + file.name;
    text += "PK\3\4" + number(20, 2) + number(file.flags, 2) + about + number(0, 2) + file.name + packed;
  }
  const std::string end = std::string("PK\5\6") + number(0, 4) + number(static_cast<std::uint32_t>(files.size()), 2) +
                          number(static_cast<std::uint32_t>(files.size()), 2) +
                          number(static_cast<std::uint32_t>(directory.size()), 4) +
                          number(static_cast<std::uint32_t>(text.size()), 4) + number(0, 2);
  return text + directory + end;
}

class TargetFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    MapText map(kOrigin);
    map.box(-10, -10, 10, 10, {{"building", "yes"}, {"height", "12"}});
    write_bytes(folder_ / "city.osm", map.text());
  }

  Mission placed(const std::string& target, const std::string& scene = "") {
    write_bytes(folder_ / "mission.yaml", "scene: {osm: city.osm, center: [48.1374, 11.5755], radius: 300" + scene +
                                              "}\nsensor: {max_range: 90}\ntarget: {" + target + "}\n");
    return resolve_mission(read_mission(folder_ / "mission.yaml"));
  }
  /// The target of a file, or of one feature of it.
  Target of_file(const std::string& file, const std::string& feature = "") {
    return placed("file: " + file + (feature.empty() ? "" : ", feature: " + feature)).target;
  }
  void write(const std::string& name, const std::string& text) { write_bytes(folder_ / name, text); }
  void refuse(const std::string& target, ErrorCode code, const std::string& where = "") {
    testing::expect_error([&] { placed(target); }, code, where);
  }

  TemporaryDirectory folder_;
};

const Corners kSquare = {{30, 0}, {50, 0}, {50, 20}, {30, 20}};
const Corners kBent = {{30, 0}, {50, 0}, {50, 20}, {40, 5}};

double plan_area(const Target& target) {
  double area = 0;
  for (const std::vector<Vec3>& part : target.parts) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Vec3 &a = part[i], &b = part[(i + 1) % part.size()];
      area += (a.x() * b.y() - a.y() * b.x()) / 2;
    }
  }
  return std::abs(area);
}

/// The lowest and the highest corner.
std::pair<double, double> heights(const Target& target) {
  std::pair<double, double> range = {INFINITY, -INFINITY};
  for (const std::vector<Vec3>& part : target.parts) {
    for (const Vec3& corner : part) {
      range.first = std::min(range.first, corner.z());
      range.second = std::max(range.second, corner.z());
    }
  }
  return range;
}

Corners raised(const Corners& corners, double z) {
  Corners result = corners;
  for (std::vector<double>& corner : result) corner.push_back(z);
  return result;
}

TEST_F(TargetFiles, APolygonOfGeoJsonLiesOnTheGround) {
  write("a square.geojson", collection(feature(json_ring(kSquare))));
  const Mission mission = placed("file: a square.geojson");
  EXPECT_EQ(mission.target.name, "a square") << "of the file: the feature has no name";
  EXPECT_NEAR(plan_area(mission.target), 400, 0.1);
  EXPECT_EQ(heights(mission.target), std::pair(0.0, 0.0));
  ASSERT_EQ(mission.target.parts.size(), 1u);
  const std::vector<Vec3>& part = mission.target.parts[0];
  EXPECT_TRUE(std::any_of(part.begin(), part.end(),
                          [](const Vec3& corner) { return (corner - Vec3(30, 0, 0)).norm() < 1e-3; }));
  EXPECT_EQ(run_mission(mission).volume.outcome, Outcome::computed);
  write("bent.geojson", R"({"type": "Polygon", "coordinates": [)" + json_ring(kBent) + "]}");
  EXPECT_GT(of_file("bent.geojson").parts.size(), 1u);
}

TEST_F(TargetFiles, CornersWithHeightsLieThere) {
  write("deck.geojson", feature(json_ring(raised(kSquare, 30)), R"({"name": "deck"})"));
  const Mission deck = placed("file: deck.geojson, offset: 0.5");
  EXPECT_EQ(deck.target.name, "deck");
  EXPECT_EQ(heights(deck.target), std::pair(30.0, 30.0));
  EXPECT_EQ(deck.target.offset_m, 0.5);
  // Askew, not convex, with a hole: parts in one plane.
  const Corners askew = {{20, -30, 20}, {60, -30, 24}, {60, 30, 24}, {40, -10, 22}, {20, 30, 20}};
  const Corners hole = {{25, -25, 20.5}, {30, -25, 21}, {30, -20, 21}};
  write("askew.geojson", feature(json_ring(askew) + ", " + json_ring(hole)));
  const Mission bent = placed("file: askew.geojson");
  EXPECT_NEAR(plan_area(bent.target), 2400 - 800 - 12.5, 0.1);
  EXPECT_GT(bent.target.parts.size(), 2u);
  for (const std::vector<Vec3>& part : bent.target.parts) {
    for (const Vec3& corner : part) EXPECT_NEAR(corner.z(), 18 + 0.1 * corner.x(), 1e-4);
  }
  write("uneven.geojson", feature(json_ring({{30, 0, 30}, {50, 0, 30}, {50, 20, 31}, {40, 5, 30}})));
  refuse("file: uneven.geojson", ErrorCode::target_not_planar, "mission.yaml:3:");
  write("inside.geojson", feature(json_ring({{-5, -5, 3}, {5, -5, 3}, {5, 5, 3}})));
  refuse("file: inside.geojson", ErrorCode::target_inside_solid, "mission.yaml:3:");
}

TEST_F(TargetFiles, HeightsAtSomeCornersAreRefused) {
  const Corners some = {{30, 0, 30}, {50, 0}, {50, 20, 30}, {30, 20, 30}};
  write("some.geojson", feature(json_ring(some)));
  refuse("file: some.geojson", ErrorCode::wrong_type, "some.geojson");
  write("hole.geojson", feature(json_ring(raised(kSquare, 30)) + ", " + json_ring({{35, 5}, {40, 5}, {40, 10}})));
  refuse("file: hole.geojson", ErrorCode::wrong_type, "hole.geojson");
  write("some.kml", kml(placemark("deck", mode("absolute"), some)));
  refuse("file: some.kml", ErrorCode::wrong_type, "some.kml");
  write("above.kml", kml(placemark("deck", mode("relativeToGround"), some)));
  refuse("file: above.kml", ErrorCode::wrong_type, "above.kml");
  write("clamped.kml", kml(placemark("deck", "", some)));
  EXPECT_EQ(heights(of_file("clamped.kml")), std::pair(0.0, 0.0)) << "they do not count";
}

TEST_F(TargetFiles, AHoleMayStandBeforeItsOutline) {
  const std::string hole = positions({{35, 5, 20.5}, {40, 5, 21}, {40, 10, 21}}, "", ",", "", " ");
  const std::string before = mode("absolute") + "<innerBoundaryIs><LinearRing><coordinates>" + hole +
                             "</coordinates></LinearRing></innerBoundaryIs>";
  write("holed.kml", kml(placemark("deck", before, {{30, 0, 20}, {50, 0, 22}, {50, 20, 22}, {30, 20, 20}})));
  const Mission holed = placed("file: holed.kml", ", sea_level: 0");
  EXPECT_NEAR(plan_area(holed.target), 400 - 12.5, 0.1);
  for (const std::vector<Vec3>& part : holed.target.parts) {
    for (const Vec3& corner : part) EXPECT_NEAR(corner.z(), 17 + 0.1 * corner.x(), 1e-4);
  }
}

TEST_F(TargetFiles, UprightPolygonsAreRefusedWithWhatToUse) {
  refuse("outline: [[30, 0, 0], [50, 0, 0], [50, 0, 9], [30, 0, 9]]", ErrorCode::zone_not_simple, "mission.yaml:3:");
  write("wall.geojson", feature(json_ring({{30, 0, 0}, {50, 0, 0}, {50, 0, 9}, {30, 0, 9}})));
  refuse("file: wall.geojson", ErrorCode::zone_not_simple, "wall.geojson");
  refuse("outline: [[30, 0, 0], [50, 0, 0], [50, 0.002, 9], [30, 0.002, 9]]", ErrorCode::target_without_area,
         "mission.yaml:3:");
}

TEST_F(TargetFiles, OneOfSeveralFeaturesIsChosen) {
  write("areas.geojson",
        collection(feature(json_ring(kSquare), R"({"name": "North lot"})") + "," +
                   feature(json_ring(kBent), R"({"id": 7, "name": "South lot"})") + "," +
                   feature("[" + json_ring(kSquare) + "], [" + json_ring({{60, 0}, {70, 0}, {70, 9}}) + "]", "{}",
                           "MultiPolygon")));
  refuse("file: areas.geojson", ErrorCode::missing_key, "areas.geojson");
  refuse("file: areas.geojson, feature: East lot", ErrorCode::object_missing, "areas.geojson");
  EXPECT_NEAR(plan_area(of_file("areas.geojson", "North lot")), 400, 0.1);
  EXPECT_NEAR(plan_area(of_file("areas.geojson", "NORTH LOT")), 400, 0.1);
  EXPECT_NEAR(plan_area(of_file("areas.geojson", "7")), 150, 0.1) << "by the id";
  const Mission south = placed("file: areas.geojson, feature: South lot");
  EXPECT_NEAR(plan_area(south.target), 150, 0.1);
  EXPECT_EQ(south.target.name, "South lot");
  const Mission both = placed("file: areas.geojson, feature: 2");
  EXPECT_NEAR(plan_area(both.target), 400 + 45, 0.1) << "of a MultiPolygon all parts must be seen";
  EXPECT_EQ(both.target.name, "areas");
  write("twice.geojson", collection(feature(json_ring(kSquare), R"({"name": "lot"})") + "," +
                                    feature(json_ring(kBent), R"({"name": "lot"})")));
  refuse("file: twice.geojson, feature: lot", ErrorCode::conflicting_keys, "twice.geojson");
}

TEST_F(TargetFiles, KmlSaysFromWhereItsHeightsAre) {
  write("ground.kml", kml(placemark("yard", "", raised(kSquare, 30))));
  const Mission ground = placed("file: ground.kml");
  EXPECT_EQ(ground.target.name, "yard");
  EXPECT_EQ(heights(ground.target), std::pair(0.0, 0.0)) << "clamped to the ground";
  write("two.kml",
        kml("<Placemark><name>a line</name></Placemark>" + placemark("", "", kSquare) + placemark("", "", kBent)));
  EXPECT_NEAR(plan_area(of_file("two.kml", "2")), 150, 0.1) << "placemarks are counted from 0";
  write("above.kml", kml(placemark("deck", mode("relativeToGround"), raised(kSquare, 30))));
  EXPECT_EQ(heights(of_file("above.kml")), std::pair(30.0, 30.0));
  write("uneven.kml", kml(placemark("deck", mode("relativeToGround"), {{30, 0, 9}, {50, 0, 9}, {50, 20, 8}})));
  refuse("file: uneven.kml", ErrorCode::target_not_planar, "uneven.kml");
  write("sea.kml", kml(placemark("deck", mode("absolute"), raised(kSquare, 530))));
  refuse("file: sea.kml", ErrorCode::heights_differ, "sea.kml");
  const Mission sea = placed("file: sea.kml", ", sea_level: -500");
  EXPECT_EQ(heights(sea.target), std::pair(30.0, 30.0));
  // Of two polygons one is on the ground, and the other one above it.
  const auto polygon = [](const std::string& how) {
    const std::string mark = placemark("", mode(how), raised(kSquare, 5));
    const std::size_t begin = mark.find("<Polygon>");
    return mark.substr(begin, mark.find("</Placemark>") - begin);
  };
  for (const bool is_ground_first : {true, false}) {
    const std::string one = polygon("clampToGround"), other = polygon("relativeToGround");
    write("mixed.kml", kml("<Placemark><name>decks</name><MultiGeometry>" +
                           (is_ground_first ? one + other : other + one) + "</MultiGeometry></Placemark>"));
    refuse("file: mixed.kml", ErrorCode::target_not_planar, "mixed.kml");
  }
}

TEST_F(TargetFiles, KmzIsUnpacked) {
  const std::string yard = kml(placemark("yard", "", kSquare)), other = kml(placemark("other", "", kBent));
  write("a.kmz", zip({{"files/icon.png", std::string(3000, 'x')}, {"other.kml", other}, {"doc.kml", yard}}));
  EXPECT_EQ(of_file("a.kmz").name, "yard") << "doc.kml counts before others";
  write("b.kmz", zip({{"__MACOSX/other.kml", "notes"}, {"Folder/Other.KML", other, false}}));
  EXPECT_EQ(of_file("b.kmz").name, "other") << "stored as it is, under any name";
  ZipFile streamed = {"doc.kml", yard};
  streamed.flags = 8;  // sizes behind the bytes: the directory has them too
  write("streamed.kmz", zip({streamed}));
  EXPECT_EQ(of_file("streamed.kmz").name, "yard");
  write("zones.kmz", zip({{"doc.kml", kml(placemark("park", "", kSquare))}}));
  write("mission.yaml",
        "scene: {osm: city.osm, center: [48.1374, 11.5755], radius: 300}\nsensor: {max_range: 90}\n"
        "target: {file: a.kmz}\nnavigation: {keep_out: [{file: zones.kmz, z: [0, 9]}]}\n");
  const Mission mission = resolve_mission(read_mission(folder_ / "mission.yaml"));
  ASSERT_EQ(mission.navigation.keep_out.size(), 1u);
  EXPECT_EQ(mission.navigation.keep_out[0].name, "zones.kmz park");
}

TEST_F(TargetFiles, OtherZonesOfAnArchiveAreNotLost) {
  const std::string park = kml(placemark("park", "", kSquare));
  for (const std::string name : {"nfz.kml", "doc.kml", "files/Other.KML", "nfz.kmz"}) {
    write("zones.kmz", zip({{"doc.kml", park}, {name, park}, {"__MACOSX/doc.kml", "notes"}, {"a.png", "x"}}));
    write("yard.kml", park);
    const auto resolve = [&](const std::string& more) {
      write("mission.yaml",
            "scene: {osm: city.osm, center: [48.1374, 11.5755], radius: 300}\nsensor: {max_range: 90}\n"
            "target: {file: yard.kml}\nnavigation: {keep_out: [{file: zones.kmz, z: [0, 9]" +
                more + "}]}\n");
      return resolve_mission(read_mission(folder_ / "mission.yaml"));
    };
    testing::expect_error([&] { resolve(""); }, ErrorCode::value_unsupported, "zones.kmz, " + name);
    EXPECT_EQ(resolve(", skip: true").navigation.keep_out.size(), 1u);
  }
}

TEST_F(TargetFiles, HostileArchivesAreRefused) {
  const std::string yard = kml(placemark("yard", "", kSquare));
  const auto refuse_archive = [&](const std::string& bytes, ErrorCode code = ErrorCode::zone_file_syntax) {
    write("bad.kmz", bytes);
    refuse("file: bad.kmz", code, "bad.kmz");
  };
  const auto with = [&](auto change) {
    ZipFile file = {"doc.kml", yard};
    change(file);
    return zip({file});
  };
  refuse_archive("PK\3\4");
  const std::string whole = zip({{"doc.kml", yard}}), ones(4, '\xFF');
  std::string zip64 = whole;
  refuse_archive(zip64.replace(whole.rfind("PK\1\2") + 24, 4, ones));
  zip64 = whole;
  refuse_archive(zip64.replace(whole.rfind("PK\5\6") + 16, 4, ones));
  refuse_archive(zip({{"doc.kml", yard}}).substr(0, 300));
  refuse_archive(zip({{"readme.txt", yard}}));
  refuse_archive(with([](ZipFile& file) { file.flags = 1; }));
  refuse_archive(with([](ZipFile& file) { file.method = 12; }));
  refuse_archive(with([](ZipFile& file) { file.checksum = 1; }));
  refuse_archive(with([](ZipFile& file) { file.said_bytes = 17; }));
  refuse_archive(with([](ZipFile& file) { file.said_bytes = 63'000'000; }));  // it would be made before it is read
  refuse_archive(with([](ZipFile& file) { file.said_bytes = 65'000'000; }), ErrorCode::file_too_large);
  refuse_archive(with([](ZipFile& file) { file.shift = 9; }));
  refuse_archive(with([](ZipFile& file) { file.shift = 0xFFFFFF00; }));
  refuse_archive(zip({{"doc.kml", zip({{"doc.kml", yard}})}}));
  // A bomb: it says little, and holds much.
  refuse_archive(with([](ZipFile& file) {
    file.content = std::string(200'000'000, ' ');
    file.said_bytes = 1'000'000;
  }));
  // Every byte of a small archive is flipped: never a crash, and only a name or a remark may change unnoticed.
  const std::string good = zip({{"doc.kml", yard}});
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bytes = good;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x55);
    write("flipped.kmz", bytes);
    try {
      EXPECT_NEAR(plan_area(of_file("flipped.kmz")), 400, 0.1) << "byte " << i;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << "byte " << i << error.what();
    }
  }
}

TEST_F(TargetFiles, WhatIsNoTargetIsRefused) {
  write("points.geojson", R"({"type": "Point", "coordinates": [11.5755, 48.1374]})");
  refuse("file: points.geojson", ErrorCode::nothing_given, "points.geojson");
  write("far.geojson", feature(json_ring({{200e3, 0}, {200.1e3, 0}, {200e3, 100}})));
  refuse("file: far.geojson", ErrorCode::too_far_away, "far.geojson");
  write("crossing.geojson", feature(json_ring({{0, 20}, {9, 29}, {9, 20}, {0, 29}})));
  refuse("file: crossing.geojson", ErrorCode::zone_not_simple, "crossing.geojson");
  write("circle.geojson", R"({"type": "Point", "coordinates": [11.5755, 48.1374],
                           "extent": {"subType": "Circle", "radius": 20}})");
  refuse("file: circle.geojson", ErrorCode::value_unsupported, "circle.geojson");
  refuse("file: missing.geojson", ErrorCode::file_not_found, "mission.yaml:3:");
  write("a.geojson", feature(json_ring(kSquare)));
  refuse("file: a.geojson, center: [48, 11]", ErrorCode::conflicting_keys, "mission.yaml:3:");
  refuse("feature: a, point: [0, 0, 30]", ErrorCode::missing_key, "mission.yaml:3:");
  write("swapped.geojson", feature("[[48.1374, 11.5755], [48.1376, 11.5755], [48.1376, 11.5757], [48.1374, 11.5755]]"));
  refuse("file: swapped.geojson", ErrorCode::too_far_away, "swapped.geojson");
  write("half.geojson",
        feature("[" + json_ring(kSquare) + "], [" + json_ring(raised(kBent, 30)) + "]", "{}", "MultiPolygon"));
  refuse("file: half.geojson", ErrorCode::wrong_type, "half.geojson");
}

TEST_F(TargetFiles, TheyAreWrittenIntoMissionsAndKept) {
  write("a.geojson",
        collection(feature(json_ring(kSquare), R"({"name": "North: lot"})") + "," + feature(json_ring(kBent))));
  const Mission mission = placed("file: a.geojson, feature: 'North: lot'");
  write("again.yaml", mission_text(mission.as_written, folder_.path()));
  const Mission again = resolve_mission(read_mission(folder_ / "again.yaml"));
  EXPECT_EQ(mission_hash(again), mission_hash(mission));
  EXPECT_EQ(again.target.name, "North: lot");
  const auto inputs = input_files(again.as_written);
  const auto is_input = [](const auto& file) { return file.filename() == "a.geojson"; };
  EXPECT_EQ(std::count_if(inputs.begin(), inputs.end(), is_input), 1) << "results may not take its place";
}

// ---- outlines of the mission itself

TEST_F(TargetFiles, OutlinesMayHaveHeights) {
  const Mission deck = placed("outline: [[30, 0, 30], [50, 0, 30], [50, 20, 30], [40, 5, 30]]");
  EXPECT_NEAR(plan_area(deck.target), 150, 0.01);
  EXPECT_EQ(heights(deck.target), std::pair(30.0, 30.0));
  const Mission convex = placed("outline: [[30.00001, 0, 30], [50, 0, 30], [50, 20, 32], [30.00001, 20, 32]]");
  ASSERT_EQ(convex.target.parts.size(), 1u);
  EXPECT_EQ(convex.target.parts[0][0], Vec3(30.00001, 0, 30)) << "a convex one stays as it is, to the bit";
  refuse("outline: [[30, 0, 30], [50, 0, 30], [50, 20]]", ErrorCode::wrong_type, "mission.yaml:3:");
  refuse("outline: [[30, 0, 30], [50, 0, 30], [50, 20, 32], [40, 5, 30]]", ErrorCode::target_not_planar,
         "mission.yaml:3:");
}

TEST_F(TargetFiles, OutlinesThatAreCutMayNotBeNearlyUpright) {
  const auto leaning = [](double slope, bool is_convex) {
    std::ostringstream text;
    text << "outline: [[30, 0, 30], [31, 0, " << 30 + slope << "], [31, 20, " << 30 + slope << "], ";
    if (!is_convex) text << "[30.5, 5, " << 30 + slope / 2 << "], ";
    text << "[30, 20, 30]]";
    return text.str();
  };
  EXPECT_EQ(placed(leaning(30, true)).target.parts.size(), 1u);
  EXPECT_GT(placed(leaning(7, false)).target.parts.size(), 1u);
  refuse(leaning(30, false), ErrorCode::target_not_planar, "mission.yaml:3:");
}

TEST_F(TargetFiles, NoOutlineIsLeftOutUnsaid) {
  const std::string square = "[[30, 0], [50, 0], [50, 20], [30, 20]]", sliver = "[[60, 0], [90, 0], [90, 0.005]]";
  refuse("outline: [" + square + ", " + sliver + "]", ErrorCode::target_without_area, "mission.yaml:3:");
  refuse(
      "outline: [[[30, 0, 9], [50, 0, 9], [50, 20, 9], [30, 20, 9]], [[60, 0, 9], [90, 0, 9], [90, 0.005, 9], [60, "
      "0.005, 9]]]",
      ErrorCode::target_without_area, "mission.yaml:3:");
  write("sliver.geojson", feature("[" + json_ring(kSquare) + "], [" + json_ring({{60, 0}, {90, 0}, {90, 0.005}}) + "]",
                                  "{}", "MultiPolygon"));
  refuse("file: sliver.geojson", ErrorCode::target_without_area, "mission.yaml:3:");
}

TEST_F(TargetFiles, AnOutlineIsConvexAsItIsGivenOrNotAtAll) {
  // A dent of 0.05 mm is less than the rounding of corners that are cut into parts: what is rounded is convex.
  const Mission dented = placed("outline: [[30, 0, 30], [50, 0, 30], [50, 20, 30], [40, 19.99995, 30], [30, 20, 30]]");
  EXPECT_NEAR(plan_area(dented.target), 400, 0.1);
  EXPECT_EQ(heights(dented.target), std::pair(30.0, 30.0));
}

TEST_F(TargetFiles, ThereMayBeSeveralOutlines) {
  const std::string two = "outline: [[[30, 0], [50, 0], [50, 20], [30, 20]], [[60, 0], [90, 0], [90, 30], [60, 30]]]";
  EXPECT_NEAR(plan_area(placed(two).target), 400 + 900, 0.01);
  const Mission holed = placed(two + ", holes: [[[70, 10], [80, 10], [80, 20], [70, 20]]]");
  EXPECT_NEAR(plan_area(holed.target), 400 + 900 - 100, 0.01);
  write("again.yaml", mission_text(holed.as_written, folder_.path()));
  EXPECT_EQ(mission_hash(resolve_mission(read_mission(folder_ / "again.yaml"))), mission_hash(holed));
  refuse(two + ", holes: [[[100, 10], [110, 10], [110, 20]]]", ErrorCode::value_out_of_range, "mission.yaml:3:");
  refuse("outline: [[[30, 0], [50, 0], [50, 20]], [[60, 0, 1], [90, 0, 1], [90, 30, 1]]]", ErrorCode::wrong_type,
         "mission.yaml:3:");
}

}  // namespace
}  // namespace vantage
