// Compiled where gdal.h is installed: what vantage says of the functions that it loads is what GDAL declares.
#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <gdal_frmts.h>
#include <ogr_srs_api.h>

#include <type_traits>

#include "maps/terrain/gdal_library.h"

namespace vantage::internal::terrain {
namespace {

template <typename T>
constexpr bool is_like_int = false;
template <typename T>
requires std::is_enum_v<T>
constexpr bool is_like_int<T> = sizeof(T) == sizeof(int);

/// Whether a caller may take one type for the other: the same type, or an enumeration of GDAL's for an int.
template <typename Ours, typename Theirs>
constexpr bool agree = std::is_same_v<Ours, Theirs> || (std::is_same_v<Ours, int> && is_like_int<Theirs>);

/// A result may be left alone: GDALClose has one since GDAL 3.7.
template <typename Ours, typename Theirs, typename... OurArguments, typename... TheirArguments>
requires(sizeof...(OurArguments) ==
         sizeof...(TheirArguments)) constexpr bool agree<Ours (*)(OurArguments...), Theirs (*)(TheirArguments...)> =
    (std::is_void_v<Ours> || agree<Ours, Theirs>)&&(agree<OurArguments, TheirArguments> && ...);

#ifdef __GNUC__
#pragma GCC diagnostic ignored "-Wignored-attributes"  // those that GDAL has for warnings
#endif
#define VANTAGE_CHECK(result, name, arguments) \
  static_assert(agree<decltype(GdalLibrary::name), decltype(&::name)>, "GDAL declares " #name " differently");
VANTAGE_GDAL_FUNCTIONS(VANTAGE_CHECK)
#undef VANTAGE_CHECK

static_assert(!agree<void (*)(int), void (*)(double)> && !agree<int (*)(), double (*)()> &&
              !agree<void (*)(int), void (*)(int, int)> && !agree<void (*)(int*), void (*)(void*)>);

using namespace gdal_values;
static_assert(kOpenRaster == GDAL_OF_RASTER && kOpenVerbose == GDAL_OF_VERBOSE_ERROR);
static_assert(kRead == GF_Read && kFailure == CE_Failure && CE_Failure < CE_Fatal);
static_assert(kByte == GDT_Byte && kFloat64 == GDT_Float64);
static_assert(kFirstComplex == GDT_CInt16 && kLastComplex == GDT_CFloat64);
static_assert(kPalette == GCI_PaletteIndex && kRed == GCI_RedBand && kAlpha == GCI_AlphaBand);

}  // namespace
}  // namespace vantage::internal::terrain
