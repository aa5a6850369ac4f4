// The functions of GDAL's C API that are used, found at run time: nothing is linked. Debian builds GDAL with libraries
// under the GPL (Poppler), and a program that reads no raster need not have it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vantage::internal::terrain {

// Handles are opaque in the C API; names and types are those of gdal.h, ogr_srs_api.h, cpl_error.h, cpl_vsi.h,
// cpl_conv.h, cpl_string.h and gdal_frmts.h, the same from GDAL 3.1 on: tests/gdal_prototypes.cpp. Enumerations are
// passed as int.
#define VANTAGE_GDAL_FUNCTIONS(X)                                                                           \
  X(void, GDALRegister_GTiff, ())                                                                           \
  X(void, GDALRegister_AAIGrid, ())                                                                         \
  X(void, GDALRegister_SRTMHGT, ())                                                                         \
  X(void*, GDALOpenEx, (const char*, unsigned, const char* const*, const char* const*, const char* const*)) \
  X(void, GDALClose, (void*))                                                                               \
  X(void*, GDALGetDatasetDriver, (void*))                                                                   \
  X(const char*, GDALGetDriverShortName, (void*))                                                           \
  X(const char*, GDALGetMetadataItem, (void*, const char*, const char*))                                    \
  X(int, GDALGetRasterCount, (void*))                                                                       \
  X(int, GDALGetRasterXSize, (void*))                                                                       \
  X(int, GDALGetRasterYSize, (void*))                                                                       \
  X(int, GDALGetGeoTransform, (void*, double*))                                                             \
  X(void*, GDALGetSpatialRef, (void*))                                                                      \
  X(void*, GDALGetRasterBand, (void*, int))                                                                 \
  X(int, GDALGetRasterDataType, (void*))                                                                    \
  X(int, GDALGetRasterColorInterpretation, (void*))                                                         \
  X(const char*, GDALGetRasterUnitType, (void*))                                                            \
  X(double, GDALGetRasterScale, (void*, int*))                                                              \
  X(double, GDALGetRasterOffset, (void*, int*))                                                             \
  X(void*, GDALGetMaskBand, (void*))                                                                        \
  X(int, GDALRasterIO, (void*, int, int, int, int, int, void*, int, int, int, int, int))                    \
  X(int, OSRExportToWktEx, (void*, char**, const char* const*))                                             \
  X(void, CPLPushErrorHandlerEx, (void (*)(int, int, const char*), void*))                                  \
  X(void, CPLPopErrorHandler, ())                                                                           \
  X(const char*, CPLGetThreadLocalConfigOption, (const char*, const char*))                                 \
  X(void, CPLSetThreadLocalConfigOption, (const char*, const char*))                                        \
  X(char**, VSIReadDir, (const char*))                                                                      \
  X(char**, CSLLoad2, (const char*, int, int, const char* const*))                                          \
  X(void, VSIFree, (void*))                                                                                 \
  X(void, CSLDestroy, (char**))

struct GdalLibrary {
// NOLINTNEXTLINE(bugprone-macro-parentheses): the arguments are types
#define VANTAGE_MEMBER(result, name, arguments) result(*name) arguments = nullptr;
  VANTAGE_GDAL_FUNCTIONS(VANTAGE_MEMBER)
#undef VANTAGE_MEMBER
};

/// Values of GDAL's flags and enumerations.
namespace gdal_values {
inline constexpr unsigned kOpenRaster = 0x02, kOpenVerbose = 0x40;  // GDAL_OF_RASTER, GDAL_OF_VERBOSE_ERROR
inline constexpr int kRead = 0;                                     // GDALRWFlag
inline constexpr int kByte = 1, kFloat64 = 7;                       // GDALDataType
inline constexpr int kFirstComplex = 8, kLastComplex = 11;          // GDALDataType
inline constexpr int kPalette = 2, kRed = 3, kAlpha = 6;            // GDALColorInterp
inline constexpr int kFailure = 3;  // CPLErr; CE_Fatal, after which GDAL ends the program, is 4
}  // namespace gdal_values

/// The drivers of GDAL that may read a raster, in GDAL's words. Others follow names in a file to other files and into
/// the network (VRT, WMS), or run programs.
inline constexpr const char* kRasterDrivers[] = {"GTiff", "AAIGrid", "SRTMHGT", nullptr};

/// The names that are tried: of GDAL 3.6 (Debian 12) first, then of its neighbours.
std::vector<std::string> gdal_library_names();

/// Loads the first of `names` that is there, with those drivers registered and no others. (A program that uses GDAL
/// itself may have registered all of them.) Null when there is none or it lacks a
/// function; `why_not` then says which. Stays loaded until the program ends: GDAL keeps state for threads and for the
/// exit. Takes some ten milliseconds.
const GdalLibrary* load_gdal_library(std::string& why_not, const std::vector<std::string>& names);

/// The same with the usual names, once per program. Throws Error(input) for `file`, which is what was to be read.
const GdalLibrary& gdal(const std::filesystem::path& file);

/// To be alive wherever GDAL is called. What GDAL has to say on this thread is kept here and not written to standard
/// error. And GDAL keeps to the file that it is given: it looks for none beside it, but for the .prj of an ASCII grid,
/// and fetches nothing from the network. Afterwards the thread's options are as they were.
class GdalCalls {
 public:
  explicit GdalCalls(const GdalLibrary& library);
  GdalCalls(const GdalCalls&) = delete;
  GdalCalls& operator=(const GdalCalls&) = delete;
  ~GdalCalls();

  /// The first error, in one line of at most 200 characters; empty when there was none.
  const std::string& first_error() const { return first_error_; }

 private:
  static void handle(int severity, int number, const char* message) noexcept;

  const GdalLibrary& library_;
  GdalCalls* outer_;
  std::vector<std::optional<std::string>> options_before_;
  std::string first_error_;
};

}  // namespace vantage::internal::terrain
