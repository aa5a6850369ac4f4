// Volumes as 3D Tiles: where they lie, what their facets know, and that a folder is written whole or not at all.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "common/output.h"
#include "support/cli_fixture.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/georeference.h"
#include "vantage/tileset.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using nlohmann::json;
using testing::read_bytes;
using testing::SceneBuilder;
using testing::TemporaryDirectory;
using testing::write_bytes;

const Georeference kPlace{48.2, -11.5, "EGM96 geoid", "EPSG:4326", "somebody"};

/// Of a square between a tower and a shed.
Volume placed_volume() {
  const Scene scene = SceneBuilder()
                          .ground("ground", 60)
                          .box("shed", {4, 4, 0}, {8, 9, 5})
                          .box("tower \"é\"", {-20, -9, 0}, {-12, -4, 30});
  Target target = Target::polygon({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  target.name = "square";
  Navigation limits;
  limits.altitude = {2, 25};
  Volume volume = compute_volume(PreparedTarget(PreparedScene(scene), target, {40}), limits, {.tolerance_m = 0.5});
  volume.georeference = kPlace;
  return volume;
}

/// ECEF by the formulas of the ellipsoid WGS 84 (EPSG guidance note 7-2, 4.1.1).
Vec3 earth_centred(double longitude_deg, double latitude_deg, double height_m) {
  constexpr double kDegree = std::numbers::pi / 180, kA = 6378137, kF = 1 / 298.257223563, kE2 = kF * (2 - kF);
  const double lambda = longitude_deg * kDegree, phi = latitude_deg * kDegree;
  const double nu = kA / std::sqrt(1 - kE2 * std::sin(phi) * std::sin(phi));
  return {(nu + height_m) * std::cos(phi) * std::cos(lambda), (nu + height_m) * std::cos(phi) * std::sin(lambda),
          ((1 - kE2) * nu + height_m) * std::sin(phi)};
}

/// Of points of the scene frame, by PROJ.
std::vector<Vec3> on_earth(const Georeference& place, const std::vector<Vec3>& points) {
  std::vector<Eigen::Vector2d> plan;
  for (const Vec3& point : points) plan.emplace_back(point.head<2>());
  const std::vector<Eigen::Vector2d> lon_lat = positions_in_crs(place, "EPSG:4326", plan);
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.push_back(earth_centred(lon_lat[i].x(), lon_lat[i].y(), points[i].z()));
  }
  return result;
}

struct Facet {
  std::array<Vec3, 3> corners;  // ECEF
  std::string material;
  double feature = 0;
};

/// A tileset as a client has it.
struct Tileset {
  json tileset, gltf;
  std::string buffer;
  std::vector<Facet> facets;
  std::vector<Vec3> places;  // of all vertices, in the frame of the tile
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();

  explicit Tileset(const std::filesystem::path& folder) {
    tileset = json::parse(read_bytes(folder / "tileset.json"));
    const auto numbers = tileset.at("root").at("transform").get<std::vector<double>>();
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(numbers.data());
    const std::string glb = read_bytes(folder / "volume.glb");
    std::uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, sizeof(size));
    gltf = json::parse(glb.substr(20, size));
    buffer = glb.substr(28 + size);
    for (const json& mesh : gltf.at("meshes")) {
      for (const json& primitive : mesh.at("primitives")) add(primitive);
    }
  }

  template <typename Number>
  std::vector<Number> view(std::size_t index) const {
    const json& view = gltf.at("bufferViews").at(index);
    std::vector<Number> numbers(view.at("byteLength").get<std::size_t>() / sizeof(Number));
    std::memcpy(numbers.data(), buffer.data() + view.at("byteOffset").get<std::size_t>(),
                numbers.size() * sizeof(Number));
    return numbers;
  }
  template <typename Number>
  std::vector<Number> accessor(std::size_t index) const {
    return view<Number>(gltf.at("accessors").at(index).at("bufferView").get<std::size_t>());
  }

  void add(const json& primitive) {
    const json& attributes = primitive.at("attributes");
    const auto positions = accessor<float>(attributes.at("POSITION").get<std::size_t>());
    const auto features = accessor<float>(attributes.at("_FEATURE_ID_0").get<std::size_t>());
    ASSERT_EQ(positions.size(), 3 * features.size());
    const auto place = [&](std::size_t v) {  // y up to z up
      return Vec3(positions[3 * v], -positions[3 * v + 2], positions[3 * v + 1]);
    };
    for (std::size_t v = 0; v < features.size(); ++v) places.push_back(place(v));
    if (primitive.at("mode") != 4) return;
    const auto indices = accessor<std::uint32_t>(primitive.at("indices").get<std::size_t>());
    const std::string material = gltf.at("materials").at(primitive.at("material").get<std::size_t>()).at("name");
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      Facet facet{{}, material, features.at(indices[i])};
      for (std::size_t k = 0; k < 3; ++k) {
        facet.corners[k] = transform * place(indices[i + k]);
        EXPECT_EQ(features.at(indices[i + k]), facet.feature);
      }
      facets.push_back(facet);
    }
  }

  const json& table() const { return gltf.at("extensions").at("EXT_structural_metadata").at("propertyTables").at(0); }

  std::vector<std::string> texts(const std::string& property) const {
    const json& column = table().at("properties").at(property);
    const auto values = view<char>(column.at("values").get<std::size_t>());
    const auto offsets = view<std::uint32_t>(column.at("stringOffsets").get<std::size_t>());
    std::vector<std::string> result;
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
      result.emplace_back(values.data() + offsets[i], values.data() + offsets[i + 1]);
    }
    return result;
  }
};

