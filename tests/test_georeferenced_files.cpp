// Where a scene lies on the earth: from coordinate systems into the scene frame, and through files of every format.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "geo/local_frame.h"
#include "io/georeference_text.h"
#include "io/sidecar.h"
#include "support/formats.h"
#include "support/mesh_reading.h"
#include "support/objects.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "vantage/result.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using nlohmann::json;
using testing::expect_error;
using testing::read_bytes;
using testing::TemporaryDirectory;
using testing::write_bytes;

const Georeference kPlace{40.748400000000004, -73.98570000000001, "EGM96 \"geoid\" of dém.tif", "EPSG:4326"};

void expect_same(const std::optional<Georeference>& found, const Georeference& expected) {
  ASSERT_TRUE(found);
  EXPECT_EQ(found->latitude_deg, expected.latitude_deg);
  EXPECT_EQ(found->longitude_deg, expected.longitude_deg);
  EXPECT_EQ(found->vertical, expected.vertical);
  EXPECT_EQ(found->source_crs, expected.source_crs);
}

Scene one_box() {
  Scene scene;
  scene.mesh = testing::make_box_mesh(Vec3(1, 2, 3), Vec3(4, 6, 8));
  scene.object_of.assign(scene.mesh.triangles.size(), 0);
  scene.objects = named({"way/1"});
  return scene;
}

Volume one_volume() {
  Volume volume;
  volume.mesh = testing::make_box_mesh(Vec3(1, 2, 3), Vec3(4, 6, 8));
  volume.causes = {{CauseKind::scene, "way/1"}};
  volume.cause_of.assign(volume.mesh.triangles.size(), 0);
  return volume;
}

TEST(Place, TravelsInScenes) {
  const TemporaryDirectory directory;
  Scene scene = one_box();
  for (const std::string& name : testing::in_each_format("a")) {
    scene.georeference = kPlace;
    write_scene(scene, directory / name);
    const Scene read = read_scene(directory / name);
    expect_same(read.georeference, kPlace);
    EXPECT_NEAR((bounding_box(read.mesh).max - Vec3(4, 6, 8)).norm(), 0, 1e-12) << name;
    scene.georeference.reset();
    write_scene(scene, directory / name);
    EXPECT_FALSE(read_scene(directory / name).georeference) << name;  // an old one beside an STL would lie
  }
}

TEST(Place, TravelsInVolumesAndReports) {
  const TemporaryDirectory directory;
  Volume volume = one_volume();
  volume.georeference = kPlace;
  for (const std::string& name : testing::in_each_format("a")) {
    write_volume(volume, directory / name);
    expect_same(read_scene(directory / name).georeference, kPlace);
  }
  write_volume(volume, directory / "y.obj", UpAxis::y, 0.5);
  const Scene read = read_scene(directory / "y.obj", {.up = UpAxis::y, .scale = 0.5});
  expect_same(read.georeference, kPlace);
  EXPECT_EQ(bounding_box(read.mesh).max, Vec3(4, 6, 8));

  ResultRequest request;
  request.volumes = {directory / "b.stl", directory / "c.ply"};
  write_results(volume, request);
  expect_same(read_scene(directory / "b.stl").georeference, kPlace);
  for (const char* name : {"b.report.json", "c.report.json"}) {
    const json report = json::parse(read_bytes(directory / name));
    EXPECT_EQ(report["georeference"]["latitude_deg"], kPlace.latitude_deg);
    EXPECT_EQ(report["georeference"]["projection"], projection_text(kPlace));
  }
  volume.georeference.reset();
  EXPECT_FALSE(json::parse(report_json(volume, measure(volume.mesh))).contains("georeference"));
}

