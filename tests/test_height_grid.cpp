// Rasters of heights: what is read, and what is refused. Real ones are compared with a reading of our own.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "maps/terrain/gdal_library.h"
#include "maps/terrain/height_grid.h"
#include "maps/terrain/triangulate.h"
#include "support/random.h"
#include "support/raster_writer.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"

namespace vantage::internal::terrain {
namespace {

using testing::make_raster;
using testing::TestRaster;
using testing::write_raster;

const float kNan = std::numeric_limits<float>::quiet_NaN();

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The code of the error of reading; its place is the file.
std::optional<ErrorCode> refusal(const std::filesystem::path& file, const std::optional<Window>& window = {}) {
  ::testing::internal::CaptureStderr();
  const std::optional<ErrorCode> code = testing::code_of([&] {
    try {
      read_height_grid(file, window);
    } catch (const Error& error) {
      EXPECT_TRUE(contains(error.where(), file.filename().string())) << error.what();
      throw;
    }
  });
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");  // GDAL's words are in the error, not on the terminal
  return code;
}

float plane(int column, int row) { return static_cast<float>(100 + 2 * column - 3 * row); }

TEST(HeightGrid, ReadsPostsAtTheCentresOfPixels) {
  const testing::TemporaryDirectory folder;
  const HeightGrid grid = read_height_grid(write_raster(folder.path(), "dem", make_raster(7, 5, plane)));
  EXPECT_EQ(grid.columns, 7);
  EXPECT_EQ(grid.rows, 5);
  EXPECT_EQ(grid.first, Eigen::Vector2d(500005, 4999995));
  EXPECT_EQ(grid.step, Eigen::Vector2d(10, -10));
  EXPECT_EQ(grid.voids, 0u);
  testing::expect_wording(grid.vertical);
  EXPECT_TRUE(contains(grid.crs.name(), "EPSG:32632")) << grid.crs.name();
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 7; ++column) EXPECT_EQ(grid.at(column, row), plane(column, row));
  }
  EXPECT_DOUBLE_EQ(grid.height_m({2.5, 1.25}), 100 + 2 * 2.5 - 3 * 1.25);
  EXPECT_EQ(grid.height_m({-3, 1}), plane(0, 1));  // no further than the posts
  EXPECT_EQ(grid.height_m({99, 99}), plane(6, 4));
  const Eigen::Vector2d there_and_back = grid.column_row(grid.position({3.25, 1.5}));
  EXPECT_NEAR(there_and_back.x(), 3.25, 1e-6);
  EXPECT_NEAR(there_and_back.y(), 1.5, 1e-6);
}

TEST(HeightGrid, ReadsAsciiGrids) {
  const testing::TemporaryDirectory folder;
  std::ofstream(folder / "dem.asc") << "ncols 3\nnrows 2\nxllcorner 7\nyllcorner 43\ncellsize 0.5\nNODATA_value -1\n"
                                    << "1 2.5 -1\n4 5 6\n";
  EXPECT_EQ(refusal(folder / "dem.asc"), ErrorCode::crs_missing);
  std::ofstream(folder / "dem.prj") << R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,)"
                                    << R"(298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])";
  const HeightGrid grid = read_height_grid(folder / "dem.asc");
  EXPECT_TRUE(grid.crs.is_geographic());
  EXPECT_EQ(grid.first, Eigen::Vector2d(7.25, 43.75));
  EXPECT_EQ(grid.at(1, 0), 2.5f);
  EXPECT_EQ(grid.at(0, 1), 4);
  EXPECT_EQ(grid.voids, 1u);
}

