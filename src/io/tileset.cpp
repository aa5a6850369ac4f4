#include "io/tileset.h"

#include <array>
#include <string>

namespace vantage::internal::io {
namespace {

constexpr std::array<std::string_view, 5> kTileMagics = {"b3dm", "cmpt", "i3dm", "pnts", "subt"};

}  // namespace

bool is_tile(std::string_view bytes) {
  for (const std::string_view magic : kTileMagics) {
    // A version in four bytes: a text that begins with these letters has none.
    if (bytes.starts_with(magic) && bytes.size() >= 8 && bytes[5] == 0 && bytes[6] == 0) return true;
  }
  return false;
}

bool is_tileset(std::string_view json) {
  const auto has = [json](std::string_view key) { return json.find(key) != std::string_view::npos; };
  return has("\"geometricError\"") && has("\"root\"") && has("\"asset\"") && !has("\"accessors\"");
}

void fail_for_tileset(const MeshSource& source) {
  const bool is_one_tile = is_tile(source.bytes());
  source.fail(ErrorCode::mesh_unsupported,
              is_one_tile ? "this is a tile of 3D Tiles, not a mesh by itself"
                          : "this is a tileset of 3D Tiles, an index of other files, not a mesh",
              std::string(is_one_tile ? "give the tileset.json that names it: " : "") +
                  "in a mission write 'tiles: tileset.json' instead of 'mesh: ...'; commands read it if its name is "
                  "tileset.json");
}

}  // namespace vantage::internal::io
