// `vantage cameras`: the table of vantage, and lists in files.
#include <string>
#include <utility>
#include <vector>

#include "support/cli_fixture.h"
#include "vantage/camera.h"

namespace vantage::testing {
namespace {

using CliCameras = Cli;

constexpr const char* kList = R"([
 {"canonicalName": "Good 35mm", "sensorWidth": 36, "sensorHeight": 24, "imageWidth": 6000, "imageHeight": 4000,
  "focalLength": 18},
 {"canonicalName": "Bad", "sensorWidth": 640, "sensorHeight": 512, "imageWidth": 640, "imageHeight": 512,
  "focalLength": 19},
 {"sensorWidth": 36}
])";

TEST_F(CliCameras, ListsThoseThatAreKnown) {
  const std::string table = output_of({"cameras"});
  EXPECT_EQ(lines(table).size(), known_cameras().size() + 1);
  for (const Camera& camera : known_cameras()) {
    EXPECT_NE(table.find("\n" + camera.name + " "), std::string::npos) << camera.name;
  }
  EXPECT_NE(table.find("-90 to 35\n"), std::string::npos) << "the gimbal of the Mavic 3E";
  for (const std::string& line : lines(table)) EXPECT_EQ(line.size(), lines(table)[0].size()) << line;

  const auto json = nlohmann::json::parse(output_of({"cameras", "--json"})).at("cameras");
  ASSERT_EQ(json.size(), known_cameras().size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const Camera& camera = known_cameras()[i];
    EXPECT_EQ(json[i].at("name"), camera.name);
    EXPECT_EQ(json[i].at("maker"), camera.maker);
    EXPECT_EQ(json[i].at("model"), camera.model);
    EXPECT_EQ(json[i].at("width_px"), camera.width_px);
    EXPECT_EQ(json[i].at("height_px"), camera.height_px);
    for (const auto& [key, millimetres] :
         {std::pair("sensor_width_mm", camera.sensor_width_mm), std::pair("sensor_height_mm", camera.sensor_height_mm),
          std::pair("focal_length_mm", camera.focal_length_mm)}) {
      EXPECT_EQ(json[i].at(key), millimetres);
    }
    EXPECT_EQ(json[i].at("source"), camera.source);
    EXPECT_TRUE(json[i].at("problem").is_null());
    EXPECT_EQ(json[i].at("carrier").at("source").is_null(), camera.carrier.source.empty());
    EXPECT_EQ(json[i].at("carrier").at("pitch_deg").is_null(), !camera.carrier.pitch_deg.has_value());
    const Pinhole pinhole = pinhole_of(camera);
    EXPECT_EQ(json[i].at("focal_px"), pinhole.focal_px.value());
    EXPECT_EQ(json[i].at("fov_deg").get<std::vector<double>>(),
              (std::vector<double>{pinhole.fov_deg()[0], pinhole.fov_deg()[1]}));
  }
}

TEST_F(CliCameras, TellsWhatCarriesACamera) {
  const auto json = nlohmann::json::parse(output_of({"cameras", "mavic_3e_wide", "--json"}));
  const auto& carrier = json.at("cameras").at(0).at("carrier");
  EXPECT_EQ(carrier.at("pitch_deg"), (std::vector<double>{-90, 35}));
  EXPECT_TRUE(carrier.at("roll_deg").is_null());
  EXPECT_EQ(carrier.at("rate_deg_s"), 100);
  EXPECT_EQ(carrier.at("dji_drone"), 77);
  EXPECT_EQ(carrier.at("dji_drone_sub_type"), 0);
  EXPECT_EQ(carrier.at("dji_payload"), 66);
  EXPECT_EQ(carrier.at("climb_m_s"), 6);
  EXPECT_EQ(carrier.at("speed_m_s"), 15);
}

TEST_F(CliCameras, ListsThoseOfAFile) {
  write("list.json", kList);
  expect_wording(output_of({"cameras", "list.json"}));
  const auto json = nlohmann::json::parse(output_of({"cameras", "list.json", "--json"})).at("cameras");
  ASSERT_EQ(json.size(), 3U);
  EXPECT_EQ(json[0].at("fov_deg").at(0), 90);
  EXPECT_EQ(json[0].at("focal_px"), 3000);
  EXPECT_TRUE(json[0].at("problem").is_null());
  EXPECT_TRUE(json[1].at("focal_px").is_null());
  EXPECT_TRUE(json[1].at("fov_deg").is_null());
  EXPECT_FALSE(json[1].at("problem").is_null());
  const std::string source = json[1].at("source");
  EXPECT_TRUE(source.ends_with(" 2")) << source;
  EXPECT_EQ(json[2].at("name"), "");
  EXPECT_TRUE(json[2].at("width_px").is_null());

  write("widths.json", R"({"Maker Model": 13.2, "Ältere Kamera": 6.17})");
  expect_wording(output_of({"cameras", "widths.json"}));
}

TEST_F(CliCameras, RefusesWhatIsNoList) {
  expect_bad({"cameras", "none.json"}, "none.json");
  expect_bad({"cameras", "city.obj"}, "city.obj, line 1");
  expect_bad({"cameras", "-"}, "-");
  expect_bad({"cameras", "a.json", "b.json"}, "command line");
}

TEST_F(CliCameras, ListsThoseWithAllWords) {
  const auto names = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "cameras");
    arguments.emplace_back("--json");
    std::vector<std::string> found;
    const auto json = nlohmann::json::parse(output_of(arguments));
    for (const auto& camera : json.at("cameras")) found.push_back(camera.at("name"));
    return found;
  };
  const std::vector<std::string> mavics = names({"mavic"});
  EXPECT_GE(mavics.size(), 7U);
  for (const std::string& name : mavics) EXPECT_EQ(name.find("dji_mavic_"), 0U) << name;
  EXPECT_EQ(names({"Thermal", "MAVIC"}), std::vector<std::string>{"dji_mavic_3t_thermal"});
  EXPECT_EQ(names({"Hasselblad", "Classic"}), std::vector<std::string>{"dji_mavic_3_classic"}) << "by the model";
  for (const std::string& name : names({"skydio"})) EXPECT_EQ(name.find("skydio_"), 0U) << name;
  EXPECT_EQ(lines(output_of({"cameras", "mavic"})).size(), mavics.size() + 1);

  write("list.json", kList);
  EXPECT_EQ(names({"list.json", "good"}), std::vector<std::string>{"Good 35mm"});
  EXPECT_EQ(names({"35MM", "list.json"}), std::vector<std::string>{"Good 35mm"});
  EXPECT_EQ(names({"27.4"}), std::vector<std::string>{"sentera_65r_27mm"}) << "a word with a dot";
  expect_bad({"cameras", "mavic", "submarine"}, "command line");
  write("plain_list", kList);
  EXPECT_EQ(names({"./plain_list", "good"}), std::vector<std::string>{"Good 35mm"});
  expect_bad({"cameras", "plain_list"}, "command line");
  expect_bad({"cameras", "list.json", "mavic"}, "list.json");
}

}  // namespace
}  // namespace vantage::testing
