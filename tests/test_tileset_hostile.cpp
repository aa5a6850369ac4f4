// Tilesets that are garbled, or made to do harm: each is read, with holes that are counted, or refused as bad input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "support/mesh_reading.h"
#include "support/random.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/tile_files.h"
#include "vantage/tileset.h"

namespace vantage {
namespace {

using nlohmann::json;
using testing::b3dm;
using testing::box_glb;
using testing::bytes_of;
using testing::expect_code;
using testing::gzip;
using testing::subtree;
using testing::TemporaryDirectory;
using testing::tile_json;
using testing::tileset_json;

using Files = std::map<std::string, std::string>;

void write_files(const TemporaryDirectory& folder, const Files& files) {
  for (const auto& [name, bytes] : files) {
    std::filesystem::create_directories((folder.path() / name).parent_path());
    testing::write_bytes(folder.path() / name, bytes);
  }
}

/// What a scene promises, whatever the files say.
void expect_sound(const Scene& scene) {
  ASSERT_EQ(scene.object_of.size(), scene.mesh.triangles.size());
  ASSERT_FALSE(scene.mesh.triangles.empty());
  bool in_range = true;
  for (std::size_t i = 0; i < scene.object_of.size(); ++i) {
    in_range = in_range && scene.object_of[i] < scene.objects.size();
    for (const std::uint32_t corner : scene.mesh.triangles[i]) {
      in_range = in_range && corner < scene.mesh.vertices.size() && scene.mesh.vertices[corner].allFinite();
    }
  }
  EXPECT_TRUE(in_range);
}

/// A tileset of all kinds of files.
Files every_kind() {
  Files files;
  json root = tile_json(64, "c/{level}_{x}_{y}.glb", 16);
  root["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                            {"subtreeLevels", 2},
                            {"availableLevels", 2},
                            {"subtrees", {{"uri", "s/{level}_{x}_{y}.subtree"}}}};
  files["tree.json"] = tileset_json(root).dump();
  const json bits = {{"buffers", {{{"byteLength", 8}}}},
                     {"bufferViews", {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 1}}}},
                     {"tileAvailability", {{"bitstream", 0}}},
                     {"contentAvailability", {{{"constant", 1}}}},
                     {"childSubtreeAvailability", {{"constant", 0}}}};
  files["s/0_0_0.subtree"] = subtree(bits, std::string("\x1f\0\0\0\0\0\0\0", 8));
  for (const char* name : {"c/1_0_0.glb", "c/1_1_0.glb", "c/1_0_1.glb", "c/1_1_1.glb"}) files[name] = box_glb({{}});
  std::string offsets, places;
  for (const std::uint32_t offset : {0u, 4u, 9u}) offsets += bytes_of(offset);
  for (const float value : {10.f, 20.f, 30.f, -10.f, -20.f, -30.f}) places += bytes_of(value);
  json extra;
  extra["more"] = {"NL.1NL.22", offsets};
  extra["extensions"]["EXT_structural_metadata"] = {
      {"schema", {{"classes", {{"b", {{"properties", {{"identificatie", {{"type", "STRING"}}}}}}}}}}},
      {"propertyTables",
       {{{"class", "b"}, {"count", 2}, {"properties", {{"identificatie", {{"values", 3}, {"stringOffsets", 4}}}}}}}}};
  files["meta.glb"] = box_glb({{{0, 0, 0}, 5, 1}, {{4, 0, 0}, 6, 0}}, "_FEATURE_ID_0", extra);
  const std::string houses = b3dm(box_glb({{{0, 0, 0}, 5, 0}, {{4, 0, 0}, 6, 1}}, "_BATCHID"), {{"BATCH_LENGTH", 2}},
                                  {{"gml_id", {"a", "b"}}, {"name", {"A", "B"}}});
  const std::string trees = testing::i3dm(box_glb({{}}), {{"INSTANCES_LENGTH", 2}, {"POSITION", {{"byteOffset", 0}}}},
                                          places, {{"id", {4, 5}}});
  files["all.cmpt"] = testing::cmpt({houses, trees});
  json top = tile_json(10);
  top["refine"] = "ADD";
  top["children"] = json::array({tile_json(5, "tree.json"), tile_json(0, "meta.glb"), tile_json(0, "all.cmpt")});
  files["tileset.json"] = tileset_json(top).dump();
  return files;
}

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(random_.integer(0, static_cast<int>(count) - 1));
  }

  void mutate(std::string& bytes) {
    for (std::size_t i = 1 + below(4); i > 0 && !bytes.empty(); --i) change(bytes);
  }

 private:
  void change(std::string& bytes) {
    const std::size_t at = below(bytes.size()), length = std::min(bytes.size() - at, 1 + below(40));
    switch (below(8)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(below(bytes.size()), length));
        break;
      case 4:
        bytes.resize(at);
        break;
      case 5: {  // a length or a count
        const std::size_t word = at / 4 * 4;
        const std::uint32_t extremes[] = {0,          1,       0x7fffffff,
                                          0xffffffff, 0x10000, static_cast<std::uint32_t>(below(300))};
        if (word + 4 <= bytes.size()) bytes.replace(word, 4, bytes_of(extremes[below(6)]));
        break;
      }
      default: {  // a number of a JSON text
        const std::size_t digit = bytes.find_first_of("0123456789", at);
        const char* numbers[] = {"-1", "1e308", "4294967295", "9007199254740993", "0", "1e-9", "null",
                                 "[]", "\"x\"", "7"};
        if (digit != std::string::npos) bytes.replace(digit, 1, numbers[below(10)]);
      }
    }
  }

  testing::Random random_;
};

