// A raster on disk: what it says of itself, and its heights as they are stored. Seen through GDAL.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "maps/terrain/gdal_library.h"
#include "maps/terrain/height_grid.h"
#include "vantage/error.h"

namespace vantage::internal::terrain {

/// An absolute path so that GDAL takes it for nothing but a file on disk: what begins with "/vsi", as in /vsicurl/, are
/// its names for other things.
std::string path_on_disk(const std::string& absolute);

struct DatasetCloser {
  const GdalLibrary* library = nullptr;
  void operator()(void* dataset) const;
};

class RasterFile {
 public:
  /// Opens it and checks that it may be read as heights: throws Error(input) as read_height_grid does. `crs`: overrides
  /// what the file says; empty: that counts.
  explicit RasterFile(const std::filesystem::path& file, const std::string& crs = {});

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// (x, y) of the upper left *corner* of the upper left pixel, and the size of a pixel: y mostly negative.
  const Eigen::Vector2d& corner() const { return corner_; }
  const Eigen::Vector2d& pixel() const { return pixel_; }
  const std::string& crs_wkt() const { return crs_wkt_; }
  /// As the file has it: "metre", "US survey foot", or empty.
  const std::string& unit() const { return unit_; }
  bool is_srtm() const { return is_srtm_; }

  /// Heights in the file's unit, row by row; not-a-number where the file has none. Calls `done` with the number of rows
  /// that were read, from time to time.
  std::vector<float> read(const PixelWindow& pixels, const std::function<void(int)>& done) const;

 private:
  void open();
  void check_bands() const;
  void read_georeference();
  std::string stated_crs(void* system) const;
  void read_rows(const PixelWindow& pixels, int begin, int end, float* heights) const;
  [[noreturn]] void fail(ErrorCode code, const std::string& problem, const std::string& fix) const;

  std::filesystem::path file_;
  const GdalLibrary& library_;
  std::unique_ptr<void, DatasetCloser> dataset_;
  void* band_ = nullptr;  // the dataset's
  int columns_ = 0, rows_ = 0;
  Eigen::Vector2d corner_, pixel_;
  std::string crs_wkt_, unit_;
  double scale_ = 1, offset_ = 0;
  bool is_srtm_ = false;
};

}  // namespace vantage::internal::terrain
