// Meshes in glTF that Draco and meshoptimizer have compressed, instances, and what only tiles may use.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/gltf_tile.h"
#include "io/mesh_codecs.h"
#include "support/mesh_reading.h"
#include "support/random.h"
#include "support/tile_files.h"

namespace vantage::internal::io {
namespace {

using nlohmann::json;
using testing::bytes_of;
using testing::expect_code;
using testing::read_as;

std::string from_hex(const std::string& digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  }
  return bytes;
}

// A tetrahedron of edges 4, 4 and 8 along x, y and z, positions of 8 bits; a number of the feature for each face: 0, 0,
// 1,
// 1. As the encoders of Draco 1.5.5 and meshoptimizer 0.18 wrote it, the latter without features.
const std::string kSequential = from_hex(
    "445241434f020201000000040801000102000203040506070605010200090300000404010001020100010101028002052055055505ffffffef"
    "55150743f52f986336a800000000ff000000000101000203014001001000000000010000000000000000000000000000000000004108");
const std::string kEdgebreaker = from_hex(
    "445241434f02020101000000040401030000012f0101105503ecca8202ff000000010001000903000002010404010001010101010102800205"
    "2"
    "055055505ffffffef5515058bd4e6608200000000ff00000000000000000000000000000000000041080101010002030140010011000000000"
    "1"
    "000000");
const std::string kVertices = from_hex(
    "a00000013c000000ffff013c000000807f0000010f000000ffff010f000000807f0000000103000000820000000000000000000000000000"
    "00000000000000000000000000000000000000000000");
const std::string kIndices = from_hex("e1fe0e1203f004007687566778a9866589689801690000");

std::string glb_with(const json& gltf, const std::string& binary) {
  std::string text = gltf.dump();
  while (text.size() % 4 != 0) text += ' ';
  return "glTF" + bytes_of(2u) + bytes_of(static_cast<std::uint32_t>(28 + text.size() + binary.size())) +
         bytes_of(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
         bytes_of(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
}

json with_one_mesh() {
  return json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [{"componentType": 5126, "count": 8, "type": "VEC3"},
                  {"componentType": 5125, "count": 12, "type": "SCALAR"}]})");
}

std::string draco_glb(const std::string& data, std::size_t corners = 12) {
  json gltf = with_one_mesh();
  gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  gltf["accessors"][1]["count"] = corners;
  gltf["accessors"].push_back({{"componentType", 5123}, {"count", 8}, {"type", "SCALAR"}});
  json& primitive = gltf["meshes"][0]["primitives"][0];
  primitive["attributes"]["_BATCHID"] = 2;
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                           {"attributes", {{"POSITION", 0}, {"_BATCHID", 1}}}};
  gltf["bufferViews"] = {{{"buffer", 0}, {"byteLength", data.size()}}};
  gltf["buffers"] = {{{"byteLength", data.size()}}};
  return glb_with(gltf, data);
}

std::string meshopt_glb(const std::string& vertices, const std::string& indices, std::uint64_t count = 4) {
  json gltf = with_one_mesh();
  gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"EXT_meshopt_compression"};
  gltf["accessors"][0]["count"] = count;
  gltf["accessors"][0]["bufferView"] = 0;
  gltf["accessors"][1]["bufferView"] = 1;
  const auto packed = [](std::size_t start, std::size_t length, int stride, std::uint64_t number, const char* mode) {
    return json{{"EXT_meshopt_compression",
                 {{"buffer", 0},
                  {"byteOffset", start},
                  {"byteLength", length},
                  {"byteStride", stride},
                  {"count", number},
                  {"mode", mode}}}};
  };
  gltf["bufferViews"] = {
      {{"buffer", 1},
       {"byteLength", 64},
       {"byteStride", 16},
       {"extensions", packed(0, vertices.size(), 16, count, "ATTRIBUTES")}},
      {{"buffer", 1}, {"byteLength", 48}, {"extensions", packed(vertices.size(), indices.size(), 4, 12, "TRIANGLES")}}};
  gltf["buffers"] = {{{"byteLength", vertices.size() + indices.size()}}, {{"byteLength", 112}}};
  return glb_with(gltf, vertices + indices);
}

