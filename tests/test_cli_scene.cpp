// vantage scene as its users run it: what it writes, what it says, and what it refuses.
#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "support/osm_maps.h"
#include "vantage/scene.h"

namespace vantage::testing {
namespace {

using nlohmann::json;

constexpr const char* kWgs84 =
    "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
    "UNIT[\"degree\",0.0174532925199433]]";
constexpr const char* kCentre = "48.1374,11.5755";

/// Heights of 500 m round the centre of the maps; `corner`: the height of the first post.
std::string grid_of_heights(const std::string& corner, double west = 11.5655, const char* nodata = "-9999") {
  std::string grid = "ncols 41\nnrows 41\nxllcenter " + std::to_string(west) +
                     "\nyllcenter 48.1274\ncellsize 0.0005\nNODATA_value " + nodata + "\n" + corner;
  for (int post = 1; post < 41 * 41; ++post) grid += post % 41 == 0 ? "\n500.0" : " 500.0";
  return grid + "\n";
}

class CliScene : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    MapText map;
    map.box(10, 20, 30, 50, {{"building", "yes"}, {"height", "12"}, {"name", "Block"}});
    map.box(-30, -30, -10, -10, {{"building", "house"}});
    map.line({{0, -60}, {40, -60}}, {{"barrier", "wall"}});
    map.node(50, 50, {{"natural", "tree"}});
    write("city.osm", map.text());
    write("scene.glb", kOldOutput);
    write("scene.report.json", kOldReport);
  }

  void write_dem(const std::string& name, const std::string& grid, const std::string& system = kWgs84) {
    write(name + ".asc", grid);
    if (!system.empty()) write(name + ".prj", system);
  }