double area_m2(const Facet& facet) {
  const auto& [a, b, c] = facet.corners;
  return (b - a).cross(c - a).norm() / 2;
}

TEST(WriteTiles, PutsEveryVertexOnTheGlobe) {
  const TemporaryDirectory directory;
  const Volume volume = placed_volume();
  ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  const WrittenVolume written = write_volume(volume, directory / "v.tiles");
  const Tileset tiles(directory / "v.tiles");
  ASSERT_EQ(tiles.facets.size(), written.facets + 2);  // and the target's two
  EXPECT_GT(written.rounding_m, 0);
  EXPECT_LT(written.rounding_m, 1e-5);
  const double allowed = written.rounding_m + 1e-8;  // numbers of 6.4e6 have steps of 1e-9
  const std::vector<Vec3> vertices = on_earth(kPlace, volume.mesh.vertices);
  // A file has its facets by kind, so that each of the volume's is looked for.
  std::set<std::size_t> met;
  for (std::size_t t = 0; t < volume.mesh.triangles.size(); ++t) {
    const auto corner = [&](std::size_t k) { return vertices[volume.mesh.triangles[t][k]]; };
    for (std::size_t f = 0; f < tiles.facets.size(); ++f) {
      const Facet& facet = tiles.facets[f];
      const bool is_same = (facet.corners[0] - corner(0)).norm() <= allowed &&
                           (facet.corners[1] - corner(1)).norm() <= allowed &&
                           (facet.corners[2] - corner(2)).norm() <= allowed;
      if (!is_same) continue;
      EXPECT_TRUE(met.insert(f).second);
      EXPECT_EQ(facet.feature, volume.cause_of[t]);
      EXPECT_EQ(facet.material, name_of(volume.causes[volume.cause_of[t]].kind));
    }
  }
  EXPECT_EQ(met.size(), volume.mesh.triangles.size());
}

