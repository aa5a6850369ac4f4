#include <gtest/gtest.h>

#include <ctime>
#include <limits>
#include <nlohmann/json.hpp>

#include "support/mesh_reading.h"
#include "support/objects.h"
#include "support/temporary_directory.h"

namespace vantage::internal::io {
namespace {

using nlohmann::json;
using testing::bytes_of;
using testing::expect_error;
using testing::read_as;

using Names = std::vector<std::string>;
using Triangles = std::vector<Triangle>;

std::string base64(const std::string& bytes) {
  const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] & 0xffu : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

/// Four corners of a unit square in x and y, as floats, then the indices 0 1 2 0 2 3 as 16-bit numbers: 60 bytes.
std::string square() {
  std::string bytes;
  for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f}) bytes += bytes_of(value);
  for (const std::uint16_t index : {0, 1, 2, 0, 2, 3}) bytes += bytes_of(index);
  return bytes;
}

/// One node with that square. Accessor 0 holds the positions, 1 the indices.
json document() {
  return json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "name": "way/17"}],
    "meshes": [{"name": "wall", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
    "buffers": [{"byteLength": 60}]})");
}

json embedded(json gltf, const std::string& bytes = square()) {
  gltf["buffers"][0] = {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}};
  return gltf;
}

std::string chunk(const std::string& type, std::string bytes, char padding) {
  while (bytes.size() % 4 != 0) bytes += padding;
  return bytes_of(static_cast<std::uint32_t>(bytes.size())) + type + bytes;
}

std::string glb(const json& gltf, const std::string& bytes = square()) {
  const std::string chunks = chunk("JSON", gltf.dump(), ' ') + chunk(std::string("BIN\0", 4), bytes, '\0');
  return "glTF" + bytes_of(2u) + bytes_of(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

RawMesh read(const json& gltf) { return read_as("a.gltf", embedded(gltf).dump()); }

void expect_unreadable(const json& gltf, ErrorCode code) {
  expect_error([&] { read_as("bad.gltf", gltf.dump()); }, code, "bad.gltf");
}

TEST(ReadGltf, ReadsEmbeddedBinaryAndExternalBuffers) {
  testing::TemporaryDirectory folder;
  testing::write_bytes(folder / "the square.bin", square());
  json external = document();
  external["buffers"][0]["uri"] = "the%20square.bin";
  testing::write_bytes(folder / "a.gltf", external.dump());
  for (const RawMesh& mesh : {read(document()), read_as("a.glb", glb(document())), read_mesh_file(folder / "a.gltf")}) {
    EXPECT_EQ(mesh.format, MeshFormat::gltf);
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}));
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(names_of(mesh.objects), Names{"way/17"});
  }
}

TEST(ReadGltf, KeepsDoublePrecisionOfNodes) {
  json gltf = document();
  gltf["nodes"][0]["translation"] = {580000.123456789, 1000.1, -4785000.987654321};
  EXPECT_EQ(read(gltf).vertices[0], Vec3(580000.123456789, 1000.1, -4785000.987654321));
  gltf["nodes"][0].erase("translation");
  gltf["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 580000.123456789, 1000.1, -4785000.987654321, 1};
  EXPECT_EQ(read(gltf).vertices[0], Vec3(580000.123456789, 1000.1, -4785000.987654321));
}

TEST(ReadGltf, MovesMeshesByTheirNodesAndParents) {
  json gltf = document();
  // Scale, then a quarter turn about z, then the translation; all that inside a parent that is moved along x.
  gltf["nodes"] = json::parse(R"([
    {"name": "city", "translation": [100, 0, 0], "children": [1, 2]},
    {"mesh": 0, "translation": [0, 10, 0], "rotation": [0, 0, 0.70710678118654752, 0.70710678118654752], "scale": [2, 3, 1]},
    {"mesh": 0, "name": "mirrored", "scale": [-1, 1, 1]}])");
  const RawMesh mesh = read(gltf);
  EXPECT_EQ(names_of(mesh.objects), (Names{"wall", "mirrored"}));  // the first node has no name; its mesh has one
  ASSERT_EQ(mesh.vertices.size(), 8u);
  EXPECT_LT((mesh.vertices[2] - Vec3(97, 12, 0)).norm(), 1e-13);
  EXPECT_EQ(mesh.vertices[6], Vec3(99, 1, 0));
  EXPECT_EQ(mesh.triangles[2], (Triangle{4, 6, 5}));  // turned, so that it still faces +z
  EXPECT_EQ(mesh.object_of, (std::vector<std::uint32_t>{0, 0, 1, 1}));
}