  void expect_bad_map(const std::string& text, const std::vector<std::string>& more = {}) {
    write("bad.osm", text);
    std::vector<std::string> arguments = {"scene", "bad.osm", "-o", "scene.glb"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_bad(arguments, "");
  }
  void expect_bad_option(const std::vector<std::string>& more, const std::string& where) {
    std::vector<std::string> arguments = {"scene", "city.osm", "-o", "scene.glb"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_bad(arguments, where);
  }

  /// The report on a map that is written all the same.
  json report_of(const std::string& text, const std::vector<std::string>& more = {}) {
    write("odd.osm", text);
    std::vector<std::string> arguments = {"scene", "odd.osm", "-q", "-o", "odd.obj"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(output_of(arguments), "");
    return json::parse(content(folder_ / "odd.report.json"));
  }
};

using CliSceneBadMap = CliScene;
using CliSceneBadTerrain = CliScene;
using CliSceneBadOption = CliScene;
using CliSceneBadOutput = CliScene;
using CliSceneMended = CliScene;

TEST_F(CliScene, InspectTellsWhatMapsAndRastersHold) {
  const std::string table = output_of({"inspect", "city.osm"});
  for (const char* expected : {"building", "wall", "tree", "latitude", "triangles", "open edges", "convex polygons"}) {
    EXPECT_NE(table.find(expected), std::string::npos) << table;
  }
  const json map = json::parse(output_of({"inspect", "city.osm", "--json"}));
  EXPECT_EQ(map.at("kinds").at("building"), 2);
  EXPECT_EQ(map.at("objects"), 5) << "four, and the ground";
  EXPECT_EQ(map.at("open_edges"), 4) << "of the ground";
  EXPECT_EQ(map.at("records").size(), 4U);
  const auto bounds = map.at("map_bounds_deg").get<std::vector<double>>();
  EXPECT_NEAR(bounds.at(1), 48.1374 - 60 / 111200.0, 1e-4);
  EXPECT_NEAR(map.at("georeference").at("latitude_deg").get<double>(), 48.1374, 1e-3);
  EXPECT_GT(map.at("bounds").at("max")[2].get<double>(), 11.9);
  const json part = json::parse(
      output_of({"inspect", "city.osm", "--json", "--center", kCentre, "--radius", "45", "--without", "trees"}));
  EXPECT_EQ(part.at("records").size(), 2U);

  write_dem("dem", grid_of_heights("520.0"));
  const json raster = json::parse(output_of({"inspect", "dem.asc", "--json"}));
  EXPECT_EQ(raster.at("raster").at("columns"), 41);
  EXPECT_EQ(raster.at("raster").at("highest_m"), 520);
  EXPECT_NEAR(raster.at("georeference").at("longitude_deg").get<double>(), 11.5755, 1e-4);
  EXPECT_NE(output_of({"inspect", "dem.asc"}).find("posts"), std::string::npos);
  expect_bad({"inspect", "dem.asc", "--up", "y"}, "--up");
  expect_bad({"inspect", "city.osm", "--lod", "2"}, "--lod");
}

TEST_F(CliScene, WithoutAnOutputItReportsOnly) {
  const std::vector<std::string> before = {content(folder_ / "scene.glb"), content(folder_ / "scene.report.json")};
  const auto files = [&] { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); };
  const auto count = files();
  const std::string table = output_of({"scene", "city.osm"});
  EXPECT_NE(table.find("building"), std::string::npos) << table;
  const json report = json::parse(output_of({"scene", "city.osm", "--json"}));
  EXPECT_EQ(report.at("kinds").at("building"), 2);
  EXPECT_EQ(report.at("bounds").at("min").size(), 3U);
  EXPECT_EQ(output_of({"scene", "city.osm", "-q"}), "");
  EXPECT_EQ(files(), count);
  EXPECT_EQ(content(folder_ / "scene.glb"), before[0]);
  const std::string old_report = content(folder_ / "scene.report.json");
  EXPECT_EQ(old_report, before[1]);
}

TEST_F(CliScene, NumbersMayHaveBlanksBetweenThem) {
  const auto place = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"scene", "city.osm", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return json::parse(output_of(arguments)).at("georeference");
  };
  const json plain = place({"--center", "48.1374,11.5755", "--radius", "90"});
  for (const char* const centre : {"48.1374, 11.5755", " 48.1374 ,11.5755 ", "48.1374,\t+11.5755"}) {
    EXPECT_EQ(place({"--center", centre, "--radius", "90"}), plain) << centre;
  }
  EXPECT_EQ(place({"--bbox", "11.574,48.136,11.577,48.139"}), place({"--bbox", "11.574, 48.136, 11.577, 48.139"}));
  write_dem("dem", grid_of_heights("520.0"));
  const json raster = json::parse(
      output_of({"scene", "dem.asc", "--json", "--window", "1, 2, 10, 20", "--origin", "48.1374, 11.5755"}));
  EXPECT_EQ(raster.at("raster").at("rows"), 20);
  EXPECT_EQ(raster.at("georeference").at("latitude_deg"), 48.1374);
  for (const char* const centre :
       {"48.1374 11.5755", "48.1374,", ",11.5", "48,1374,11,5755", "48.1374, 11.5755,", "nan, 1"}) {
    expect_bad_option({"--center", centre, "--radius", "90"}, "--center");
  }
}

TEST_F(CliScene, WritesEveryFormatAndAReport) {
  const std::string summary = output_of({"scene", "city.osm", "-o", "scene.glb", "-o", "scene.obj", "-o", "scene.ply",
                                         "-o", "scene.stl", "--center", kCentre, "--radius", "300"});
  for (const char* expected : {"origin", "48.137400, 11.575500", "what is built", "building", "wall", "tree"}) {
    EXPECT_NE(summary.find(expected), std::string::npos) << summary;
  }
  std::size_t triangles = 0;
  for (const char* name : {"scene.glb", "scene.obj", "scene.ply", "scene.stl"}) {
    const Scene scene = read_scene(folder_ / name);
    if (triangles == 0) triangles = scene.mesh.triangles.size();
    EXPECT_EQ(scene.mesh.triangles.size(), triangles) << name;
    ASSERT_TRUE(scene.georeference) << name;
    EXPECT_NEAR(scene.georeference->latitude_deg, 48.1374, 1e-12) << name;
    EXPECT_NEAR(bounding_box(scene.mesh).max.z(), 12, 1e-6) << name;
  }
  const auto report = json::parse(content(folder_ / "scene.report.json"));
  EXPECT_EQ(report.at("triangles"), triangles);
  EXPECT_EQ(report.at("kinds").at("building"), 2);
  EXPECT_EQ(report.at("georeference").at("longitude_deg"), 11.5755);
  EXPECT_EQ(report.at("georeference").at("attribution"), kOpenStreetMapCredit);
  EXPECT_EQ(report.at("records").size(), 4U);
}

TEST_F(CliScene, KeepsNamesWhereTheFormatHasThem) {
  output_of({"scene", "city.osm", "-q", "-o", "scene.glb", "-o", "scene.obj"});
  for (const char* name : {"scene.glb", "scene.obj"}) {
    const std::vector<SceneObject> objects = read_scene(folder_ / name).objects;
    EXPECT_EQ(objects.at(0), (SceneObject{"Block", "way/1", ObjectKind::building})) << name;
    EXPECT_EQ(objects.back(), (SceneObject{"ground", "", ObjectKind::ground})) << name;
  }
}

TEST_F(CliScene, NoReportOfTheUsersOwnIsReplaced) {
  write("scene.report.json", "{\"my\": \"notes\"}");
  expect_bad({"scene", "city.osm", "-o", "scene.glb"}, "scene.report.json");
  write("own.stl.place.json", "{\"my\": \"place\"}");
  expect_bad({"scene", "city.osm", "-o", "own.stl"}, "own.stl.place.json");
}

TEST_F(CliScene, LengthsMayHaveAUnit) {
  const auto size = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"scene", "city.osm", "--json", "--center", kCentre};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return json::parse(output_of(arguments)).at("bounds");
  };
  EXPECT_EQ(size({"--radius", "100 ft"}), size({"--radius", "30.48"}));
  EXPECT_NE(size({"--radius", "100 ft"}), size({"--radius", "100"}));
  expect_bad_option({"--center", kCentre, "--radius", "100 yd"}, "--radius");
  expect_bad_option({"--center", kCentre, "--radius", "-5 m"}, "--radius");
}

