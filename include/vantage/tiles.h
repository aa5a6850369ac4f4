// A city larger than memory, in tiles: docs/python-areas.md.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "vantage/city.h"
#include "vantage/export.h"
#include "vantage/progress.h"

namespace vantage {

/// A square of the map, and what must be built for targets in it.
struct Tile {
  std::array<double, 4>
      square_m{};     ///< west, south, east, north, scene frame; targets with their centre here are its own
  CityRegion region;  ///< to build, with the plan's frame
};

/// How a map is cut. The volume of a target is the same in its tile as in the whole map built with the frame: vertices,
/// facets and causes, but for the index of the object of a cause. That holds for every target of which each part has
/// its centre within a tile's square, or beyond it by e metres, where e and the longest reach (its range, and the
/// distance to keep from obstacles) make `margin_m` at the most.
struct TilePlan {
  CityFrame frame;
  double size_m = 0, margin_m = 0;
  std::size_t columns = 0, rows = 0;
  std::vector<Tile> tiles;  ///< row by row from the south, each from the west

  /// Which tile a place of the scene frame belongs to. What lies outside of all belongs to the nearest: beyond the
  /// tiles there is nothing to build.
  VANTAGE_API std::size_t tile_at(double east_m, double north_m) const;
};

/// Cuts a map into squares of `size_m` metres, and says what to build for each, so that it holds all within `margin_m`
/// of the square. The map is read and its outlines are cleaned once, but nothing is built.
/// `options`: as for build_city, without a region, a frame and terrain.
///
/// Throws Error(input) for what build_city refuses, a size or a margin out of range (1 m to 50 km; the margin may be
/// 0), more than 10^6 tiles, a map round a pole, and terrain. Error(cancelled) when told to stop.
VANTAGE_API TilePlan plan_tiles(const std::filesystem::path& file, const CityOptions& options, double size_m,
                                double margin_m, const Progress& progress = {});

}  // namespace vantage
