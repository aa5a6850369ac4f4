// libFuzzer target: any bytes as a raster of heights: GeoTIFF or an ASCII grid, whose reference system lies beside it.
// They may be refused with an input error; a scene of it must be finite, and within the error that it states.
#include <cmath>
#include <string>

#include "fuzz/bytes.h"
#include "fuzz/files.h"
#include "maps/terrain/raster_file.h"
#include "vantage/ground.h"

namespace vantage::fuzzing {
namespace {

constexpr const char* kSystem =
    "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],PRIMEM[\"Greenwich\","
    "0.0],UNIT[\"Degree\",0.0174532925199433]]";

void check(const RasterScene& raster) {
  const RasterReport& report = raster.report;
  require(report.columns * report.rows <= std::size_t{1} << 28, "posts are bounded");
  require(report.voids < report.columns * report.rows, "not all is void");
  require(report.largest_error_m <= 0.25 * (1 + 1e-6), "the error is kept");
  require(report.lowest_m <= report.highest_m && std::abs(report.lowest_m) <= 12000, "heights are of the earth");
  for (const Vec3& vertex : raster.scene.mesh.vertices) require(vertex.allFinite(), "coordinates are finite");
  require(raster.scene.georeference.has_value(), "it has a place");
}

}  // namespace
}  // namespace vantage::fuzzing

// GDAL keeps what it registers until the program ends.
extern "C" const char* __lsan_default_suppressions() { return "leak:libgdal\nleak:libproj\nleak:libgeos\n"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vantage::fuzzing;
  const std::string_view bytes = text_of(data, size);
  const bool is_grid = bytes.starts_with("n") || bytes.starts_with("N");  // "ncols"
  static const auto system = folder().write("grid.prj", kSystem);
  const auto file = folder().write(is_grid ? "grid.asc" : "grid.tif", bytes);
  try {
    // A few bytes may have millions of posts, which take minutes under the sanitizers.
    constexpr std::int64_t kMostPosts = std::int64_t{1} << 14;
    const vantage::internal::terrain::RasterFile raster(file);
    if (std::int64_t{raster.columns()} * raster.rows() > kMostPosts) return 0;
    check(vantage::scene_from_raster(file));
  } catch (const vantage::Error& error) {
    check_refusal(error);
  }
  return 0;
}