TEST_F(CliScene, PrintsTheReportAsJsonAndIsQuiet) {
  const std::string printed = output_of({"scene", "city.osm", "--json", "-o", "scene.glb"});
  const std::string written = content(folder_ / "scene.report.json");
  EXPECT_EQ(json::parse(printed), json::parse(written));
  EXPECT_EQ(output_of({"scene", "city.osm", "--quiet", "-o", "scene.glb"}), "");
  EXPECT_NE(content(folder_ / "scene.glb"), kOldOutput);
}

TEST_F(CliScene, LeavesOutAndSetsDefaults) {
  output_of({"scene", "city.osm", "-q", "-o", "a.obj", "--without", "walls", "--without", "trees", "--set",
             "levels.house=5", "--set", "level=4"});
  const auto report = json::parse(content(folder_ / "a.report.json"));
  ASSERT_EQ(report.at("records").size(), 2U);
  EXPECT_NEAR(report.at("records")[1].at("top_m").get<double>(), 20, 1e-9);
}

TEST_F(CliScene, MeshesAndRastersBecomeScenesToo) {
  write_dem("dem", grid_of_heights("480"));
  output_of({"scene", "dem.asc", "-q", "-o", "dem.ply"});
  EXPECT_NEAR(bounding_box(read_scene(folder_ / "dem.ply").mesh).min.z(), 480, 1e-6);
  output_of({"scene", "city.obj", "--origin", kCentre, "-q", "-o", "placed.obj"});
  EXPECT_NEAR(read_scene(folder_ / "placed.obj").georeference.value().longitude_deg, 11.5755, 1e-12);
}

// ---- maps ----

TEST_F(CliSceneBadMap, NotAMap) {
  expect_bad({"scene", "none.osm", "-o", "scene.glb"}, "none.osm");
  expect_bad({"scene", ".", "-o", "scene.glb"}, ".");
  expect_bad_map("");
  expect_bad_map("hello\n");
  expect_bad_map("<html><body>429 Too Many Requests</body></html>");
  expect_bad_map("<osm version='0.6'>\n<node id='1' lat='1' lon='1'>\n");
}

TEST_F(CliSceneBadMap, NothingInIt) {
  expect_bad_map("<osm version='0.6'></osm>\n");
  MapText map;
  map.line({{0, 0}, {100, 0}}, {{"highway", "residential"}});
  expect_bad_map(map.text());
}

