// Cameras and their pinholes: closed forms, what is refused, and the table of vantage.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/input.h"
#include "support/places.h"
#include "support/random.h"
#include "support/wording.h"
#include "vantage/camera.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using testing::expect_error;

constexpr double kDegree = std::numbers::pi / 180;

Camera camera_of(int width_px, int height_px, double width_mm, double height_mm, double focal_mm) {
  return {"test", "", "", width_px, height_px, width_mm, height_mm, focal_mm, ""};
}

/// Of the whole picture, from one corner to the opposite one.
double diagonal_deg(const Pinhole& pinhole) {
  return 2 * std::atan(std::hypot(pinhole.half_width, pinhole.half_height)) / kDegree;
}

TEST(Pinhole, ClosedForms) {
  const Pinhole right_angle = pinhole_of(camera_of(8000, 4000, 36, 18, 18));
  EXPECT_DOUBLE_EQ(right_angle.half_width, 1);
  EXPECT_DOUBLE_EQ(right_angle.half_height, 0.5);
  EXPECT_DOUBLE_EQ(right_angle.fov_deg()[0], 90);
  EXPECT_NEAR(right_angle.fov_deg()[1], 53.130102354155978, 1e-12);  // the 3-4-5 triangle
  EXPECT_DOUBLE_EQ(right_angle.focal_px.value(), 4000);
  EXPECT_EQ(right_angle.width_px, 8000);
  EXPECT_EQ(right_angle.height_px, 4000);

  const Pinhole sixty = pinhole_of_fov(60, 60);
  EXPECT_DOUBLE_EQ(sixty.half_width, 1 / std::sqrt(3.0));
  EXPECT_EQ(sixty.width_px, 0);
  EXPECT_FALSE(sixty.focal_px.has_value());
}

TEST(Pinhole, TheSmallerFocalLengthCounts) {
  const double by_width = 4000 / std::tan(30 * kDegree), by_height = 3000 / std::tan(20 * kDegree);
  ASSERT_LT(by_width, by_height);
  EXPECT_NEAR(pinhole_of_fov(60, 40, 8000, 6000).focal_px.value(), by_width, 1e-9);
  EXPECT_NEAR(pinhole_of_fov(40, 60, 6000, 8000).focal_px.value(), by_width, 1e-9);
  // Pixels that are not quite square: 4.40 x 4.44 um.
  EXPECT_NEAR(pinhole_of(camera_of(8000, 6000, 35.2, 26.64, 35)).focal_px.value(), 6000 * 35 / 26.64, 1e-9);
  EXPECT_NEAR(pinhole_of(camera_of(8000, 6000, 35.52, 26.4, 35)).focal_px.value(), 8000 * 35 / 35.52, 1e-9);
}

// A point on the edge of the field of view has its image on the edge of the picture.
TEST(Pinhole, EdgesOfTheViewAreEdgesOfThePicture) {
  testing::Random random(411);
  for (int i = 0; i < 200; ++i) {
    const double pixel_mm = random.uniform(0.0005, 0.02), focal_mm = random.uniform(1, 200);
    const int width = random.integer(100, 9000), height = random.integer(100, 9000);
    SCOPED_TRACE(::testing::Message() << width << " x " << height << ", pixel " << pixel_mm << ", focal " << focal_mm);
    const Camera camera = camera_of(width, height, width * pixel_mm, 0, focal_mm);
    if (std::max(width, height) * pixel_mm > std::min(20 * focal_mm, 100.0)) continue;
    const Pinhole pinhole = pinhole_of(camera);
    const double depth = random.uniform(0.1, 1000);
    EXPECT_NEAR(pinhole.focal_px.value() * (pinhole.half_width * depth) / depth, width / 2.0, 1e-9 * width);
    EXPECT_NEAR(pinhole.focal_px.value() * (pinhole.half_height * depth) / depth, height / 2.0, 1e-9 * height);
    const auto [horizontal, vertical] = pinhole.fov_deg();
    if (std::min(horizontal, vertical) < 0.001) continue;
    const Pinhole again = pinhole_of_fov(horizontal, vertical, width, height);
    EXPECT_NEAR(again.half_width, pinhole.half_width, 1e-12 * (1 + pinhole.half_width * pinhole.half_width));
    EXPECT_NEAR(again.focal_px.value(), pinhole.focal_px.value(), 1e-9 * pinhole.focal_px.value());
  }
}