TEST(ReadGltf, ReadsStripsFansAndUnindexedTriangles) {
  json gltf = document();
  json& primitive = gltf["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  expect_unreadable(embedded(gltf), ErrorCode::mesh_syntax);  // four vertices: one triangle and a rest
  primitive["mode"] = 5;
  EXPECT_EQ(read(gltf).triangles, (Triangles{{0, 1, 2}, {1, 3, 2}}));
  primitive["mode"] = 6;
  EXPECT_EQ(read(gltf).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  primitive["mode"] = 1;  // lines
  expect_unreadable(embedded(gltf), ErrorCode::mesh_empty);
}

TEST(ReadGltf, AddsOnlyVerticesThatAreUsed) {
  json gltf = document();
  gltf["accessors"][1]["count"] = 3;
  EXPECT_EQ(read(gltf).vertices.size(), 3u);
}

TEST(ReadGltf, ReadsStridesSparseAndQuantizedPositions) {
  json gltf = document();
  std::string bytes;
  for (const std::uint8_t value : {0, 0, 0, 9, 255, 0, 0, 9, 255, 51, 0, 9}) bytes += bytes_of(value);  // stride 4
  bytes += bytes_of(std::uint16_t{2});                                                                  // sparse index
  for (const std::uint8_t value : {0, 255, 255}) bytes += bytes_of(value);                              // sparse value
  gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
  gltf["bufferViews"] = json::parse(R"([{"buffer": 0, "byteLength": 12, "byteStride": 4},
    {"buffer": 0, "byteOffset": 12, "byteLength": 2}, {"buffer": 0, "byteOffset": 14, "byteLength": 3}])");
  gltf["accessors"] =
      json::parse(R"([{"bufferView": 0, "componentType": 5121, "count": 3, "type": "VEC3", "normalized": true,
    "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 2}}}])");
  gltf["meshes"][0]["primitives"][0].erase("indices");
  const RawMesh mesh = read_as("a.gltf", embedded(gltf, bytes).dump());
  EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 1)}));
  bytes.replace(12, 2, bytes_of(std::uint16_t{3}));  // there is no such vertex
  expect_unreadable(embedded(gltf, bytes), ErrorCode::mesh_syntax);
}

TEST(ReadGltf, TakesTheDefaultScene) {
  json gltf = document();
  gltf["nodes"].push_back({{"mesh", 0}, {"name", "other"}});
  gltf["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  gltf["scene"] = 1;
  EXPECT_EQ(names_of(read(gltf).objects), Names{"other"});
  gltf.erase("scene");
  EXPECT_EQ(names_of(read(gltf).objects), Names{"way/17"});
  gltf.erase("scenes");
  gltf["nodes"].push_back({{"children", {1}}});
  EXPECT_EQ(names_of(read(gltf).objects), (Names{"way/17", "other"}));
}

TEST(ReadGltf, NamesWhatIsWrong) {
  const auto with = [](const std::string& pointer, const json& value) {
    json gltf = embedded(document());
    gltf[json::json_pointer(pointer)] = value;
    return gltf;
  };
  expect_unreadable(with("/asset/version", "1.0"), ErrorCode::mesh_unsupported);
  expect_unreadable(with("/asset", 7), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes", 7), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0", 7), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0/mesh", 1), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0/mesh", -1), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0/mesh", 0.5), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0/mesh", 1e300), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0/name", 7), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0/children", {0}), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0/matrix", {1, 2}), ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0/scale", {1, 2, "3"}), ErrorCode::mesh_syntax);
  expect_unreadable(with("/meshes/0/primitives/0", 7), ErrorCode::mesh_syntax);
  expect_unreadable(with("/accessors/0/count", 5), ErrorCode::mesh_syntax);
  expect_unreadable(with("/accessors/0/count", 9007199254740992), ErrorCode::mesh_syntax);
  expect_unreadable(with("/accessors/0/byteOffset", 9007199254740992), ErrorCode::mesh_syntax);
  expect_unreadable(with("/accessors/0/componentType", 5124), ErrorCode::mesh_syntax);
  expect_unreadable(with("/accessors/0/componentType", 4294967296 + 5126), ErrorCode::mesh_syntax);
  expect_unreadable(with("/accessors/0/type", "VEC2"), ErrorCode::mesh_syntax);
  expect_unreadable(with("/accessors/0/sparse", {{"count", 1}}), ErrorCode::mesh_syntax);
  expect_unreadable(with("/accessors/1/componentType", 5122), ErrorCode::mesh_syntax);
  expect_unreadable(with("/bufferViews/0/byteStride", 4), ErrorCode::mesh_syntax);
  expect_unreadable(with("/bufferViews/0/byteLength", 61), ErrorCode::mesh_syntax);
  expect_unreadable(with("/buffers/0/byteLength", 61), ErrorCode::mesh_syntax);
  expect_unreadable(with("/buffers/0/uri", "data:;base64,%%%"), ErrorCode::mesh_syntax);
  expect_unreadable(with("/buffers/0/uri", "data:,abc"), ErrorCode::mesh_syntax);
  expect_unreadable(with("/buffers/0/uri", "https://example.org/a.bin"), ErrorCode::mesh_unsupported);
  expect_unreadable(document(), ErrorCode::mesh_syntax);
  expect_unreadable(with("/extensionsRequired", {"KHR_animation_pointer"}), ErrorCode::mesh_unsupported);
  expect_unreadable(with("/extensionsUsed", {"CESIUM_RTC"}), ErrorCode::mesh_unsupported);
  expect_unreadable(json(), ErrorCode::mesh_syntax);
  expect_error([] { read_as("bad.gltf", R"({"asset": )"); }, ErrorCode::mesh_syntax);
  expect_error([] { read_as("bad.gltf", "{" + std::string(1000000, '[')); }, ErrorCode::mesh_syntax);
  expect_error([] { read_as("bad.gltf", "{\"a\":" + std::string(1000000, '[')); }, ErrorCode::mesh_syntax);
  expect_unreadable(with("/nodes/0/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5}),
                    ErrorCode::mesh_syntax);
}