/// The JSON and the buffer of a GLB.
std::pair<json, std::string> parts_of(const std::string& glb) {
  std::uint32_t text = 0;
  std::memcpy(&text, glb.data() + 12, sizeof text);
  return {json::parse(glb.substr(20, text)), glb.substr(28 + text)};
}

/// Skips the test where this build lacks the library.
template <class Read>
RawMesh read_or_skip(const Read& read, bool& is_missing) {
  try {
    return read();
  } catch (const Error& error) {
    is_missing = error.code() == ErrorCode::component_missing;
    if (!is_missing) throw;
    return {};
  }
}

void expect_tetrahedron(const RawMesh& mesh, double within) {
  ASSERT_EQ(mesh.triangles.size(), 4u);
  double volume = 0;
  Box box;
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3 &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
    volume += a.dot(b.cross(c)) / 6;
    for (const std::uint32_t corner : triangle) box.extend(mesh.vertices[corner]);
  }
  EXPECT_NEAR(volume, 4. * 4 * 8 / 6, 20 * within);
  EXPECT_LT((box.min - Vec3(0, 0, 0)).norm(), within);
  EXPECT_LT((box.max - Vec3(4, 4, 8)).norm(), within);
}

TEST(ReadGltfPacked, ReadsDraco) {
  for (const std::string& data : {kSequential, kEdgebreaker}) {
    bool is_missing = false;
    const RawMesh mesh = read_or_skip([&] { return read_as("a.glb", draco_glb(data)); }, is_missing);
    if (is_missing) GTEST_SKIP() << "vantage was built without Draco";
    expect_tetrahedron(mesh, 0.03);
    TileContext tile{"t", [](std::uint64_t id) { return SceneObject{"", "b" + std::to_string(id)}; }, {}};
    const TileMesh in_tile = read_gltf_tile(MeshSource("a.glb", draco_glb(data)), {}, {}, tile);
    ASSERT_EQ(in_tile.mesh.objects.size(), 2u);
    const std::string &first = in_tile.mesh.objects[0].source_id, &second = in_tile.mesh.objects[1].source_id;
    EXPECT_EQ(std::min(first, second) + std::max(first, second), "b0b1");  // in the encoder's order
    EXPECT_EQ(std::count(in_tile.mesh.object_of.begin(), in_tile.mesh.object_of.end(), 0u), 2);
  }
}