TEST(WriteTiles, TheTableHasEachCauseAndTheTarget) {
  const TemporaryDirectory directory;
  const Volume volume = placed_volume();
  write_volume(volume, directory / "v.tiles");
  const Tileset tiles(directory / "v.tiles");
  const std::size_t count = volume.causes.size();
  const auto kinds = tiles.texts("kind"), names = tiles.texts("name");
  const json& area = tiles.table().at("properties").at("area_m2");
  const auto areas = tiles.view<double>(area.at("values").get<std::size_t>());
  ASSERT_EQ(tiles.table().at("count"), count + 1);
  ASSERT_EQ(kinds.size(), count + 1);
  ASSERT_EQ(names.size(), count + 1);
  ASSERT_EQ(areas.size(), count + 1);
  std::vector<double> sums(count + 1, 0.0);
  for (const Facet& facet : tiles.facets) sums.at(static_cast<std::size_t>(facet.feature)) += area_m2(facet);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(kinds[i], name_of(volume.causes[i].kind));
    EXPECT_EQ(names[i], volume.causes[i].name);
    EXPECT_EQ(areas[i], volume.causes[i].area_m2);
    EXPECT_NEAR(sums[i], areas[i], 1e-4 * areas[i]) << names[i];
  }
  EXPECT_EQ(kinds[count], "target");
  EXPECT_EQ(names[count], "square");
  EXPECT_NEAR(areas[count], 16, 1e-9);
  EXPECT_NEAR(sums[count], 16, 1e-3);
  double total = 0;
  for (std::size_t i = 0; i < count; ++i) total += areas[i];
  EXPECT_NEAR(total, measure(volume.mesh).area_m2, 1e-6 * total);
  const json& properties = tiles.gltf.at("extensions")
                               .at("EXT_structural_metadata")
                               .at("schema")
                               .at("classes")
                               .at(tiles.table().at("class").get<std::string>())
                               .at("properties");
  EXPECT_EQ(properties.at("area_m2").at("componentType"), "FLOAT64");
  EXPECT_EQ(tiles.gltf.at("asset").at("copyright"), "somebody");
}

TEST(WriteTiles, TheBoxHoldsAllOfIt) {
  const TemporaryDirectory directory;
  write_volume(placed_volume(), directory / "v.tiles");
  const Tileset tiles(directory / "v.tiles");
  const json& root = tiles.tileset.at("root");
  const auto box = root.at("boundingVolume").at("box").get<std::vector<double>>();
  ASSERT_EQ(box.size(), 12U);
  Vec3 largest = Vec3::Zero();
  for (const Vec3& place : tiles.places) {
    const Vec3 from_middle = (place - Vec3(box[0], box[1], box[2])).cwiseAbs();
    largest = largest.cwiseMax(from_middle);
    EXPECT_LE(from_middle.x(), box[3]);
    EXPECT_LE(from_middle.y(), box[7]);
    EXPECT_LE(from_middle.z(), box[11]);
  }
  EXPECT_NEAR(largest.x(), box[3], 1e-6);
  EXPECT_NEAR(largest.y(), box[7], 1e-6);
  EXPECT_NEAR(largest.z(), box[11], 1e-6);
  EXPECT_EQ(root.at("geometricError"), 0);
  EXPECT_NEAR(tiles.tileset.at("geometricError").get<double>(), 2 * Vec3(box[3], box[7], box[11]).norm(), 1e-6);
  EXPECT_EQ(tiles.tileset.at("asset").at("version"), "1.1");
}

TEST(WriteTiles, AFrameThatTouchesTheEarthIsTurnedAsAWhole) {
  const TemporaryDirectory directory;
  Volume volume = testing::make_dome({900, 0, 100}, 12, 4, [](double, double) { return 30.0; });
  volume.georeference = Georeference{48.2, -11.5, "ellipsoidal height", "EPSG:4978"};  // as tilesets are read
  write_volume(volume, directory / "v.tiles");
  const Tileset tiles(directory / "v.tiles");
  const Vec3 origin = earth_centred(-11.5, 48.2, 0);
  constexpr double kDegree = std::numbers::pi / 180;
  const double phi = 48.2 * kDegree, lambda = -11.5 * kDegree;
  const Vec3 east(-std::sin(lambda), std::cos(lambda), 0);
  const Vec3 up(std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi));
  const Vec3 centre = origin + 900 * east + 100 * up;  // of the dome, 6 cm above where a map has it
  double farthest = 0;
  for (const Vec3& place : tiles.places) farthest = std::max(farthest, (tiles.transform * place - centre).norm());
  EXPECT_NEAR(farthest, 30, 1e-4);
}

