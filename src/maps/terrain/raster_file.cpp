#include "maps/terrain/raster_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>
#include <vector>

#include "vantage/error.h"

namespace vantage::internal::terrain {
namespace {

namespace fs = std::filesystem;

using namespace gdal_values;

constexpr double kUsualVoids[] = {-9999, -32768};  // what files use for "no value", often without declaring it

std::string in_lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string lower_extension(const fs::path& file) { return in_lower_case(file.extension().string()); }

void check_regular(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) {
    throw Error(ErrorCode::file_not_found, "the raster does not exist", file.string(), "check the path");
  }
  if (!fs::is_regular_file(status)) {
    throw Error(ErrorCode::not_a_file, "the raster is not a regular file", file.string(), "name a file on disk");
  }
}

const GdalLibrary& library_for(const fs::path& file) {
  check_regular(file);  // first: no library is needed to say that there is no file
  return gdal(file);
}

// What a file beside a raster says of its heights or of its place: without it they would be read wrong. GDAL reads
// elements, and names of files, in any case.
constexpr std::string_view kThatCount[] = {"nodatavalue", "offset", "scale", "unittype", "srs", "geotransform"};
constexpr std::size_t kMostMetadata = std::size_t{1} << 20U;

/// `file` may be an archive; `beside`: the file's name is that of the raster with an ending more.
[[noreturn]] void refuse_for_beside(const fs::path& file, const std::string& what, const std::string& beside) {
  const bool is_packed = lower_extension(file) == ".zip";
  const bool is_mask = in_lower_case(beside).ends_with(".msk");
  const std::size_t length = beside.size() - std::string_view(is_mask ? ".msk" : ".aux.xml").size();
  throw Error(ErrorCode::raster_unreadable,
              "the raster has " + what + " in a file of its own, which is not read: " + beside, file.string(),
              (is_packed ? "unpack it, and write that into the raster" : "write it into the raster") +
                  std::string(", as gdal_translate does: gdal_translate ").append(beside, 0, length) +
                  " new.tif --config GDAL_TIFF_INTERNAL_MASK YES");
}

/// Refuses a .aux.xml that says what counts. `name`: how messages call it.
void check_metadata_text(const fs::path& file, const std::string& text, const std::string& name) {
  if (text.size() > kMostMetadata) refuse_for_beside(file, "more than 1 MiB of metadata", name);
  const std::string lower = in_lower_case(text);
  for (const std::string_view element : kThatCount) {
    const std::size_t at = lower.find(std::string("<").append(element));
    if (at != std::string::npos) refuse_for_beside(file, text.substr(at + 1, element.size()), name);
  }
}

/// Whether there is such a file. Refuses what is none: opening a pipe that nobody writes to would wait for ever.
bool is_file_beside(const fs::path& file, const fs::path& beside) {
  std::error_code error;
  const fs::file_status status = fs::status(beside, error);
  if (!fs::exists(status)) return false;
  if (fs::is_regular_file(status)) return true;
  throw Error(ErrorCode::raster_unreadable,
              "what lies beside the raster is not a regular file: " + beside.filename().string(), file.string(),
              "move it away");
}

void check_metadata(const fs::path& file, const fs::path& metadata) {
  if (!is_file_beside(file, metadata)) return;
  std::string text(kMostMetadata + 1, '\0');
  std::ifstream stream(metadata, std::ios::binary);
  if (!stream) {
    throw Error(ErrorCode::raster_unreadable, "the raster's metadata cannot be read: " + metadata.filename().string(),
                file.string(), "change its permissions, or move it away");
  }
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, stream.gcount())));
  check_metadata_text(file, text, metadata.filename().string());
}

/// The same of one in an archive, by GDAL.
void check_metadata_in_archive(const GdalLibrary& library, const fs::path& file, const std::string& archive,
                               const std::string& name) {
  constexpr int kMostLines = 4096, kLongestLine = 1 << 14;
  const GdalCalls calls(library);
  const std::unique_ptr<char*, void (*)(char**)> lines(
      library.CSLLoad2((archive + "/" + name).c_str(), kMostLines, kLongestLine, nullptr), library.CSLDestroy);
  std::string text;
  int count = 0;
  for (char* const* line = lines.get(); line && *line; ++line, ++count) text.append(*line).append("\n");
  if (count == kMostLines || !calls.first_error().empty()) {
    refuse_for_beside(file, "metadata that cannot be looked through", name);
  }
  check_metadata_text(file, text, name);
}

/// Masks, overviews and metadata in files of their own are not read: GDAL opens them by any driver that knows them. It
/// reads the .prj of a grid, which may have any extension.
void check_beside(const fs::path& file) {
  const std::string own = in_lower_case(file.filename().string());
  const std::string system = in_lower_case(file.stem().string()) + ".prj";
  std::error_code error;
  const fs::path folder = fs::absolute(file).parent_path();
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string(), lower = in_lower_case(name);
    if (lower == own + ".msk") refuse_for_beside(file, "its mask", name);
    if (lower == own + ".aux.xml") check_metadata(file, entry->path());
    if (lower == system) is_file_beside(file, entry->path());
  }
  if (!error) return;
  // A folder that may be passed through and not be listed.
  if (fs::exists(file.string() + ".msk", error)) refuse_for_beside(file, "its mask", file.filename().string() + ".msk");
  check_metadata(file, file.string() + ".aux.xml");
  for (const char* const extension : {".prj", ".PRJ"})
    is_file_beside(file, fs::path(file).replace_extension(extension));
}