TEST(HeightGrid, ReadsOnlyTheWindowAndTwoPostsRoundIt) {
  const testing::TemporaryDirectory folder;
  const auto file = write_raster(folder.path(), "dem", make_raster(200, 150, plane));
  const HeightGrid all = read_height_grid(file);
  const geo::LonLat origin = all.position({100, 75});
  const HeightGrid part = read_height_grid(file, Window{origin, {-103, -52}, {97, 48}});
  // 20 posts and 10 from edge to edge; the meridian of the origin is not quite the grid's, hence one more at most.
  EXPECT_GE(part.columns, 20 + 1 + 4);
  EXPECT_LE(part.columns, 20 + 3 + 4);
  EXPECT_GE(part.rows, 10 + 1 + 4);
  EXPECT_LE(part.rows, 10 + 3 + 4);
  const Eigen::Vector2d shift = (part.first - all.first).cwiseQuotient(all.step);
  EXPECT_EQ(shift, Eigen::Vector2d(std::round(shift.x()), std::round(shift.y())));
  for (int row = 0; row < part.rows; ++row) {
    for (int column = 0; column < part.columns; ++column) {
      EXPECT_EQ(part.at(column, row), all.at(column + static_cast<int>(shift.x()), row + static_cast<int>(shift.y())));
    }
  }
  // Its border may cut pixels in half, no more.
  EXPECT_EQ(read_height_grid(file, Window{origin, {-1000, -745}, {990, 750}}).columns, 200);
  for (const auto& [min, max] : std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>{{{-1020, -700}, {900, 700}},
                                                                                         {{-900, -760}, {900, 700}},
                                                                                         {{-900, -700}, {1010, 700}},
                                                                                         {{-900, -700}, {900, 770}}}) {
    EXPECT_EQ(refusal(file, Window{origin, min, max}), ErrorCode::region_outside);
  }
}

TEST(HeightGrid, ReadsLargeRastersInParts) {
  const testing::TemporaryDirectory folder;
  const auto height = [](int column, int row) { return 1 + (7 * column + 13 * row) % 1000; };
  const HeightGrid grid = read_height_grid(write_raster(folder.path(), "large", make_raster(1100, 2050, height)));
  std::size_t differ = 0;
  for (int row = 0; row < 2050; ++row) {
    for (int column = 0; column < 1100; ++column) {
      if (grid.at(column, row) != static_cast<float>(height(column, row))) ++differ;
    }
  }
  EXPECT_EQ(differ, 0u);
}

TEST(HeightGrid, ReadsAWindowOfPixels) {
  const testing::TemporaryDirectory folder;
  const auto file = write_raster(folder.path(), "dem", make_raster(20, 15, plane));
  const HeightGrid part = read_height_pixels(file, {3, 4, 5, 6});
  EXPECT_EQ(part.columns, 5);
  EXPECT_EQ(part.rows, 6);
  EXPECT_EQ(part.first, Eigen::Vector2d(500035, 4999955));
  EXPECT_EQ(part.at(0, 0), plane(3, 4));
  EXPECT_EQ(part.at(4, 5), plane(7, 9));
  for (const PixelWindow bad : {PixelWindow{16, 0, 5, 5}, PixelWindow{0, 11, 5, 5}, PixelWindow{-1, 0, 5, 5},
                                PixelWindow{0, 0, 0, 5}, PixelWindow{0, 0, 2147483647, 5}}) {
    EXPECT_THROW(read_height_pixels(file, bad), Error);
  }
}

TEST(HeightGrid, FillsVoids) {
  const testing::TemporaryDirectory folder;
  for (const float value : {-9999.0f, kNan, -32768.0f, -3.402823e38f, std::numeric_limits<float>::infinity()}) {
    TestRaster raster = make_raster(9, 9, [](int, int) { return 7; });
    raster.values[0] = raster.values[40] = raster.values[41] = value;
    EXPECT_EQ(read_height_grid(write_raster(folder.path(), "bare", raster)).voids, 3u) << value;  // not declared
  }
  for (const char* declared : {"42", "nan", "-3.40282306073709653e+38"}) {
    TestRaster raster = make_raster(9, 9, [](int column, int) { return column == 4 ? 10 : 20; });
    const float value = std::strtof(declared, nullptr);
    for (int row = 2; row < 7; ++row) raster.at(4, row) = value;
    raster.nodata = declared;
    const HeightGrid grid =
        read_height_grid(write_raster(folder.path(), "declared", raster), {}, {}, {.missing = MissingPolicy::warn});
    EXPECT_EQ(grid.voids, 5u) << declared;
    // Of the middle one's neighbours two, along the column, are 10 at a distance of 3; two along the row 20 at 1, and
    // four along the diagonals 20 at the root of 2.
    const double weights = 2.0 / 3 + 2 + 4 / std::sqrt(2.0);
    EXPECT_NEAR(grid.at(4, 4), (10 * 2.0 / 3 + 20 * 2 + 20 * 4 / std::sqrt(2.0)) / weights, 1e-5);
  }
}