TEST_F(CliSceneBadMap, Truncated) {
  VANTAGE_REQUIRE_OSMIUM();
  osmium({"cat", "-o", (folder_ / "city.osm.pbf").string(), (folder_ / "city.osm").string()});
  const std::string whole = content(folder_ / "city.osm.pbf");
  for (const std::size_t length : {whole.size() - 1, whole.size() / 2, whole.size() / 4, std::size_t{5}}) {
    write("cut.osm.pbf", whole.substr(0, length));
    expect_bad({"scene", "cut.osm.pbf", "-o", "scene.glb"}, "cut.osm.pbf");
  }
  output_of({"scene", "city.osm.pbf", "-q", "-o", "whole.obj"});
}

TEST_F(CliSceneBadMap, NothingInTheArea) {
  expect_bad_option({"--center", "48.13776,11.57523", "--radius", "5"}, "city.osm");
  expect_bad_option({"--center", "50,10", "--radius", "100"}, "city.osm");
  expect_bad_option({"--center", "11.5755,48.1374", "--radius", "100"}, "city.osm");
  expect_bad_option({"--center", "-98.5,40", "--radius", "100"}, "center");
  expect_bad_option({"--bbox", "12,50,13,50.1"}, "city.osm");
  expect_bad_option({"--bbox", "11.6,48.1,11.5,48.2"}, "bbox");
}

// ---- what is mended, and counted ----

TEST_F(CliSceneMended, OutlinesThatCrossThemselves) {
  MapText map;
  map.area({{0, 0}, {20, 20}, {20, 0}, {0, 20}}, {{"building", "yes"}, {"height", "10"}});
  const json report = report_of(map.text());
  EXPECT_EQ(report.at("ledger").size(), 1U);
  EXPECT_NEAR(report.at("records")[0].at("footprint_m2").get<double>(), 400, 1) << "two corners may have been swapped";
}

TEST_F(CliSceneMended, BadNestingOfPolygons) {
  MapText map;
  map.box(100, 100, 120, 120, {{"building", "yes"}});
  const long outer = map.box(0, 0, 40, 40, {}), hole = map.box(30, 10, 60, 30, {});
  map.relation({{"way", outer, "outer"}, {"way", hole, "inner"}}, {{"type", "multipolygon"}, {"building", "yes"}});
  const json report = report_of(map.text());
  EXPECT_EQ(report.at("kinds").at("building"), 2);
  ASSERT_EQ(report.at("ledger").size(), 1U);
  EXPECT_EQ(report.at("ledger")[0].at("object"), "relation/1");
  EXPECT_FALSE(report.at("ledger")[0].at("reason").get<std::string>().empty());
}

TEST_F(CliSceneMended, OutlinesWithoutAnAreaAndBeyondBelief) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  map.area({{60, 0}, {70, 0}, {80, 0}}, {{"building", "yes"}});
  map.box(-5000, 100, 5000, 120, {{"building", "yes"}});
  const json report = report_of(map.text());
  EXPECT_EQ(report.at("kinds").at("building"), 2);
  EXPECT_EQ(report.at("kinds").at("stand-in"), 1);
  ASSERT_EQ(report.at("ledger").size(), 1U);
  testing::expect_wording(report.at("ledger")[0].at("reason").get<std::string>());
}

TEST_F(CliSceneMended, HeightsThatAreNone) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}, {"height", "-5"}});
  map.box(30, 0, 50, 20, {{"building", "yes"}, {"height", "10"}, {"min_height", "12"}});
  map.box(60, 0, 80, 20, {{"building", "yes"}, {"height", "high"}});
  const json report = report_of(map.text());
  const json& records = report.at("records");
  for (const json& record : records) EXPECT_EQ(record.at("remarks").size(), 1U) << record.dump();
  EXPECT_NEAR(records[0].at("top_m").get<double>(), 9, 1e-9) << "three storeys of 3 m";
  EXPECT_NEAR(records[1].at("base_m").get<double>(), 0, 1e-9);
  EXPECT_NEAR(records[1].at("top_m").get<double>(), 10, 1e-9);
  EXPECT_NEAR(records[2].at("top_m").get<double>(), 9, 1e-9);
}

TEST_F(CliSceneMended, PointsAreToldOf) {
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  map.node(40, 40, {{"building", "yes"}, {"name", "Kiosk"}});
  map.node(50, 40, {{"building", "yes"}, {"man_made", "tower"}, {"height", "30"}});
  const json report = report_of(map.text());
  EXPECT_EQ(report.at("kinds").at("building"), 1);
  EXPECT_EQ(report.at("kinds").at("stand-in"), 1);
  EXPECT_EQ(report.at("kinds").at("tower"), 1);
  ASSERT_EQ(report.at("ledger").size(), 1U);
  testing::expect_wording(report.at("ledger")[0].at("reason").get<std::string>());
}