TEST(Camera, ItsSensorIsCompletedBySquarePixels) {
  EXPECT_DOUBLE_EQ(completed(camera_of(8000, 6000, 36, 0, 24)).sensor_height_mm, 27);
  EXPECT_DOUBLE_EQ(completed(camera_of(8000, 6000, 0, 27, 24)).sensor_width_mm, 36);
  EXPECT_EQ(completed(camera_of(8000, 6000, 0, 0, 24)).sensor_width_mm, 0);
  EXPECT_EQ(completed(camera_of(0, 0, 36, 0, 24)).sensor_height_mm, 0);
  EXPECT_EQ(completed(camera_of(8000, 6000, 36, 26.5, 24)).sensor_height_mm, 26.5) << "what is given stays";
  EXPECT_FALSE(pinhole_of(camera_of(0, 0, 36, 24, 24)).focal_px.has_value());
}

TEST(Camera, WhatCannotBeIsRefused) {
  const auto refuse = [](const Camera& camera) {
    expect_error([&] { completed(camera); }, ErrorCode::camera_invalid, "test");
    testing::expect_code([&] { pinhole_of(camera); }, ErrorCode::camera_invalid, "test");
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  refuse(camera_of(-1, 6000, 36, 27, 24));
  refuse(camera_of(8000, 1'000'001, 36, 27, 24));
  refuse(camera_of(8000, 0, 36, 27, 24));
  refuse(camera_of(8000, 6000, -36, 27, 24));
  refuse(camera_of(8000, 6000, 36, kInfinity, 24));
  refuse(camera_of(8000, 6000, kNoNumber, 27, 24));
  refuse(camera_of(8000, 6000, 36, 27, kNoNumber));
  refuse(camera_of(8000, 6000, 36, 27, 1e-300));
  refuse(camera_of(8000, 6000, 36, 27, 1e6));
  refuse(camera_of(160, 120, 160, 120, 9));           // a sensor in pixels
  refuse(camera_of(1920, 1080, 160, 120, 1.9));       // another one
  refuse(camera_of(80, 60, 80, 60, 40));              // a small one
  refuse(camera_of(5472, 3648, 1.32, 0.88, 0.88));    // in centimetres
  refuse(camera_of(8000, 6000, 36, 24, 24));          // another shape: a part of the sensor
  refuse(camera_of(8000, 6000, 36, 27, 1));           // 174 degrees
  completed(camera_of(8000, 6000, 36, 26, 24));       // 4 % are rounding
  completed(camera_of(32, 24, 3.2, 2.4, 3));          // large pixels of a small thermal array
  completed(camera_of(16000, 16000, 230, 230, 152));  // scanned film
}

TEST(Camera, WithoutFocalLengthOrSensorIsNoPinhole) {
  expect_error([] { pinhole_of(camera_of(8000, 6000, 36, 27, 0)); }, ErrorCode::camera_invalid, "test");
  expect_error([] { pinhole_of(camera_of(8000, 6000, 0, 0, 24)); }, ErrorCode::camera_invalid, "test");
  expect_error([] { pinhole_of(camera_of(0, 0, 36, 0, 24)); }, ErrorCode::camera_invalid, "test");
  EXPECT_FALSE(pinhole_if_known({camera_of(8000, 6000, 36, 27, 0), ""}).has_value());
  EXPECT_FALSE(pinhole_if_known({camera_of(8000, 6000, 36, 27, 24), "something"}).has_value());
  EXPECT_DOUBLE_EQ(pinhole_if_known({camera_of(8000, 6000, 36, 0, 24), ""}).value().half_width, 0.75);
}

TEST(Camera, FieldsOfViewThatCannotBeAreRefused) {
  const auto refuse = [](double horizontal, double vertical, int width, int height) {
    expect_error([&] { pinhole_of_fov(horizontal, vertical, width, height); }, ErrorCode::camera_invalid, "camera");
  };
  refuse(0, 40, 0, 0);
  refuse(180, 40, 0, 0);
  refuse(60, -40, 0, 0);
  refuse(60, std::numeric_limits<double>::quiet_NaN(), 0, 0);
  refuse(60, 40, 8000, 0);
  refuse(60, 40, -8000, 6000);
}

TEST(KnownCameras, AreWholeAndConsistent) {
  const std::vector<Camera>& cameras = known_cameras();
  ASSERT_GE(cameras.size(), 30U);
  for (const Camera& camera : cameras) {
    SCOPED_TRACE(camera.name);
    EXPECT_FALSE(camera.maker.empty());
    EXPECT_FALSE(camera.model.empty());
    EXPECT_GE(camera.source.size(), 15U);
    EXPECT_EQ(camera.source.find("memory"), std::string::npos) << "a number needs a document that was found";
    const double width_um = 1000 * camera.sensor_width_mm / camera.width_px;
    const double height_um = 1000 * camera.sensor_height_mm / camera.height_px;
    EXPECT_NEAR(width_um / height_um, 1, 0.02);
    EXPECT_GE(camera.width_px, camera.height_px) << "pictures are wider than high";
    const Pinhole pinhole = pinhole_of(camera);
    EXPECT_NEAR(pinhole.focal_px.value(), camera.width_px * camera.focal_length_mm / camera.sensor_width_mm,
                0.02 * pinhole.focal_px.value());
    EXPECT_GT(pinhole.fov_deg()[1], camera.name == "dji_mavic_3e_tele" ? 8 : 15);
    EXPECT_LT(pinhole.fov_deg()[0], 90) << "no wide lens without distortion";
  }
}

TEST(KnownCameras, HaveNamesOfOneKindInOrder) {
  std::string before;
  for (const Camera& camera : known_cameras()) {
    const std::string& name = camera.name;
    EXPECT_LT(before, name);
    before = name;
    for (const char c : name) EXPECT_TRUE((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_') << name;
    EXPECT_EQ(name.find("__"), std::string::npos) << name;
    EXPECT_GE(name.front(), 'a') << name;
    EXPECT_NE(name.back(), '_') << name;
    // A lens in the name is the lens of the entry.
    const std::size_t last = name.rfind('_');
    if (!name.ends_with("mm")) continue;
    const std::string lens = name.substr(last + 1, name.size() - last - 3);
    EXPECT_NEAR(parse_number(lens).value, camera.focal_length_mm, 0.5) << name;
  }
}

// Fields of view that makers publish beside the numbers of the table.
TEST(KnownCameras, SeeAsWideAsTheirMakersSay) {
  enum Direction { kHorizontal, kVertical, kDiagonal };
  struct Published {
    const char* name;
    Direction direction;
    double degrees;
    double tolerance = 0.02;
  };
  constexpr double kOfType13 = 0.026;  // docs/camera.md: wide cameras of DJI of type 1/1.3
  for (const Published& published :
       {Published{"micasense_rededge_m", kHorizontal, 47.2}, Published{"raspberry_pi_camera_2", kHorizontal, 62.2},
        Published{"raspberry_pi_camera_2", kVertical, 48.8}, Published{"dji_zenmuse_p1_35mm", kDiagonal, 63.5},
        Published{"dji_zenmuse_h20t_thermal", kDiagonal, 40.6}, Published{"dji_mavic_3e_wide", kDiagonal, 84},
        Published{"dji_phantom_4_rtk", kDiagonal, 84}, Published{"autel_evo_ii", kDiagonal, 79},
        Published{"dji_air_2s", kDiagonal, 88}, Published{"dji_matrice_30_wide", kDiagonal, 84},
        Published{"dji_matrice_4t_thermal", kDiagonal, 45}, Published{"dji_matrice_4t_wide", kDiagonal, 82, kOfType13},
        Published{"dji_mavic_3_classic", kDiagonal, 84}, Published{"dji_mavic_3_pro_wide", kDiagonal, 84},
        Published{"dji_mavic_3e_tele", kDiagonal, 15}, Published{"dji_mavic_3t_wide", kDiagonal, 84},
        Published{"dji_air_3_medium_tele", kDiagonal, 35}, Published{"dji_air_3_wide", kDiagonal, 82, kOfType13},
        Published{"dji_air_3s_medium_tele", kDiagonal, 35}, Published{"dji_air_3s_wide", kDiagonal, 84},
        Published{"dji_mavic_3_pro_medium_tele", kDiagonal, 35}, Published{"dji_mini_3", kDiagonal, 82.1, kOfType13},
        Published{"dji_mini_3_pro", kDiagonal, 82.1, kOfType13},
        Published{"dji_mini_4_pro", kDiagonal, 82.1, kOfType13},
        Published{"dji_zenmuse_h30_wide", kDiagonal, 82.1, kOfType13},
        // of Skydio's camera and metadata overviews
        Published{"skydio_2", kHorizontal, 80}, Published{"skydio_2", kVertical, 64},
        Published{"skydio_2", kDiagonal, 94}, Published{"skydio_x10_narrow", kHorizontal, 40},
        Published{"skydio_x10_narrow", kDiagonal, 50}}) {
    const Pinhole pinhole = pinhole_of(find_camera(published.name));
    const double degrees =
        published.direction == kDiagonal ? diagonal_deg(pinhole) : pinhole.fov_deg()[published.direction];
    EXPECT_NEAR(degrees / published.degrees, 1, published.tolerance) << published.name;
  }
  // The thermal cameras of DJI have a wider view on the data sheet than in their pictures.
  const double film_diagonal_mm = std::hypot(36.0, 24.0);
  for (const char* name : {"dji_mavic_3t_thermal", "dji_matrice_30t_thermal"}) {
    EXPECT_NEAR(diagonal_deg(pinhole_of(find_camera(name))), 2 * std::atan(film_diagonal_mm / 2 / 40) / kDegree, 0.5);
  }
  // And what they write into their pictures, or publish of these: the focal length in pixels.
  for (const auto& [name, focal_px] :
       {std::pair("autel_evo_ii_pro", 4404.1667), std::pair("skydio_2", 2376.5625), std::pair("skydio_x2", 2376.5625),
        std::pair("skydio_x10_narrow", 12611.0291), std::pair("skydio_x10_wide", 4936.49),
        std::pair("skydio_x2_color_thermal", 4832.3438)}) {
    EXPECT_NEAR(pinhole_of(find_camera(name)).focal_px.value() / focal_px, 1, 0.001) << name;
  }
  // Where two are published, each direction of the view has its own: the picture is no wider than either.
  for (const auto& [name, across_px, along_px] : {std::tuple("skydio_x10_narrow", 12668.3474, 12611.0291),
                                                  std::tuple("skydio_x2_color_thermal", 4848.1875, 4832.3438)}) {
    const Pinhole pinhole = pinhole_of(find_camera(name));
    EXPECT_NEAR(pinhole.width_px / (2 * pinhole.half_width) / across_px, 1, 5e-5) << name;
    EXPECT_NEAR(pinhole.height_px / (2 * pinhole.half_height) / along_px, 1, 5e-5) << name;
  }
  const Pinhole mavic = pinhole_of(find_camera("dji_mavic_3e_wide"));
  EXPECT_NEAR(mavic.focal_px.value(), 3725.15, 0.02 * 3725.15);
  // What lists of others differ by, as docs/camera.md says: OpenAthena's calibration, and YMapper's 8.67 of 13.2 mm.
  EXPECT_NEAR(2892.6 / pinhole_of(find_camera("dji_mini_3")).focal_px.value(), 1.033, 0.001);
  EXPECT_NEAR(4096 * 8.67 / 13.2 / pinhole_of(find_camera("dji_air_3s_wide")).focal_px.value(), 0.947, 0.001);
}

TEST(KnownCameras, SayWhatCarriesThemWithItsSource) {
  std::size_t known = 0;
  for (const Camera& camera : known_cameras()) {
    SCOPED_TRACE(camera.name);
    const CameraCarrier& carrier = camera.carrier;
    const bool is_known = carrier.pitch_deg || carrier.dji_payload || carrier.speed_m_s;
    EXPECT_EQ(is_known, carrier.source.size() >= 15);
    if (is_known) ++known;
    for (const auto& range : {carrier.pitch_deg, carrier.roll_deg, carrier.yaw_deg}) {
      EXPECT_TRUE(!range || (*range)[0] < (*range)[1]);
    }
    if (carrier.pitch_deg) {
      EXPECT_LE((*carrier.pitch_deg)[0], -90) << "all look straight down";
      EXPECT_GT((*carrier.pitch_deg)[1], 0);
    }
    EXPECT_EQ(carrier.dji_drone.has_value(), carrier.dji_drone_sub_type.has_value());
    EXPECT_TRUE(!carrier.dji_drone || carrier.dji_payload);
  }
  EXPECT_GE(known, 30U);
}

TEST(KnownCameras, AreFoundByName) {
  for (const Camera& camera : known_cameras()) EXPECT_EQ(&find_camera(camera.name), &camera);
  const Camera& camera = find_camera("sony_a7r_iv_35mm");
  EXPECT_EQ(camera.width_px, 9504);
  EXPECT_EQ(camera.focal_length_mm, 35);
}

TEST(KnownCameras, AnUnknownNameIsToldItsNeighbours) {
  const auto expect_told = [](const std::string& name, const std::vector<std::string>& neighbours) {
    const std::string fix = expect_error([&] { find_camera(name); }, ErrorCode::unknown_choice).fix();
    for (const std::string& neighbour : neighbours) EXPECT_NE(fix.find(neighbour), std::string::npos) << fix;
  };
  expect_told("sony_a7r_vi_35mm", {"sony_a7r_iv_35mm"});
  expect_told("Sony A7R IV 35mm", {"sony_a7r_iv_35mm"});
  expect_told("P1", {"dji_zenmuse_p1_24mm", "dji_zenmuse_p1_35mm", "dji_zenmuse_p1_50mm"});
  expect_told("", {});
  expect_told(std::string(100'000, 'x'), {});
}

// The table in the manual is that of the code.
TEST(KnownCameras, AreInTheManual) {
  std::ifstream file(testing::source_folder() / "docs/camera.md");
  std::set<std::string> rows;
  bool is_table = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) is_table = line == "## Cameras that vantage knows";
    if (line.starts_with("## Gimbals")) is_table = true;
    if (is_table && line.starts_with("| `")) rows.insert(line);
  }
  for (const Camera& camera : known_cameras()) {
    const std::string row = "| `" + camera.name + "` | " + std::to_string(camera.width_px) + " x " +
                            std::to_string(camera.height_px) + " | " + shortest(camera.sensor_width_mm) + " x " +
                            shortest(camera.sensor_height_mm) + " | " + shortest(camera.focal_length_mm) + " |";
    EXPECT_TRUE(rows.contains(row)) << row;
    rows.erase(row);
    if (!camera.carrier.pitch_deg) continue;
    const auto [low, high] = *camera.carrier.pitch_deg;
    const std::string gimbal = "| `" + camera.name + "` | " + shortest(low) + " to " + shortest(high) + " |";
    EXPECT_TRUE(rows.contains(gimbal)) << gimbal;
    rows.erase(gimbal);
  }
  EXPECT_TRUE(rows.empty()) << *rows.begin();
}

}  // namespace
}  // namespace vantage