TEST(HeightGrid, FillsVoidsFarFromAnyValue) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = make_raster(40, 30, [](int, int) { return kNan; });
  raster.at(5, 3) = 12.5f;
  const HeightGrid grid = read_height_grid(write_raster(folder.path(), "lonely", raster));
  EXPECT_EQ(grid.voids, 1199u);
  for (const float height : grid.heights_m) EXPECT_EQ(height, 12.5f);
}

/// The mean over eight directions as its definition says, one void after the other.
double filled_slowly(TestRaster& raster, int column, int row) {
  double sum = 0, weights = 0;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      if (dx == 0 && dy == 0) continue;
      for (int i = 1;; ++i) {
        const int x = column + i * dx, y = row + i * dy;
        if (x < 0 || y < 0 || x >= raster.columns || y >= raster.rows) break;
        const float value = raster.at(x, y);
        if (std::isnan(value)) continue;
        const double distance = i * std::hypot(dx, dy);
        sum += static_cast<double>(value) / distance;
        weights += 1 / distance;
        break;
      }
    }
  }
  return sum / weights;
}

TEST(HeightGrid, FillsVoidsAsTheDefinitionSays) {
  const testing::TemporaryDirectory folder;
  testing::Random random(5);
  for (int run = 0; run < 20; ++run) {
    const int columns = random.integer(1, 30), rows = random.integer(1, 30);
    TestRaster raster =
        make_raster(columns, rows, [&](int, int) { return random.chance(0.4) ? kNan : random.uniform(0, 100); });
    raster.values[0] = 1;
    const HeightGrid grid =
        read_height_grid(write_raster(folder.path(), "random", raster), {}, {}, {.missing = MissingPolicy::warn});
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const float value = raster.at(column, row);
        const double expected = std::isnan(value) ? filled_slowly(raster, column, row) : value;
        if (std::isnan(expected)) continue;  // no value in any direction: filled in another round
        ASSERT_NEAR(grid.at(column, row), expected, 1e-3) << column << " " << row;
      }
    }
  }
}

TEST(HeightGrid, ConvertsUnitsScalesAndOffsets) {
  const testing::TemporaryDirectory folder;
  const auto first_height = [&](const std::function<void(TestRaster&)>& change) {
    TestRaster raster = make_raster(3, 3, [](int, int) { return 29000; });
    change(raster);
    return read_height_grid(write_raster(folder.path(), "unit", raster)).at(0, 0);
  };
  EXPECT_FLOAT_EQ(first_height([](TestRaster& r) { r.unit = "ft"; }), 8839.2f);
  EXPECT_FLOAT_EQ(first_height([](TestRaster& r) { r.unit = "US survey foot"; }), 29000.0f * 1200 / 3937);
  EXPECT_FLOAT_EQ(first_height([](TestRaster& r) {
                    r.scale = 0.1;
                    r.unit = "metre";
                  }),
                  2900);
  EXPECT_FLOAT_EQ(first_height([](TestRaster& r) {
                    r.scale = 0.1;
                    r.offset = -100;
                  }),
                  2800);
  EXPECT_FLOAT_EQ(first_height([](TestRaster& r) { r.srs = "EPSG:6318+6360", r.transform = {-74, 1, 0, 41, 0, -1}; }),
                  29000.0f * 1200 / 3937);  // the heights of the compound system are in feet
  TestRaster raster = make_raster(3, 3, plane);
  raster.unit = "degrees Celsius";
  EXPECT_EQ(refusal(write_raster(folder.path(), "warm", raster)), ErrorCode::raster_not_heights);
}

