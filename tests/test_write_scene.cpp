// Scenes of many objects, written and read again.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <vector>

#include "common/ledger.h"
#include "support/objects.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/scene.h"

namespace vantage {
namespace {

using testing::read_bytes;
using testing::TemporaryDirectory;

/// Adds a tetrahedron with vertices of its own.
void add_tetrahedron(Scene& scene, const Vec3& at, double size, std::uint32_t object) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    scene.mesh.vertices.push_back(at + size * corner);
  }
  for (const Triangle& t : {Triangle{0, 2, 1}, Triangle{0, 1, 3}, Triangle{0, 3, 2}, Triangle{1, 2, 3}}) {
    scene.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    scene.object_of.push_back(object);
  }
}

/// Objects whose triangles lie mixed, awkward names, UTM-sized and awkward coordinates, an object and a vertex that
/// nothing uses.
Scene awkward_scene() {
  Scene scene;
  scene.objects =
      named({"way/265517 Straße \"7\"", "unused", "two\nlines", "", "way/265517 Straße \"7\"", "back\\slash\\"});
  const Vec3 far(580000.1, 4785000.2, 1000.3);
  add_tetrahedron(scene, far, 10.0 / 3, 4);
  add_tetrahedron(scene, far + Vec3(1000.7, 0, 0), 1e-3, 0);
  add_tetrahedron(scene, Vec3(-0.1, 1.0 / 3, 1e-9), 20, 2);
  add_tetrahedron(scene, Vec3(0, 0, 0), 30, 5);
  add_tetrahedron(scene, far + Vec3(50, 7, 7), 1, 4);
  scene.mesh.vertices.emplace_back(9e8, 0, 0);
  add_tetrahedron(scene, Vec3(70, 7, 7), 1, 3);
  return scene;
}

/// The farthest that a corner of a triangle is from where it was.
double moved(const Scene& before, const Scene& after) {
  const auto corners = [](const Scene& scene) {
    std::vector<std::array<double, 3>> all;
    for (const Triangle& t : scene.mesh.triangles) {
      for (const std::uint32_t v : t) {
        const Vec3& p = scene.mesh.vertices[v];
        all.push_back({p.x(), p.y(), p.z()});
      }
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  const auto a = corners(before), b = corners(after);
  EXPECT_EQ(a.size(), b.size());
  double most = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    most = std::max(most, (Vec3(a[i].data()) - Vec3(b[i].data())).norm());
  }
  return most;
}

TEST(WriteScene, SaysHowFarSinglePrecisionMovesVertices) {
  const TemporaryDirectory folder;
  Scene scene;
  scene.objects = named({"far", "wide"});
  add_tetrahedron(scene, Vec3(1000.1, 2000.2, 3.3), 7.7, 0);
  add_tetrahedron(scene, Vec3(-900.7, 0.3, 0.1), 1234.5, 1);
  for (const auto& [name, least, most] :
       {std::tuple{"a.obj", 0.0, 0.0}, {"a.ply", 0.0, 0.0}, {"a.glb", 1e-6, 1e-4}, {"a.stl", 1e-6, 2e-4}}) {
    const double told = write_scene(scene, folder / name);
    const double found = moved(scene, read_scene(folder / name));
    EXPECT_NEAR(told, found, 1e-12) << name;
    EXPECT_GE(told, least) << name;
    EXPECT_LE(told, most) << name;
  }
  Scene exact;
  exact.objects = named({"exact"});
  add_tetrahedron(exact, Vec3(512, 0.25, 0), 64, 0);
  EXPECT_EQ(write_scene(exact, folder / "exact.glb"), 0);
  EXPECT_EQ(write_scene(exact, folder / "exact.stl"), 0);
}

/// The corners of an object's triangles, in the order of the scene's triangles.
std::vector<Vec3> corners_of(const Scene& scene, std::uint32_t object) {
  std::vector<Vec3> corners;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (scene.object_of[t] != object) continue;
    for (const std::uint32_t vertex : scene.mesh.triangles[t]) corners.push_back(scene.mesh.vertices[vertex]);
  }
  return corners;
}