/// Returns how many of the mutants were read.
int read_mutants(const Files& files, int count, std::uint64_t seed) {
  TemporaryDirectory folder;
  write_files(folder, files);
  Mutator mutator(seed);
  std::vector<std::string> names;
  for (const auto& [name, bytes] : files) names.push_back(name);
  int read = 0;
  for (int i = 0; i < count; ++i) {
    const std::string& name = names[mutator.below(names.size())];
    std::string bytes = files.at(name);
    mutator.mutate(bytes);
    testing::write_bytes(folder.path() / name, bytes);
    try {
      const TilesetScene scene = read_tileset(folder / "tileset.json", {});
      expect_sound(scene.scene);
      ++read;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << "mutant " << i << ": " << error.what();
      EXPECT_FALSE(error.fix().empty()) << error.what();
    }
    testing::write_bytes(folder.path() / name, files.at(name));
  }
  return read;
}

/// $VANTAGE_MUTANTS, or else `otherwise`.
int mutants(int otherwise) {
  const char* const set = std::getenv("VANTAGE_MUTANTS");
  return set ? std::atoi(set) : otherwise;
}

TEST(TilesetHostile, MutantsAreReadOrRefused) {
  const int count = mutants(1500), read = read_mutants(every_kind(), count, 20260711);
  std::cout << read << " of " << count << " mutants were read\n";
  EXPECT_GT(read, count / 4);  // most spoil one file of several
}

TEST(TilesetHostile, MutantsOfRealTilesAreReadOrRefused) {
  VANTAGE_REQUIRE_SHARED("tiles/plateau/data/data3.b3dm");
  Files files;
  json root = tile_json(10);
  root["refine"] = "ADD";
  root["children"] =
      json::array({tile_json(0, "plateau.b3dm"), tile_json(0, "quarter.b3dm"), tile_json(0, "billboards.i3dm")});
  files["tileset.json"] = tileset_json(root).dump();
  files["plateau.b3dm"] = testing::read_bytes(testing::shared_data("tiles/plateau/data/data3.b3dm"));
  files["quarter.b3dm"] =
      testing::read_bytes(testing::shared_data("tiles/samples/1.0/TilesetWithRequestVolume/city/ll.b3dm"));
  files["billboards.i3dm"] =
      testing::read_bytes(testing::shared_data("tiles/samples/1.0/TilesetWithTreeBillboards/tree.i3dm"));
  const int count = mutants(200), read = read_mutants(files, count, 20260712);
  std::cout << read << " of " << count << " mutants were read\n";
}

TEST(TilesetHostile, TilesWithoutEndAreRefused) {
  // Each tileset holds the next one twice: 2^40 tiles in 40 small files.
  Files files;
  for (int i = 0; i < 40; ++i) {
    json root = tile_json(10);
    root["refine"] = "ADD";
    const std::string next = i == 39 ? "a.glb" : "t" + std::to_string(i + 1) + ".json";
    root["children"] = json::array({tile_json(0, next), tile_json(0, next)});
    files[i == 0 ? "tileset.json" : "t" + std::to_string(i) + ".json"] = tileset_json(root).dump();
  }
  files["a.glb"] = box_glb({{}});
  TemporaryDirectory folder;
  write_files(folder, files);
  expect_code([&] { read_tileset(folder / "tileset.json"); }, ErrorCode::region_invalid, "");
}