// ---- terrain ----

TEST_F(CliSceneBadTerrain, CannotBeUsed) {
  expect_bad_option({"--terrain", "none.tif"}, "none.tif");
  expect_refused({"scene", "city.osm", "-o", "scene.glb", "--terrain", "city.obj"}, "city.obj");  // with GDAL's words
  write_dem("far", grid_of_heights("500", 12.5));
  expect_bad_option({"--terrain", "far.asc"}, "far.asc");
  write_dem("nowhere", grid_of_heights("500"), "");
  expect_bad_option({"--terrain", "nowhere.asc"}, "nowhere.asc");
  expect_bad_option({"--terrain", "nowhere.asc", "--crs", "nonsense"}, "nowhere.asc");
}

TEST_F(CliSceneBadTerrain, MayBeGivenItsReferenceSystem) {
  write_dem("dem", grid_of_heights("500"));
  write_dem("nowhere", grid_of_heights("500"), "");
  const std::string map = content(folder_ / "city.osm");
  EXPECT_EQ(report_of(map, {"--terrain", "nowhere.asc", "--crs", "EPSG:4326"}).at("records"),
            report_of(map, {"--terrain", "dem.asc"}).at("records"));
}

TEST_F(CliSceneBadTerrain, VoidsAreFilledAndCounted) {
  for (const char* nodata : {"-9999", "nan"}) {
    write_dem("dem", grid_of_heights("500", 11.5655, nodata));
    std::string grid = content(folder_ / "dem.asc");
    // The post at the centre: row 20, column 20.
    std::vector<std::string> rows = lines(grid);
    std::string row;
    for (int column = 0; column < 41; ++column) row += column == 20 ? std::string(nodata) + " " : "500.0 ";
    rows[6 + 20] = row;
    grid.clear();
    for (const std::string& line : rows) grid += line + "\n";
    write("dem.asc", grid);
    const json report = report_of(content(folder_ / "city.osm"), {"--terrain", "dem.asc"});
    testing::expect_wording(report.at("notes").dump());
    EXPECT_NEAR(report.at("records")[0].at("ground_m").get<double>(), 500, 1e-6) << nodata;
  }
}

// ---- the command line ----

TEST_F(CliSceneBadOption, ThatDoNotFit) {
  expect_bad_option({"--radius", "100"}, "radius");
  expect_bad_option({"--center", kCentre}, "--center");
  expect_bad_option({"--center", kCentre, "--radius", "9", "--bbox", "11,48,12,49"}, "center");
  expect_bad_option({"--lod", "2"}, "--lod");
  expect_bad_option({"--crs", "EPSG:4326"}, "--crs");
  expect_bad_option({"--up", "y"}, "--up");
  expect_bad_option({"--scale", "2"}, "--scale");
  expect_bad_option({"--window", "0,0,5,5"}, "--window");
  expect_bad({"scene", "city.obj", "-o", "scene.glb", "--set", "level=3"}, "--set");
  expect_bad({"scene", "city.obj", "-o", "scene.glb", "--terrain", "dem.asc"}, "--terrain");
}

TEST_F(CliSceneBadOption, ThatAreNoNumbers) {
  for (const char* text : {"48.1374", "48.1374,", "48.1374 11.5755", "north,east", "48.1374,11.5755,3", "nan,inf"}) {
    expect_bad_option({"--center", text, "--radius", "100"}, "center");
  }
  for (const char* text : {"0", "-5", "nan", "inf", "1e9", "ten", "5 parsecs"}) {
    expect_bad_option({"--center", kCentre, "--radius", text}, "radius");
  }
  for (const char* text : {"1,2,3", "a,b,c,d", "nan,nan,nan,nan"}) expect_bad_option({"--bbox", text}, "bbox");
  for (const char* text : {"level", "level=", "level=0", "level=x", "storey=3", "levels.house=0", "=3"}) {
    expect_bad_option({"--set", text}, "--set");
  }
  expect_bad_option({"--without", "windows"}, "");
  expect_bad_option({"--error", "-1"}, "--error");
}