TEST(ReadGltf, FindsIndicesAndCoordinatesThatAreWrong) {
  std::string bytes = square();
  bytes.replace(58, 2, bytes_of(std::uint16_t{4}));
  expect_unreadable(embedded(document(), bytes), ErrorCode::mesh_syntax);
  bytes = square();
  bytes.replace(4, 4, bytes_of(std::numeric_limits<float>::quiet_NaN()));
  expect_unreadable(embedded(document(), bytes), ErrorCode::coordinate_not_finite);
}

TEST(ReadGltf, FindsBrokenBinaryFiles) {
  const std::string good = glb(document());
  const auto expect = [](const std::string& bytes, ErrorCode code, const std::string& where) {
    expect_error([&] { read_as("bad.glb", bytes); }, code, where);
  };
  for (std::size_t size = 4; size < good.size(); size += 7) {
    testing::expect_code([&] { read_as("bad.glb", good.substr(0, size)); }, ErrorCode::mesh_syntax, "bad.glb, byte");
  }
  std::string bad = good;
  bad[4] = 1;
  expect(bad, ErrorCode::mesh_unsupported, "byte 4");
  bad = good;
  bad.replace(8, 4, bytes_of(static_cast<std::uint32_t>(good.size() + 1)));
  expect(bad, ErrorCode::mesh_syntax, "byte 8");
  bad = good;
  bad.replace(12, 4, bytes_of(0xffffffffu));
  expect(bad, ErrorCode::mesh_syntax, "byte 12");
  bad = good;
  bad.replace(16, 4, "BIN ");
  expect(bad, ErrorCode::mesh_syntax, "byte 16");
}

TEST(ReadGltf, StopsMeshesThatRepeatWithoutEnd) {
  json gltf = document();
  for (int i = 0; i < 100; ++i) {
    gltf["nodes"].push_back({{"mesh", 0}});
    gltf["scenes"][0]["nodes"].push_back(i + 1);
  }
  EXPECT_EQ(read(gltf).triangles.size(), 202u);
  core::ReadLimits limits;
  limits.repeated_triangles = 100;
  expect_error([&] { read_as("a.gltf", embedded(gltf).dump(), limits); }, ErrorCode::mesh_too_large);
  limits.json_values = 50;
  expect_error([&] { read_as("a.gltf", embedded(gltf).dump(), limits); }, ErrorCode::mesh_syntax);
}