TEST(TilesetHostile, OneTileCannotBringMoreThanItsLimit) {
  // One small compressed file by many names: 40 times 60 MiB.
  constexpr std::size_t kBytes = std::size_t{60} << 20U;
  json gltf = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  gltf["nodes"] = {{{"mesh", 0}}};
  json primitives = json::array();
  for (int i = 0; i < 40; ++i) {
    gltf["buffers"].push_back({{"uri", "x.bin?" + std::to_string(i)}, {"byteLength", kBytes}});
    gltf["bufferViews"].push_back({{"buffer", i}, {"byteOffset", 0}, {"byteLength", 36}});
    gltf["accessors"].push_back({{"bufferView", i}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    primitives.push_back({{"attributes", {{"POSITION", i}}}});
  }
  gltf["meshes"] = {{{"primitives", primitives}}};
  json root = tile_json(10);
  root["refine"] = "ADD";
  root["children"] = json::array({tile_json(0, "a.glb"), tile_json(0, "many.gltf")});
  Files files;
  files["tileset.json"] = tileset_json(root).dump();
  files["many.gltf"] = gltf.dump();
  files["a.glb"] = box_glb({{}});
  files["x.bin"] = gzip(std::string(kBytes, '\0'));
  TemporaryDirectory folder;
  write_files(folder, files);
  const TilesetScene read = read_tileset(folder / "tileset.json");
  EXPECT_EQ(read.report.holes, 1u);
  EXPECT_EQ(read.report.triangles, 24u);  // with the box that stands in
  EXPECT_NE(read.report.first_hole.find("512 MiB"), std::string::npos) << read.report.first_hole;
}

TEST(TilesetHostile, ATilesetThatIsNamedOftenIsParsedOnce) {
  json much = tile_json(0);
  for (int i = 0; i < 50'000; ++i) much["extras"].push_back(i);
  json root = tile_json(10);
  root["refine"] = "ADD";
  root["children"].push_back(tile_json(0, "a.glb"));
  for (int i = 0; i < 1000; ++i) root["children"].push_back(tile_json(0, "much.json?" + std::to_string(i)));
  Files files;
  files["tileset.json"] = tileset_json(root).dump();
  files["much.json"] = tileset_json(much).dump();
  files["a.glb"] = box_glb({{}});
  TemporaryDirectory folder;
  write_files(folder, files);
  const TilesetScene read = read_tileset(folder / "tileset.json");
  EXPECT_EQ(read.report.documents, 1001u);
  EXPECT_EQ(read.report.holes, 0u);
  const std::size_t once = files["tileset.json"].size() + files["much.json"].size() + files["a.glb"].size();
  EXPECT_EQ(read.report.bytes, once);
}

TEST(TilesetHostile, NestedTilesetsShareOneLimit) {
  // Each takes 330 MB when it is parsed, and all that contain a tile are kept.
  std::string arrays = "[0";
  for (int i = 0; i < 3'400'000; ++i) arrays += ",[]";
  Files files;
  for (int i = 0; i < 5; ++i) {
    json root = tile_json(10, "a.glb");
    root["refine"] = "ADD";
    root["children"] = json::array({tile_json(5, "t" + std::to_string(i + 1) + ".json")});
    const std::string text = tileset_json(root).dump();
    files[i == 0 ? "tileset.json" : "t" + std::to_string(i) + ".json"] =
        gzip(text.substr(0, text.size() - 1) + ",\"extras\":" + arrays + "]}");
  }
  files["a.glb"] = box_glb({{}});
  TemporaryDirectory folder;
  write_files(folder, files);
  const TilesetScene read = read_tileset(folder / "tileset.json");
  EXPECT_EQ(read.report.documents, 3u);
  EXPECT_EQ(read.report.holes, 1u);
  EXPECT_NE(read.report.first_hole.find("t3.json"), std::string::npos) << read.report.first_hole;
}

TEST(TilesetHostile, DeepNestingIsRefused) {
  std::string text = R"({"asset":{"version":"1.1"},"geometricError":1,"root":)";
  for (int i = 0; i < 100'000; ++i) text += R"({"geometricError":1,"children":[)";
  TemporaryDirectory folder;
  testing::write_bytes(folder / "tileset.json", text);
  expect_code([&] { read_tileset(folder / "tileset.json"); }, ErrorCode::mesh_syntax, "tileset.json");
}

TEST(TilesetHostile, AMillionChildrenAreReadOrRefused) {
  std::string text =
      R"({"asset":{"version":"1.1"},"geometricError":1,"root":{"geometricError":9,"refine":"ADD","children":[)";
  for (int i = 0; i < 1'000'000; ++i) text += R"({"geometricError":0,"content":{"uri":"gone"}},)";
  text.back() = ']';
  TemporaryDirectory folder;
  testing::write_bytes(folder / "tileset.json", text + "}}");
  expect_code([&] { read_tileset(folder / "tileset.json"); }, ErrorCode::region_invalid, "");
}

}  // namespace
}  // namespace vantage