void expect_same_objects(const Scene& wrote, const Scene& read, double tolerance) {
  const std::vector<std::uint32_t> kept = {0, 2, 3, 4, 5};
  const std::vector<std::string> names = {"way/265517 Straße \"7\"", "two lines", "object 3", "way/265517 Straße \"7\"",
                                          "back\\slash\\"};
  ASSERT_EQ(names_of(read.objects), names);
  ASSERT_EQ(read.mesh.triangles.size(), wrote.mesh.triangles.size());
  EXPECT_EQ(read.mesh.vertices.size(), wrote.mesh.vertices.size() - 1);
  for (std::uint32_t i = 0; i < kept.size(); ++i) {
    const std::vector<Vec3> expected = corners_of(wrote, kept[i]), found = corners_of(read, i);
    ASSERT_EQ(found.size(), expected.size()) << names[i];
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_LE((found[k] - expected[k]).norm(), tolerance) << names[i];
  }
}

TEST(WriteScene, ObjKeepsObjectsAndEveryBit) {
  const TemporaryDirectory directory;
  const Scene scene = awkward_scene();
  write_scene(scene, directory / "scene.obj");
  expect_same_objects(scene, read_scene(directory / "scene.obj"), 0);
}

TEST(WriteScene, GlbKeepsObjectsWhereverTheyLie) {
  const TemporaryDirectory directory;
  const Scene scene = awkward_scene();
  write_scene(scene, directory / "scene.glb");
  expect_same_objects(scene, read_scene(directory / "scene.glb"), 4e-6);
}

TEST(WriteScene, ObjAndGlbKeepWhatObjectsAre) {
  const TemporaryDirectory directory;
  Scene scene = awkward_scene();
  scene.objects[0] = {"Stra\u00dfe \"7\"", "way/265517", ObjectKind::building_part};
  scene.objects[2] = {"", "node/9", ObjectKind::tree};
  scene.objects[4] = {"ground", "", ObjectKind::other};  // of the kind that it says, not that of its name
  scene.objects[5] = {"back\\slash\\", "", ObjectKind::wall};
  for (const char* name : {"scene.obj", "scene.glb"}) {
    write_scene(scene, directory / name);
    const std::vector<SceneObject> read = read_scene(directory / name).objects;
    ASSERT_EQ(read.size(), 5U) << name;
    EXPECT_EQ(read[0], scene.objects[0]) << name;
    EXPECT_EQ(read[1], scene.objects[2]) << name;
    EXPECT_EQ(read[3], scene.objects[4]) << name;
    EXPECT_EQ(read[4], scene.objects[5]) << name;
  }
}

TEST(WriteScene, ARenamedObjectHasItsNewName) {
  const TemporaryDirectory directory;
  Scene scene = awkward_scene();
  scene.objects[5] = {"tower", "way/1", ObjectKind::building};
  write_scene(scene, directory / "scene.obj");
  std::string text = testing::read_bytes(directory / "scene.obj");
  text.replace(text.find("o way/1 tower"), 13, "o ground     ");
  testing::write_bytes(directory / "renamed.obj", text);
  EXPECT_EQ(read_scene(directory / "renamed.obj").objects.back(), (SceneObject{"ground", "", ObjectKind::ground}));
}

TEST(WriteScene, PlyIsOneMeshWithEveryBit) {
  const TemporaryDirectory directory;
  const Scene scene = awkward_scene();
  write_scene(scene, directory / "scene.ply");
  const Scene read = read_scene(directory / "scene.ply");
  EXPECT_EQ(names_of(read.objects), std::vector<std::string>{"scene"});
  ASSERT_EQ(read.mesh.triangles.size(), scene.mesh.triangles.size());
  for (std::size_t t = 0; t < read.mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(read.mesh.vertices[read.mesh.triangles[t][k]], scene.mesh.vertices[scene.mesh.triangles[t][k]]);
    }
  }
}

TEST(WriteScene, StlIsOneMesh) {
  const TemporaryDirectory directory;
  const Scene scene = awkward_scene();
  write_scene(scene, directory / "scene.stl");
  const Scene read = read_scene(directory / "scene.stl");
  EXPECT_EQ(read.mesh.triangles.size(), scene.mesh.triangles.size());
  EXPECT_FALSE(std::filesystem::exists(directory / "scene.stl.place.json"));
}

