// CityJSON made by hand: what is read of it, and how what is wrong with it is told.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/json_text.h"
#include "io/lod.h"
#include "support/mesh_reading.h"
#include "support/objects.h"
#include "support/temporary_directory.h"

namespace vantage {
namespace {

using io::RawMesh;
using nlohmann::json;
using testing::expect_error;
using testing::read_as;

/// A cube of 2 m as a Solid whose vertices are those of corners(), from `first` on.
json cube_shell(int first = 0) {
  json shell = json::array();
  for (const auto& ring :
       {std::vector<int>{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    json surface = json::array();
    for (const int corner : ring) surface.push_back(first + corner);
    shell.push_back(json::array({surface}));
  }
  return shell;
}

/// Corners of a cube, in the file's whole numbers.
json corners(int low, int high) {
  json vertices = json::array();
  for (int i = 0; i < 8; ++i) vertices.push_back({i & 1 ? high : low, i & 2 ? high : low, i & 4 ? high : low});
  return vertices;
}

json geometry(const char* type, const char* lod, json boundaries) {
  return {{"type", type}, {"lod", lod}, {"boundaries", std::move(boundaries)}};
}

/// One building: a cube of 2 m at (10, 20, 30).
json document() {
  return {{"type", "CityJSON"},
          {"version", "2.0"},
          {"transform", {{"scale", {0.01, 0.01, 0.01}}, {"translate", {10, 20, 30}}}},
          {"vertices", corners(0, 200)},
          {"CityObjects",
           {{"b1", {{"type", "Building"}, {"geometry", {geometry("Solid", "1", json::array({cube_shell()}))}}}}}}};
}

RawMesh read(const json& file, const std::string& lod = "") {
  const core::ProgressReporter progress;
  return io::read_cityjson(io::MeshSource("a.city.json", file.dump()), progress, {}, lod);
}

Mesh mesh_of(const RawMesh& raw) { return {raw.vertices, raw.triangles}; }

void expect_notes(const RawMesh& mesh, std::size_t count) {
  EXPECT_EQ(mesh.notes.size(), count);
  testing::expect_wording(mesh.notes);
}

void expect_unreadable(const json& file, ErrorCode code, const std::string& where = "a.city.json") {
  expect_error([&] { read(file); }, code, where);
}

TEST(ReadCityJson, UndoesTheTransform) {
  const RawMesh mesh = read(document());
  EXPECT_EQ(mesh.format, io::MeshFormat::cityjson);
  EXPECT_EQ(names_of(mesh.objects), std::vector<std::string>{"b1"});
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_NEAR(enclosed_volume(mesh_of(mesh)), 8, 1e-12);
  EXPECT_EQ(bounding_box(mesh_of(mesh)).min, Vec3(10, 20, 30));
  EXPECT_EQ(bounding_box(mesh_of(mesh)).max, Vec3(12, 22, 32));
  EXPECT_TRUE(mesh.notes.empty());
}

TEST(ReadCityJson, TakesEveryTypeOfSurfaces) {
  json file = document();
  json& geometries = file["CityObjects"]["b1"]["geometry"];
  const json solid = json::array({cube_shell()});
  for (const char* type : {"MultiSolid", "CompositeSolid"}) {
    geometries = json::array({geometry(type, "1", json::array({solid}))});
    EXPECT_EQ(read(file).triangles.size(), 12u) << type;
  }
  for (const char* type : {"MultiSurface", "CompositeSurface"}) {
    geometries = json::array({geometry(type, "1", cube_shell())});
    EXPECT_EQ(read(file).triangles.size(), 12u) << type;
  }
}

TEST(ReadCityJson, KeepsCavities) {
  json file = document();
  file["vertices"] = corners(0, 400);
  for (const json& corner : corners(100, 300)) file["vertices"].push_back(corner);
  json cavity = cube_shell(8);
  for (json& surface : cavity) std::reverse(surface[0].begin(), surface[0].end());
  json& boundaries = file["CityObjects"]["b1"]["geometry"][0]["boundaries"];
  boundaries.push_back(cavity);
  const RawMesh mesh = read(file);
  EXPECT_EQ(mesh.triangles.size(), 24u);
  EXPECT_NEAR(enclosed_volume(mesh_of(mesh)), 64 - 8, 1e-12);
  EXPECT_TRUE(mesh.notes.empty());
  boundaries[1] = cube_shell(8);
  expect_notes(read(file), 1);
}

TEST(ReadCityJson, LeavesHolesOpen) {
  json file = document();
  file["vertices"] = {{0, 0, 0},       {1000, 0, 500},  {1000, 1000, 500}, {0, 1000, 0},
                      {200, 200, 100}, {200, 400, 100}, {400, 400, 200},   {400, 200, 200}};
  file["CityObjects"]["b1"]["geometry"] = json::array({geometry("MultiSurface", "1", {{{0, 1, 2, 3}, {4, 5, 6, 7}}})});
  const RawMesh mesh = read(file);
  EXPECT_EQ(mesh.triangles.size(), 8u);
  EXPECT_NEAR(surface_area(mesh_of(mesh)), 96 * std::sqrt(1.25), 1e-9);
}

TEST(ReadCityJson, ChoosesTheLevelOfDetail) {
  EXPECT_EQ(io::choose_lod({1, 2.2, 1.3}, std::nullopt), 2.2);
  EXPECT_EQ(io::choose_lod({1, 2.2, 1.3}, 1.3), 1.3);
  EXPECT_EQ(io::choose_lod({1.2, 2.2, 1.3}, 1), 1.3);  // the highest of its refinements
  EXPECT_EQ(io::choose_lod({1, 1.2, 2.2}, 1), 1);
  EXPECT_EQ(io::choose_lod({0, 1.2, 2.2}, 1.3), 1.2);
  EXPECT_EQ(io::choose_lod({2.2, 3}, 1), 2.2);
  EXPECT_EQ(io::parse_lod("2.2"), 2.2);
  for (const char* bad : {"", "two", "2.2.1", "-1", "10", "nan"}) EXPECT_FALSE(io::parse_lod(bad)) << bad;

  json file = document();
  json& b1 = file["CityObjects"]["b1"]["geometry"];
  b1.push_back(geometry("MultiSurface", "0", json::array({cube_shell()[0]})));
  file["CityObjects"]["b2"] = {{"type", "Building"},
                               {"geometry", {geometry("MultiSurface", "2.2", json::array({cube_shell()[0]}))}}};
  EXPECT_EQ(read(file).triangles.size(), 14u);
  const RawMesh ground = read(file, "0");
  EXPECT_EQ(ground.triangles.size(), 4u);
  expect_notes(ground, 1);
  EXPECT_TRUE(read(file, "1").notes.size() == 1);
  expect_error([&] { read(file, "3"); }, ErrorCode::level_of_detail_missing, "a.city.json");
  expect_error([&] { read(file, "high"); }, ErrorCode::value_syntax, "a.city.json");
}

TEST(ReadCityJson, PlacesInstancesOfTemplates) {
  json file = document();
  // A right-angled triangle, made twice as large, turned by 90 degrees about z and put at vertex 7.
  file["geometry-templates"] = {{"templates", {geometry("MultiSurface", "2", {{{0, 1, 2}}})}},
                                {"vertices-templates", {{0.5, 0, 0}, {1.5, 0, 0}, {0.5, 0.25, 0}}}};
  const json instance = {{"type", "GeometryInstance"},
                         {"template", 0},
                         {"boundaries", {7}},
                         {"transformationMatrix", {0, -2, 0, 1, 2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1}}};
  file["CityObjects"] = {{"t1", {{"type", "SolitaryVegetationObject"}, {"geometry", {instance}}}},
                         {"t2", {{"type", "SolitaryVegetationObject"}, {"geometry", {instance}}}}};
  file["CityObjects"]["t2"]["geometry"][0]["boundaries"][0] = 0;
  const RawMesh mesh = read(file);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices[0], Vec3(12 + 1, 22 + 1, 32));
  EXPECT_EQ(mesh.vertices[1], Vec3(12 + 1, 22 + 3, 32));
  EXPECT_EQ(mesh.vertices[2], Vec3(12 + 0.5, 22 + 1, 32));
  EXPECT_EQ(mesh.vertices[3], Vec3(10 + 1, 20 + 1, 30));

  const auto with = [&](const char* key, const json& value) {
    json bad = file;
    bad["CityObjects"]["t1"]["geometry"][0][key] = value;
    return bad;
  };
  const std::string where = "CityObject \"t1\", geometry 0";
  expect_unreadable(with("template", 1), ErrorCode::mesh_syntax, where);
  expect_unreadable(with("boundaries", {8}), ErrorCode::mesh_syntax, where);
  expect_unreadable(with("boundaries", {1, 2}), ErrorCode::mesh_syntax, where);
  expect_unreadable(with("transformationMatrix", {1, 0, 0}), ErrorCode::mesh_syntax, where);
  expect_unreadable(with("transformationMatrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}),
                    ErrorCode::mesh_syntax, where);
  json nested = file;
  nested["geometry-templates"]["templates"][0] = instance;
  expect_unreadable(nested, ErrorCode::mesh_syntax, where);
  json many = file;
  many["CityObjects"]["t1"]["geometry"] = std::vector<json>(200, instance);
  const core::ProgressReporter progress;
  core::ReadLimits limits;
  limits.repeated_triangles = 10;
  const io::MeshSource small("a", file.dump());
  EXPECT_NO_THROW(io::read_cityjson(small, progress, limits));
  // Of a template with many triangles: few bytes, many instances.
  json surfaces = std::vector<json>(1000, {{0, 1, 2}});
  many["geometry-templates"]["templates"][0]["boundaries"] = surfaces;
  const io::MeshSource large("a", many.dump());
  expect_error([&] { io::read_cityjson(large, progress, limits); }, ErrorCode::mesh_too_large, "\"t1\"");
}

TEST(ReadCityJson, TurnsMirroredInstancesBack) {
  json file = document();
  file["geometry-templates"] = {{"templates", {geometry("Solid", "2", json::array({cube_shell()}))}},
                                {"vertices-templates", corners(0, 1)}};
  file["CityObjects"]["b1"]["geometry"] = {
      {{"type", "GeometryInstance"},
       {"template", 0},
       {"boundaries", {0}},
       {"transformationMatrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}};
  const RawMesh mesh = read(file);
  EXPECT_NEAR(enclosed_volume(mesh_of(mesh)), 1, 1e-12);
  EXPECT_TRUE(mesh.notes.empty());
}

TEST(ReadCityJson, NamesObjectsAndLeavesPartsToThemselves) {
  json file = document();
  json& objects = file["CityObjects"];
  objects["p1"] = objects["b1"];
  objects["p1"]["type"] = "BuildingPart";
  objects["p1"]["parents"] = {"b1"};
  objects["p1"]["attributes"] = {{"name", "Tower"}, {"height", 3}};
  objects["b1"].erase("geometry");
  objects["b1"]["children"] = {"p1"};
  objects["e"] = {{"type", "+Bench"}};
  objects["l"] = {{"type", "Road"}, {"geometry", {geometry("MultiLineString", "0", {{0, 1}})}}};
  const RawMesh mesh = read(file);
  EXPECT_EQ(names_of(mesh.objects), std::vector<std::string>{"p1 Tower"});
  expect_notes(mesh, 2);
}

TEST(ReadCityJson, NotesWhatIsWrongInAWayThatASoupMayBe) {
  json file = document();
  json& shell = file["CityObjects"]["b1"]["geometry"][0]["boundaries"][0];
  const json sound = shell;
  shell.erase(5);
  expect_notes(read(file), 1);
  shell = sound;
  std::reverse(shell[5][0].begin(), shell[5][0].end());
  expect_notes(read(file), 1);
  for (std::size_t i = 0; i < 5; ++i) std::reverse(shell[i][0].begin(), shell[i][0].end());
  expect_notes(read(file), 1);

  file = document();
  file["vertices"][7][2] = 260;
  const RawMesh bent = read(file);
  EXPECT_EQ(bent.triangles.size(), 14u) << "both diagonals of a face that is not flat";

  file = document();
  file["vertices"].push_back({900, 0, 0});
  file["vertices"].push_back({950, 0, 0});
  file["vertices"].push_back({900, 50, 0});
  file["CityObjects"]["b1"]["geometry"] = json::array({geometry("MultiSurface", "1", {{{0, 1, 3, 2}, {8, 9, 10}}})});
  expect_notes(read(file), 1);
}

TEST(ReadCityJson, TakesRepeatedCornersAsOne) {
  json file = document();
  json& ring = file["CityObjects"]["b1"]["geometry"][0]["boundaries"][0][0][0];
  ring = {0, 0, 2, 2, 2, 3, 1, 0};  // and closed, as in GML
  file["vertices"].push_back({0, 0, 0});
  file["CityObjects"]["b1"]["geometry"][0]["boundaries"][0][1][0].push_back(4);
  file["CityObjects"]["b1"]["geometry"][0]["boundaries"][0].push_back({{0, 8, 1}});  // a line there and back
  const RawMesh mesh = read(file);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.dropped_faces, 1u);
  EXPECT_TRUE(mesh.notes.empty());
}

TEST(ReadCityJson, ReadsAllVersions) {
  json file = document();
  file["version"] = "1.1";
  EXPECT_EQ(read(file).triangles.size(), 12u);
  file["version"] = "1.0";
  file["CityObjects"]["b1"]["geometry"][0]["lod"] = 2.2;  // a number then
  file.erase("transform");
  file["metadata"] = {{"referenceSystem", "urn:ogc:def:crs:EPSG::28992"}};
  const RawMesh mesh = read(file, "2.2");
  EXPECT_EQ(mesh.crs, "urn:ogc:def:crs:EPSG::28992");
  EXPECT_EQ(bounding_box(mesh_of(mesh)).max, Vec3(200, 200, 200));
  for (const json& version : {json("0.9"), json("1.00"), json("3.0"), json("")}) {
    file["version"] = version;
    expect_unreadable(file, ErrorCode::mesh_unsupported);
  }
}

TEST(ReadCityJson, ReadsTextSequences) {
  json head = document();
  head["CityObjects"] = json::object();
  head["vertices"] = json::array();
  json feature = {{"type", "CityJSONFeature"},
                  {"id", "b1"},
                  {"CityObjects", document()["CityObjects"]},
                  {"vertices", corners(0, 200)}};
  json second = feature;
  second["CityObjects"] = {{"b2", feature["CityObjects"]["b1"]}};
  second["vertices"] = corners(1000, 1300);
  const std::string text = head.dump() + "\n" + feature.dump() + "\r\n\n" + second.dump();
  const RawMesh mesh = read_as("a.city.jsonl", text);
  EXPECT_EQ(names_of(mesh.objects), (std::vector<std::string>{"b1", "b2"}));
  EXPECT_EQ(mesh.triangles.size(), 24u);
  EXPECT_NEAR(enclosed_volume(mesh_of(mesh)), 8 + 27, 1e-9);

  expect_error([&] { read_as("a.city.jsonl", text.substr(text.find('\n') + 1)); }, ErrorCode::mesh_syntax, "line 1");
  second["CityObjects"]["b2"]["geometry"][0]["boundaries"][0][0][0][0] = 8;
  expect_error([&] { read_as("a.jsonl", head.dump() + "\n\n" + second.dump()); }, ErrorCode::mesh_syntax,
               "a.jsonl, line 3, CityObject \"b2\", geometry 0, shell 0, surface 0, ring 0");
  expect_error([&] { read_as("a.jsonl", head.dump() + "\n" + feature.dump() + "\n{]"); }, ErrorCode::mesh_syntax,
               "a.jsonl, line 3, column 2");
  expect_error([&] { read_as("a.jsonl", head.dump() + "\n" + feature.dump() + "\n" + head.dump()); },
               ErrorCode::mesh_syntax, "line 3");
}

TEST(ReadCityJson, SaysWhereTheJsonEnds) {
  expect_error([] { read_as("a.city.json", "{\"type\": \"CityJSON\",\n  \"version\" \"2.0\"}"); },
               ErrorCode::mesh_syntax, "a.city.json, line 2, column 17");
  expect_error([] { read_as("a.json", "hello"); }, ErrorCode::mesh_syntax, "line 1, column 1");
  expect_error([] { read_as("a.json", "[]"); }, ErrorCode::mesh_syntax, "a.json");
  expect_error([] { read_as("a.json", "{}"); }, ErrorCode::mesh_syntax, "a.json");
  expect_error([] { read_as("a.json", R"({"type": "FeatureCollection"})"); }, ErrorCode::mesh_syntax, "a.json");
  const std::string deep = R"({"type":"CityJSON","a":)" + std::string(200, '[');
  expect_error([&] { read_as("a.json", deep); }, ErrorCode::mesh_syntax, "a.json");
}

TEST(ReadCityJson, NamesWhatIsWrongInTheDocument) {
  const auto with = [](const json& patch) {
    json file = document();
    file.merge_patch(patch);
    return file;
  };
  expect_unreadable(with({{"version", nullptr}}), ErrorCode::mesh_syntax);
  expect_unreadable(with({{"vertices", nullptr}}), ErrorCode::mesh_syntax);
  expect_unreadable(with({{"vertices", 7}}), ErrorCode::mesh_syntax);
  expect_unreadable(with({{"vertices", {{1, 2, 3}, {1, 2}}}}), ErrorCode::mesh_syntax);
  expect_unreadable(with({{"transform", nullptr}}), ErrorCode::mesh_syntax);
  expect_unreadable(with({{"transform", {{"scale", nullptr}}}}), ErrorCode::mesh_syntax);
  expect_unreadable(with({{"transform", {{"scale", {1, 1}}}}}), ErrorCode::mesh_syntax);
  expect_unreadable(with({{"transform", {{"scale", {1, 0, 1}}}}}), ErrorCode::mesh_syntax);
  expect_unreadable(with({{"transform", {{"scale", {1, 1e300, 1}}, {"translate", {0, 1e308, "x"}}}}}),
                    ErrorCode::mesh_syntax);
  expect_unreadable(with({{"metadata", {{"referenceSystem", 7415}}}}), ErrorCode::mesh_syntax);
  json misspelt = document();
  misspelt["City Objects"] = misspelt["CityObjects"];
  misspelt.erase("CityObjects");
  expect_unreadable(misspelt, ErrorCode::mesh_syntax);
  expect_unreadable(with({{"CityObjects", {{"b1", nullptr}}}}), ErrorCode::mesh_empty);
}

TEST(ReadCityJson, NamesWhatIsWrongInAGeometry) {
  const std::string where = "a.city.json, CityObject \"b1\", geometry 0";
  const auto with = [](const char* pointer, const json& value) {
    json file = document();
    file[json::json_pointer("/CityObjects/b1" + std::string(pointer))] = value;
    return file;
  };
  expect_unreadable(with("/geometry/0/type", "Sphere"), ErrorCode::mesh_syntax, where);
  expect_unreadable(with("/geometry/0/type", 3), ErrorCode::mesh_syntax, where);
  expect_unreadable(with("/geometry/0/lod", "high"), ErrorCode::mesh_syntax, where);
  expect_unreadable(with("/geometry/0/boundaries", "x"), ErrorCode::mesh_syntax, where);
  expect_unreadable(with("/geometry", 5), ErrorCode::mesh_syntax, "CityObject \"b1\"");
  expect_unreadable(with("", 5), ErrorCode::mesh_syntax, "CityObject \"b1\"");
  expect_unreadable(with("/type", nullptr), ErrorCode::mesh_syntax, "CityObject \"b1\"");

  const std::string ring = where + ", shell 0, surface 3, ring 0";
  const std::string at = "/geometry/0/boundaries/0/3/0";
  expect_unreadable(with(at.c_str(), {1, 2}), ErrorCode::mesh_syntax, ring);
  expect_unreadable(with(at.c_str(), {1, 2, 8}), ErrorCode::mesh_syntax, ring);
  expect_unreadable(with(at.c_str(), {1, 2, -1}), ErrorCode::mesh_syntax, ring);
  expect_unreadable(with(at.c_str(), {1, 2, 0.5}), ErrorCode::mesh_syntax, ring);
  expect_unreadable(with(at.c_str(), {1, 2, nullptr}), ErrorCode::mesh_syntax, ring);
  expect_unreadable(with(at.c_str(), {{1, 2, 3}}), ErrorCode::mesh_syntax, ring);
  expect_unreadable(with(at.c_str(), 1), ErrorCode::mesh_syntax, ring);
  expect_unreadable(with("/geometry/0/boundaries/0/3", json::array()), ErrorCode::mesh_syntax, "surface 3");
  expect_unreadable(with("/geometry/0/boundaries", cube_shell()), ErrorCode::mesh_syntax, "shell 0, surface 0, ring 0");
  expect_unreadable(with("/geometry/0/type", "MultiSurface"), ErrorCode::mesh_syntax, "surface 0, ring 0");
}

TEST(ReadCityJson, KeepsWithinItsLimits) {
  const core::ProgressReporter progress;
  core::ReadLimits limits;
  limits.corners = 3;
  const io::MeshSource source("a.city.json", document().dump());
  expect_error([&] { io::read_cityjson(source, progress, limits); }, ErrorCode::mesh_too_large, "surface 0");
  limits = {};
  limits.json_values = 20;
  expect_error([&] { io::read_cityjson(source, progress, limits); }, ErrorCode::mesh_syntax, "a.city.json");
}

/// Of what is parsed, empty lists take most memory for a byte of text, then empty texts.
TEST(ReadCityJson, TheMemoryOfItsJsonIsBounded) {
  const core::ProgressReporter progress;
  for (const std::string part : {"[],", "{\"\":{\"\":0}},", "\"\",", "0.5,"}) {
    SCOPED_TRACE(part);
    std::string text = "[";
    for (int i = 0; i < 10000; ++i) text += part;
    text += "0]";
    core::ReadLimits limits;
    limits.json_bytes = 300'000;
    EXPECT_THROW(io::parse_json(text, progress, limits), io::JsonProblem);
    limits.json_bytes = 5'000'000;
    EXPECT_EQ(io::parse_json(text, progress, limits).size(), 10001u);
  }
  core::ReadLimits limits;
  limits.json_bytes = 500;
  const io::MeshSource source("a.city.json", document().dump());
  expect_error([&] { io::read_cityjson(source, progress, limits); }, ErrorCode::mesh_syntax, "a.city.json");
}

TEST(ReadCityJson, IsToldByItsContent) {
  using io::MeshFormat;
  const auto format = [](const std::string& name, const std::string& bytes) {
    return io::mesh_format(io::MeshSource(name, bytes));
  };
  EXPECT_EQ(format("a", " {\n\"type\" : \"CityJSON\""), MeshFormat::cityjson);
  const std::string document = R"({"version": "2.0", "type":"CityJSON"})";
  EXPECT_EQ(format("a.gltf", document), MeshFormat::cityjson);
  EXPECT_EQ(format("a", "{\"type\":\"CityJSONFeature\"}"), MeshFormat::cityjson);
  EXPECT_EQ(format("a", "{\"note\":\"CityJSON\"}"), MeshFormat::gltf);
  EXPECT_EQ(format("a.gltf", "{}"), MeshFormat::gltf);
  EXPECT_EQ(format("a.json", "{\"asset\": {}}"), MeshFormat::gltf);
  EXPECT_EQ(format("b.city.json", "{}"), MeshFormat::cityjson);
  EXPECT_EQ(format("a.city.jsonl.gz", "?"), MeshFormat::cityjson);
}

/// What of the ledger matters: name, what, why, and what stands in.
std::vector<std::string> told(const RawMesh& mesh) {
  std::vector<std::string> lines;
  for (const auto& [entry, holder, is_stated] : mesh.ledger) {
    lines.push_back(display_name(entry.object) + ": " + entry.what + ": " + entry.reason + ": " + entry.instead);
  }
  return lines;
}

TEST(ReadCityJson, ObjectsWithoutSurfacesAreInTheLedger) {
  json file = document();
  file["vertices"].push_back({5000, 5000, 100});
  json& objects = file["CityObjects"];
  objects["empty"] = {{"type", "Building"}, {"attributes", {{"measuredHeight", 30}}}, {"geometry", json::array()}};
  objects["extent"] = {{"type", "Bridge"}, {"geographicalExtent", {100, 100, 30, 120, 110, 45}}};
  objects["garbled"] = {{"type", "Bridge"}, {"geographicalExtent", {100, 100, 30, 0, 0, 0}}};
  objects["tree"] = {{"type", "SolitaryVegetationObject"},
                     {"geometry", json::array({geometry("MultiPoint", "1", json::array({8}))})}};
  objects["part"] = objects["b1"];
  objects["part"]["type"] = "BuildingPart";
  objects["parent"] = {{"type", "Building"}, {"children", {"part"}}};
  objects["orphaned"] = {{"type", "Building"}, {"children", {"gone"}}};
  const RawMesh mesh = read(file);
  testing::expect_wording(told(mesh));
  ASSERT_EQ(mesh.ledger.size(), 5u);
  for (const auto& [entry, holder, is_stated] : mesh.ledger) {
    const bool has_extent = entry.object.source_id == "extent";
    EXPECT_EQ(holder.triangles.size(), has_extent ? 12u : 0u) << entry.object.source_id;
    EXPECT_EQ(entry.box.has_value(), has_extent || entry.object.source_id == "tree") << entry.object.source_id;
  }
  EXPECT_EQ(mesh.ledger[0].entry.height_m, 30);  // in the order of their ids
  EXPECT_EQ(mesh.ledger[1].entry.height_m, 15);
  EXPECT_EQ(mesh.ledger[4].entry.box->min, Vec3(60, 70, 31));
}

TEST(ReadCityJson, PartsStandForTheirWholeIfAllAreThereAndHaveABody) {
  const json extent = {100, 100, 30, 200, 200, 80};
  const auto is_held = [&](const json& children, const char* type, const json& body) {
    json file = document();
    file["vertices"].push_back({400, 400, 400});
    json& objects = file["CityObjects"];
    objects["part"] = {{"type", type}, {"geometry", body}};
    objects["whole"] = {{"type", "Building"}, {"children", children}, {"geographicalExtent", extent}};
    for (const auto& missing : read(file).ledger) {
      if (missing.entry.object.source_id == "whole") return !missing.holder.triangles.empty();
    }
    return false;
  };
  const json body = document()["CityObjects"]["b1"]["geometry"];
  EXPECT_FALSE(is_held({"part"}, "BuildingPart", body));
  EXPECT_TRUE(is_held({"part", "gone"}, "BuildingPart", body));
  EXPECT_TRUE(is_held({"part"}, "BuildingInstallation", body));
  EXPECT_TRUE(is_held({"part"}, "BuildingPart", json::array()));
  const json flat = json::array({geometry("MultiSurface", "0", json::array({json::array({{0, 1, 3, 2}})}))});
  const json nothing = json::array({geometry("MultiSurface", "1", json::array({json::array({{0, 0, 0}})}))});
  const json shell = json::array({geometry("Solid", "1", json::array({json::array()}))});
  const json line = json::array({geometry("MultiSurface", "1", json::array({json::array({{0, 7, 8}})}))});
  const json level = json::array({geometry("MultiSurface", "1", json::array({json::array({{0, 1, 3, 2}})}))});
  for (const json& none : {flat, nothing, shell, line, level})
    EXPECT_TRUE(is_held({"part"}, "BuildingPart", none)) << none;
  EXPECT_TRUE(is_held({"whole"}, "BuildingPart", body));
}

// Of several heights that a file states the highest counts.
TEST(ReadCityJson, StandInsAreAsHighAsAnythingSays) {
  const auto top = [](const json& extent, const json& height, const json& shape) {
    json file = document();
    json object = file["CityObjects"]["b1"];
    object["geometry"] = shape;
    if (!extent.is_null()) object["geographicalExtent"] = extent;
    if (!height.is_null()) object["attributes"]["measuredHeight"] = height;
    file["CityObjects"]["other"] = object;
    const RawMesh mesh = read(file);
    const auto& missing = mesh.ledger.at(0);
    EXPECT_EQ(missing.entry.box->max.z(), missing.holder.triangles.empty() ? 0 : bounding_box(missing.holder).max.z());
    return missing.entry.box->max.z();
  };
  const json none = json::array(), low = {9, 19, 30, 13, 23, 35}, thin = {9, 19, 30, 13, 23, 30};
  const json flat = json::array({geometry("MultiSurface", "0", json::array({json::array({{0, 1, 3, 2}})}))});
  const json level = json::array({geometry("MultiSurface", "2", json::array({json::array({{0, 1, 3, 2}})}))});
  const json points = json::array({geometry("MultiPoint", "1", json::array({0, 1, 2, 3}))});
  EXPECT_EQ(top(low, 20, none), 50);
  EXPECT_EQ(top(thin, 20, none), 50);
  EXPECT_EQ(top(low, 2, none), 35);
  EXPECT_EQ(top(low, 2, flat), 35);
  EXPECT_EQ(top(low, {}, flat), 35);
  EXPECT_EQ(top({}, 20, points), 50);
  EXPECT_EQ(top({}, 20, level), 50);
}

// An extent that is wider than the footprint holds what it says; one that tells no more than that is no height.
TEST(ReadCityJson, ExtentsCountBesideFootprints) {
  const auto with_extent = [](const json& extent, const json& height = {}, const char* lod = "0") {
    json file = document();
    json& object = file["CityObjects"]["b1"];
    object["geometry"] = json::array({geometry("MultiSurface", lod, json::array({json::array({{0, 1, 3, 2}})}))});
    object["geographicalExtent"] = extent;
    if (!height.is_null()) object["attributes"]["measuredHeight"] = height;
    file["vertices"][3] = {200, 200, 100};  // a corner that is 1 m higher
    return read(file).ledger;
  };
  const auto top = [](const io::Missing& missing) { return bounding_box(missing.holder).max; };
  const auto wide = with_extent({10, 20, 30, 20, 22, 40}, 5);
  ASSERT_EQ(wide.size(), 2u);
  EXPECT_EQ(top(wide[0]), Vec3(12, 22, 40));
  EXPECT_EQ(top(wide[1]), Vec3(20, 22, 40));
  const auto elsewhere = with_extent({1e7, 20, 30, 2e7, 22, 40}, 5);
  ASSERT_EQ(elsewhere.size(), 2u);
  EXPECT_EQ(top(elsewhere[0]), Vec3(12, 22, 36));
  const auto same = with_extent({10, 20, 30, 12, 22, 31.001});
  ASSERT_EQ(same.size(), 1u);
  EXPECT_TRUE(same[0].holder.triangles.empty());
  EXPECT_FALSE(same[0].entry.box->max.allFinite());
  const auto roof = with_extent({10, 20, 25, 12, 22, 31}, {}, "0.3");
  ASSERT_EQ(roof.size(), 1u);
  EXPECT_NEAR(std::abs(enclosed_volume(roof[0].holder)), 2 * (2 * 2 * 6), 1e-9) << "by both diagonals";
}

TEST(ReadCityJson, WhatHasNoHeightMayReachAnywhere) {
  json file = document();
  json& objects = file["CityObjects"];
  objects["flat"] = {{"type", "Building"}, {"geographicalExtent", {100, 100, 30, 120, 110, 30}}};
  objects["points"] = {{"type", "Building"}, {"geometry", json::array({geometry("MultiPoint", "1", {0, 1, 2, 3})})}};
  const auto ledger = read(file).ledger;
  ASSERT_EQ(ledger.size(), 2u);
  for (const auto& [entry, holder, is_stated] : ledger) {
    EXPECT_TRUE(holder.triangles.empty());
    EXPECT_FALSE(entry.box->max.allFinite()) << entry.object.source_id;
  }
}

TEST(ReadCityJson, AnEmptyGeometryBesideOthersIsTold) {
  json file = document();
  file["CityObjects"]["b1"]["geometry"].push_back(geometry("Solid", "1", json::array()));
  const RawMesh mesh = read(file);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  testing::expect_wording(told(mesh));
}

TEST(ReadCityJson, AnEmptyGeometryDoesNotTakeTheBodyOfAnotherLevel) {
  json file = document();
  file["CityObjects"]["b1"]["geometry"].push_back(geometry("MultiSurface", "3", json::array()));
  const RawMesh mesh = read(file);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  ASSERT_EQ(mesh.ledger.size(), 1u);
  EXPECT_TRUE(mesh.ledger[0].entry.stand_in);
  testing::expect_wording(told(mesh));
}

TEST(ReadCityJson, EdgesOfRoofsAreHeldDownToTheGround) {
  json file = document();
  json& building = file["CityObjects"]["b1"];
  building["geometry"] = json::array({geometry("MultiSurface", "0.3", json::array({json::array({{0, 1, 3, 2}})}))});
  building["attributes"]["measuredHeight"] = "30";  // a text counts, too
  EXPECT_EQ(bounding_box(read(file).ledger.at(0).holder).min, Vec3(10, 20, 0));
  building["geographicalExtent"] = {10, 20, 5, 12, 22, 30};
  const RawMesh mesh = read(file);
  EXPECT_EQ(bounding_box(mesh.ledger.at(0).holder).min, Vec3(10, 20, 5));
  EXPECT_EQ(mesh.ledger[0].entry.box->min, Vec3(10, 20, 5));
}

TEST(ReadCityJson, RaisesFootprintsToTheirHeight) {
  json file = document();
  json& building = file["CityObjects"]["b1"];
  building["geometry"] = json::array({geometry("MultiSurface", "0", json::array({json::array({{0, 1, 3, 2}})}))});
  EXPECT_TRUE(read(file).ledger.at(0).holder.triangles.empty());
  building["attributes"]["measuredHeight"] = 30;
  const RawMesh mesh = read(file);
  ASSERT_EQ(mesh.ledger.size(), 1u);
  const Mesh& holder = mesh.ledger[0].holder;
  EXPECT_NEAR(std::abs(enclosed_volume(holder)), 120, 1e-9);
  EXPECT_EQ(bounding_box(holder).max, Vec3(12, 22, 60));
  testing::expect_wording(told(mesh));
}

TEST(ReadCityJson, TellsOfFootprintsOfAllThatDoesNotLieOnTheGround) {
  json file = document();
  json& object = file["CityObjects"]["b1"];
  object["geometry"] = json::array({geometry("MultiSurface", "0", json::array({json::array({{0, 1, 3, 2}})}))});
  const auto holders = [&](const char* type, bool has_height) {
    object["type"] = type;
    object["attributes"] = has_height ? json{{"measuredHeight", 30}} : json::object();
    std::vector<bool> are_held;
    for (const auto& [entry, holder, is_stated] : read(file).ledger) are_held.push_back(!holder.triangles.empty());
    return are_held;
  };
  for (const char* type : {"OtherConstruction", "BuildingInstallation", "Tunnel", "PlantCover", "CityFurniture"}) {
    EXPECT_EQ(holders(type, false), std::vector<bool>{false}) << type;
    EXPECT_EQ(holders(type, true), std::vector<bool>{true}) << type;
  }
  for (const char* type : {"Road", "Railway", "TransportSquare", "Waterway", "WaterBody", "LandUse", "TINRelief"}) {
    EXPECT_EQ(holders(type, false), std::vector<bool>{}) << type;
    EXPECT_EQ(holders(type, true), std::vector<bool>{true}) << type;
  }
}

// measuredHeight is in metres, whatever z is in.
TEST(ReadCityJson, RaisesFootprintsByMetresWhereHeightsAreInFeet) {
  testing::TemporaryDirectory folder;
  json file = document();
  file["transform"]["translate"] = {500000, 5500000, 100};
  json& building = file["CityObjects"]["b1"];
  building["geometry"] = json::array({geometry("MultiSurface", "0", json::array({json::array({{0, 1, 3, 2}})}))});
  building["attributes"]["measuredHeight"] = 30;
  file["CityObjects"]["gone"] = {{"type", "Bridge"},
                                 {"geographicalExtent", {500000, 5500000, 0, 500009, 5500009, 100}}};
  const auto expect_height = [&](const SceneReadOptions& options, double z, double extent_m) {
    testing::write_bytes(folder / "a.city.json", file.dump());
    const Scene scene = read_scene(folder / "a.city.json", options);
    ASSERT_EQ(scene.ledger.size(), 2u);
    EXPECT_NEAR(scene.ledger[0].box->min.z(), z, 1e-6);
    EXPECT_NEAR(scene.ledger[0].box->max.z(), z + 30, 1e-6);
    EXPECT_EQ(scene.ledger[0].height_m, 30);
    EXPECT_NEAR(bounding_box(scene.mesh).max.z(), z + 30, 1e-6);
    EXPECT_NEAR(*scene.ledger[1].height_m, extent_m, 1e-6);
  };
  constexpr double kFoot = 1200.0 / 3937;
  expect_height({}, 100, 100);
  expect_height({.crs = "EPSG:25832+6360"}, 100 * kFoot, 100 * kFoot);
  file["metadata"]["referenceSystem"] = "EPSG:25832+6360";
  expect_height({}, 100 * kFoot, 100 * kFoot);
  expect_height({.scale = 0.5}, 50 * kFoot, 50 * kFoot);
  expect_height({.crs = "EPSG:25832"}, 100, 100);
  expect_height({.crs = "none"}, 100, 100);
}

TEST(ReadCityJson, HoldsOpenShellsByTheBoxOfTheirOpenEdges) {
  json file = document();
  json& shell = file["CityObjects"]["b1"]["geometry"][0]["boundaries"][0];
  shell.erase(5);  // the wall at x = 12
  const RawMesh mesh = read(file);
  ASSERT_EQ(mesh.ledger.size(), 1u);
  EXPECT_EQ(mesh.ledger[0].entry.box->min, Vec3(12, 20, 30));
  EXPECT_EQ(mesh.ledger[0].entry.box->max, Vec3(12, 22, 32));
  EXPECT_TRUE(mesh.ledger[0].entry.may_be_larger);
  shell = json::array({shell[0], shell[1]});  // floor and roof alone
  EXPECT_EQ(bounding_box(read(file).ledger.at(0).holder).min, Vec3(10, 20, 30));
  testing::expect_wording(told(mesh));
}

// In the scene the stand-ins are objects, or the file is refused.
TEST(ReadCityJson, StandInsAreObjectsOfTheScene) {
  testing::TemporaryDirectory folder;
  json file = document();
  file["CityObjects"]["gone"] = {{"type", "Bridge"}, {"geographicalExtent", {100, 100, 30, 120, 110, 45}}};
  testing::write_bytes(folder / "a.city.json", file.dump());
  const Scene scene = read_scene(folder / "a.city.json");
  ASSERT_EQ(scene.ledger.size(), 1u);
  ASSERT_EQ(scene.ledger[0].stand_in, 1u);
  EXPECT_EQ(scene.objects[1], (SceneObject{"", "gone", ObjectKind::stand_in}));
  EXPECT_EQ(bounding_box(scene.mesh).max, Vec3(120, 110, 45));
  EXPECT_EQ(scene.ledger[0].box->max, Vec3(120, 110, 45));
  const Scene without = read_scene(folder / "a.city.json", {.missing = MissingPolicy::warn});
  EXPECT_EQ(without.objects.size(), 1u);
  ASSERT_EQ(without.ledger.size(), 1u);
  EXPECT_FALSE(without.ledger[0].stand_in);
  EXPECT_TRUE(without.ledger[0].instead.empty());
  expect_error([&] { read_scene(folder / "a.city.json", {.missing = MissingPolicy::refuse}); },
               ErrorCode::scene_incomplete, "a.city.json");
  // An extent that is nowhere near is garbled.
  file["CityObjects"]["gone"]["geographicalExtent"] = {1e7, 1e7, 0, 2e7, 2e7, 9};
  testing::write_bytes(folder / "a.city.json", file.dump());
  EXPECT_FALSE(read_scene(folder / "a.city.json").ledger.at(0).stand_in);
}

}  // namespace
}  // namespace vantage