TEST(ReadGltf, NamesABufferFileThatIsMissing) {
  testing::TemporaryDirectory folder;
  json gltf = document();
  gltf["buffers"][0]["uri"] = "gone.bin";
  testing::write_bytes(folder / "a.gltf", gltf.dump());
  expect_error([&] { read_mesh_file(folder / "a.gltf"); }, ErrorCode::file_not_found);
  gltf["buffers"][0]["uri"] = ".";
  testing::write_bytes(folder / "a.gltf", gltf.dump());
  expect_error([&] { read_mesh_file(folder / "a.gltf"); }, ErrorCode::not_a_file);
}

// Whoever made the file shall not choose what else of the disk is read.
TEST(ReadGltf, ReadsBuffersBelowItsOwnFolderOnly) {
  namespace fs = std::filesystem;
  testing::TemporaryDirectory folder;
  fs::create_directories(folder / "city/data");
  fs::create_directories(folder / "city2");
  for (const char* name : {"secret.bin", "city/data/near.bin", "city2/twin.bin"}) {
    testing::write_bytes(folder / name, square());
  }
  fs::create_symlink(folder / "secret.bin", folder / "city/data/link.bin");
  fs::create_symlink(folder.path(), folder / "city/up");
  fs::create_symlink("near.bin", folder / "city/data/inner.bin");
  const auto read = [&](const std::string& uri, const fs::path& file) {
    json gltf = document();
    gltf["buffers"][0]["uri"] = uri;
    testing::write_bytes(folder / "city/a.gltf", gltf.dump());
    return read_mesh_file(file).triangles.size();
  };
  const fs::path file = folder / "city/a.gltf";
  const std::string absolute = fs::canonical(folder.path()).string();
  for (const std::string& uri :
       {std::string("data/near.bin"), std::string("./data/../data/near.bin"), std::string("../city/data/near.bin"),
        std::string("data%2Fnear.bin"), std::string("data/inner.bin"), absolute + "/city/data/near.bin"}) {
    EXPECT_EQ(read(uri, file), 2u) << uri;
  }
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("..%2Fsecret.bin"),
        std::string("data/../../secret.bin"), std::string("data/link.bin"), std::string("up/secret.bin"),
        absolute + "/secret.bin", std::string("../city2/twin.bin"), std::string("/etc/passwd"),
        std::string("%2Fetc%2Fpasswd"), std::string("/dev/zero"), std::string("../gone.bin")}) {
    expect_error([&] { read(uri, file); }, ErrorCode::mesh_unsupported);
  }
  // A link to the glTF file finds what is beside the file.
  fs::create_directories(folder / "links");
  fs::create_symlink(folder / "city/a.gltf", folder / "links/a.gltf");
  fs::create_symlink(folder / "city/data", folder / "links/data");
  EXPECT_EQ(read("data/near.bin", folder / "links/a.gltf"), 2u);
}

