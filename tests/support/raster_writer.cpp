#include "support/raster_writer.h"

#include <dlfcn.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "maps/terrain/gdal_library.h"
#include "support/internals.h"

namespace vantage::testing {
namespace {

/// The functions of GDAL that write. It is the library that vantage loads, with all of its drivers.
struct WritingGdal {
  void (*all_register)() = nullptr;
  void* (*open)(const char*, int) = nullptr;
  void* (*driver)(const char*) = nullptr;
  void* (*copy)(void*, const char*, void*, int, char**, void*, void*) = nullptr;
  int (*set_metadata)(void*, const char*, const char*, const char*) = nullptr;
  void (*close)(void*) = nullptr;

  WritingGdal() {
    void* handle = nullptr;
    for (const std::string& name : terrain::gdal_library_names()) {
      if ((handle = ::dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL))) break;
    }
    const auto find = [handle](auto& function, const char* name) {
      function =
          reinterpret_cast<std::remove_reference_t<decltype(function)>>(handle ? ::dlsym(handle, name) : nullptr);
      if (!function) throw std::runtime_error(std::string("no GDAL with ") + name);
    };
    find(all_register, "GDALAllRegister");
    find(open, "GDALOpen");
    find(driver, "GDALGetDriverByName");
    find(copy, "GDALCreateCopy");
    find(set_metadata, "GDALSetMetadataItem");
    find(close, "GDALClose");
    all_register();
  }
};

}  // namespace

void convert_raster(const std::filesystem::path& from, const std::filesystem::path& to, const std::string& driver,
                    const std::string& metadata) {
  static const WritingGdal gdal;
  void* const source = gdal.open(from.c_str(), 0);
  void* const format = gdal.driver(driver.c_str());
  if (!source || !format) throw std::runtime_error("GDAL cannot read " + from.string());
  if (!metadata.empty()) {
    const std::size_t bar = metadata.find('|'), equals = metadata.find('=');
    gdal.set_metadata(source, metadata.substr(bar + 1, equals - bar - 1).c_str(), metadata.substr(equals + 1).c_str(),
                      metadata.substr(0, bar).c_str());
  }
  void* const made = gdal.copy(format, to.c_str(), source, 0, nullptr, nullptr, nullptr);
  if (made) gdal.close(made);
  gdal.close(source);
  if (!made) throw std::runtime_error("GDAL cannot write " + to.string());
}

std::filesystem::path write_raster(const std::filesystem::path& folder, const std::string& name,
                                   const TestRaster& raster) {
  std::filesystem::path file = folder / (name + ".tif");
  convert_raster(write_virtual_raster(folder, name, raster), file, "GTiff");
  return file;
}

std::filesystem::path write_virtual_raster(const std::filesystem::path& folder, const std::string& name,
                                           const TestRaster& raster) {
  std::ofstream(folder / (name + ".bin"), std::ios::binary)
      .write(reinterpret_cast<const char*>(raster.values.data()),
             static_cast<std::streamsize>(raster.values.size() * sizeof(float)));
  std::ostringstream text;
  text.precision(17);
  text << "<VRTDataset rasterXSize=\"" << raster.columns << "\" rasterYSize=\"" << raster.rows << "\">\n";
  if (!raster.srs.empty()) text << "<SRS>" << raster.srs << "</SRS>\n";
  if (raster.placed) {
    text << "<GeoTransform>";
    for (std::size_t i = 0; i < 6; ++i) text << (i ? ", " : "") << raster.transform[i];
    text << "</GeoTransform>\n";
  }
  for (int band = 1; band <= raster.bands; ++band) {
    text << "<VRTRasterBand dataType=\"" << raster.type << "\" band=\"" << band << "\" subClass=\"VRTRawRasterBand\">\n"
         << "<SourceFilename relativetoVRT=\"1\">" << name << ".bin</SourceFilename><ImageOffset>0</ImageOffset>"
         << "<PixelOffset>4</PixelOffset><LineOffset>" << 4 * raster.columns << "</LineOffset>"
         << "<ByteOrder>LSB</ByteOrder>\n";
    if (!raster.nodata.empty()) text << "<NoDataValue>" << raster.nodata << "</NoDataValue>\n";
    if (!raster.unit.empty()) text << "<UnitType>" << raster.unit << "</UnitType>\n";
    if (raster.scale != 1) text << "<Scale>" << raster.scale << "</Scale>\n";
    if (raster.offset != 0) text << "<Offset>" << raster.offset << "</Offset>\n";
    if (!raster.colour.empty()) text << "<ColorInterp>" << raster.colour << "</ColorInterp>\n";
    text << "</VRTRasterBand>\n";
  }
  text << "</VRTDataset>\n";
  std::filesystem::path file = folder / (name + ".vrt");
  std::ofstream(file) << text.str();
  return file;
}

}  // namespace vantage::testing
