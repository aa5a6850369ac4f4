#include "maps/terrain/height_grid.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include "core/format.h"
#include "core/progress_reporter.h"
#include "maps/terrain/raster_file.h"
#include "vantage/error.h"

namespace vantage::internal::terrain {
namespace {

constexpr std::int64_t kMaxPosts = static_cast<std::int64_t>(1) << 28;
// A header alone may announce any number of posts, and a scene needs some 50 bytes for each. Heights that are
// compressed well take a byte each.
constexpr std::int64_t kPostsOfAnyFile = static_cast<std::int64_t>(1) << 24, kPostsOfByte = 8;
constexpr int kMarginPosts = 2;
constexpr float kImpossible_m = 12000;  // no place on the earth is so high or deep
constexpr int kSideSamples = 32;        // of an outline, whose image is curved

/// The corners of a rectangle and points along its sides, in one turn.
std::vector<Eigen::Vector2d> outline(const Eigen::Vector2d& min, const Eigen::Vector2d& max) {
  const std::array<Eigen::Vector2d, 4> corners = {min, {max.x(), min.y()}, max, {min.x(), max.y()}};
  std::vector<Eigen::Vector2d> points;
  for (std::size_t side = 0; side < 4; ++side) {
    for (int i = 0; i < kSideSamples; ++i) {
      points.push_back(corners[side] + (corners[(side + 1) % 4] - corners[side]) * i / kSideSamples);
    }
  }
  return points;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void extend(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// "latitude 43 to 44, longitude 7 to 8" of the places that an outline is mapped to.
template <typename ToPosition>
std::string bounds_text(const std::vector<Eigen::Vector2d>& points, const ToPosition& to_position) {
  Range latitude, longitude;
  for (const Eigen::Vector2d& point : points) {
    try {
      const geo::LonLat position = to_position(point);
      latitude.extend(position.latitude_deg);
      // Not torn apart by the antimeridian.
      const double near = longitude.low > longitude.high ? position.longitude_deg : longitude.low;
      longitude.extend(near + std::remainder(position.longitude_deg - near, 360));
    } catch (const Error&) {  // a corner beyond the projection: the others tell enough
    }
  }
  return core::format("latitude {:.7g} to {:.7g}, longitude {:.7g} to {:.7g}", latitude.low, latitude.high,
                      longitude.low, longitude.high);
}

/// Whether the raster holds the window's origin with latitude and longitude the other way round.
bool is_swapped(const HeightGrid& grid, const Window& window) {
  try {
    const Eigen::Vector2d at = grid.column_row({window.origin.latitude_deg, window.origin.longitude_deg});
    return at.minCoeff() >= 0 && at.x() <= grid.columns && at.y() <= grid.rows;
  } catch (const Error&) {
    return false;
  }
}

[[noreturn]] void fail_uncovered(const HeightGrid& grid, const Window& window) {
  const geo::LocalFrame frame(window.origin);
  const auto edges = outline({-0.5, -0.5}, {grid.columns - 0.5, grid.rows - 0.5});
  throw Error(
      ErrorCode::region_outside,
      "the raster does not cover the area: it has " +
          bounds_text(edges, [&](const Eigen::Vector2d& p) { return grid.position(p); }) + ", the area " +
          bounds_text(outline(window.min, window.max), [&](const Eigen::Vector2d& p) { return frame.to_lonlat(p); }),
      grid.file.string(),
      is_swapped(grid, window)
          ? "latitude and longitude are the wrong way round: give the latitude first"
          : "make the area smaller, or give a raster that covers it (an SRTM tile is named after its south-west "
            "corner; gdalwarp joins several)");
}

/// Columns of a full turn, where the raster goes round the earth: its first column follows its last one.
std::optional<double> full_turn(const HeightGrid& grid) {
  if (!grid.crs.is_geographic()) return std::nullopt;
  const double turn = 360 / std::abs(grid.step.x());
  return std::abs(turn - grid.columns) < 0.5 ? std::optional(turn) : std::nullopt;
}

/// Where a window's outline lies in the raster, in columns and rows; nothing where that cannot be told. Of a raster
/// that goes round the earth, columns may lie beyond its ends. Round a pole the window holds all of them.
std::pair<Range, Range> columns_and_rows(const HeightGrid& grid, const Window& window) {
  const geo::LocalFrame frame(window.origin);
  const std::optional<double> turn = full_turn(grid);
  const double middle = turn ? grid.column_row(window.origin).x() : 0;
  std::pair<Range, Range> result;
  for (const Eigen::Vector2d& point : outline(window.min, window.max)) {
    const Eigen::Vector2d at = grid.column_row(frame.to_lonlat(point));
    result.first.extend(turn ? middle + std::remainder(at.x() - middle, *turn) : at.x());
    result.second.extend(at.y());
  }
  for (const double pole : {-90.0, 90.0}) {
    const Eigen::Vector2d place = frame.to_local({window.origin.longitude_deg, pole});
    const bool is_inside = (place.array() >= window.min.array() && place.array() <= window.max.array()).all();
    if (!grid.crs.is_geographic() || !is_inside) continue;
    result.first.extend(-0.5);
    result.first.extend((turn ? grid.columns : 360 / std::abs(grid.step.x())) - 0.5);
    result.second.extend(grid.column_row({window.origin.longitude_deg, pole}).y());
  }
  return result;
}

PixelWindow pixels_of(const HeightGrid& grid, const Window& window) {
  if (!window.min.allFinite() || !window.max.allFinite() || !(window.min.array() < window.max.array()).all()) {
    throw Error(ErrorCode::region_invalid, "the area has no extent", grid.file.string(),
                "give it a width and a length");
  }
  std::pair<Range, Range> ranges;
  try {
    ranges = columns_and_rows(grid, window);
  } catch (const Error&) {  // the projection does not reach there
    fail_uncovered(grid, window);
  }
  const auto [columns, rows] = ranges;
  const bool goes_round = full_turn(grid).has_value();
  constexpr double kHalfPixel = 0.5 + 1e-6;  // and rounding
  const bool has_columns = columns.low >= -kHalfPixel && columns.high <= grid.columns - 1 + kHalfPixel;
  if ((!has_columns && !goes_round) || rows.low < -kHalfPixel || rows.high > grid.rows - 1 + kHalfPixel) {
    fail_uncovered(grid, window);
  }
  const auto begin = [](double low) { return static_cast<int>(std::floor(low)) - kMarginPosts; };
  const auto end = [](double high) { return static_cast<int>(std::ceil(high)) + kMarginPosts + 1; };
  PixelWindow pixels{begin(columns.low), std::max(0, begin(rows.low)), 0, 0};
  int last = end(columns.high);
  if (!goes_round || last - pixels.first_column >= grid.columns) {
    pixels.first_column = std::max(0, goes_round ? 0 : pixels.first_column);
    last = goes_round ? grid.columns : std::min(grid.columns, last);
  }
  pixels.columns = last - pixels.first_column;
  pixels.rows = std::min(grid.rows, end(rows.high)) - pixels.first_row;
  return pixels;
}

/// Reads from a raster that goes round the earth: columns beyond its ends are those at its other end.
std::vector<float> read_round(const RasterFile& raster, const PixelWindow& pixels,
                              const std::function<void(int)>& done) {
  const int all = raster.columns(), first = ((pixels.first_column % all) + all) % all;
  if (first + pixels.columns <= all) {
    return raster.read({first, pixels.first_row, pixels.columns, pixels.rows}, done);
  }
  const int left = all - first, right = pixels.columns - left;
  const std::vector<float> west = raster.read({first, pixels.first_row, left, pixels.rows}, done);
  const std::vector<float> east = raster.read({0, pixels.first_row, right, pixels.rows}, done);
  std::vector<float> heights;
  heights.reserve(west.size() + east.size());
  for (int row = 0; row < pixels.rows; ++row) {
    heights.insert(heights.end(), west.begin() + std::ptrdiff_t{row} * left,
                   west.begin() + std::ptrdiff_t{row + 1} * left);
    heights.insert(heights.end(), east.begin() + std::ptrdiff_t{row} * right,
                   east.begin() + std::ptrdiff_t{row + 1} * right);
  }
  return heights;
}

constexpr double metres_in(HeightUnit unit) {
  return unit == HeightUnit::metre ? 1 : unit == HeightUnit::foot ? 0.3048 : 1200.0 / 3937;
}

/// The unit of the heights as the file names it; nothing where it does not.
std::optional<HeightUnit> stated_unit(const RasterFile& raster, const std::filesystem::path& file) {
  std::string unit = raster.unit();
  if (unit.empty()) return std::nullopt;
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* metre : {"m", "metre", "metres", "meter", "meters"}) {
    if (unit == metre) return HeightUnit::metre;
  }
  for (const char* foot : {"ft", "foot", "feet", "international foot", "foot (international)", "foot_international"}) {
    if (unit == foot) return HeightUnit::foot;
  }
  for (const char* foot : {"us survey foot", "us survey feet", "us-ft", "ftus", "us_ft", "foot_us", "us-foot"}) {
    if (unit == foot) return HeightUnit::us_survey_foot;
  }
  throw Error(ErrorCode::raster_not_heights, "the raster's unit of height is '" + raster.unit().substr(0, 40) + "'",
              file.string(), "convert the heights to metres with gdal_calc.py");
}

/// Metres in the unit of the heights, negative where they are depths.
double unit_m(const RasterFile& raster, const geo::CoordinateSystem& crs, const std::filesystem::path& file,
              const std::optional<HeightUnit>& given) {
  const std::optional<double> of_axis = crs.vertical_unit_m();
  const std::optional<HeightUnit> unit = given ? given : stated_unit(raster, file);
  if (unit) return metres_in(*unit) * (of_axis.value_or(1) < 0 ? -1 : 1);
  if (!of_axis && crs.units().horizontal_m != 1) {
    throw Error(ErrorCode::height_unknown,
                "the raster does not say in which unit its heights are, and its eastings are not in metres (" +
                    crs.name() + ")",
                file.string(), "say it: scene.z_unit (--z-unit) is us-ft (US survey feet), ft (feet) or m (metres)");
  }
  return of_axis.value_or(1);
}

/// From one column, and from one row, to the next, in the middle.
std::array<double, 2> post_spacing_m(const HeightGrid& grid) {
  const Eigen::Vector2d middle((grid.columns - 1) / 2.0, (grid.rows - 1) / 2.0);
  const geo::LonLat place = grid.position(middle);
  const geo::LocalFrame frame({std::remainder(place.longitude_deg, 360), place.latitude_deg});
  const auto step_m = [&](const Eigen::Vector2d& step) {
    return (frame.to_local(grid.position(middle + step / 2)) - frame.to_local(grid.position(middle - step / 2))).norm();
  };
  return {step_m({1, 0}), step_m({0, 1})};
}

void fill(HeightGrid& grid, const HeightReading& reading, const core::ProgressReporter& progress) {
  const auto is_void = [](float height) { return std::isnan(height); };
  if (std::none_of(grid.heights_m.begin(), grid.heights_m.end(), is_void)) return;
  if (std::all_of(grid.heights_m.begin(), grid.heights_m.end(), is_void)) {
    throw Error(ErrorCode::region_empty, "the raster has no value in the area: all of its posts are void",
                grid.file.string(), "give a raster that has heights there");
  }
  Voids voids = fill_voids(grid.heights_m, grid.columns, grid.rows,
                           {reading.missing, reading.heights.void_m, post_spacing_m(grid)}, progress);
  grid.voids = voids.posts;
  grid.void_regions = std::move(voids.regions);
  grid.lowest_m = std::move(voids.lowest_m);
}

std::string vertical_text(const RasterFile& raster, const geo::CoordinateSystem& crs,
                          const std::filesystem::path& file) {
  if (!crs.vertical_name().empty()) return crs.vertical_name();
  return raster.is_srtm() ? "EGM96 geoid" : "as in " + file.filename().string();
}

/// All but the heights, of the whole raster.
HeightGrid describe(const RasterFile& raster, const std::filesystem::path& file) {
  geo::CoordinateSystem crs(raster.crs_wkt(), file.string());
  std::string vertical = vertical_text(raster, crs, file);
  return {file,
          std::move(crs),
          raster.corner() + raster.pixel() / 2,
          raster.pixel(),
          raster.columns(),
          raster.rows(),
          {},
          0,
          std::move(vertical),
          {},
          {}};
}

void check_posts(std::int64_t posts, const std::filesystem::path& file) {
  if (posts > kMaxPosts) {
    throw Error(ErrorCode::raster_too_large,
                "the area has " + std::to_string(posts) + " posts of the raster; at most " + std::to_string(kMaxPosts) +
                    " can be read",
                file.string(), "make the area smaller, or the raster coarser with gdalwarp -tr");
  }
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (!error && posts > kPostsOfAnyFile + kPostsOfByte * static_cast<std::int64_t>(bytes)) {
    throw Error(ErrorCode::raster_too_large,
                "the area has " + std::to_string(posts) + " posts, and the file " + std::to_string(bytes) +
                    " bytes: it has no heights for most of them",
                file.string(),
                "make the area smaller; or, if the raster is right, write it without compression: gdal_translate -co "
                "COMPRESS=NONE");
  }
}

HeightGrid read_pixels(const RasterFile& raster, HeightGrid grid, const PixelWindow& pixels, const Progress& callback,
                       const HeightReading& reading) {
  check_posts(static_cast<std::int64_t>(pixels.columns) * pixels.rows, grid.file);
  // Where posts lie on each other, or between those of other rows, a surface of them takes quadratic time to refuse.
  if (grid.crs.is_geographic() && !(std::abs(grid.step.x()) * (pixels.columns - 1) < 360)) {
    throw Error(ErrorCode::raster_grid_unsupported,
                "the posts of the raster do not lie side by side: it goes round the earth", grid.file.string(),
                "give a smaller region, with --center and --radius, or check the size of its pixels");
  }
  if (!(std::abs(reading.heights.void_m.value_or(0)) <= kImpossible_m)) {
    throw Error(ErrorCode::value_out_of_range, "the height of voids is beyond 12 km", grid.file.string(),
                "give it in metres");
  }
  const double unit = unit_m(raster, grid.crs, grid.file, reading.heights.unit);
  core::ProgressReporter progress(callback, grid.file);
  progress.begin("reading heights");
  grid.heights_m = read_round(raster, pixels, [&](int rows) {
    progress.report(static_cast<std::uint64_t>(rows), static_cast<std::uint64_t>(pixels.rows));
  });
  for (float& height : grid.heights_m) {
    height = static_cast<float>(height * unit);
    if (std::abs(height) > kImpossible_m) height = std::numeric_limits<float>::quiet_NaN();
  }
  grid.first += grid.step.cwiseProduct(Eigen::Vector2d(pixels.first_column, pixels.first_row));
  grid.columns = pixels.columns;
  grid.rows = pixels.rows;
  fill(grid, reading, progress);
  return grid;
}

}  // namespace

double HeightGrid::height_m(const Eigen::Vector2d& column_row) const {
  const double x = std::clamp(column_row.x(), 0.0, columns - 1.0), y = std::clamp(column_row.y(), 0.0, rows - 1.0);
  const int left = std::min(static_cast<int>(x), std::max(0, columns - 2)), right = std::min(left + 1, columns - 1);
  const int upper = std::min(static_cast<int>(y), std::max(0, rows - 2)), lower = std::min(upper + 1, rows - 1);
  const double across = x - left, down = y - upper;
  return (1 - down) * ((1 - across) * at(left, upper) + across * at(right, upper)) +
         down * ((1 - across) * at(left, lower) + across * at(right, lower));
}

Eigen::Vector2d HeightGrid::column_row(geo::LonLat position) const {
  Eigen::Vector2d place = crs.from_lonlat(position);
  if (crs.is_geographic()) {  // some rasters run from 0 to 360 degrees, or across the antimeridian
    const double middle = first.x() + step.x() * (columns - 1) / 2;
    place.x() = middle + std::remainder(place.x() - middle, 360);
  }
  return (place - first).cwiseQuotient(step);
}

geo::LonLat HeightGrid::position(const Eigen::Vector2d& column_row) const {
  return crs.to_lonlat(first + step.cwiseProduct(column_row));
}

HeightGrid read_height_grid(const std::filesystem::path& file, const std::optional<Window>& window,
                            const Progress& progress, const HeightReading& reading) {
  const RasterFile raster(file, reading.crs);
  HeightGrid grid = describe(raster, file);
  const PixelWindow pixels = window ? pixels_of(grid, *window) : PixelWindow{0, 0, grid.columns, grid.rows};
  return read_pixels(raster, std::move(grid), pixels, progress, reading);
}

HeightGrid read_height_pixels(const std::filesystem::path& file, const PixelWindow& pixels, const Progress& progress,
                              const HeightReading& reading) {
  const RasterFile raster(file, reading.crs);
  HeightGrid grid = describe(raster, file);
  const auto fits = [](int first, int count, int all) { return first >= 0 && count > 0 && count <= all - first; };
  if (!fits(pixels.first_column, pixels.columns, grid.columns) || !fits(pixels.first_row, pixels.rows, grid.rows)) {
    throw Error(ErrorCode::region_outside,
                "the window of pixels is empty or sticks out of the raster, which has " + std::to_string(grid.columns) +
                    " columns and " + std::to_string(grid.rows) + " rows",
                file.string(), "give the first column and row, counted from 0, and how many of each");
  }
  return read_pixels(raster, std::move(grid), pixels, progress, reading);
}

}  // namespace vantage::internal::terrain
