// Numbers are read and written the same in every locale: a program that embeds the library may have called setlocale.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "common/input.h"
#include "common/json.h"
#include "depth/depth_request.h"
#include "io/mesh_readers.h"
#include "support/decimal_comma.h"
#include "support/internals.h"
#include "support/map_text.h"
#include "support/mesh_reading.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/city.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/result.h"
#include "verify/closed_mesh.h"

namespace vantage {
namespace {

using testing::DecimalComma;
using testing::write_bytes;

class LocaleTest : public ::testing::Test {
 protected:
  /// What `make` returns with a decimal point is what it returns with a comma.
  void expect_same(const std::function<std::string()>& make) {
    const DecimalComma& comma = DecimalComma::instance();
    if (!comma.is_available())
      GTEST_SKIP() << "no locale with a decimal comma is installed, nor can localedef make one";
    const std::string plain = make();
    comma.enter();
    char text[8];
    std::snprintf(text, sizeof text, "%.1f", 1.5);
    ASSERT_STREQ(text, "1,5");
    const std::string with_comma = make();
    DecimalComma::leave();
    EXPECT_NE(plain.find_first_of("0123456789"), std::string::npos) << plain;
    EXPECT_EQ(with_comma, plain);
  }

  void expect_same_error(ErrorCode code, const std::function<void()>& action) {
    expect_same([&]() -> std::string { return testing::expect_code(action, code).what(); });
  }

  testing::TemporaryDirectory folder_;
};

TEST_F(LocaleTest, BoundsOfOptions) {
  expect_same_error(ErrorCode::value_out_of_range, [] {
    CityOptions options;
    set_city_option(options, "levels", 1e-3, "here");
  });
}

TEST_F(LocaleTest, RangesOfDepthImages) {
  expect_same_error(ErrorCode::value_out_of_range, [] {
    depth::DepthRequest request;
    request.face_size = 1;
    request.range_m = -1.5;
    RenderDevice device;
    device.largest_face_size = 8;
    depth::check_request(request, device);
  });
}

TEST_F(LocaleTest, EdgesOfOpenMeshes) {
  Mesh mesh = testing::make_box_mesh({-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5});
  mesh.triangles.pop_back();
  expect_same_error(ErrorCode::mesh_not_closed, [&] { verify::ClosedMesh(mesh, Vec3::Zero(), "volume"); });
}

TEST_F(LocaleTest, LevelsOfDetail) {
  const std::string file = R"({"type": "CityJSON", "version": "1.1", "vertices": [[0, 0, 0], [4, 0, 0], [0, 4, 2]],
      "transform": {"scale": [0.5, 0.5, 0.5], "translate": [0, 0, 0]}, "CityObjects": {"a": {"type": "Building",
      "geometry": [{"type": "MultiSurface", "lod": "2.2", "boundaries": [[[0, 1, 2]]]}]}}})";
  expect_same_error(ErrorCode::level_of_detail_missing,
                    [&] { io::read_cityjson(io::MeshSource("a.city.json", file), {}, {}, "1.3"); });
  expect_same([&] {
    const io::RawMesh mesh = io::read_cityjson(io::MeshSource("a.city.json", file), {});
    EXPECT_EQ(mesh.vertices.at(2), Vec3(0, 2, 1));
    return shortest(mesh.vertices[1].x());
  });
}

TEST_F(LocaleTest, NumbersOfMeshes) {
  expect_same([] {
    const io::RawMesh mesh = testing::read_as("a.obj", "v 0.5 1.5e-400 1.5e-320\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(mesh.vertices[0], Vec3(0.5, 0, 1.5e-320));
    return shortest(mesh.vertices[0].x());
  });
}

TEST_F(LocaleTest, Maps) {
  testing::MapText map;
  map.box(0, 0, 40, 40, {{"building", "yes"}, {"height", "10.5"}});
  map.box(0, 0, 20, 40, {{"building:part", "yes"}, {"height", "30.5"}});
  map.line({{60, 0}, {80, 0}, {80, 20.5}, {60, 20.5}}, {{"building", "yes"}});
  map.area({{100, 0}, {120, 20}, {120, 0}, {100, 20.5}}, {{"building", "yes"}});
  write_bytes(folder_ / "city.osm", map.text());
  expect_same([&] {
    LoadedScene loaded;
    City city = build_city(folder_ / "city.osm", {});
    loaded.scene = std::move(city.scene);
    loaded.city = std::move(city.report);
    loaded.city->read_seconds = loaded.city->build_seconds = 0;
    return json_text(loaded);
  });
  expect_same_error(ErrorCode::region_outside, [&] {
    CityOptions options;
    options.region.center_deg = {47.5, 11.5};
    options.region.radius_m = 50.5;
    build_city(folder_ / "city.osm", options);
  });
}

TEST_F(LocaleTest, MissionsAndTheirVolumes) {
  testing::MapText map;
  map.box(10, 20, 30, 50, {{"building", "yes"}, {"height", "12.5"}});
  write_bytes(folder_ / "city.osm", map.text());
  write_bytes(folder_ / "mission.yaml",
              "scene: {osm: city.osm}\n"
              "target: {vertices: [[0.001, 0.001, 1.5], [0.0025, 0.001, 1.5], [0.001, 0.0025, 1.5]]}\n"
              "sensor: {max_range: 12.5}\n");
  expect_same([&] {
    const MissionFile file = read_mission(folder_ / "mission.yaml");
    const Mission mission = resolve_mission(file);
    Result result = run_mission(mission);
    std::string text = mission_text(file, folder_.path());
    const std::vector<Warning> warnings = mission_warnings(mission, &result.volume);
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(),
                            [](const Warning& w) { return w.code == WarningCode::target_in_degrees; }));
    for (const Warning& warning : warnings) text += warning.text + "\n";
    ResultRequest request;
    request.volumes = {folder_ / "volume.obj"};
    write_results(result.volume, request);
    return text + testing::read_bytes(folder_ / "volume.obj");
  });
}

}  // namespace
}  // namespace vantage
