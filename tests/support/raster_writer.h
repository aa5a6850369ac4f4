// Small rasters for tests: raw floats, described by a text of GDAL's virtual format, of which GDAL makes a GeoTIFF.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace vantage::testing {

/// A raster file to be; the defaults are 10 m pixels in UTM zone 32 north.
struct TestRaster {
  int columns = 0, rows = 0;
  std::vector<float> values;  ///< row by row, from the north
  /// Of GDAL: x of the upper left corner, pixel width, 0, its y, 0, pixel height (negative).
  std::array<double, 6> transform = {500000, 10, 0, 5000000, 0, -10};
  float& at(int column, int row) {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }

  std::string srs = "EPSG:32632";  ///< empty: none
  std::string nodata;              ///< "-9999", "nan"; empty: none declared
  std::string unit;                ///< "ft"; empty: none
  double scale = 1, offset = 0;    ///< declared when they differ from these
  int bands = 1;                   ///< all with the same values
  std::string colour;              ///< GDAL's colour interpretation; empty: none
  bool placed = true;              ///< has a transform
  std::string type = "Float32";    ///< of GDAL; the file then holds nothing but zeros if it is another
};

/// Writes NAME.vrt and the floats beside it; returns the former's path. vantage does not read it.
std::filesystem::path write_virtual_raster(const std::filesystem::path& folder, const std::string& name,
                                           const TestRaster& raster);

/// A copy of any raster by GDAL, with all of its drivers: "GTiff", "AAIGrid", "SRTMHGT", "HFA", ... `metadata`, of the
/// form DOMAIN|NAME=VALUE, is added to it. Throws where GDAL cannot.
void convert_raster(const std::filesystem::path& from, const std::filesystem::path& to, const std::string& driver,
                    const std::string& metadata = "");

/// Writes NAME.tif, a GeoTIFF; returns its path.
std::filesystem::path write_raster(const std::filesystem::path& folder, const std::string& name,
                                   const TestRaster& raster);

/// A raster whose values are `height(column, row)`.
template <typename Height>
TestRaster make_raster(int columns, int rows, const Height& height) {
  TestRaster raster;
  raster.columns = columns;
  raster.rows = rows;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) raster.values.push_back(static_cast<float>(height(column, row)));
  }
  return raster;
}

}  // namespace vantage::testing
