// Lists of cameras in files: QGroundControl's and OpenSfM's, and what is wrong in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/camera.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using testing::expect_error;
using testing::shared_data;

constexpr const char* kQGroundControl = "cameras/qgroundcontrol_excerpt.json";
constexpr const char* kOpenSfm = "cameras/opensfm_sensor_data.json";

/// An entry of QGroundControl's list that is right, with one of its members replaced; an empty value leaves it out.
std::string entry_with(std::string_view changed_key, const std::string& value) {
  std::string entry;
  for (const auto& [key, original] :
       std::vector<std::pair<std::string, std::string>>{{"canonicalName", "\"Maker Model\""},
                                                        {"brand", "\"Maker\""},
                                                        {"model", "\"Model\""},
                                                        {"sensorWidth", "13.2"},
                                                        {"sensorHeight", "8.8"},
                                                        {"imageWidth", "5472"},
                                                        {"imageHeight", "3648"},
                                                        {"focalLength", "8.8"},
                                                        {"landscape", "true"}}) {
    const std::string& used = key == changed_key ? value : original;
    if (used.empty()) continue;
    entry.append(entry.empty() ? "{" : ",\n ").append("\"").append(key).append("\": ").append(used);
  }
  return entry + "}";
}

class CameraLists : public ::testing::Test {
 protected:
  std::vector<ListedCamera> read(const std::string& text) const {
    testing::write_bytes(folder_ / "list.json", text);
    return read_cameras(folder_ / "list.json");
  }
  void refuse(const std::string& text, ErrorCode code, const std::string& where = "list.json") const {
    expect_error([&] { read(text); }, code, where);
  }

  testing::TemporaryDirectory folder_;
};

const ListedCamera& named(const std::vector<ListedCamera>& cameras, std::string_view name) {
  const auto found =
      std::find_if(cameras.begin(), cameras.end(), [&](const ListedCamera& c) { return c.camera.name == name; });
  if (found != cameras.end()) return *found;
  ADD_FAILURE() << "no " << name;
  return cameras.front();
}

TEST_F(CameraLists, OfQGroundControl) {
  const auto cameras = read("[" + entry_with("", "") + ",\n" + entry_with("canonicalName", "\"Another\"") + "]");
  ASSERT_EQ(cameras.size(), 2U);
  const Camera& camera = cameras[0].camera;
  EXPECT_EQ(cameras[0].problem, "");
  EXPECT_EQ(camera.name, "Maker Model");
  EXPECT_EQ(camera.maker, "Maker");
  EXPECT_EQ(camera.model, "Model");
  EXPECT_EQ(camera.width_px, 5472);
  EXPECT_EQ(camera.height_px, 3648);
  EXPECT_EQ(camera.sensor_width_mm, 13.2);
  EXPECT_EQ(camera.sensor_height_mm, 8.8);
  EXPECT_EQ(camera.focal_length_mm, 8.8);
  EXPECT_TRUE(camera.source.ends_with(" 1")) << camera.source;
  EXPECT_EQ(cameras[1].camera.name, "Another");
  EXPECT_TRUE(cameras[1].camera.source.ends_with(" 2")) << cameras[1].camera.source;
  testing::expect_wording(camera.source);
}

TEST_F(CameraLists, OfOpenSfm) {
  const auto cameras = read(R"({"Maker B": 6.17, "Maker A": 13.2, "Maker C": -1})");
  ASSERT_EQ(cameras.size(), 3U);
  EXPECT_EQ(cameras[0].camera.name, "Maker A");
  EXPECT_EQ(cameras[0].camera.sensor_width_mm, 13.2);
  EXPECT_EQ(cameras[0].camera.focal_length_mm, 0);
  EXPECT_EQ(cameras[0].problem, "");
  EXPECT_FALSE(pinhole_if_known(cameras[0]).has_value());
  EXPECT_FALSE(cameras[2].problem.empty());
  EXPECT_EQ(cameras[2].camera.sensor_width_mm, 0);
}

TEST_F(CameraLists, AMessageQuotesLittleOfTheFile) {
  const std::string secret(5000, 's');
  for (const std::string& text :
       {"{\"A\": \"" + secret, "{\"A\": [" + secret + "]}", "{\"A\": 1" + std::string(5000, '0') + "}",
        "{\"" + secret + "\": 1, \"" + secret + "\": 2}", "[\"" + secret + "\" 1]"}) {
    const Error error = testing::expect_code([&] { read(text); }, ErrorCode::camera_list_syntax, "list.json");
    EXPECT_LT(error.problem().size(), 300U) << error.problem();
  }
}