TEST(ReadGltfPacked, RefusesDracoThatIsCutOrLies) {
  bool is_missing = false;
  read_or_skip([&] { return read_as("a.glb", draco_glb(kSequential)); }, is_missing);
  if (is_missing) GTEST_SKIP() << "vantage was built without Draco";
  expect_code([] { read_as("a.glb", draco_glb(kSequential, 9)); }, ErrorCode::mesh_syntax, "a.glb");
  expect_code([] { read_as("a.glb", draco_glb("DRACO")); }, ErrorCode::mesh_syntax, "a.glb");
  // It announces 2^28 triangles in 118 bytes.
  std::string bomb = kEdgebreaker;
  bomb.replace(13, 1, "\xff\xff\xff\x7f");
  expect_code([&] { read_as("a.glb", draco_glb(bomb, 3'000'000'000)); }, ErrorCode::mesh_syntax, "a.glb");
  for (const std::string& whole : {kSequential, kEdgebreaker}) {
    for (std::size_t length = 0; length < whole.size(); ++length) {
      try {
        read_as("a.glb", draco_glb(whole.substr(0, length)));
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
      }
    }
  }
}

TEST(ReadGltfPacked, BoundsTheAttributesOfDraco) {
  core::ReadLimits limits;
  const auto decode = [&](const std::string& data) { return decode_draco(data, {0, 1}, 4, limits); };
  for (const std::string& data : {kSequential, kEdgebreaker}) {
    limits.decompressed_bytes = 1000;
    try {
      EXPECT_EQ(decode(data).points, 8u);
    } catch (const CodecProblem& problem) {
      if (problem.library_missing) GTEST_SKIP() << "vantage was built without Draco";
      ADD_FAILURE() << problem.text;
    }
    limits.decompressed_bytes = 50;
    try {
      decode(data);
      ADD_FAILURE() << "read beyond the limit";
    } catch (const CodecProblem& problem) {
      EXPECT_NE(problem.text.find(" 50 "), std::string::npos) << problem.text;
    }
  }
}

TEST(ReadGltfPacked, ReadsDracoOfStripsAndOfSharedData) {
  bool is_missing = false;
  read_or_skip([&] { return read_as("a.glb", draco_glb(kSequential)); }, is_missing);
  if (is_missing) GTEST_SKIP() << "vantage was built without Draco";
  const auto parts = parts_of(draco_glb(kSequential));
  const json& gltf = parts.first;
  const std::string& binary = parts.second;
  json strip = gltf;  // four triangles are a strip of six corners, but Draco gives a list
  strip["meshes"][0]["primitives"][0]["mode"] = 5;
  strip["accessors"][1]["count"] = 6;
  expect_tetrahedron(read_as("a.glb", glb_with(strip, binary)), 0.03);
  json shared = gltf;
  json other = gltf["meshes"][0]["primitives"][0];
  other["attributes"].erase("_BATCHID");
  other["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("_BATCHID");
  shared["meshes"][0]["primitives"].push_back(other);
  EXPECT_EQ(read_as("a.glb", glb_with(shared, binary)).triangles.size(), 8u);
}

TEST(ReadGltfPacked, ReadsMeshopt) {
  bool is_missing = false;
  const RawMesh mesh = read_or_skip([&] { return read_as("a.glb", meshopt_glb(kVertices, kIndices)); }, is_missing);
  if (is_missing) GTEST_SKIP() << "vantage was built without meshoptimizer";
  expect_tetrahedron(mesh, 1e-9);
  expect_code([&] { read_as("a.glb", meshopt_glb(kVertices.substr(0, 40), kIndices)); }, ErrorCode::mesh_syntax);
  expect_code([&] { read_as("a.glb", meshopt_glb(kVertices, kIndices, std::uint64_t{1} << 40)); },
              ErrorCode::mesh_syntax);
  expect_code([&] { read_as("a.glb", meshopt_glb(kIndices, kVertices)); }, ErrorCode::mesh_syntax);
}

TEST(ReadGltfPacked, SurvivesMutations) {
  testing::Random random(20260713);
  int read = 0, refused = 0;
  for (const std::string& whole : {draco_glb(kSequential), draco_glb(kEdgebreaker), meshopt_glb(kVertices, kIndices)}) {
    for (int i = 0; i < 1000; ++i) {
      std::string bytes = whole;
      for (int changes = random.integer(1, 4); changes > 0; --changes) {
        const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
        bytes[at] = static_cast<char>(random.integer(0, 255));
      }
      try {
        const RawMesh mesh = read_as("a.glb", bytes);
        for (const Vec3& vertex : mesh.vertices) EXPECT_TRUE(vertex.allFinite());
        ++read;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        ++refused;
      }
    }
  }
  EXPECT_EQ(read + refused, 3000);
  EXPECT_GT(refused, 1000);
}

/// Boxes at (10, 0, 0) and (0, 20, 0), which the attributes of the instances may give as accessor 3; accessor 4 is two
/// bytes.
std::string instanced_glb(const json& attributes) {
  json extra;
  std::string places;
  for (const float value : {10.f, 0.f, 0.f, 0.f, 20.f, 0.f}) places += bytes_of(value);
  extra["more"] = {places, std::string("ab")};
  extra["extensionsUsed"] = extra["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  extra["nodes"] = {{{"mesh", 0},
                     {"name", "tree"},
                     {"scale", {2, 2, 2}},
                     {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}}};
  auto [gltf, binary] = parts_of(testing::box_glb({{}}, "", extra));
  gltf["accessors"].push_back({{"bufferView", 3}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}});
  gltf["accessors"].push_back({{"bufferView", 4}, {"componentType", 5121}, {"count", 2}, {"type", "SCALAR"}});
  return glb_with(gltf, binary);
}

TEST(ReadGltfPacked, ReadsInstances) {
  const RawMesh mesh = read_as("a.glb", instanced_glb({{"TRANSLATION", 3}}));
  EXPECT_EQ(mesh.triangles.size(), 24u);
  ASSERT_EQ(mesh.objects.size(), 2u);
  Box box;
  for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
  EXPECT_EQ(box.max, Vec3(22, 42, 2));  // the node's scale moves its instances, too
}

TEST(ReadGltfPacked, CountsInstancesByAnyAttribute) {
  EXPECT_EQ(read_as("a.glb", instanced_glb({{"_ID", 4}})).triangles.size(), 24u);
  EXPECT_EQ(read_as("a.glb", instanced_glb({{"_ID", 4}, {"TRANSLATION", 3}})).triangles.size(), 24u);
  expect_code([] { read_as("a.glb", instanced_glb(json::object())); }, ErrorCode::mesh_syntax, "a.glb");
  expect_code([] { read_as("a.glb", instanced_glb({{"_ID", 1}, {"TRANSLATION", 3}})); }, ErrorCode::mesh_syntax);
}

TEST(ReadGltfPacked, SparseAccessorsMayBeginAsZeros) {
  json extra;
  std::string corners;
  for (const float value : {3.f, 0.f, 0.f, 0.f, 3.f, 0.f}) corners += bytes_of(value);
  extra["more"] = {std::string("\1\2"), corners};
  auto parts = parts_of(testing::box_glb({{}}, "", extra));
  json& gltf = parts.first;
  const std::string& binary = parts.second;
  json& accessor = gltf["accessors"][0];
  accessor.erase("bufferView");
  accessor["count"] = 3;
  accessor["sparse"] = {
      {"count", 2}, {"indices", {{"bufferView", 3}, {"componentType", 5121}}}, {"values", {{"bufferView", 4}}}};
  gltf["meshes"][0]["primitives"][0].erase("indices");
  const RawMesh mesh = read_as("a.glb", glb_with(gltf, binary));
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][0]], Vec3(0, 0, 0));
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][2]], Vec3(0, 3, 0));
  extra["more"][0] = std::string("\2\1");  // they must ascend
  auto turned = parts_of(testing::box_glb({{}}, "", extra));
  expect_code([&] { read_as("a.glb", glb_with(gltf, turned.second)); }, ErrorCode::mesh_syntax, "a.glb");
  accessor["count"] = std::uint64_t{1} << 40;
  expect_code([&] { read_as("a.glb", glb_with(gltf, binary)); }, ErrorCode::mesh_syntax, "a.glb");
}