TEST(WriteScene, GlbIsWhatTheSpecificationAsksFor) {
  const TemporaryDirectory directory;
  write_scene(awkward_scene(), directory / "scene.glb");
  const std::string bytes = read_bytes(directory / "scene.glb");
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  std::uint32_t length = 0, json_length = 0;
  std::memcpy(&length, bytes.data() + 8, 4);
  std::memcpy(&json_length, bytes.data() + 12, 4);
  EXPECT_EQ(length, bytes.size());
  ASSERT_EQ(json_length % 4, 0u);
  const auto json = nlohmann::json::parse(bytes.substr(20, json_length));
  EXPECT_EQ(json["asset"]["version"], "2.0");
  EXPECT_EQ(json["nodes"].size(), 5u);
  EXPECT_EQ(json["scenes"][0]["nodes"].size(), 5u);
  std::uint32_t binary = 0;
  std::memcpy(&binary, bytes.data() + 20 + json_length, 4);
  EXPECT_EQ(json["buffers"][0]["byteLength"], binary);
  const auto& views = json["bufferViews"];
  EXPECT_EQ(views[0]["byteLength"].get<std::size_t>() + views[1]["byteLength"].get<std::size_t>(), binary);
  std::size_t positions = 0, indices = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const auto& primitive = json["meshes"][i]["primitives"][0];
    const auto& accessor = json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(accessor["byteOffset"], positions);
    for (int axis = 0; axis < 3; ++axis) EXPECT_LE(accessor["min"][axis], accessor["max"][axis]);
    positions += accessor["count"].get<std::size_t>() * 12;
    const auto& index = json["accessors"][primitive["indices"].get<std::size_t>()];
    EXPECT_EQ(index["byteOffset"], indices);
    indices += index["count"].get<std::size_t>() * 4;
  }
  EXPECT_EQ(views[0]["byteLength"], positions);
  EXPECT_EQ(views[1]["byteLength"], indices);
}