TEST_F(CliSceneBadOption, UnknownReferenceSystems) {
  expect_bad({"scene", "city.obj", "-o", "scene.glb", "--crs", "EPSG:999999"}, "city.obj");
  expect_bad({"scene", "city.obj", "-o", "scene.glb", "--crs", "nonsense"}, "city.obj");
  expect_bad({"scene", "city.obj", "-o", "scene.glb", "--origin", "95,10"}, "");
}

TEST_F(CliSceneBadOutput, CannotBeWritten) {
  expect_bad({"scene", "city.osm", "-o", "none/scene.glb"}, "none/scene.glb");
  expect_bad({"scene", "city.osm", "-o", "scene.xyz"}, "scene.xyz");
  expect_bad({"scene", "city.osm", "-o", "scene"}, "scene");
  expect_bad({"scene", "city.osm", "-o", "."}, ".");
  expect_bad({"scene", "city.osm", "-o", "city.osm"}, "city.osm");
  expect_bad({"scene", "city.obj", "-o", "city.obj"}, "city.obj");
  expect_bad({"scene", "city.osm", "-o", "scene.glb", "-o", "./scene.glb"}, "scene.glb");
  fs::create_directory(folder_ / "taken.report.json");
  expect_bad({"scene", "city.osm", "-o", "taken.glb"}, "taken.report.json");
}

TEST_F(CliSceneBadOutput, FullDisk) {
  options_.largest_file = 1000;
  expect_bad({"scene", "city.osm", "-q", "-o", "scene.glb"}, "scene");
}

TEST_F(CliSceneBadOutput, WriteProtected) {
  become_nobody();
  if (!run({"--version"}).was_started) GTEST_SKIP() << "the program is out of reach of a user without rights";
  fs::permissions(folder_ / "scene.glb", fs::perms::owner_read | fs::perms::others_read);
  expect_bad({"scene", "city.osm", "-o", "scene.glb"}, "scene.glb");
  fs::permissions(folder_ / "scene.glb", fs::perms::all);
}

// Logs of others have what the program says.
TEST_F(CliScene, ErrorsShowNoKeysOfServers) {
  const std::string address = "HTTPS://me:SECRET@127.0.0.1:1/a/tileset.json?key=SECRET";
  write("web.yaml", "scene: {tiles: \"" + address + "\"}\n" + kTarget + kSensor);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"inspect", address},
                                                    {"inspect", address, "--lod", "2"},
                                                    {"inspect", address, "--areas", "a"},
                                                    {"scene", address, "-o", "scene.glb"},
                                                    {"compute", "web.yaml", "-o", "volume.ply"},
                                                    {"report", "web.yaml", "-o", "r.html"}}) {
    const ProgramRun told = run(arguments);
    EXPECT_EQ(told.exit_code, 2) << told.err;
    EXPECT_EQ((told.out + told.err).find("SECRET"), std::string::npos) << told.err;
  }
  write("map.osm", "<osm/>");
  const std::string in_map = "scene: {osm: map.osm}\n";
  const std::string target(kTarget), sensor(kSensor);
  for (std::string text :
       {"scene: @\n" + target + sensor, "scene: {mesh: @}\n" + target + sensor, "scene: {osm: @}\n" + target + sensor,
        "scene: {raster: @}\n" + target + sensor, "scene: {osm: map.osm, terrain: @}\n" + target + sensor,
        "scene: {tiles: @, crs: @}\n" + target + sensor, "scene: {tiles: x, missing: @}\n" + target,
        "scene: {@: x}\n" + target, in_map + sensor + "target: {file: @}\n", in_map + sensor + "target: {volume: @}\n",
        in_map + target + sensor + "navigation: {meshes: [@]}\n",
        in_map + target + sensor + "navigation: {keep_out: [{file: @}]}\n"}) {
    for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at + address.size())) {
      text.replace(at, 1, "\" ftp" + address.substr(5) + "\"");
    }
    write("web.yaml", text);
    const ProgramRun told = run({"compute", "web.yaml", "-o", "volume.ply"});
    EXPECT_EQ(told.exit_code, 2) << told.err;
    EXPECT_EQ((told.out + told.err).find("SECRET"), std::string::npos) << told.err;
  }
}

}  // namespace
}  // namespace vantage::testing