/// The only file in an archive that may be a raster, by its extension.
std::string raster_in_archive(const GdalLibrary& library, const fs::path& file, const std::string& archive) {
  const std::unique_ptr<char*, void (*)(char**)> names(library.VSIReadDir(archive.c_str()), library.CSLDestroy);
  std::vector<std::string> rasters;
  for (char* const* name = names.get(); name && *name; ++name) {
    const std::string extension = lower_extension(*name);
    if (extension == ".hgt" || extension == ".tif" || extension == ".tiff" || extension == ".asc") {
      rasters.emplace_back(*name);
    }
  }
  if (rasters.size() > 1) {
    throw Error(
        ErrorCode::raster_unreadable,
        "the archive has several rasters: " + rasters[0] + ", " + rasters[1] + (rasters.size() > 2 ? ", ..." : ""),
        file.string(), "unpack it, and give one of them");
  }
  if (rasters.empty()) return archive;
  const std::string own = in_lower_case(rasters[0]);
  for (char* const* name = names.get(); *name; ++name) {
    const std::string lower = in_lower_case(*name);
    if (lower == own + ".msk") refuse_for_beside(file, "its mask", *name);
    if (lower == own + ".aux.xml") check_metadata_in_archive(library, file, archive, *name);
  }
  return archive + "/" + rasters[0];
}

/// GDAL's name of a file: absolute, so that none is taken for something else (a subdataset, a database).
std::string gdal_name(const GdalLibrary& library, const fs::path& file) {
  std::string path = path_on_disk(fs::absolute(file).string());
  const std::string extension = lower_extension(file);
  if (extension == ".zip") return raster_in_archive(library, file, "/vsizip/" + path);
  if (extension == ".gz") return "/vsigzip/" + path;
  return path;
}

}  // namespace

std::string path_on_disk(const std::string& absolute) {
  return absolute.starts_with("/vsi") ? "/." + absolute : absolute;
}

void DatasetCloser::operator()(void* dataset) const {
  const GdalCalls calls(*library);
  library->GDALClose(dataset);
}

RasterFile::RasterFile(const fs::path& file, const std::string& crs)
    : file_(file), library_(library_for(file)), crs_wkt_(crs) {
  const GdalCalls calls(library_);
  open();
  check_bands();
  read_georeference();
  int given = 0;
  const double scale = library_.GDALGetRasterScale(band_, &given);
  if (given && scale != 0) scale_ = scale;
  const double offset = library_.GDALGetRasterOffset(band_, &given);
  if (given) offset_ = offset;
  if (const char* unit = library_.GDALGetRasterUnitType(band_)) unit_ = unit;
  is_srtm_ =
      std::string_view(library_.GDALGetDriverShortName(library_.GDALGetDatasetDriver(dataset_.get()))) == "SRTMHGT";
}

void RasterFile::fail(ErrorCode code, const std::string& problem, const std::string& fix) const {
  throw Error(code, problem, file_.string(), fix);
}

void RasterFile::open() {
  const GdalCalls calls(library_);
  check_beside(file_);
  const std::string name = gdal_name(library_, file_);
  dataset_ = {library_.GDALOpenEx(name.c_str(), kOpenRaster | kOpenVerbose, kRasterDrivers, nullptr, nullptr),
              DatasetCloser{&library_}};
  if (!dataset_) {
    fail(
        ErrorCode::raster_unreadable,
        "not a raster that is read here" + (calls.first_error().empty() ? "" : " (" + calls.first_error() + ")"),
        "give a GeoTIFF, an ASCII grid (.asc) or an SRTM .hgt under its own name (N43E007.hgt); gdal_translate makes a "
        "GeoTIFF of a VRT and of other rasters");
  }
  columns_ = library_.GDALGetRasterXSize(dataset_.get());
  rows_ = library_.GDALGetRasterYSize(dataset_.get());
}