TEST(ReadGltfPacked, BoundsTheFilesOfATile) {
  auto parts = parts_of(testing::box_glb({{}}));
  json& gltf = parts.first;
  const std::string bytes = parts.second;
  gltf["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "a.bin?1"}},
                     {{"byteLength", bytes.size()}, {"uri", "a.bin?2"}}};
  gltf["bufferViews"][1]["buffer"] = 1;
  TileContext tile;
  tile.read_file = [&bytes](const std::string&) { return std::string(bytes); };
  core::ReadLimits limits;
  const MeshSource source("a.gltf", gltf.dump());
  limits.decompressed_bytes = 2 * bytes.size();
  EXPECT_EQ(read_gltf_tile(source, {}, limits, tile).mesh.triangles.size(), 12u);
  --limits.decompressed_bytes;
  expect_code([&] { read_gltf_tile(source, {}, limits, tile); }, ErrorCode::mesh_too_large, "a.gltf");
}

TEST(ReadGltfPacked, OnlyTilesHaveACentre) {
  json extra;
  extra["extensionsUsed"] = extra["extensionsRequired"] = {"CESIUM_RTC"};
  extra["extensions"]["CESIUM_RTC"]["center"] = {1e6, 2e6, 3e6};
  const std::string glb = testing::box_glb({{}}, "", extra);
  expect_code([&] { read_as("a.glb", glb); }, ErrorCode::mesh_unsupported, "a.glb");
  EXPECT_EQ(read_gltf_tile(MeshSource("a.glb", glb), {}, {}, {}).center, Vec3(1e6, 2e6, 3e6));
}

}  // namespace
}  // namespace vantage::internal::io