// Whoever gives a scene of no known place may have to be named, too.
TEST(Place, NamesWhomTheDataIsFromWithoutAPlace) {
  const TemporaryDirectory directory;
  Scene scene = one_box();
  scene.objects = named({"house"});
  Volume volume = one_volume();
  const auto copyrights = [&] {
    write_scene(scene, directory / "s.glb");
    write_volume(volume, directory / "v.glb");
    std::vector<bool> found;
    for (const char* name : {"s.glb", "v.glb"}) {
      found.push_back(read_bytes(directory / name).find("\"copyright\":\"the city\"") != std::string::npos);
    }
    return found;
  };
  const auto report = [&] { return json::parse(report_json(volume, measure(volume.mesh))); };
  EXPECT_EQ(copyrights(), std::vector<bool>({false, false}));
  EXPECT_FALSE(report().contains("attribution"));
  scene.attribution = volume.attribution = "the city";
  EXPECT_EQ(copyrights(), std::vector<bool>({true, true}));
  EXPECT_EQ(report()["attribution"], "the city");
}

// The licence of OpenStreetMap asks for it wherever the data is shown.
TEST(Place, NamesWhomTheDataIsFrom) {
  const TemporaryDirectory directory;
  Scene scene = one_box();
  scene.objects = named({"house"});
  scene.georeference = kPlace;
  EXPECT_EQ(attribution_of(scene), "");
  scene.georeference->attribution = kOpenStreetMapCredit;
  Volume volume = one_volume();
  volume.georeference = scene.georeference;
  for (const std::string& name : testing::in_each_format("a")) {
    write_scene(scene, directory / name);
    EXPECT_EQ(attribution_of(read_scene(directory / name)), kOpenStreetMapCredit) << name;
    write_volume(volume, directory / name);
    EXPECT_EQ(read_scene(directory / name).georeference->attribution, kOpenStreetMapCredit) << name;
  }
  write_volume(volume, directory / "v.glb");
  for (const char* name : {"a.glb", "v.glb"}) {
    if (name == std::string("a.glb")) write_scene(scene, directory / name);
    const std::string bytes = read_bytes(directory / name);
    EXPECT_NE(bytes.find("\"copyright\":\""), std::string::npos) << name;
  }
  EXPECT_EQ(json::parse(report_json(volume, measure(volume.mesh)))["georeference"]["attribution"],
            kOpenStreetMapCredit);
  // Files of earlier versions have the ids of the map's objects.
  scene.georeference.reset();
  for (const auto& [id, credit] : {std::pair("way/265517", kOpenStreetMapCredit),
                                   {"relation/1", kOpenStreetMapCredit},
                                   {"node/12", kOpenStreetMapCredit},
                                   {"way/", ""},
                                   {"way/12a", ""},
                                   {"gml/12", ""},
                                   {"12", ""}}) {
    scene.objects[0].source_id = id;
    EXPECT_EQ(attribution_of(scene), credit) << id;
  }
  // Whoever gives a scene may add a name, and takes none away.
  scene.attribution = "the city";
  EXPECT_EQ(attribution_of(scene), "the city");
  scene.objects[0].source_id = "way/1";
  EXPECT_EQ(attribution_of(scene), std::string("the city, ") + kOpenStreetMapCredit);
  scene.attribution = kOpenStreetMapCredit;
  EXPECT_EQ(attribution_of(scene), kOpenStreetMapCredit);
}

