// Files of 3D Tiles where a mesh was expected. src/tiles reads them.
#pragma once

#include <string_view>

#include "io/mesh_source.h"

namespace vantage::internal::io {

/// Whether these are the bytes of a tile in a container: b3dm, i3dm, cmpt, pnts, or a subtree.
bool is_tile(std::string_view bytes);

/// Whether this JSON is the index of a tileset: tileset.json.
bool is_tileset(std::string_view json);

/// Throws Error(mesh_unsupported) for such a file, with advice.
[[noreturn]] void fail_for_tileset(const MeshSource& source);

}  // namespace vantage::internal::io