TEST(WriteTiles, APointIsAPoint) {
  const TemporaryDirectory directory;
  Volume volume = testing::make_dome({0, 0, 0}, 12, 4, [](double, double) { return 30.0; });
  volume.georeference = kPlace;
  volume.provenance.emplace();
  volume.provenance->target = Target::point({1, 2, 3});
  write_volume(volume, directory / "v.tiles");
  const Tileset tiles(directory / "v.tiles");
  const json& primitive = tiles.gltf.at("meshes").at(1).at("primitives").at(0);
  EXPECT_EQ(primitive.at("mode"), 0);
  EXPECT_FALSE(primitive.contains("indices"));
  EXPECT_LT((tiles.transform * tiles.places.back() - on_earth(kPlace, {{1, 2, 3}})[0]).norm(), 1e-5);
}

TEST(WriteTiles, TheReaderOfTilesetsFindsTheFacetsAtTheirPlace) {
  const TemporaryDirectory directory;
  Volume volume = placed_volume();
  volume.georeference->vertical = "ellipsoidal height";
  const WrittenVolume written = write_volume(volume, directory / "v.tiles");
  TilesetOptions options;
  options.center_deg = {kPlace.latitude_deg, kPlace.longitude_deg};
  options.radius_m = 500;
  const Scene scene = read_tileset(directory / "v.tiles/tileset.json", options).scene;
  EXPECT_EQ(scene.mesh.triangles.size(), written.facets + 2);
  EXPECT_EQ(scene.objects.size(), volume.causes.size() + 1);
  const Box box = bounding_box(scene.mesh), wanted = bounding_box(volume.mesh);
  EXPECT_NEAR(box.max.z(), wanted.max.z(), 1e-3);  // 0.1 mm lower at 40 m: that frame is not bent
  EXPECT_LT((box.min.head<2>() - wanted.min.head<2>()).norm(), 1e-3);
  EXPECT_LT((box.max.head<2>() - wanted.max.head<2>()).norm(), 1e-3);
}

TEST(WriteTiles, WithoutAPlaceItIsRefused) {
  const TemporaryDirectory directory;
  Volume volume = placed_volume();
  volume.georeference.reset();
  testing::expect_error([&] { write_volume(volume, directory / "v.tiles/"); }, ErrorCode::not_georeferenced, "v.tiles");
  EXPECT_TRUE(directory.names().empty());
}

/// All files below a folder and what they hold.
std::map<std::string, std::string> contents(const TemporaryDirectory& directory) {
  std::map<std::string, std::string> result;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory.path())) {
    result[entry.path().string()] = entry.is_regular_file() ? read_bytes(entry.path()) : "";
  }
  return result;
}

TEST(WriteTiles, ReplacesItsOwnFolder) {
  const TemporaryDirectory directory;
  Volume volume = placed_volume();
  std::filesystem::create_directory(directory / "v.tiles");  // an empty one may be replaced, too
  write_volume(volume, directory / "v.tiles/");
  const auto before = contents(directory);
  EXPECT_EQ(before.size(), 3U);
  volume.georeference->longitude_deg = 20;
  write_volume(volume, directory / "v.tiles");
  const auto after = contents(directory);
  EXPECT_EQ(after.size(), 3U);
  EXPECT_NE(after, before);
}

