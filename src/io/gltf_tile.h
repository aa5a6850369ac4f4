// glTF as the content of a tile of 3D Tiles.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "io/feature_identity.h"
#include "io/mesh_file.h"

namespace vantage::internal::io {

struct TileContext {
  std::string name;  ///< of the tile, in ids of objects that have none: "data/data0.b3dm"
  /// Who a feature of the batch table is; empty where there is no such table.
  std::function<SceneObject(std::uint64_t id)> batch;
  /// The content of a file that the glTF refers to.
  std::function<std::string(const std::string& uri)> read_file;
};

struct TileMesh {
  RawMesh mesh;                ///< as read_gltf gives it, y up, but with an object for each feature; may be empty
  Vec3 center = Vec3::Zero();  ///< CESIUM_RTC: to be added when z is up
  UnreadableProperties unreadable_properties = {};
  std::uint64_t features_by_texture = 0;  ///< primitives that have such
};

TileMesh read_gltf_tile(const MeshSource& source, const core::ProgressReporter& progress,
                        const core::ReadLimits& limits, const TileContext& tile);

}  // namespace vantage::internal::io
