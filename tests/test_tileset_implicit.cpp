// Implicit tiling of tilesets that are made here: subtrees, availabilities, and templates of addresses.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "support/tile_files.h"
#include "support/tileset_folder.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/tileset.h"

namespace vantage {
namespace {

using nlohmann::json;
using testing::box_glb;
using testing::expect_code;
using testing::ids_of;
using testing::subtree;
using testing::tile_json;
using testing::Tileset;
using testing::tileset_json;

TEST(Tileset, ReadsImplicitTrees) {
  json root = tile_json(16, "c/{level}_{x}_{y}.glb", 8);
  root["refine"] = "REPLACE";
  root["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                            {"subtreeLevels", 2},
                            {"availableLevels", 3},
                            {"subtrees", {{"uri", "s/{level}_{x}_{y}.subtree"}}}};
  Tileset tiles(tileset_json(root));
  // Level 1: the tiles (1, 0) and (0, 1), Morton numbers 1 and 2. Below (0, 1) is a subtree at (1, 2), number 9 of 16.
  const json bits = {{"buffers", {{{"byteLength", 4}}}},
                     {"bufferViews",
                      {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 1}},
                       {{"buffer", 0}, {"byteOffset", 1}, {"byteLength", 1}},
                       {{"buffer", 0}, {"byteOffset", 2}, {"byteLength", 2}}}},
                     {"tileAvailability", {{"bitstream", 0}}},
                     {"contentAvailability", {{{"bitstream", 1}}}},
                     {"childSubtreeAvailability", {{"bitstream", 2}}}};
  tiles.add("s/0_0_0.subtree", subtree(bits, std::string("\x0d\x0d\x00\x02\0\0\0\0", 8)));
  const json all = {{"tileAvailability", {{"constant", 1}}},
                    {"contentAvailability", {{{"constant", 1}}}},
                    {"childSubtreeAvailability", {{"constant", 0}}}};
  tiles.add("s/2_1_2.subtree", subtree(all));
  for (const char* name : {"c/0_0_0.glb", "c/1_1_0.glb", "c/1_0_1.glb", "c/2_1_2.glb"}) tiles.add(name, box_glb({{}}));
  const TilesetScene read = tiles.read();
  EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
  EXPECT_EQ(ids_of(read), (std::set<std::string>{"c/1_1_0.glb", "c/2_1_2.glb"}));
  EXPECT_EQ(read.report.largest_error_m, 8);
  EXPECT_EQ(read.report.documents, 3u);
  // What the parent says to be there is missed; the coarser tile is kept in its place.
  json none = all;
  none["tileAvailability"]["constant"] = 0;
  tiles.add("s/2_1_2.subtree", subtree(none));
  const TilesetScene without = tiles.read();
  EXPECT_EQ(without.report.holes, 1u);
  EXPECT_TRUE(ids_of(without).contains("c/1_0_1.glb"));
}

TEST(Tileset, TemplatesOfAddressesAreShort) {
  json root = tile_json(16, "c/{level}.glb", 8);
  root["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                            {"subtreeLevels", 1},
                            {"availableLevels", 1},
                            {"subtrees", {{"uri", std::string(5000, 'x') + ".subtree"}}}};
  const Error long_one =
      expect_code([&] { Tileset(tileset_json(root)).read(); }, ErrorCode::mesh_empty, "tileset.json");
  EXPECT_NE(std::string(long_one.what()).find(" 4096 "), std::string::npos) << long_one.what();
}

TEST(Tileset, ImplicitTreesMayAnnounceManyLevels) {
  json root = tile_json(16, "c/%7Blevel%7D_%7bx%7d_{y}.glb", 8);
  root["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                            {"subtreeLevels", 1},
                            {"availableLevels", 1000},
                            {"subtrees", {{"uri", "s/%7Blevel%7D.subtree"}}}};
  Tileset tiles(tileset_json(root));
  json all = {{"tileAvailability", {{"constant", 1}}},
              {"contentAvailability", {{{"constant", 1}}}},
              {"childSubtreeAvailability", {{"constant", 0}}}};
  tiles.add("s/0.subtree", subtree(all));
  tiles.add("c/0_0_0.glb", box_glb({{}}));
  const TilesetScene read = tiles.read();
  EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
  EXPECT_EQ(ids_of(read), std::set<std::string>{"c/0_0_0.glb"});
  // One child below the other: too many are a hole, and the last that can be read stands for them.
  const json one = {{"buffers", {{{"byteLength", 1}}}},
                    {"bufferViews", {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 1}}}},
                    {"tileAvailability", {{"constant", 1}}},
                    {"contentAvailability", {{{"constant", 0}}}},
                    {"childSubtreeAvailability", {{"bitstream", 0}}}};
  for (int i = 0; i < 70; ++i) {
    tiles.add("s/" + std::to_string(i) + ".subtree", subtree(one, std::string("\x01\0\0\0\0\0\0\0", 8)));
  }
  all["childSubtreeAvailability"] = one["childSubtreeAvailability"];
  all["buffers"] = one["buffers"];
  all["bufferViews"] = one["bufferViews"];
  tiles.add("s/0.subtree", subtree(all, std::string("\x01\0\0\0\0\0\0\0", 8)));
  TilesetOptions fine;
  fine.detail_m = 0;
  const TilesetScene deep = tiles.read(fine);
  EXPECT_EQ(deep.report.holes, 1u) << deep.report.first_hole;
  EXPECT_EQ(deep.report.coarser_kept, 1u);
  EXPECT_EQ(ids_of(deep), std::set<std::string>{"c/0_0_0.glb"});
}