TEST(WriteTiles, AFailureKeepsTheOldFolder) {
  const TemporaryDirectory directory;
  const Volume volume = placed_volume();
  const std::filesystem::path folder = directory / "v.tiles";
  write_volume(volume, folder);
  std::vector<StagedVolume> staged;
  staged.push_back(stage_volume(volume, folder));
  write_bytes(folder / "notes.txt", "precious");  // while it was computed
  const auto with_notes = [&] {
    auto all = contents(directory);
    std::erase_if(all, [](const auto& file) { return file.first.find(".vantage-tiles-") != std::string::npos; });
    return all;
  };
  const auto before = with_notes();
  ASSERT_EQ(before.size(), 4U);
  testing::expect_error([&] { commit_volumes(std::move(staged)); }, ErrorCode::folder_in_use, "v.tiles");
  staged.clear();
  EXPECT_EQ(contents(directory), before) << "nothing is changed, and nothing is left";
  testing::expect_error([&] { write_volume(volume, folder); }, ErrorCode::folder_in_use, "v.tiles");
  testing::expect_error([&] { check_volume_output(folder); }, ErrorCode::folder_in_use, "v.tiles");
  EXPECT_EQ(contents(directory), before);
}

TEST(WriteTiles, OthersFoldersAreLeftAlone) {
  const TemporaryDirectory directory;
  const Volume volume = placed_volume();
  const std::filesystem::path folder = directory / "v.tiles";
  const auto refuse = [&](ErrorCode code) {
    const auto before = contents(directory);
    testing::expect_error([&] { write_volume(volume, folder); }, code, "v.tiles");
    EXPECT_EQ(contents(directory), before);
  };
  write_bytes(folder, "a file");
  refuse(ErrorCode::output_folder_missing);
  std::filesystem::remove(folder);
  std::filesystem::create_directory(folder);
  write_bytes(folder / "tileset.json", R"({"asset": {"version": "1.1"}, "geometricError": 1})");  // somebody's
  refuse(ErrorCode::folder_in_use);
  std::filesystem::remove(folder / "tileset.json");
  write_volume(volume, folder);
  write_bytes(folder / "volume.glb", "glTF of somebody");
  refuse(ErrorCode::folder_in_use);
  std::filesystem::remove(folder / "volume.glb");
  std::filesystem::create_directory(folder / "volume.glb");
  refuse(ErrorCode::folder_in_use);
  testing::expect_error([&] { write_volume(volume, directory / "none/v.tiles"); }, ErrorCode::output_folder_missing);
}

TEST(WriteTiles, ALinkToAFolderStaysOne) {
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory / "there");
  std::filesystem::create_directory_symlink("there", directory / "v.tiles");
  write_volume(placed_volume(), directory / "v.tiles");
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "v.tiles"));
  EXPECT_TRUE(std::filesystem::exists(directory / "there/tileset.json"));
}

using testing::Cli;

TEST_F(Cli, ComputesATilesetWithItsReportBesideIt) {
  write("block.yaml",
        "scene: {osm: block.osm, center: [48, 11], radius: 100}\n" + std::string(testing::kTarget) + testing::kSensor);
  write("block.osm",
        "<osm version=\"0.6\"><node id=\"1\" lat=\"48.0002\" lon=\"11.0002\"/><node id=\"2\" lat=\"48.0002\" "
        "lon=\"11.0004\"/><node id=\"3\" lat=\"48.0004\" lon=\"11.0004\"/><way id=\"7\"><nd ref=\"1\"/><nd ref=\"2\"/>"
        "<nd ref=\"3\"/><nd ref=\"1\"/><tag k=\"building\" v=\"yes\"/></way></osm>\n");
  const testing::ProgramRun run = this->run({"compute", "block.yaml", "-o", "new.tiles/"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  testing::expect_wording(run.err);  // what z is taken as
  EXPECT_EQ(files().count((folder_ / "new.tiles/tileset.json").string()), 1U);
  EXPECT_EQ(files().count((folder_ / "new.tiles/volume.glb").string()), 1U);
  EXPECT_EQ(files().count((folder_ / "new.report.json").string()), 1U);
}

TEST_F(Cli, ATilesetNeedsAPlace) { expect_bad({"compute", "mission.yaml", "-o", "new.tiles"}, "new.tiles"); }

}  // namespace
}  // namespace vantage
