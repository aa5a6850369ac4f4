// A tileset in a folder of its own, and what was read of it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "support/temporary_directory.h"
#include "vantage/tileset.h"

namespace vantage::testing {

/// A folder with a tileset.
class Tileset : public TemporaryDirectory {
 public:
  explicit Tileset(const nlohmann::json& tileset) { add("tileset.json", tileset.dump()); }
  void add(const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories((path() / name).parent_path());
    write_bytes(path() / name, bytes);
  }
  std::filesystem::path file() const { return path() / "tileset.json"; }
  TilesetScene read(const TilesetOptions& options = {}) const { return read_tileset(file(), options); }
};

/// Of all objects that were read, without those that stand in.
inline std::set<std::string> ids_of(const TilesetScene& tiles) {
  std::set<std::string> ids;
  for (const SceneObject& object : tiles.scene.objects) {
    if (object.kind != ObjectKind::stand_in) ids.insert(object.source_id);
  }
  return ids;
}

}  // namespace vantage::testing