TEST_F(CameraLists, AWrongEntryIsNamedAndSpoilsNoOther) {
  std::vector<std::string> problems;
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{{"canonicalName", ""},
                                                                                   {"canonicalName", "\" \""},
                                                                                   {"canonicalName", "7"},
                                                                                   {"brand", "[]"},
                                                                                   {"sensorWidth", ""},
                                                                                   {"sensorWidth", "\"13.2\""},
                                                                                   {"sensorWidth", "0"},
                                                                                   {"sensorWidth", "-13.2"},
                                                                                   {"sensorWidth", "132"},
                                                                                   {"sensorHeight", "13.2"},
                                                                                   {"sensorHeight", "null"},
                                                                                   {"imageWidth", "5472.5"},
                                                                                   {"imageWidth", "1e300"},
                                                                                   {"imageHeight", "0"},
                                                                                   {"imageHeight", ""},
                                                                                   {"focalLength", "0.3"},
                                                                                   {"focalLength", "1000000"},
                                                                                   {"focalLength", "true"}}) {
    const auto cameras = read("[" + entry_with("", "") + "," + entry_with(key, value) + "," + entry_with("", "") + "]");
    ASSERT_EQ(cameras.size(), 3U);
    EXPECT_EQ(cameras[0].problem + cameras[2].problem, "") << key << " " << value;
    EXPECT_FALSE(cameras[1].problem.empty()) << key << " " << value;
    EXPECT_FALSE(pinhole_if_known(cameras[1]).has_value());
    problems.push_back(std::string(key).append(" ").append(value).append(": ").append(cameras[1].problem));
  }
  const auto mixed = read("[" + entry_with("", "") + ", 7, [], \"camera\", null, {}]");
  ASSERT_EQ(mixed.size(), 6U);
  for (std::size_t i = 1; i < mixed.size(); ++i) {
    EXPECT_TRUE(mixed[i].camera.source.ends_with(" " + std::to_string(i + 1))) << mixed[i].camera.source;
    problems.push_back(mixed[i].problem);
  }
  for (const ListedCamera& listed : read(R"({"A": 6, "B": 7, "C": 8, "D": 9, "": 5, "E": "6", "F": 300})")) {
    if (!listed.problem.empty()) problems.push_back(listed.camera.name + ": " + listed.problem);
  }
  testing::expect_wording(problems);
}

