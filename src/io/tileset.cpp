#include "io/tileset.h"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "common/input.h"
#include "io/json_text.h"

namespace vantage::internal::io {
namespace {

/// The files that a tile names.
std::vector<std::string> contents_of(const nlohmann::json& tile) {
  std::vector<std::string> found;
  const auto add = [&found](const nlohmann::json& content) {
    if (!content.is_object()) return;
    for (const char* const key : {"uri", "url"}) {
      const auto name = content.find(key);
      if (name != content.end() && name->is_string()) found.push_back(name->get<std::string>());
    }
  };
  if (const auto content = tile.find("content"); content != tile.end()) add(*content);
  if (const auto several = tile.find("contents"); several != tile.end() && several->is_array()) {
    for (const nlohmann::json& content : *several) add(content);
  }
  return found;
}

/// The first file that is named and ends so.
std::optional<std::string> content_with(const nlohmann::json& root, std::initializer_list<std::string_view> endings) {
  std::vector<const nlohmann::json*> open = {&root};
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (!open[i]->is_object()) continue;
    for (std::string& name : contents_of(*open[i])) {
      for (const std::string_view ending : endings) {
        if (name.ends_with(ending)) return std::move(name);
      }
    }
    const auto children = open[i]->find("children");
    if (children == open[i]->end() || !children->is_array()) continue;
    for (const nlohmann::json& child : *children) open.push_back(&child);
  }
  return std::nullopt;
}

struct TileKind {
  std::string_view magic, ending;
  const char* advice;
};
constexpr std::array<TileKind, 5> kTileKinds = {{
    {"b3dm", ".b3dm", "take the GLB out of the tile: 3d-tiles-tools b3dmToGlb -i TILE.b3dm -o tile.glb"},
    {"cmpt", ".cmpt", "take the GLBs out of the tile: 3d-tiles-tools cmptToGlb -i TILE.cmpt -o tile.glb"},
    {"i3dm", ".i3dm", "it holds copies of one model: export them as one mesh from the program that made them"},
    {"pnts", ".pnts", "it is a cloud of points, without surfaces: make a mesh of it"},
    {"subt", ".subtree", "it only says which tiles there are: give one of these, as GLB"},
}};

std::string advice_of(const MeshSource& source) {
  for (const TileKind& kind : kTileKinds) {
    if (source.bytes().starts_with(kind.magic)) return kind.advice;
  }
  std::string convert = std::string("give one of its tiles, as GLB; of b3dm: ") + kTileKinds[0].advice;
  try {
    const nlohmann::json tileset = parse_json(source.bytes(), {}, {});
    const auto root = tileset.find("root");
    if (root == tileset.end()) return convert;
    if (const auto mesh = content_with(*root, {".glb", ".gltf"})) {
      return "give one of the tiles that it names, such as " + in_quotes(*mesh);
    }
    for (const TileKind& kind : kTileKinds) {
      if (const auto tile = content_with(*root, {kind.ending})) {
        return "it names " + in_quotes(*tile) + "; " + kind.advice;
      }
    }
  } catch (const JsonProblem&) {  // it is cut off: the advice need not name a tile
  }
  return convert;
}

}  // namespace

bool is_tile(std::string_view bytes) {
  for (const TileKind& kind : kTileKinds) {
    // A version in four bytes: a text that begins with these letters has none.
    if (bytes.starts_with(kind.magic) && bytes.size() >= 8 && bytes[5] == 0 && bytes[6] == 0) return true;
  }
  return false;
}

bool is_tileset(std::string_view json) {
  const auto has = [json](std::string_view key) { return json.find(key) != std::string_view::npos; };
  return has("\"geometricError\"") && has("\"root\"") && has("\"asset\"") && !has("\"accessors\"");
}

void fail_for_tileset(const MeshSource& source) {
  source.fail(ErrorCode::mesh_unsupported,
              is_tile(source.bytes()) ? "this is a tile of 3D Tiles, which is not read"
                                      : "this is a tileset of 3D Tiles, an index of other files, which is not read",
              advice_of(source));
}

}  // namespace vantage::internal::io
