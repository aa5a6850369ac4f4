// Where a tileset lies, and the way from its coordinates into the scene frame.
#pragma once

#include <filesystem>
#include <optional>

#include "tiles/collector.h"
#include "tiles/document.h"
#include "vantage/tileset.h"

namespace vantage::internal::tiles {

/// What the coordinates of a tileset are: as the options say, or on the earth where the root's volume is.
World world_of(const Volume& root, const TilesetOptions& options);

/// The circle that is wanted. Throws Error(input) for a centre that the tileset cannot have, as one that is nowhere,
/// and for one outside of the root's volume.
Reach reach_of(World world, const Volume& root, const TilesetOptions& options, const std::filesystem::path& file);

/// The collected mesh in the scene frame, with its georeference. Throws Error(input).
Scene placed_scene(World world, Collector&& collected, const TilesetOptions& options, const std::filesystem::path& file,
                   const core::ProgressReporter& progress);

/// How far the frame of a scene on the earth is from the ellipsoid: rim_drop_m and rim_shift_m of the report, at the
/// corners of the scene.
void measure_frame(const Scene& scene, TilesetReport& report);

}  // namespace vantage::internal::tiles