TEST(Place, IsRefusedWhenGarbled) {
  const TemporaryDirectory directory;
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto obj = [&](const std::string& comment) {
    write_bytes(directory / "a.obj", "# made by hand\n" + comment + "\n" + mesh);
    return read_scene(directory / "a.obj");
  };
  const std::string ours = "# vantage georeference: ";
  EXPECT_FALSE(obj("# vantage georeferences").georeference);
  const Scene placed = obj(ours + R"({"latitude_deg": 1, "longitude_deg": 2, "more": []})");
  EXPECT_EQ(placed.georeference->longitude_deg, 2);
  const auto refused = [&](const std::string& text) {
    expect_error([&] { obj(ours + text); }, ErrorCode::record_garbled, "a.obj, line 2");
  };
  refused("");
  refused("{");
  refused("7");
  refused(R"({"longitude_deg": 2})");
  refused(R"({"latitude_deg": 91, "longitude_deg": 2})");
  refused(R"({"latitude_deg": 1, "longitude_deg": "2"})");
  refused(R"({"latitude_deg": 1, "longitude_deg": 2, "vertical": 3})");
  const std::string one = ours + R"({"latitude_deg": 1, "longitude_deg": 2})";
  EXPECT_TRUE(obj(one + "\n" + one).georeference);
  expect_error([&] { obj(one + "\n" + ours + R"({"latitude_deg": 3, "longitude_deg": 2})"); },
               ErrorCode::record_garbled, "a.obj, line 3");

  write_bytes(
      directory / "a.ply",
      "ply\nformat ascii 1.0\ncomment vantage georeference: {]\nelement vertex 3\nproperty float x\nproperty "
      "float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
      "0\n0 1 0\n3 0 1 2\n");
  expect_error([&] { read_scene(directory / "a.ply"); }, ErrorCode::record_garbled, "a.ply, line 3");

  write_scene(one_box(), directory / "a.stl");
  for (const char* text : {"{]", "{}", "{\"vantage\": 3}", R"({"vantage": {"georeference": 3}})",
                           R"({"vantage": {"georeference": null}, "vantage": {"georeference": null}})"}) {
    write_bytes(directory / "a.stl.place.json", text);
    expect_error([&] { read_scene(directory / "a.stl"); }, ErrorCode::record_garbled, "a.stl.place.json");
  }
}

