#include "support/raster_writer.h"

#include <fstream>
#include <sstream>

namespace vantage::testing {

std::filesystem::path write_raster(const std::filesystem::path& folder, const std::string& name,
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
