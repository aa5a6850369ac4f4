#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>

#include "geo/local_frame.h"
#include "support/environment.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"

namespace vantage::internal::geo {
namespace {

/// Points of the self-test of RDNAPTRANS 2008, the transformation of the Dutch mapping agency.
struct DutchPoint {
  LonLat etrs89;
  Eigen::Vector2d rd;
};
const DutchPoint kDutchPoints[] = {{{5.387203657, 52.155172897}, {155000, 463000}},         // Amersfoort, RD's origin
                                   {{4.824761912, 53.160753042}, {117380.12, 575040.34}},   // Texel
                                   {{6.776726674, 53.419482050}, {247380.56, 604580.78}}};  // Groningen

double metres_apart(LonLat a, LonLat b) { return LocalFrame(a).to_local(b).norm(); }

/// Expects that no system is made of a text, and that the error quotes `quoted`. Its words may have PROJ's in them.
void expect_refused(const std::string& text, ErrorCode code, const std::string& quoted = "") {
  const Error error = testing::expect_code([&] { CoordinateSystem(text, "file.tif"); }, code, "file.tif");
  EXPECT_NE(error.problem().find(quoted), std::string::npos) << error.what();
  EXPECT_LT(error.problem().size(), 300U) << error.what();
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(CoordinateSystem, ConvertsDutchCoordinates) {
  const CoordinateSystem rd("EPSG:28992", "test");
  EXPECT_EQ(rd.name(), "EPSG:28992 (Amersfoort / RD New)");
  EXPECT_EQ(rd.code(), "EPSG:28992");
  EXPECT_FALSE(rd.is_geographic());
  EXPECT_EQ(rd.vertical_name(), "");
  EXPECT_FALSE(rd.vertical_unit_m());
  double worst_m = 0;
  for (const DutchPoint& point : kDutchPoints) {
    worst_m = std::max(worst_m, metres_apart(rd.to_lonlat(point.rd), point.etrs89));
    EXPECT_LT((rd.from_lonlat(point.etrs89) - point.rd).norm(), 1.0);
  }
  std::cout << "without the correction grid: " << worst_m << " m\n";
  EXPECT_LT(worst_m, 1.0);
  EXPECT_LT((rd.from_lonlat(rd.to_lonlat({85000, 447000})) - Eigen::Vector2d(85000, 447000)).norm(), 1e-3);
}

TEST(CoordinateSystem, UsesTheHorizontalPartOfACompoundSystem) {
  const CoordinateSystem compound("EPSG:7415", "test");
  EXPECT_EQ(compound.name(), "EPSG:7415 (Amersfoort / RD New + NAP height)");
  EXPECT_EQ(compound.vertical_name(), "NAP height");
  EXPECT_EQ(compound.vertical_unit_m(), 1.0);
  const LonLat expected = CoordinateSystem("EPSG:28992", "test").to_lonlat({85000, 447000});
  const LonLat got = compound.to_lonlat({85000, 447000});
  EXPECT_EQ(got.longitude_deg, expected.longitude_deg);
  EXPECT_EQ(got.latitude_deg, expected.latitude_deg);
}

TEST(CoordinateSystem, KnowsHeightsOfThreeAxesAndOtherUnits) {
  const CoordinateSystem ellipsoidal("EPSG:4979", "test");
  EXPECT_TRUE(ellipsoidal.is_geographic());
  EXPECT_EQ(ellipsoidal.vertical_name(), "ellipsoidal height");
  EXPECT_EQ(ellipsoidal.vertical_unit_m(), 1.0);
  const CoordinateSystem feet("EPSG:6318+6360", "test");  // NAD83(2011) + NAVD88 height (ftUS)
  EXPECT_NEAR(feet.vertical_unit_m().value(), 1200.0 / 3937, 1e-12);
  const CoordinateSystem depth("EPSG:4326+5715", "test");
  EXPECT_EQ(depth.vertical_unit_m(), -1.0);
}

TEST(CoordinateSystem, UnderstandsTheSpellingsOfCityJson) {
  for (const char* spelling :
       {"https://www.opengis.net/def/crs/EPSG/0/7415", "http://www.opengis.net/def/crs/EPSG/0/7415",
        "https://www.opengis.net/def/crs/EPSG/9.9.1/7415", "http://opengis.net/def/crs/EPSG/0/7415",
        "urn:ogc:def:crs:EPSG::7415", "epsg:7415"}) {
    const CoordinateSystem system(spelling, "test");
    EXPECT_EQ(system.name(), CoordinateSystem("EPSG:7415", "test").name()) << spelling;
    EXPECT_EQ(system.vertical_name(), "NAP height") << spelling;
  }
  expect_refused("https://www.opengis.net/def/crs/EPSG/0/", ErrorCode::crs_unknown);
  expect_refused("https://www.opengis.net/def/crs/7415", ErrorCode::crs_unknown);
}

TEST(CoordinateSystem, EastComesFirstWhateverTheAuthoritySays) {
  const LonLat place{24.9, 60.2};
  const CoordinateSystem wgs84("EPSG:4326", "test");  // latitude first by its definition
  EXPECT_TRUE(wgs84.is_geographic());
  EXPECT_EQ(wgs84.from_lonlat(place), Eigen::Vector2d(24.9, 60.2));
  EXPECT_EQ(CoordinateSystem("OGC:CRS84", "test").from_lonlat(place), Eigen::Vector2d(24.9, 60.2));
  const Eigen::Vector2d gauss_kruger = CoordinateSystem("EPSG:31467", "test").from_lonlat({9, 50});  // northing first
  EXPECT_NEAR(gauss_kruger.x(), 3.5e6, 200);
  EXPECT_NEAR(gauss_kruger.y(), 5.54e6, 2000);
}

TEST(CoordinateSystem, TakesProjAndWktTexts) {
  const LonLat place{8.5, 50.1};
  const Eigen::Vector2d utm = CoordinateSystem("EPSG:32632", "test").from_lonlat(place);
  for (const char* text : {"+proj=utm +zone=32 +datum=WGS84", "+proj=utm +zone=32 +datum=WGS84 +type=crs"}) {
    const CoordinateSystem system(text, "test");
    EXPECT_LT((system.from_lonlat(place) - utm).norm(), 1e-6);
    EXPECT_TRUE(contains(system.name(), "+proj=utm")) << system.name();
  }
  const CoordinateSystem wkt(
      R"(PROJCS["my own",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
      R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],)"
      R"(PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],)"
      R"(PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]])",
      "test");
  EXPECT_EQ(wkt.name(), "my own");
  EXPECT_EQ(wkt.code(), "");
  EXPECT_LT((wkt.from_lonlat(place) - utm).norm(), 1e-6);
  // Brings its own transformation to WGS 84 (a bound system).
  const CoordinateSystem bound("+proj=utm +zone=32 +ellps=intl +towgs84=-87,-98,-121", "test");
  EXPECT_FALSE(bound.is_geographic());
  EXPECT_NEAR((bound.from_lonlat(place) - utm).norm(), 210, 60);
}

// Texts come from mission files, and those from anywhere.
TEST(CoordinateSystem, ReadsNoFilesButThoseOfProj) {
  const testing::TemporaryDirectory folder;
  const auto is_refused = [](const std::string& text) {
    try {
      CoordinateSystem(text, "test").to_lonlat({9, 50});
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  testing::write_bytes(folder / "init", "<4326> +proj=longlat +datum=WGS84 +no_defs <>\n");
  EXPECT_TRUE(is_refused("+init=" + (folder / "init").string() + ":4326"));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  is_refused("+proj=longlat +ellps=bessel +nadgrids=" + (folder / "pipe").string() + ",@null");  // does not wait for it

  const std::filesystem::path data = "/usr/share/proj", grid = "BETA2007.gsb";
  if (!std::filesystem::exists(data / grid)) GTEST_SKIP() << "proj-data is not installed";
  std::filesystem::copy_file(data / grid, folder / grid);
  std::filesystem::create_symlink(folder / grid, folder / "link.gsb");
  const std::string longlat = "+proj=longlat +ellps=bessel +nadgrids=";
  EXPECT_FALSE(is_refused(longlat + grid.string()));
  EXPECT_TRUE(is_refused(longlat + (folder / grid).string()));
  EXPECT_TRUE(is_refused(longlat + (data / ".." / ".." / ".." / folder.path().relative_path() / grid).string()));
  const testing::EnvironmentVariable by_user("PROJ_DATA", folder.path().string() + ":" + data.string());
  EXPECT_FALSE(is_refused(longlat + (folder / grid).string()));
}

TEST(CoordinateSystem, SaysWhatItDoesNotKnow) {
  expect_refused("EPSG:99999", ErrorCode::crs_unknown, "'EPSG:99999'");
  expect_refused("", ErrorCode::crs_unknown, "''");
  expect_refused("usual one\n", ErrorCode::crs_unknown, "'usual one?'");
  expect_refused(std::string("EPSG:4326\0x", 11), ErrorCode::crs_unknown, "'EPSG:4326?x'");
  expect_refused("+proj=nonsense", ErrorCode::crs_unknown);
  expect_refused("EPSG:4978", ErrorCode::crs_unusable);  // geocentric
  expect_refused("EPSG:5773", ErrorCode::crs_unusable);  // EGM96 height
  expect_refused("EPSG:7030", ErrorCode::crs_unknown);   // an ellipsoid
  expect_refused(std::string(100000, 'x'), ErrorCode::crs_unknown);
}

TEST(CoordinateSystem, SaysWhereTheProjectionEnds) {
  const CoordinateSystem mercator("EPSG:3857", "file.tif");
  EXPECT_THROW(mercator.from_lonlat({std::numeric_limits<double>::quiet_NaN(), 0}), Error);
  const Error error = testing::expect_code(
      [&] {
        mercator.from_lonlat({10, 100});
      },
      ErrorCode::too_far_away, "file.tif");
  EXPECT_TRUE(contains(error.problem(), "(10, 100)")) << error.what();
  EXPECT_TRUE(contains(error.problem(), "EPSG:3857")) << error.what();
  EXPECT_NEAR(mercator.from_lonlat({10, 50}).y(), 6446275.84, 0.01);  // and goes on working
}

TEST(CoordinateSystem, KnowsTheAreaThatItIsMadeFor) {
  const CoordinateSystem rd("EPSG:28992", "test"), utm("EPSG:32632", "test"), proj("+proj=utm +zone=32", "test");
  EXPECT_FALSE(rd.area_without({4.36, 52.01}));
  EXPECT_NE(rd.area_without({11.58, 48.14}).value_or("").find("Netherlands"), std::string::npos);
  EXPECT_FALSE(utm.area_without({11.58, 48.14}));
  EXPECT_TRUE(utm.area_without({4.36, 52.01}));
  EXPECT_FALSE(proj.area_without({100, 0})) << "a text of PROJ's has no area";
  const CoordinateSystem fiji("EPSG:3460", "test");  // its area crosses the antimeridian
  EXPECT_FALSE(fiji.area_without({178, -17}));
  EXPECT_FALSE(fiji.area_without({-179, -17}));
  EXPECT_FALSE(fiji.area_without({181, -17}));
  EXPECT_TRUE(fiji.area_without({0, -17}));
}

TEST(CoordinateSystem, SaysWhenTheDatabaseIsMissing) {
  const testing::TemporaryDirectory empty;
  const testing::EnvironmentVariable data("PROJ_DATA", empty.path().string());
  const testing::EnvironmentVariable lib("PROJ_LIB", empty.path().string());
  expect_refused("EPSG:4326", ErrorCode::library_missing, "proj.db");
  expect_refused("+proj=utm +zone=32", ErrorCode::library_missing, "proj.db");
  EXPECT_NEAR(LocalFrame({7.4, 43.7}).to_local({7.4, 43.71}).y(), 1111, 1);  // needs none
}

}  // namespace
}  // namespace vantage::internal::geo