TEST(HeightGrid, NamesWhatHeightsAreMeasuredFrom) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = make_raster(3, 3, plane);
  raster.srs = "EPSG:7415";
  raster.transform = {85000, 0.5, 0, 447000, 0, -0.5};
  const HeightGrid grid = read_height_grid(write_raster(folder.path(), "nap", raster));
  EXPECT_EQ(grid.vertical, "NAP height");
  EXPECT_TRUE(contains(grid.crs.name(), "Amersfoort / RD New")) << grid.crs.name();
}

TEST(HeightGrid, TakesRowsThatRunNorthAndLongitudesBeyond180) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = make_raster(40, 30, plane);
  raster.srs = "EPSG:4326";
  raster.transform = {285, 0.1, 0, 39, 0, 0.1};  // 75 to 71 degrees west, 39 to 42 north
  const auto file = write_raster(folder.path(), "north", raster);
  const HeightGrid all = read_height_grid(file);
  const Eigen::Vector2d at = all.column_row({-73.95, 40.05});
  EXPECT_NEAR(at.x(), 10, 1e-9);
  EXPECT_NEAR(at.y(), 10, 1e-9);
  const HeightGrid part = read_height_grid(file, Window{{-73.95, 40.05}, {-20000, -20000}, {20000, 20000}});
  EXPECT_LT(part.columns, 15);
  EXPECT_NEAR(part.height_m(part.column_row({-73.95, 40.05})), plane(10, 10), 1e-4);
}

/// All round the earth in columns of half a degree; the height is that of a plane over the frame about `origin`.
TestRaster round_the_earth(const geo::LonLat& origin, double north_deg, int rows) {
  const geo::LocalFrame frame(origin);
  TestRaster raster = make_raster(720, rows, [&](int column, int row) {
    const Eigen::Vector2d at = frame.to_local({-180 + (column + 0.5) * 0.5, north_deg - (row + 0.5) * 0.5});
    return at.norm() < 3e6 ? 300 + 1e-3 * at.x() - 5e-4 * at.y() : 0;
  });
  raster.srs = "EPSG:4326";
  raster.transform = {-180, 0.5, 0, north_deg, 0, -0.5};
  return raster;
}

TEST(HeightGrid, ARasterRoundTheEarthHasNoEndAtTheAntimeridian) {
  const testing::TemporaryDirectory folder;
  for (const double longitude : {180.0, -179.9, 179.9, -180.0}) {
    const geo::LonLat origin{longitude, 5};
    const auto file = write_raster(folder.path(), "world", round_the_earth(origin, 10, 20));
    const HeightGrid grid = read_height_grid(file, Window{origin, {-150e3, -100e3}, {150e3, 100e3}});
    EXPECT_LT(grid.columns, 14);
    for (const double east : {-140e3, -30e3, 0.0, 20e3, 140e3}) {
      const Eigen::Vector2d at = grid.column_row(geo::LocalFrame(origin).to_lonlat({east, 10e3}));
      EXPECT_NEAR(grid.height_m(at), 300 + 1e-3 * east - 5, 0.5) << longitude << " " << east;
    }
  }
}

TEST(HeightGrid, AWindowRoundAPoleHoldsAllLongitudes) {
  const testing::TemporaryDirectory folder;
  for (const bool south : {false, true}) {
    const geo::LonLat origin{30, south ? -89.0 : 89.5};
    const auto file = write_raster(folder.path(), "pole", round_the_earth(origin, south ? -80 : 90, 20));
    const Eigen::Vector2d half(300e3, 300e3);
    const HeightGrid grid = read_height_grid(file, Window{origin, -half, half});
    EXPECT_EQ(grid.columns, 720);
    const geo::LocalFrame frame(origin);
    const Triangulation ground = triangulate(grid, frame, -half, half, 0.1);
    testing::Random random(73);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d at(random.uniform(-290e3, 290e3), random.uniform(-290e3, 290e3));
      EXPECT_NEAR(ground.surface.height(at).value(), 300 + 1e-3 * at.x() - 5e-4 * at.y(), 6) << at.transpose();
    }
    TestRaster part = round_the_earth(origin, south ? -80 : 90, 20);
    part.transform[0] = -100;  // no longer all round
    part.transform[1] = 0.4;
    EXPECT_EQ(refusal(write_raster(folder.path(), "part", part), Window{origin, -half, half}),
              ErrorCode::region_outside);
  }
}

