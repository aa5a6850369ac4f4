// Rasters of heights as scenes of their own: docs/terrain.md.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/georeference.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage {

/// Which part of a raster becomes a scene; at most one of the three, none: all of it.
struct RasterRegion {
  std::optional<std::array<double, 2>> center_deg;  ///< latitude, longitude (WGS 84): a square about it
  double radius_m = 0;                              ///< half the square's side; > 0 with `center_deg`
  std::optional<std::array<double, 4>> bbox_deg;    ///< west, south, east, north; west > east crosses the antimeridian
  std::optional<std::array<int, 4>> pixels;         ///< first column, first row (from 0), columns, rows
};

struct RasterOptions {
  RasterRegion region;
  /// The scene differs from the heights in the file by no more than this, vertically, at every post. 0 keeps every
  /// post: two triangles for each square of four.
  double max_error_m = 0.25;
  std::optional<std::array<double, 2>> origin_deg;  ///< of the scene frame: latitude, longitude; else the middle
};

struct RasterReport {
  std::size_t columns = 0, rows = 0;  ///< posts in the region
  std::size_t voids = 0;              ///< of these, posts without a value, filled from their neighbours
  double largest_error_m = 0;         ///< vertical, measured at every post
  double lowest_m = 0, highest_m = 0;
};

struct RasterScene {
  Scene scene;  ///< one object, of ObjectKind::surface
  RasterReport report;
};

/// Reads a raster of heights (GeoTIFF, SRTM .hgt, ASCII grid; also in a .zip) and makes its surface a scene, in metres
/// about `origin_deg`: z is the height in the file (see Georeference::vertical). The surface ends on the outermost
/// posts of the region, which covers what was asked for.
///
/// It has one height at every place. Under bridges, eaves and crowns of trees it is solid; walls are as steep as one
/// step of the raster; and what the true surface does between two posts is not known: the triangles take it for flat.
/// A sight line that passes within one post's distance of an edge may be judged either way. With an error above 0, so
/// may one that passes within that error above or below the surface.
///
/// Throws Error(input) naming the file for all that makes a raster unusable (docs/terrain.md: among others no
/// coordinate reference system, a region that it does not cover, no value in it), for options out of range, and where
/// GDAL is not installed; Error(cancelled) when told to stop. Cost: n log n in the posts.
VANTAGE_API RasterScene scene_from_raster(const std::filesystem::path& file, const RasterOptions& options = {},
                                          const Progress& progress = {});

}  // namespace vantage
