// Heights on a grid: terrain (DEM) and surface (DSM) rasters. docs/terrain.md.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geo/local_frame.h"
#include "maps/terrain/fill_voids.h"
#include "vantage/ground.h"
#include "vantage/progress.h"

namespace vantage::internal::terrain {

/// A rectangle of posts (samples), in the raster's own coordinate reference system. Immutable after reading.
struct HeightGrid {
  std::filesystem::path file;
  geo::CoordinateSystem crs;
  Eigen::Vector2d first;  ///< position of the first post (row 0, column 0), in the CRS: the *centre* of that pixel
  Eigen::Vector2d step;   ///< to the next column (x) and to the next row (y; mostly negative: rows run south)
  int columns = 0, rows = 0;
  std::vector<float> heights_m;  ///< row by row; all finite: voids are filled
  std::size_t voids = 0;         ///< posts that had no value
  std::string vertical;          ///< what the heights are measured from, as far as the file says
  std::vector<VoidRegion> void_regions = {};
  std::vector<float> lowest_m = {};  ///< the least that the heights may be: Voids::lowest_m

  float at(int column, int row) const {
    return heights_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
  }
  /// Bilinear, at a place given in columns and rows. Outside the posts, the value on their border.
  double height_m(const Eigen::Vector2d& column_row) const;
  /// Where a position lies, in columns and rows; beyond the posts too. Throws as CoordinateSystem::from_lonlat.
  Eigen::Vector2d column_row(geo::LonLat position) const;
  geo::LonLat position(const Eigen::Vector2d& column_row) const;  ///< the inverse
};

/// The part of a raster that is read: a rectangle in the local frame about `origin`, plus two posts round it.
struct Window {
  geo::LonLat origin;
  Eigen::Vector2d min, max;  ///< metres, local frame
};

/// Pixels of the raster: columns and rows from its upper left corner.
struct PixelWindow {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
};

/// What is given beside the file.
struct HeightReading {
  std::string crs = {};  ///< overrides that of the file
  HeightOptions heights = {};
  MissingPolicy missing = MissingPolicy::block;
};

/// Reads GeoTIFF, SRTM .hgt and ASCII grids of one band of heights, also in a .zip. A height lies at the centre of its
/// pixel. Feet become metres; scale and offset of the band are applied. A post is void when
/// the file masks it (nodata), when it is not finite, -9999 or -32768 (often not declared), or beyond 12 km up or down:
/// fill_voids. Without a window the whole raster.
///
/// Throws Error(input) naming the file for: no such file, not a raster, several bands or a picture, no CRS, rotated or
/// without georeference, does not cover the window up to half a pixel (says the bounds of both), no value at all in the
/// window, more than 2^28 posts, or more than 2^24 and 8 for each byte of the file, a mask or a value for "no height"
/// in a file beside it, a unit of height other than metres and feet, eastings in feet without a unit of height, a
/// height of voids out of range, or a GDAL that cannot be loaded (which package to install). Error(cancelled) when
/// told to stop.
HeightGrid read_height_grid(const std::filesystem::path& file, const std::optional<Window>& window = {},
                            const Progress& progress = {}, const HeightReading& reading = {});
/// The same for pixels; throws Error(input) for a window that is empty or sticks out of the raster.
HeightGrid read_height_pixels(const std::filesystem::path& file, const PixelWindow& pixels,
                              const Progress& progress = {}, const HeightReading& reading = {});

}  // namespace vantage::internal::terrain