TEST(Place, IsReadFromScenesAndAssetsOfGltf) {
  const std::string place = R"({"vantage":{"georeference":{"latitude_deg":1,"longitude_deg":2}}})";
  json gltf = {{"asset", {{"version", "2.0"}}},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"mesh", 0}}}},
               {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
               {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
               {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
               {"buffers", {{{"byteLength", 36}, {"uri", "data:;base64," + std::string(48, 'A')}}}}};
  EXPECT_FALSE(testing::read_as("a.gltf", gltf.dump()).georeference);
  json in_scene = gltf, in_asset = gltf;
  in_scene["scenes"][0]["extras"] = json::parse(place);
  in_asset["asset"]["extras"] = json::parse(place);
  EXPECT_EQ(testing::read_as("a.gltf", in_scene.dump()).georeference->latitude_deg, 1);
  EXPECT_EQ(testing::read_as("a.gltf", in_asset.dump()).georeference->latitude_deg, 1);
  in_scene["scenes"][0]["extras"]["vantage"]["georeference"]["latitude_deg"] = 100;
  expect_error([&] { testing::read_as("a.gltf", in_scene.dump()); }, ErrorCode::mesh_syntax, "a.gltf");
  in_scene["scenes"][0]["extras"] = "anything";
  EXPECT_FALSE(testing::read_as("a.gltf", in_scene.dump()).georeference);
}

TEST(Axes, TravelInObjAndGoBeforeTheOptions) {
  const TemporaryDirectory directory;
  Volume volume = one_volume();
  write_volume(volume, directory / "a.obj", UpAxis::y, 0.3048);
  const Scene read = read_scene(directory / "a.obj");
  EXPECT_NEAR((bounding_box(read.mesh).max - Vec3(4, 6, 8)).norm(), 0, 1e-12);
  EXPECT_TRUE(read.states_axes);
  EXPECT_EQ(read.up, UpAxis::y);
  EXPECT_EQ(read.scale, 0.3048);
  EXPECT_TRUE(read.notes.empty());
  EXPECT_TRUE(read_scene(directory / "a.obj", {.up = UpAxis::y, .scale = 0.3048}).notes.empty());
  const Scene other = read_scene(directory / "a.obj", {.scale = 2});
  EXPECT_EQ(other.mesh.vertices, read.mesh.vertices);
  ASSERT_EQ(other.notes.size(), 1U);
  testing::expect_wording(other.notes);
  write_scene(one_box(), directory / "b.obj");
  EXPECT_TRUE(read_scene(directory / "b.obj", {.up = UpAxis::y}).states_axes);
}

TEST(Axes, AreRefusedWhenGarbled) {
  const TemporaryDirectory directory;
  const auto obj = [&](const std::string& comment) {
    write_bytes(directory / "a.obj", "# made by hand\n" + comment + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    return read_scene(directory / "a.obj");
  };
  EXPECT_FALSE(obj("# vantage axes").states_axes);
  EXPECT_FALSE(obj("# y up").states_axes);
  const Scene in_millimetres = obj("#vantage axes: y up, unit 1e-3 m\r");
  EXPECT_EQ(in_millimetres.scale, 1e-3);
  for (const char* const text :
       {"", " ", " x up, unit 1 m", " y up", " y up, unit 1", " y up, unit  m", " y up, unit m", " y up, unit -1 m",
        " y up, unit 0 m", " y up, unit nan m", " y up, unit 1e999 m", " y up, unit 1 m 2"}) {
    expect_error([&] { obj(std::string("# vantage axes:") + text); }, ErrorCode::record_garbled, "a.obj, line 2");
  }
  const std::string one = "# vantage axes: y up, unit 1 m";
  EXPECT_TRUE(obj(one + "\n" + one).states_axes);
  expect_error([&] { obj(one + "\n# vantage axes: z up, unit 1 m"); }, ErrorCode::record_garbled, "a.obj, line 3");
}

/// Two triangles, the lower left corner at (x, y).
std::string square_obj(const std::string& x0, const std::string& y0, const std::string& x1, const std::string& y1) {
  return "v " + x0 + " " + y0 + " 5\nv " + x1 + " " + y0 + " 5\nv " + x1 + " " + y1 + " 7\nv " + x0 + " " + y1 +
         " 7\nf 1 2 3 4\n";
}

TEST(Place, TakesMapCoordinatesIntoTheLocalFrame) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a.obj", square_obj("84800.125", "447500.25", "84900.125", "447600.25"));
  const Scene scene = read_scene(directory / "a.obj", {.crs = "EPSG:28992"});
  ASSERT_TRUE(scene.georeference);
  EXPECT_EQ(scene.georeference->source_crs, "EPSG:28992");
  testing::expect_wording(scene.georeference->vertical);
  EXPECT_TRUE(scene.notes.empty());
  const Scene elsewhere = read_scene(directory / "a.obj", {.crs = "EPSG:32632"});
  ASSERT_EQ(elsewhere.notes.size(), 1U);
  EXPECT_NE(elsewhere.notes[0].find("EPSG:32632"), std::string::npos);  // with PROJ's words
  expect_error(
      [&] {
        read_scene(directory / "a.obj", {.crs = "EPSG:28992", .origin_deg = {{4.366, 52.01}}});
      },
      ErrorCode::too_far_away, "a.obj");
  const Box box = bounding_box(scene.mesh);
  EXPECT_EQ(box.min.z(), 5);
  EXPECT_EQ(box.max.z(), 7);
  // The centre is the origin; RD is turned by 0.8 degrees there, its scale is right to 1e-4.
  EXPECT_LT(((box.min + box.max) / 2).head<2>().norm(), 1e-3);
  EXPECT_NEAR((scene.mesh.vertices[0] - scene.mesh.vertices[1]).norm(), 100, 0.01);
  EXPECT_NEAR((scene.mesh.vertices[1] - scene.mesh.vertices[0]).y(), 100 * std::sin(0.8 / 57.3), 0.02);
  // And back: the coordinates of the file, but for the height that changes of datum leave out.
  const geo::CoordinateSystem rd("EPSG:28992", "test");
  const geo::LocalFrame frame({scene.georeference->longitude_deg, scene.georeference->latitude_deg});
  const Eigen::Vector2d back = rd.from_lonlat(frame.to_lonlat(scene.mesh.vertices[2].head<2>()));
  EXPECT_LT((back - Eigen::Vector2d(84900.125, 447600.25)).norm(), 1e-3);

  const std::array<double, 2> origin = {52.01, 4.36};
  const Scene about = read_scene(directory / "a.obj", {.crs = "EPSG:28992", .origin_deg = origin});
  EXPECT_EQ(about.georeference->latitude_deg, 52.01);
  EXPECT_EQ(about.georeference->longitude_deg, 4.36);
  EXPECT_LT((rd.from_lonlat(geo::LocalFrame({4.36, 52.01}).to_lonlat(about.mesh.vertices[2].head<2>())) - back).norm(),
            1e-6);

  // A volume computed there is read about another origin.
  write_scene(scene, directory / "b.ply");
  const Scene moved = read_scene(directory / "b.ply", {.origin_deg = origin});
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& vertex = moved.mesh.vertices[moved.mesh.triangles[t][k]];
      EXPECT_LT((vertex - about.mesh.vertices[about.mesh.triangles[t][k]]).norm(), 1e-6);
    }
  }
  expect_error([&] { read_scene(directory / "b.ply", {.crs = "EPSG:28992"}); }, ErrorCode::not_applicable, "b.ply");
}