TEST(WriteScene, RefusesWhatDoesNotFitTogether) {
  const TemporaryDirectory directory;
  const auto expect_refused = [&](const Scene& scene, const char* name, ErrorCode code, const std::string& where) {
    testing::expect_error([&] { write_scene(scene, directory / name); }, code, where);
  };
  expect_refused(Scene(), "a.obj", ErrorCode::mesh_empty, "");
  Scene scene = awkward_scene();
  expect_refused(scene, "a.xyz", ErrorCode::output_format_unknown, (directory / "a.xyz").string());
  scene.object_of[3] = 6;
  expect_refused(scene, "a.obj", ErrorCode::index_out_of_range, "triangle 3");
  scene.object_of.pop_back();
  expect_refused(scene, "a.obj", ErrorCode::array_sizes_differ, "");
  scene = awkward_scene();
  scene.mesh.triangles[7][1] = 25;
  expect_refused(scene, "a.obj", ErrorCode::index_out_of_range, "triangle 7");
  scene = awkward_scene();
  scene.mesh.vertices[2].y() = std::numeric_limits<double>::quiet_NaN();
  expect_refused(scene, "a.glb", ErrorCode::coordinate_not_finite, "vertex 2");
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(WriteScene, KeepsTheOldFileWhenItCannotWrite) {
  const TemporaryDirectory directory;
  write_scene(awkward_scene(), directory / "scene.obj");
  const std::string old = read_bytes(directory / "scene.obj");
  EXPECT_THROW(write_scene(Scene(), directory / "scene.obj"), Error);
  EXPECT_EQ(read_bytes(directory / "scene.obj"), old);
  EXPECT_THROW(write_scene(awkward_scene(), directory / "missing" / "scene.obj"), Error);
}

/// Two entries: one that an object holds, and one of which only the place is known, up to no height.
Scene scene_with_ledger() {
  Scene scene = awkward_scene();
  scene.objects.push_back({"held", "relation/7", ObjectKind::stand_in});
  add_tetrahedron(scene, Vec3(0.1, 1.0 / 3, -2), 47, 6);
  LedgerEntry held;
  held.object = {"Wal\"l\n", "relation/7", ObjectKind::building};
  held.what = "relation";
  held.reason = "its ring is open at 7.41, 1.11";
  held.box = Box{Vec3(0.1, 1.0 / 3, -2), Vec3(5, 6, 45)};
  held.outlines = {{{0.1, 1.0 / 3}, {5, 0}, {5, 6}}};
  held.height_m = 45;
  held.stand_in = 6;
  held.instead = "its outline without holes, 45 m high";
  held.may_be_larger = true;
  LedgerEntry open;
  open.what = "posts without a height";
  open.reason = "void";
  open.box =
      Box{Vec3(1, 2, -std::numeric_limits<double>::infinity()), Vec3(3, 4, std::numeric_limits<double>::infinity())};
  scene.ledger = {held, open, LedgerEntry{{}, "wood", "no height"}};
  return scene;
}

TEST(WriteScene, KeepsTheLedgerInEveryFormat) {
  TemporaryDirectory folder;
  const Scene scene = scene_with_ledger();
  for (const char* name : {"a.obj", "a.glb", "a.ply", "a.stl"}) {
    SCOPED_TRACE(name);
    write_scene(scene, folder / name);
    const Scene read = read_scene(folder / name);
    ASSERT_EQ(read.ledger.size(), 3u);
    const LedgerEntry& held = read.ledger[0];
    EXPECT_EQ(held.object, (SceneObject{"Wal\"l", "relation/7", ObjectKind::building}));
    EXPECT_EQ(held.what, "relation");
    EXPECT_EQ(held.reason, scene.ledger[0].reason);
    ASSERT_TRUE(held.box);
    EXPECT_EQ(held.box->min, scene.ledger[0].box->min);
    EXPECT_EQ(held.box->max, scene.ledger[0].box->max);
    EXPECT_EQ(held.outlines, scene.ledger[0].outlines);
    EXPECT_EQ(held.height_m, 45);
    EXPECT_EQ(held.instead, scene.ledger[0].instead);
    EXPECT_TRUE(held.may_be_larger);
    ASSERT_TRUE(held.stand_in);
    ASSERT_LT(*held.stand_in, read.objects.size());
    const bool has_kinds = read.objects.size() > 1;
    EXPECT_EQ(read.objects[*held.stand_in].kind, has_kinds ? ObjectKind::stand_in : ObjectKind::other);
    ASSERT_TRUE(read.ledger[1].box);
    EXPECT_EQ(read.ledger[1].box->min, scene.ledger[1].box->min);
    EXPECT_EQ(read.ledger[1].box->max, scene.ledger[1].box->max);
    EXPECT_FALSE(read.ledger[1].stand_in);
    EXPECT_FALSE(read.ledger[2].box);
    // Written once more it is the same.
    write_scene(read, folder / ("again" + std::string(name).substr(1)));
    EXPECT_EQ(read_scene(folder / ("again" + std::string(name).substr(1))).ledger.size(), 3u);
  }
}

TEST(WriteScene, LinesOverheadAreInTheLedgerOfTheFile) {
  TemporaryDirectory folder;
  Scene scene = awkward_scene();
  scene.overhead = {{{"volt", "way/12"}, testing::make_box_mesh({5, -50, 0}, {6, 50, 45})}};
  for (const char* name : {"a.obj", "a.glb", "a.ply", "a.stl"}) {
    SCOPED_TRACE(name);
    write_scene(scene, folder / name);
    const Scene read = read_scene(folder / name);
    ASSERT_EQ(read.ledger.size(), 1u);
    EXPECT_EQ(read.ledger[0].object, scene.overhead[0].object);
    EXPECT_FALSE(read.ledger[0].stand_in);
    ASSERT_TRUE(read.ledger[0].box);
    EXPECT_EQ(read.ledger[0].box->min, Vec3(5, -50, 0));
    EXPECT_EQ(read.ledger[0].box->max, Vec3(6, 50, 45));
    testing::expect_wording(read.ledger[0].reason);
  }
}

/// A house and a mast, 45 m high, whose place a stand-in holds.
Scene house_and_mast() {
  Scene scene = testing::SceneBuilder()
                    .ground("ground", 200)
                    .box("house", {-10, -10, 0}, {10, 10, 10})
                    .box("mast", {40, 0, 0}, {44, 4, 45});
  scene.objects[0].kind = ObjectKind::ground;
  scene.objects[2].kind = ObjectKind::stand_in;
  scene.ledger = {{{"mast"}, "power=tower", "nothing tells how wide it is", Box{{40, 0, 0}, {44, 4, 45}}}};
  scene.ledger[0].stand_in = 2;
  return scene;
}

using Json = nlohmann::json;

/// What is read of house_and_mast after another program changed the document of its GLB.
LedgerEntry after(const std::filesystem::path& folder, const std::function<void(Json&)>& change) {
  write_scene(house_and_mast(), folder / "a.glb");
  const std::string bytes = read_bytes(folder / "a.glb");
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  Json json = Json::parse(bytes.substr(20, word(12)));
  change(json);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = bytes.substr(20 + word(12));
  std::string changed = bytes.substr(0, 20);
  for (const auto& [at, value] : {std::pair{8U, 20 + text.size() + rest.size()}, {12U, text.size()}}) {
    const auto size = static_cast<std::uint32_t>(value);
    std::memcpy(changed.data() + at, &size, sizeof size);
  }
  testing::write_bytes(folder / "b.glb", changed + text + rest);
  return read_scene(folder / "b.glb").ledger.at(0);
}

TEST(WriteScene, WhatHoldsAPlaceMustBeThere) {
  const TemporaryDirectory folder;
  const Box box = *house_and_mast().ledger[0].box;
  const auto as_written = after(folder.path(), [](Json&) {});
  EXPECT_EQ(as_written.stand_in, 2U);
  EXPECT_EQ(as_written.box->min, box.min);
  const auto is_held = [&](const std::function<void(Json&)>& change) {
    const LedgerEntry entry = after(folder.path(), change);
    EXPECT_TRUE(entry.stand_in || entry.instead.empty());
    return entry.stand_in.has_value();
  };
  EXPECT_FALSE(is_held([](Json& json) { json["nodes"][2].erase("mesh"); }));
  EXPECT_FALSE(is_held([](Json& json) { json["nodes"][2]["scale"] = {1e-6, 1e-6, 1e-6}; }));
  EXPECT_FALSE(is_held([](Json& json) { json["nodes"][2]["translation"] = {4000, 0, 0}; }));
  EXPECT_FALSE(is_held([](Json& json) { json["scenes"][0]["nodes"] = {2, 1, 0}; }));
  EXPECT_FALSE(is_held([](Json& json) { json["scenes"][0]["extras"]["vantage"]["ledger"][0]["stand_in"] = 1; }));
  const LedgerEntry reordered = after(folder.path(), [](Json& json) { json["scenes"][0]["nodes"] = {2, 1, 0}; });
  ASSERT_TRUE(reordered.box);
  testing::expect_wording(reordered.reason);
}

TEST(WriteScene, APlaceThatTheSceneDoesNotBearOutIsNotKnown) {
  const TemporaryDirectory folder;
  const auto ledger = [](Json& json) -> Json& { return json["scenes"][0]["extras"]["vantage"]["ledger"][0]; };
  const LedgerEntry far = after(folder.path(), [&](Json& json) { ledger(json)["box"] = {{1e8, 0, 0}, {1e8, 4, 45}}; });
  EXPECT_FALSE(far.box);
  EXPECT_FALSE(far.stand_in);
  const LedgerEntry open = after(folder.path(), [&](Json& json) {
    ledger(json)["box"] = {{1e8, 0, 0}, {1e8, 4, 45}};
    ledger(json).erase("stand_in");
  });
  EXPECT_FALSE(open.box);
  const LedgerEntry moved = after(folder.path(), [&](Json& json) {
    ledger(json)["box"] = {{5e3, 0, 0}, {5e3, 4, 45}};
    ledger(json).erase("stand_in");
  });
  EXPECT_FALSE(moved.box) << "the scene is 400 m across";
  const LedgerEntry apart = after(folder.path(), [&](Json& json) { ledger(json)["box"] = {{90, 0, 0}, {94, 4, 45}}; });
  EXPECT_FALSE(apart.box);
  EXPECT_FALSE(apart.stand_in);
}

TEST(WriteScene, StandInsThatNoLedgerNamesAreInIt) {
  const TemporaryDirectory folder;
  Scene scene = house_and_mast();
  scene.ledger.clear();
  for (const char* const name : {"a.obj", "a.glb"}) {
    SCOPED_TRACE(name);
    write_scene(scene, folder / name);
    const Scene read = read_scene(folder / name);
    ASSERT_EQ(read.ledger.size(), 1u);
    EXPECT_EQ(read.ledger[0].stand_in, 2U);
    EXPECT_TRUE(read.ledger[0].may_be_larger);
    ASSERT_TRUE(read.ledger[0].box);
    EXPECT_EQ(read.ledger[0].box->max, Vec3(44, 4, 45));
    testing::expect_wording(ledger_text(read.ledger[0]));
    testing::expect_code([&] { read_scene(folder / name, {.missing = MissingPolicy::refuse}); },
                         ErrorCode::scene_incomplete);
  }
}

TEST(WriteScene, LedgersMoveWithOneNodeAboutAllOthers) {
  const TemporaryDirectory folder;
  const auto under = [&](const Json& node) {
    return after(folder.path(), [&](Json& json) {
      json["nodes"].push_back(node);
      json["nodes"].back()["children"] = {0, 1, 2};
      json["scenes"][0]["nodes"] = {3};
    });
  };
  const LedgerEntry scaled = under({{"scale", {2, 2, 2}}, {"translation", {100, 0, 0}}});
  ASSERT_TRUE(scaled.box);
  EXPECT_EQ(scaled.box->min, Vec3(180, 0, 0));
  EXPECT_EQ(scaled.box->max, Vec3(188, 8, 90));
  EXPECT_EQ(scaled.stand_in, 2U);
  EXPECT_TRUE(under(Json::object()).box);
  const LedgerEntry in_groups = after(folder.path(), [](Json& json) {
    json["nodes"].push_back({{"scale", {2, 2, 2}}, {"children", {0, 1}}});
    json["scenes"][0]["nodes"] = {3, 2};
  });
  EXPECT_FALSE(in_groups.box) << "what it moves with is not known";
}

TEST(WriteScene, LedgersAreReadOfAllScenesOfAFile) {
  const TemporaryDirectory folder;
  const LedgerEntry other = after(folder.path(), [](Json& json) {
    json["scenes"].push_back({{"nodes", {0, 1, 2}}});
    json["scene"] = 1;
  });
  EXPECT_EQ(other.stand_in, 2U);
}

// It may come from a stranger.
TEST(WriteScene, LedgersThatAreGarbledAreRefused) {
  TemporaryDirectory folder;
  const auto read = [&](const std::string& entry) {
    testing::write_bytes(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n# vantage ledger: " + entry + "\n");
    return read_scene(folder / "a.obj");
  };
  EXPECT_EQ(read("{}").ledger.size(), 1u);
  EXPECT_FALSE(read(R"({"stand_in": 7, "instead": "nothing"})").ledger.at(0).stand_in);  // there is no such object
  for (const char* bad :
       {"{", "7", R"({"what": 7})", R"({"box": [[0, 0], [1, 1]]})", R"({"box": [[0, 0, 0], [1, -1, 0]]})",
        R"({"box": [[0, 0, 0], [1, 1, 1e99]]})", R"({"box": [[null, 0, 0], [1, 1, 1]]})",
        R"({"outlines": [[[0, "a"]]]})", R"({"what": "a", "what": "b"})", R"({"height_m": "tall"})",
        R"({"stand_in": -1})", R"({"object": {"kind": "castle"}})"}) {
    SCOPED_TRACE(bad);
    testing::expect_error([&] { read(bad); }, ErrorCode::record_garbled, "a.obj, line 5");
  }
}

}  // namespace
}  // namespace vantage