// Each as deep as all: in time the square of the nodes before.
TEST(ReadGltf, ReadsManyNestedNodesInLinearTime) {
  const auto seconds = [](int count) {
    json gltf = document();
    gltf["nodes"] = json::array();
    for (int i = 0; i < count; ++i) gltf["nodes"].push_back({{"children", {i + 1}}, {"translation", {0, 0, 0.5}}});
    gltf["nodes"].push_back({{"mesh", 0}});
    const std::string text = embedded(gltf).dump();
    const std::clock_t start = std::clock();
    const RawMesh mesh = read_as("a.gltf", text);
    EXPECT_EQ(mesh.vertices[0], Vec3(0, 0, 0.5 * count));
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const double few = seconds(20'000), many = seconds(200'000);
  EXPECT_LT(many, 30 * few + 0.5);  // 10 times, where linear; 100 times, where not
}

// glTF 2.0, section 3.7.2.2: a mesh is drawn with its default weights, or with those of its node.
TEST(ReadGltf, MovesVerticesByDefaultMorphWeights) {
  std::string bytes = square();
  for (const float value : {0.f, 0.f, 0.f, 0.f, 0.f, 0.f, 0.f, 30.f, 0.f, 0.f, 30.f, 0.f}) bytes += bytes_of(value);
  json gltf = document();
  gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 48}});
  gltf["accessors"].push_back({{"bufferView", 2}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  gltf["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 2}}, {{"NORMAL", 2}}};
  const auto height = [&] { return read_as("a.gltf", embedded(gltf, bytes).dump()).vertices[2].y(); };
  EXPECT_EQ(height(), 1);  // weights are 0 where the file has none
  gltf["meshes"][0]["weights"] = {1.0, 1.0};
  EXPECT_EQ(height(), 31);
  gltf["nodes"][0]["weights"] = {0.5, 0};
  EXPECT_EQ(height(), 16);
  gltf["nodes"][0]["translation"] = {0, 100, 0};
  EXPECT_EQ(height(), 116);
  gltf["accessors"][2]["count"] = 3;
  expect_unreadable(embedded(gltf, bytes), ErrorCode::mesh_syntax);
  gltf["nodes"][0]["weights"] = {0.5};
  expect_unreadable(embedded(gltf, bytes), ErrorCode::mesh_syntax);
}

// Section 3.7.3.3: by the joints, as the nodes stand, and not by the node of the mesh.
TEST(ReadGltf, MovesVerticesByTheirSkins) {
  std::string bytes = square();
  for (const std::uint8_t joint : {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}) bytes += bytes_of(joint);
  for (const float weight : {1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.5f, 0.5f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f}) {
    bytes += bytes_of(weight);
  }
  for (int joint = 0; joint < 2; ++joint) {  // 1 down, along y
    for (int i = 0; i < 16; ++i) bytes += bytes_of(i % 5 == 0 ? 1.f : i == 13 ? -1.f : 0.f);
  }
  json gltf = document();
  for (const auto& [offset, length] : {std::pair{60, 16}, {76, 64}, {140, 128}}) {
    gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}});
  }
  gltf["accessors"].push_back({{"bufferView", 2}, {"componentType", 5121}, {"count", 4}, {"type", "VEC4"}});
  gltf["accessors"].push_back({{"bufferView", 3}, {"componentType", 5126}, {"count", 4}, {"type", "VEC4"}});
  gltf["accessors"].push_back({{"bufferView", 4}, {"componentType", 5126}, {"count", 2}, {"type", "MAT4"}});
  gltf["meshes"][0]["primitives"][0]["attributes"].update({{"JOINTS_0", 2}, {"WEIGHTS_0", 3}});
  gltf["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0, "translation": [1000, 0, 0]}, {"translation": [0, 0, 5],
    "children": [2]}, {"translation": [0, 10, 0]}])");
  gltf["scenes"][0]["nodes"] = {0, 1};
  gltf["skins"] = json::parse(R"([{"joints": [1, 2], "inverseBindMatrices": 4}])");
  const auto read_skin = [&] { return read_as("a.gltf", embedded(gltf, bytes).dump()); };
  EXPECT_EQ(read_skin().vertices, (std::vector<Vec3>{Vec3(0, -1, 5), Vec3(1, -1, 5), Vec3(1, 5, 5), Vec3(0, 10, 5)}));
  gltf["skins"][0].erase("inverseBindMatrices");
  EXPECT_EQ(read_skin().vertices[3], Vec3(0, 11, 5));
  json bad = gltf;
  bad["skins"][0]["joints"] = {1};
  expect_unreadable(embedded(bad, bytes), ErrorCode::mesh_syntax);  // vertex 2 has joint 1
  bad = gltf;
  bad["nodes"][2]["children"] = {1};
  bad["scenes"][0]["nodes"] = {0};
  expect_unreadable(embedded(bad, bytes), ErrorCode::mesh_syntax);
  bad = gltf;
  bad["accessors"][3]["count"] = 3;
  expect_unreadable(embedded(bad, bytes), ErrorCode::mesh_syntax);
  gltf["nodes"][0].erase("skin");
  EXPECT_EQ(read_skin().vertices[3], Vec3(1000, 1, 0));
}

TEST(ReadGltf, DoesNotBuildNodesThatTheFileHides) {
  json gltf = document();
  gltf["nodes"].push_back(json::parse(
      R"({"name": "off", "mesh": 0, "children": [2], "extensions": {"KHR_node_visibility": {"visible": false}}})"));
  gltf["nodes"].push_back({{"name", "below"}, {"mesh", 0}});
  gltf["scenes"][0]["nodes"] = {0, 1};
  gltf["extensionsRequired"] = {"KHR_node_visibility"};
  const RawMesh mesh = read(gltf);
  EXPECT_EQ(names_of(mesh.objects), Names{"way/17"});
  EXPECT_TRUE(mesh.ledger.empty());
  testing::expect_wording(mesh.notes);
}