TEST(Tileset, AContentMayStandBesideSeveral) {
  const auto read_with = [](const std::string& content, json availability) {
    json root = tile_json(16, content, 8);
    root["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                              {"subtreeLevels", 1},
                              {"availableLevels", 1},
                              {"subtrees", {{"uri", "s.subtree"}}}};
    root["extensions"]["3DTILES_multiple_contents"]["contents"] = {{{"uri", "a.glb"}}, {{"uri", "b.glb"}}};
    Tileset tiles(tileset_json(root));
    availability["tileAvailability"] = {{"constant", 1}};
    availability["childSubtreeAvailability"] = {{"constant", 0}};
    availability["extensions"]["3DTILES_multiple_contents"]["contentAvailability"] = {{{"constant", 1}},
                                                                                      {{"constant", 0}}};
    tiles.add("s.subtree", subtree(availability));
    for (const char* name : {"a.glb", "b.glb", "c.glb"}) tiles.add(name, box_glb({{}}));
    const TilesetScene read = tiles.read();
    EXPECT_EQ(read.report.holes, 0u) << read.report.first_hole;
    EXPECT_EQ(read.report.triangles, 12 * read.report.contents);
    return ids_of(read);
  };
  using Ids = std::set<std::string>;
  const json own = {{"contentAvailability", {{"constant", 0}}}};
  EXPECT_EQ(read_with("c.glb", json::object()), (Ids{"a.glb", "c.glb"}));
  EXPECT_EQ(read_with("c.glb", own), Ids{"a.glb"});
  EXPECT_EQ(read_with("a.glb", json::object()), Ids{"a.glb"});  // the same, for programs that know no others
}

TEST(Tileset, GarbledAvailabilityIsAHole) {
  json implicit = tile_json(16, "c/{level}.glb", 8);
  implicit["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                                {"subtreeLevels", 1},
                                {"availableLevels", 1},
                                {"subtrees", {{"uri", "s.subtree"}}}};
  json root = tile_json(50);
  root["refine"] = "ADD";
  root["children"] = json::array({implicit, tile_json(0, "a.glb")});
  Tileset tiles(tileset_json(root));
  tiles.add("a.glb", box_glb({{}}));
  tiles.add("c/0.glb", box_glb({{}}));
  const auto holes_of = [&](const json& contents, const json& extensions = {}) {
    json all = {{"tileAvailability", {{"constant", 1}}}, {"childSubtreeAvailability", {{"constant", 0}}}};
    if (!contents.is_discarded()) all["contentAvailability"] = contents;
    if (!extensions.empty()) all["extensions"] = extensions;
    tiles.add("s.subtree", subtree(all));
    const TilesetScene read = tiles.read();
    EXPECT_EQ(read.report.contents + read.report.holes, 2u) << contents << extensions;
    return read.report.holes;
  };
  const json missing(json::value_t::discarded), available = {{"constant", 1}};
  EXPECT_EQ(holes_of(json::array({available})), 0u);
  EXPECT_EQ(holes_of(available), 0u);  // 1.0
  EXPECT_EQ(holes_of(missing, {{"3DTILES_multiple_contents", {{"contentAvailability", json::array({available})}}}}),
            0u);
  EXPECT_EQ(holes_of(missing), 1u);
  EXPECT_EQ(holes_of(nullptr), 1u);
  EXPECT_EQ(holes_of(json::array()), 1u);
  EXPECT_EQ(holes_of(json::array({nullptr})), 1u);
  EXPECT_EQ(holes_of(json::array({{{"constant", true}}})), 1u);
  EXPECT_EQ(holes_of(json::array({{{"constant", 2}}})), 1u);
}

}  // namespace
}  // namespace vantage