TEST_F(CameraLists, NamesAreOneLineOfText) {
  const auto cameras = read(R"({"two\nlines\u001b[31m": 6, "B": 7})");
  const ListedCamera& two_lines = named(cameras, "two lines [31m");
  EXPECT_EQ(two_lines.camera.sensor_width_mm, 6);
  const auto entries = read("[" + entry_with("brand", R"("a\u0007b ")") + "]");
  EXPECT_EQ(entries.at(0).camera.maker, "a b");
}

TEST_F(CameraLists, WhatIsNoJsonIsRefusedWithItsPlace) {
  const char* comma_too_many = "[\n {\"canonicalName\": \"A\",\n  \"sensorWidth\": 13.2,}]";
  refuse(comma_too_many, ErrorCode::camera_list_syntax, "line 3, column 23");
  refuse("{\"A\": 6.17", ErrorCode::camera_list_syntax, "line 1");
  refuse("<cameras/>", ErrorCode::camera_list_syntax, "line 1, column 1");
  refuse("{\"A\": 1e999}", ErrorCode::camera_list_syntax);
  refuse(std::string(500, '['), ErrorCode::camera_list_syntax);
}

TEST_F(CameraLists, OtherJsonIsRefused) {
  for (const char* text :
       {"[]", "{}", "7", "null", "\"text\"", "[1, 2]", "[{\"name\": \"A\"}]",
        R"({"fileType": "Plan", "version": 1, "mission": {}})", R"({"type": "FeatureCollection", "features": []})"}) {
    testing::expect_code([&] { read(text); }, ErrorCode::camera_list_syntax, "list.json");
  }
  refuse("[1, 2]", ErrorCode::camera_list_syntax);
}

TEST_F(CameraLists, WhatCannotBeReadIsRefused) {
  refuse("", ErrorCode::file_empty);
  expect_error([&] { read_cameras(folder_ / "none.json"); }, ErrorCode::file_not_found, "none.json");
  expect_error([&] { read_cameras(folder_.path()); }, ErrorCode::not_a_file);
  read("{\"A\": 6}");
  std::filesystem::resize_file(folder_ / "list.json", 64'000'001);
  expect_error([&] { read_cameras(folder_ / "list.json"); }, ErrorCode::file_too_large, "list.json");
  std::string many = "[0";
  for (int i = 0; i < 2'000'000; ++i) many += ",0";
  refuse(many + "]", ErrorCode::camera_list_syntax);
}

TEST_F(CameraLists, TheRealOneOfQGroundControl) {
  VANTAGE_REQUIRE_SHARED(kQGroundControl);
  const auto cameras = read_cameras(shared_data(kQGroundControl));
  ASSERT_EQ(cameras.size(), 7U);
  for (const ListedCamera& listed : cameras) {
    const bool is_in_pixels = listed.camera.name == "Flir Duo R";
    EXPECT_EQ(!listed.problem.empty(), is_in_pixels) << listed.camera.name << ": " << listed.problem;
    EXPECT_EQ(pinhole_if_known(listed).has_value(), !is_in_pixels) << listed.camera.name;
  }
  const ListedCamera& bad = named(cameras, "Flir Duo R");
  EXPECT_EQ(bad.camera.sensor_width_mm, 160);
  testing::expect_wording({bad.camera.source, bad.problem});
  const Pinhole sentera = pinhole_of(named(cameras, "Sentera 65R Sensor").camera);
  EXPECT_NEAR(sentera.focal_px.value(), 27.4 / 0.0032, 5);
}

TEST_F(CameraLists, TheRealOneOfOpenSfm) {
  VANTAGE_REQUIRE_SHARED(kOpenSfm);
  const auto cameras = read_cameras(shared_data(kOpenSfm));
  EXPECT_GT(cameras.size(), 3000U);
  for (const ListedCamera& listed : cameras) EXPECT_EQ(listed.problem, "") << listed.camera.name;
  const Camera& camera = named(cameras, "DJI FC6310").camera;
  EXPECT_EQ(camera.sensor_width_mm, 13.2);
  testing::expect_code([&] { pinhole_of(camera); }, ErrorCode::camera_invalid, "DJI FC6310");
}

// Where others list a camera of the table too, they agree to 2 %.
TEST_F(CameraLists, AgreeWithTheTableOfVantage) {
  VANTAGE_REQUIRE_SHARED(kQGroundControl);
  VANTAGE_REQUIRE_SHARED(kOpenSfm);
  const auto planner = read_cameras(shared_data(kQGroundControl));
  for (const auto& [ours, theirs] :
       {std::pair("sony_a7r_ii_21mm", "Sony a7R II Zeiss 21mm f/2.8"),
        std::pair("sentera_65r_27mm", "Sentera 65R Sensor"), std::pair("flir_duo_pro_r_640_19mm", "Flir Duo Pro R")}) {
    const Pinhole a = pinhole_of(find_camera(ours)), b = pinhole_of(named(planner, theirs).camera);
    EXPECT_NEAR(a.half_width / b.half_width, 1, 0.02) << ours;
    EXPECT_NEAR(a.half_height / b.half_height, 1, 0.02) << ours;
    EXPECT_EQ(a.width_px, b.width_px) << ours;
    EXPECT_EQ(a.height_px, b.height_px) << ours;
  }
  const auto widths = read_cameras(shared_data(kOpenSfm));
  for (const auto& [ours, theirs] :
       {std::pair("canon_eos_m_22mm", "Canon EOS M"), std::pair("canon_g9_x", "Canon PowerShot G9 X"),
        std::pair("canon_sx260_hs", "Canon PowerShot SX260 HS"), std::pair("dji_mavic_3e_wide", "Hasselblad L2D-20c"),
        std::pair("dji_phantom_4_pro", "DJI FC6310"), std::pair("dji_zenmuse_h20t_thermal", "DJI ZH20T"),
        std::pair("dji_zenmuse_p1_35mm", "DJI ZENMUSEP1"), std::pair("dji_zenmuse_x7_24mm", "DJI FC6540"),
        std::pair("dji_zenmuse_xt2_thermal_13mm", "DJI XT2"), std::pair("ricoh_gr_ii", "Ricoh GR"),
        std::pair("sony_a6000_16mm", "Sony Alpha a6000"), std::pair("sony_qx1_16mm", "Sony QX1"),
        std::pair("sony_rx100_ii", "Sony Cybershot DSC RX100 II"),
        std::pair("sony_rx1r_ii", "Sony Cybershot DSC RX1R")}) {
    EXPECT_NEAR(find_camera(ours).sensor_width_mm / named(widths, theirs).camera.sensor_width_mm, 1, 0.02) << ours;
  }
}

}  // namespace
}  // namespace vantage