void RasterFile::check_bands() const {
  const int count = library_.GDALGetRasterCount(dataset_.get());
  const auto colour = [&](int band) {
    return library_.GDALGetRasterColorInterpretation(library_.GDALGetRasterBand(dataset_.get(), band));
  };
  if (library_.GDALGetMetadataItem(dataset_.get(), "SUBDATASET_2_NAME", "SUBDATASETS") != nullptr) {
    fail(ErrorCode::raster_not_heights, "the file has several rasters, and the first alone would be read",
         "take one of them out: gdal_translate GTIFF_DIR:1:in.tif out.tif");
  }
  if (count == 0) {
    fail(ErrorCode::raster_not_heights, "the raster has no band",
         "give a file with one band of heights; convert it with gdal_translate");
  }
  if (colour(1) == kPalette || colour(1) == kRed)
    fail(ErrorCode::raster_not_heights, "this is a picture, not heights", "give a raster of heights");
  if (count > 1 && !(count == 2 && colour(2) == kAlpha)) {
    fail(ErrorCode::raster_not_heights, "the raster has " + std::to_string(count) + " bands; heights have one",
         "choose one with gdal_translate -b");
  }
  const int type = library_.GDALGetRasterDataType(library_.GDALGetRasterBand(dataset_.get(), 1));
  if (type >= kFirstComplex && type <= kLastComplex) {
    fail(ErrorCode::raster_not_heights, "the raster's values are complex numbers, not heights",
         "give a raster of heights");
  }
}

void RasterFile::read_georeference() {
  band_ = library_.GDALGetRasterBand(dataset_.get(), 1);
  double transform[6] = {};
  void* const system = library_.GDALGetSpatialRef(dataset_.get());
  const bool placed = library_.GDALGetGeoTransform(dataset_.get(), transform) == 0;
  if (!placed && !system) {
    fail(ErrorCode::not_georeferenced, "the raster does not say where on the earth it lies",
         "give a georeferenced one, or assign its place and its "
         "system with gdal_translate -a_ullr and -a_srs; a world file (.tfw) beside it is not read");
  }
  if (!placed) {
    fail(ErrorCode::not_georeferenced, "the raster does not say where its corner lies",
         "assign it with gdal_translate -a_ullr; without it gdal_translate in.tif out.tif takes the place from a world "
         "file (.tfw) beside the raster, which is not read here");
  }
  if (!system && crs_wkt_.empty()) {
    fail(ErrorCode::crs_missing, "the raster has no coordinate reference system",
         "give it: of a raster that is the scene, or the terrain of a map, as scene.crs, such as 'crs: EPSG:25832' "
         "(--crs); of other terrain with gdal_translate -a_srs EPSG:25832 in out.tif");
  }
  if (transform[2] != 0 || transform[4] != 0) {
    fail(ErrorCode::raster_grid_unsupported, "the raster's rows do not run east (it is rotated or sheared)",
         "straighten it with gdalwarp");
  }
  corner_ = {transform[0], transform[3]};
  pixel_ = {transform[1], transform[5]};
  if (!corner_.allFinite() || !pixel_.allFinite() || pixel_.x() == 0 || pixel_.y() == 0) {
    fail(ErrorCode::raster_grid_unsupported, "the raster's pixels have no size",
         "assign it with gdal_translate -a_ullr");
  }
  if (crs_wkt_.empty()) crs_wkt_ = stated_crs(system);
}

std::string RasterFile::stated_crs(void* system) const {
  char* wkt = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  const bool exported = library_.OSRExportToWktEx(system, &wkt, options) == 0;
  const std::unique_ptr<char, void (*)(void*)> text(wkt, library_.VSIFree);
  if (!exported || !text) {
    fail(ErrorCode::crs_unusable, "the raster's coordinate reference system cannot be read",
         "assign it with gdal_translate -a_srs");
  }
  return text.get();
}

void RasterFile::read_rows(const PixelWindow& pixels, int begin, int end, float* heights) const {
  const GdalCalls calls(library_);
  const std::size_t count = static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(pixels.columns);
  std::vector<double> values(count);
  std::vector<unsigned char> mask(count);
  const auto get = [&](void* band, void* into, int type) {
    return library_.GDALRasterIO(band, kRead, pixels.first_column, pixels.first_row + begin, pixels.columns,
                                 end - begin, into, pixels.columns, end - begin, type, 0, 0) == 0;
  };
  if (!get(band_, values.data(), kFloat64) || !get(library_.GDALGetMaskBand(band_), mask.data(), kByte)) {
    fail(ErrorCode::raster_unreadable,
         "the raster is damaged: it cannot be read to its end" +
             (calls.first_error().empty() ? "" : " (" + calls.first_error() + ")"),
         "fetch it again");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double stored = values[i], height = stored * scale_ + offset_;
    const bool is_void = mask[i] == 0 || !std::isfinite(height) ||
                         std::find(std::begin(kUsualVoids), std::end(kUsualVoids), stored) != std::end(kUsualVoids);
    heights[i] = is_void ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(height);
  }
}

std::vector<float> RasterFile::read(const PixelWindow& pixels, const std::function<void(int)>& done) const {
  const int at_once = std::max(1, (1 << 20) / pixels.columns);
  std::vector<float> heights(static_cast<std::size_t>(pixels.columns) * static_cast<std::size_t>(pixels.rows));
  for (int begin = 0; begin < pixels.rows; begin += at_once) {
    done(begin);
    const int end = std::min(pixels.rows, begin + at_once);
    read_rows(pixels, begin, end,
              heights.data() + static_cast<std::size_t>(begin) * static_cast<std::size_t>(pixels.columns));
  }
  return heights;
}

}  // namespace vantage::internal::terrain
