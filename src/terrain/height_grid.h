// Heights on a grid: terrain (DEM) and surface (DSM) rasters.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geo/local_frame.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"

namespace vantage::terrain {

/// A rectangle of posts (samples), in the raster's own coordinate reference system. Immutable after reading.
struct HeightGrid {
  std::filesystem::path file;
  geo::CoordinateSystem crs;
  Eigen::Vector2d first;  ///< position of the first post (row 0, column 0), in the CRS: the *centre* of that pixel
  Eigen::Vector2d step;   ///< to the next column (x) and to the next row (y; mostly negative: rows run south)
  int columns = 0, rows = 0;
  std::vector<float> heights_m;  ///< row by row; all finite: voids are filled
  std::size_t voids = 0;         ///< posts that had no value (nodata, NaN) and were filled from their neighbours
  std::string vertical;          ///< what the heights are measured from, as far as the file says

  float at(int column, int row) const {
    return heights_m[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
  }
};

/// The part of a raster that is read: a rectangle in the local frame about `origin`, plus two posts round it.
struct Window {
  geo::LonLat origin;
  Eigen::Vector2d min, max;  ///< metres, local frame
};

/// Reads GeoTIFF, SRTM .hgt (also zipped) and whatever else GDAL reads as a raster of one band of heights in metres.
/// Without a window the whole raster. Voids are filled with the mean of the nearest values in eight directions,
/// weighted by the inverse of their distance, and counted. Throws Error(input) naming the file for: no such file, not a
/// raster, no CRS, rotated or without georeference, does not cover the window (says its bounds and the window's), no
/// value at all in the window, more than 2^28 posts, a unit of height other than metres and feet, or a GDAL that cannot
/// be loaded (which package to install). Error(cancelled) when told to stop. GDAL is loaded at run time: Debian builds
/// it with libraries under the GPL, which this library does not link.
HeightGrid read_height_grid(const std::filesystem::path& file, const std::optional<Window>& window = {},
                            const Progress& progress = {});

/// A piecewise linear terrain over a part of the plane, in a local frame.
class Surface {
 public:
  /// Triangles that span the rectangle [min, max] of the frame; none overlap. Made by `triangulate`.
  explicit Surface(Mesh mesh);

  const Mesh& mesh() const;                                       ///< counter-clockwise seen from above
  std::optional<double> height(const Eigen::Vector2d& at) const;  ///< nothing outside
  /// The lowest and the highest height over a polygon (its boundary and inside), exactly. Nothing where the polygon
  /// sticks out of the surface. `ring`: open, either turn.
  struct Range {
    double lowest, highest;
  };
  std::optional<Range> range(const std::vector<Eigen::Vector2d>& ring) const;

 private:
  Mesh mesh_;
  // a grid of triangles for look-up
  std::vector<std::vector<std::uint32_t>> cells_;
  Eigen::Vector2d corner_, cell_;
  int columns_ = 0, rows_ = 0;
};

/// A triangulated irregular network that differs from the grid's bilinear surface by at most `max_error_m` vertically
/// at every post (measured and returned). Posts are inserted greedily, worst first, into a Delaunay triangulation
/// (Garland and Heckbert, "Fast polygonal approximation of terrains and height fields", 1995). `window` in the frame's
/// metres.
struct Triangulation {
  Surface surface;
  double largest_error_m = 0;  ///< over all posts in the window
  std::size_t posts = 0;       ///< posts in the window
};
Triangulation triangulate(const HeightGrid& grid, const geo::LocalFrame& frame, const Eigen::Vector2d& min,
                          const Eigen::Vector2d& max, double max_error_m, const Progress& progress = {});

}  // namespace vantage::terrain