TEST(Place, TakesTurnsUnitsAndDegrees) {
  const TemporaryDirectory directory;
  // y up: north is -z. The scale is that of z alone.
  write_bytes(directory / "y.obj", "v 84800 1 -447500\nv 84900 1 -447500\nv 84900 3 -447600\nf 1 2 3\n");
  const Scene turned = read_scene(directory / "y.obj", {.up = UpAxis::y, .scale = 0.5, .crs = "EPSG:28992"});
  EXPECT_NEAR((turned.mesh.vertices[0] - turned.mesh.vertices[1]).norm(), 100, 0.01);
  EXPECT_EQ(turned.mesh.vertices[2].z(), 1.5);
  EXPECT_EQ(turned.scale, 1);

  write_bytes(directory / "d.obj", square_obj("4.36", "52.01", "4.361", "52.011"));
  const Scene degrees = read_scene(directory / "d.obj", {.crs = "EPSG:4326"});
  EXPECT_NEAR((degrees.mesh.vertices[3] - degrees.mesh.vertices[0]).norm(), 111.29, 0.05);

  write_bytes(directory / "f.obj", square_obj("987000", "211000", "987328", "211328"));
  const Scene feet = read_scene(directory / "f.obj", {.crs = "EPSG:2263"});
  EXPECT_NEAR((feet.mesh.vertices[0] - feet.mesh.vertices[1]).norm(), 100, 0.1);
  ASSERT_EQ(feet.notes.size(), 1u);
  testing::expect_wording(feet.notes);
  EXPECT_TRUE(read_scene(directory / "f.obj", {.scale = 0.3048, .crs = "EPSG:2263"}).notes.empty());
}

TEST(Place, PutsLocalMeshesAtAnOrigin) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a.obj", square_obj("0", "0", "100", "100"));
  const Scene scene = read_scene(directory / "a.obj", {.origin_deg = std::array<double, 2>{35.2249, -80.8403}});
  EXPECT_EQ(scene.georeference->latitude_deg, 35.2249);
  EXPECT_EQ(scene.mesh.vertices[2], Vec3(100, 100, 7));
  write_bytes(directory / "b.obj", square_obj("84800", "447500", "84900", "447600"));
  expect_error(
      [&] {
        read_scene(directory / "b.obj", {.origin_deg = std::array<double, 2>{52, 4}});
      },
      ErrorCode::crs_missing, "b.obj");
}

TEST(Place, IsForgottenWhereItIsAskedFor) {
  const TemporaryDirectory directory;
  Scene scene = one_box();
  scene.georeference = kPlace;
  write_scene(scene, directory / "a.obj");
  SceneReadOptions options;
  options.crs = "none";
  const Scene read = read_scene(directory / "a.obj", options);
  EXPECT_FALSE(read.georeference);
  EXPECT_EQ(bounding_box(read.mesh).max, Vec3(4, 6, 8));
}

TEST(Place, RefusesWhatIsNowhere) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a.obj", square_obj("0", "0", "100", "100"));
  expect_error([&] { read_scene(directory / "a.obj", {.crs = "EPSG:999999"}); }, ErrorCode::crs_unknown, "a.obj");
  expect_error(
      [&] {
        read_scene(directory / "a.obj", {.origin_deg = std::array<double, 2>{95, 4}});
      },
      ErrorCode::not_on_earth, "");
}

}  // namespace
}  // namespace vantage