TEST(HeightGrid, RefusesWhatIsNoRasterOfHeights) {
  const testing::TemporaryDirectory folder;
  EXPECT_EQ(refusal(folder / "absent.tif"), ErrorCode::file_not_found);
  EXPECT_EQ(refusal(folder.path()), ErrorCode::not_a_file);
  const auto expect_unreadable = [&](const std::string& name) {  // with GDAL's words
    testing::expect_code([&] { read_height_grid(folder / name, {}); }, ErrorCode::raster_unreadable, name);
  };
  std::ofstream(folder / "text.tif") << "not a raster\n";
  expect_unreadable("text.tif");
  std::ofstream(folder / "empty.hgt") << "";
  expect_unreadable("empty.hgt");
  std::ofstream(folder / "not.zip") << "PK";
  expect_unreadable("not.zip");

  const auto refused = [&](const std::function<void(TestRaster&)>& change) {
    TestRaster raster = make_raster(4, 3, plane);
    change(raster);
    return refusal(write_raster(folder.path(), "bad", raster));
  };
  EXPECT_EQ(refused([](TestRaster&) {}), std::nullopt);
  EXPECT_EQ(refused([](TestRaster& r) { r.srs.clear(); }), ErrorCode::crs_missing);
  EXPECT_EQ(refused([](TestRaster& r) { r.placed = false; }), ErrorCode::not_georeferenced);
  EXPECT_EQ(refused([](TestRaster& r) {
              r.placed = false;
              r.srs.clear();
            }),
            ErrorCode::not_georeferenced);
  EXPECT_EQ(refused([](TestRaster& r) { r.transform[2] = 1; }), ErrorCode::raster_grid_unsupported);
  // Of an ASCII grid: a GeoTIFF cannot say so.
  std::ofstream(folder / "flat.prj") << "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257]],"
                                        "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]";
  std::ofstream(folder / "flat.asc") << "ncols 3\nnrows 2\nxllcorner 7\nyllcorner 43\ncellsize 0\n1 2 3\n4 5 6\n";
  EXPECT_EQ(refusal(folder / "flat.asc"), ErrorCode::raster_grid_unsupported);
  EXPECT_EQ(refused([](TestRaster& r) { r.bands = 3; }), ErrorCode::raster_not_heights);
  EXPECT_EQ(refused([](TestRaster& r) {
              r.bands = 3;
              r.colour = "Red";
            }),
            ErrorCode::raster_not_heights);
  EXPECT_EQ(refused([](TestRaster& r) { r.type = "CInt16"; }), ErrorCode::raster_not_heights);
  EXPECT_EQ(refused([](TestRaster& r) { std::fill(r.values.begin(), r.values.end(), kNan); }), ErrorCode::region_empty);
  EXPECT_EQ(refused([](TestRaster& r) { r.srs = "LOCAL_CS[&quot;mine&quot;,UNIT[&quot;m&quot;,1]]"; }),
            ErrorCode::crs_unusable);
}

