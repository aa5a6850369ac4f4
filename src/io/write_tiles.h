// 3D Tiles 1.1 (OGC 22-025r4): a volume on the globe, as a folder with tileset.json and one GLB.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "common/output.h"
#include "io/tiles_folder.h"

namespace vantage::internal::io {

/// Throws Error(not_georeferenced) where it is not known where on the earth the scene lies.
void check_tiles_georeference(const std::optional<Georeference>& georeference, const std::filesystem::path& folder);

/// Writes all but the last step. Every vertex is placed on the globe in double precision (io/on_globe.h), then rounded
/// to single precision about the middle of the volume. Throws as write_volume does, and Error(input) for a volume
/// without georeference.
StagedVolume stage_tiles(const Volume& volume, const std::filesystem::path& folder);

}  // namespace vantage::internal::io