TEST(ReadGltf, PutsWhatIsNotBuiltIntoTheLedger) {
  json gltf = document();
  gltf["meshes"].push_back(json::parse(R"({"primitives": [{"attributes": {"POSITION": 0}, "mode": 0},
    {"attributes": {"POSITION": 0}, "mode": 3}, {"attributes": {"NORMAL": 0}}]})"));
  gltf["nodes"].push_back({{"name", "cloud"}, {"mesh", 1}, {"translation", {0, 0, 7}}});
  gltf["nodes"].push_back({{"name", "spare"}, {"mesh", 0}, {"translation", {50, 0, 0}}});
  gltf["scenes"] = {{{"nodes", {0, 1}}}, {{"nodes", {2}}}};
  const RawMesh mesh = read(gltf);
  ASSERT_EQ(mesh.ledger.size(), 4u);
  std::vector<std::string> told;
  for (const Missing& missing : mesh.ledger) {
    told.push_back(missing.entry.object.name + ": " + missing.entry.what + ": " + missing.entry.reason);
  }
  testing::expect_wording(told);
  EXPECT_EQ(mesh.ledger[0].entry.box->max, Vec3(1, 1, 7));
  EXPECT_EQ(mesh.ledger[0].holder.triangles.size(), 12u);
  EXPECT_EQ(mesh.ledger[1].entry.box->min, Vec3(0, 0, 7));
  EXPECT_TRUE(mesh.ledger[1].holder.triangles.empty());
  EXPECT_FALSE(mesh.ledger[2].entry.box);
  EXPECT_EQ(mesh.ledger[3].entry.box->max, Vec3(51, 1, 0));
  gltf["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = json::array({2});  // a coarser form of what is built
  EXPECT_EQ(read(gltf).ledger.size(), 3u);
  json levels = std::exchange(gltf["nodes"][0]["extensions"], json::object());
  gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
  gltf["nodes"].push_back({{"extensions", std::move(levels)}});
  EXPECT_EQ(read(gltf).ledger.size(), 4u) << "there is no finer form of it";
}

// A box about a part of what is missing would say that the rest is nowhere.
TEST(ReadGltf, PlacesWhatOtherScenesHaveOnlyAsAWhole) {
  json gltf = document();
  gltf["meshes"].push_back(json::parse(R"({"primitives": [{"attributes": {"NORMAL": 0}}]})"));
  gltf["nodes"].push_back({{"name", "spare"}, {"mesh", 0}, {"translation", {50, 0, 0}}});
  ASSERT_TRUE(read(gltf).ledger.at(0).entry.box);
  EXPECT_EQ(read(gltf).ledger[0].entry.box->max, Vec3(51, 1, 0));
  const json instanced = {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", json::object()}}}};
  const json garbled = {{"mesh", 77}}, unplaced = {{"mesh", 1}};
  for (const json& node : {instanced, garbled, unplaced}) {
    gltf["nodes"][2] = node;
    const RawMesh mesh = read(gltf);
    ASSERT_EQ(mesh.ledger.size(), 1u) << node;
    EXPECT_TRUE(mesh.ledger[0].entry.what.starts_with("2 nodes")) << node;
    EXPECT_FALSE(mesh.ledger[0].entry.box) << node;
  }
}

TEST(ReadGltf, PointsOfWhichOneIsNowhereAreNotHeldByABox) {
  json gltf = document();
  std::string bytes = square();
  for (int i = 0; i < 3; ++i) bytes += bytes_of(std::numeric_limits<float>::quiet_NaN());
  gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 12}});
  gltf["accessors"].push_back({{"bufferView", 2}, {"componentType", 5126}, {"count", 1}, {"type", "VEC3"}});
  gltf["meshes"].push_back(json::parse(R"({"primitives": [{"attributes": {"POSITION": 0}, "mode": 0},
    {"attributes": {"POSITION": 2}, "mode": 0}]})"));
  gltf["nodes"].push_back({{"name", "cloud"}, {"mesh", 1}});
  gltf["scenes"][0]["nodes"] = {0, 1};
  const RawMesh mesh = read_as("a.gltf", embedded(gltf, bytes).dump());
  ASSERT_EQ(mesh.ledger.size(), 1u);
  EXPECT_EQ(mesh.ledger[0].entry.what, "5 points");
  EXPECT_FALSE(mesh.ledger[0].entry.box);
  EXPECT_TRUE(mesh.ledger[0].holder.triangles.empty());
}

}  // namespace
}  // namespace vantage::internal::io