TEST(HeightGrid, SaysWhatItCoversWhenTheAreaIsElsewhere) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = make_raster(10, 10, plane);
  raster.srs = "EPSG:4326";
  raster.transform = {7, 0.1, 0, 44, 0, -0.1};
  const auto file = write_raster(folder.path(), "dem", raster);
  EXPECT_EQ(refusal(file, Window{{-73.98, 40.75}, {-1000, -1000}, {1000, 1000}}), ErrorCode::region_outside);
  // Where the raster's own projection has no place for the area.
  TestRaster utm = make_raster(10, 10, plane);
  EXPECT_EQ(refusal(write_raster(folder.path(), "utm", utm), Window{{-171, 1}, {-9, -9}, {9, 9}}),
            ErrorCode::region_outside);
  EXPECT_EQ(refusal(file, Window{{7.5, 43.5}, {0, 0}, {0, 10}}), ErrorCode::region_invalid);
  EXPECT_EQ(refusal(file, Window{{7.5, 43.5}, {0, 0}, {kNan, 10}}), ErrorCode::region_invalid);
}

TEST(HeightGrid, SaysWhenAFileIsCutShort) {
  VANTAGE_REQUIRE_SHARED("dsm/dsm.tif");
  const testing::TemporaryDirectory folder;
  const std::string bytes = testing::read_bytes(testing::shared_data("dsm/dsm.tif"));
  for (const std::size_t kept : {static_cast<std::size_t>(8), static_cast<std::size_t>(400), bytes.size() / 2,
                                 static_cast<std::size_t>(156000)}) {
    testing::write_bytes(folder / "cut.tif", bytes.substr(0, kept));
    testing::expect_code([&] { read_height_grid(folder / "cut.tif", {}); }, ErrorCode::raster_unreadable, "cut.tif");
  }
}

TEST(HeightGrid, StopsWhenTold) {
  const testing::TemporaryDirectory folder;
  const auto file = write_raster(folder.path(), "dem", make_raster(4, 4, plane));
  try {
    read_height_grid(file, {}, [](std::string_view, double) { return false; });
    FAIL() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

TEST(HeightGrid, SaysWhenGdalIsMissing) {
  std::string why_not;
  EXPECT_EQ(load_gdal_library(why_not, {"libnothing.so.1"}), nullptr);
  testing::expect_wording(why_not);
  EXPECT_EQ(load_gdal_library(why_not, {"libm.so.6"}), nullptr);  // a library without its functions
  testing::expect_wording(why_not);
}

// ---- real files ----

template <typename Number>
Number number_at(const std::string& bytes, std::size_t place, std::endian order) {
  std::array<char, sizeof(Number)> raw{};
  std::memcpy(raw.data(), bytes.data() + place, sizeof(Number));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}

/// A tile of the Shuttle mission as its documentation describes it: 1201 x 1201 big-endian numbers, the first at the
/// north-west corner, posts on whole degrees. Unpacked by `unzip`, not by GDAL.
std::string srtm_bytes() {
  const std::string command =
      "unzip -p '" + testing::shared_data("osm-terrain/N43E007.hgt.zip").string() + "' N43E007.hgt";
  std::string bytes;
  FILE* const pipe = ::popen(command.c_str(), "r");
  if (!pipe) return bytes;
  std::array<char, 65536> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) bytes.append(buffer.data(), n);
  ::pclose(pipe);
  return bytes;
}

TEST(HeightGrid, ReadsATileOfTheShuttleMissionInItsArchive) {
  VANTAGE_REQUIRE_SHARED("osm-terrain/N43E007.hgt.zip");
  const std::string bytes = srtm_bytes();
  if (bytes.empty()) GTEST_SKIP() << "needs unzip";
  const auto side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(bytes.size()) / 2)));
  ASSERT_EQ(bytes.size(), 2u * static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  const HeightGrid grid = read_height_grid(testing::shared_data("osm-terrain/N43E007.hgt.zip"));
  ASSERT_EQ(grid.columns, side);
  ASSERT_EQ(grid.rows, side);
  EXPECT_EQ(grid.vertical, "EGM96 geoid");
  EXPECT_NEAR(grid.first.x(), 7, 1e-9);
  EXPECT_NEAR(grid.first.y(), 44, 1e-9);
  EXPECT_NEAR(grid.step.x(), 1.0 / (side - 1), 1e-12);
  std::size_t voids = 0, differ = 0;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const auto post =
          2u * (static_cast<std::size_t>(row) * static_cast<std::size_t>(side) + static_cast<std::size_t>(column));
      const auto stored = number_at<std::int16_t>(bytes, post, std::endian::big);
      if (stored == -32768) {
        ++voids;
      } else if (grid.at(column, row) != stored) {
        ++differ;
      }
    }
  }
  EXPECT_EQ(differ, 0u);
  EXPECT_EQ(grid.voids, voids);
  std::cout << side << " x " << side << " posts, " << voids << " voids\n";

  // Unpacked, under its own name; packed with gzip; and a part of it: Monaco.
  const testing::TemporaryDirectory folder;
  testing::write_bytes(folder / "N43E007.hgt", bytes);
  EXPECT_EQ(read_height_grid(folder / "N43E007.hgt").heights_m, grid.heights_m);
  const geo::LonLat monaco{7.42, 43.735};
  const HeightGrid part = read_height_grid(folder / "N43E007.hgt", Window{monaco, {-1000, -1000}, {1000, 1000}});
  EXPECT_LT(part.columns, 100);
  EXPECT_NEAR(part.height_m(part.column_row(monaco)), grid.height_m(grid.column_row(monaco)), 1e-6);
}

