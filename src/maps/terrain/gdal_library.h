// The functions of GDAL's C API that are used, found at run time: nothing is linked. Debian builds GDAL with libraries
// under the GPL (Poppler), and a program that reads no raster need not have it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage::internal::terrain {

// Handles are opaque in the C API; names and types are those of gdal.h, ogr_srs_api.h, cpl_error.h, cpl_vsi.h and
// cpl_string.h, the same from GDAL 3.1 on: tests/gdal_prototypes.cpp. Enumerations are passed as int.
#define VANTAGE_GDAL_FUNCTIONS(X)                                                                           \
  X(void, GDALAllRegister, ())                                                                              \
  X(void*, GDALOpenEx, (const char*, unsigned, const char* const*, const char* const*, const char* const*)) \
  X(void, GDALClose, (void*))                                                                               \
  X(void*, GDALGetDatasetDriver, (void*))                                                                   \
  X(const char*, GDALGetDriverShortName, (void*))                                                           \
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
  X(char**, VSIReadDir, (const char*))                                                                      \
  X(void, VSIFree, (void*))                                                                                 \
  X(void, CSLDestroy, (char**))

struct GdalLibrary {
// NOLINTNEXTLINE(bugprone-macro-parentheses): the arguments are types
#define VANTAGE_MEMBER(result, name, arguments) result(*name) arguments = nullptr;
  VANTAGE_GDAL_FUNCTIONS(VANTAGE_MEMBER)
#undef VANTAGE_MEMBER
};

/// Of flags and enumerations.
namespace gdal_values {
inline constexpr unsigned kOpenRaster = 0x02, kOpenVerbose = 0x40;  // GDAL_OF_RASTER, GDAL_OF_VERBOSE_ERROR
inline constexpr int kRead = 0;                                     // GDALRWFlag
inline constexpr int kByte = 1, kFloat64 = 7;                       // GDALDataType
inline constexpr int kFirstComplex = 8, kLastComplex = 11;          // GDALDataType
inline constexpr int kPalette = 2, kRed = 3, kAlpha = 6;            // GDALColorInterp
inline constexpr int kFailure = 3;  // CPLErr; CE_Fatal, after which GDAL ends the program, is 4
}  // namespace gdal_values

/// The names that are tried: of GDAL 3.6 (Debian 12) first, then of its neighbours.
std::vector<std::string> gdal_library_names();

/// Loads the first of `names` that is there, with its drivers registered. Null when there is none or it lacks a
/// function; `why_not` then says which. Stays loaded until the program ends: GDAL keeps state for threads and for the
/// exit. Takes about 0.1 s the first time.
const GdalLibrary* load_gdal_library(std::string& why_not, const std::vector<std::string>& names);

/// The same with the usual names, once per program. Throws Error(input) for `file`, which is what was to be read.
const GdalLibrary& gdal(const std::filesystem::path& file);

/// While it lives, what GDAL has to say on this thread is kept here and not written to standard error.
class GdalMessages {
 public:
  explicit GdalMessages(const GdalLibrary& library);
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;
  ~GdalMessages();

  /// The first error, in one line of at most 200 characters; empty when there was none.
  const std::string& first_error() const { return first_error_; }

 private:
  static void handle(int severity, int number, const char* message) noexcept;

  const GdalLibrary& library_;
  GdalMessages* outer_;
  std::string first_error_;
};

}  // namespace vantage::internal::terrain