TEST(HeightGrid, ReadsAnUncompressedGeoTiff) {
  VANTAGE_REQUIRE_SHARED("dsm/dsm.tif");
  const std::string bytes = testing::read_bytes(testing::shared_data("dsm/dsm.tif"));
  const HeightGrid grid = read_height_grid(testing::shared_data("dsm/dsm.tif"));
  ASSERT_EQ(grid.columns, 223);
  ASSERT_EQ(grid.rows, 175);
  // Its strips follow each other from byte 503 on, as its header says.
  std::size_t voids = 0, differ = 0;
  for (std::size_t i = 0; i < grid.heights_m.size(); ++i) {
    const auto stored = number_at<float>(bytes, 503 + 4 * i, std::endian::little);
    if (stored < -1e30f) {
      ++voids;
    } else if (stored != grid.heights_m[i]) {
      ++differ;
    }
  }
  EXPECT_EQ(differ, 0u);
  EXPECT_EQ(grid.voids, voids);
  EXPECT_TRUE(contains(grid.crs.name(), "EPSG:8353")) << grid.crs.name();
  EXPECT_NEAR(grid.first.x(), -336531.6453 + 0.5, 1e-6);
  EXPECT_NEAR(grid.first.y(), -1189032.1189 - 0.5, 1e-6);
  const geo::LonLat position = grid.position({0, 0});  // Krovak's projection: Slovakia
  EXPECT_NEAR(position.latitude_deg, 49, 1);
  EXPECT_NEAR(position.longitude_deg, 20, 2);
}

TEST(HeightGrid, ReadsLidarRasters) {
  VANTAGE_REQUIRE_SHARED("dsm/delft-dtm-0.5m.tif");
  const HeightGrid ground = read_height_grid(testing::shared_data("dsm/delft-dtm-0.5m.tif"));
  const HeightGrid surface = read_height_grid(testing::shared_data("dsm/delft-dsm-0.5m.tif"));
  ASSERT_EQ(ground.heights_m.size(), surface.heights_m.size());
  EXPECT_TRUE(contains(ground.crs.name(), "EPSG:28992")) << ground.crs.name();
  EXPECT_EQ(ground.first, Eigen::Vector2d(84808.25, 447641.75));
  std::cout << ground.columns << " x " << ground.rows << ", voids: ground " << ground.voids << ", surface "
            << surface.voids << "\n";
  double sum = 0;
  for (std::size_t i = 0; i < ground.heights_m.size(); ++i) {
    sum += static_cast<double>(surface.heights_m[i]) - static_cast<double>(ground.heights_m[i]);
  }
  EXPECT_GT(sum / static_cast<double>(ground.heights_m.size()), 1);  // houses and trees
}

}  // namespace
}  // namespace vantage::internal::terrain
