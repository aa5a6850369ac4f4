// Real CityJSON files: what is read of them, compared with what their JSON says.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "geo/local_frame.h"
#include "support/mesh_reading.h"
#include "support/objects.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "vantage/scene.h"

namespace vantage {
namespace {

using nlohmann::json;
using testing::shared_data;

/// What a file holds, counted without the reader: all rings are borders in these files.
struct Counted {
  std::set<std::string> objects;
  std::size_t triangles = 0;
  double area = 0;  // in the file's coordinates
};

Vec3 position(const json& file, const json& index) {
  const json& vertex = file["vertices"][index.get<std::size_t>()];
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    p[axis] = vertex[axis].get<double>() * file["transform"]["scale"][axis].get<double>() +
              file["transform"]["translate"][axis].get<double>();
  }
  return p;
}

void count_rings(const json& file, const json& boundaries, const std::string& id, Counted& counted) {
  if (!boundaries[0].is_number()) {
    for (const json& part : boundaries) count_rings(file, part, id, counted);
    return;
  }
  std::vector<Vec3> ring;  // corners may come back later, but not at once
  for (const json& index : boundaries) {
    const Vec3 p = position(file, index);
    if (ring.empty() || p != ring.back()) ring.push_back(p);
  }
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) return;
  counted.objects.insert(id);
  counted.triangles += ring.size() - 2;
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) area += (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]) / 2;
  counted.area += area.norm();
}

Counted count(const json& file, const std::string& lod) {
  Counted counted;
  for (const auto& [id, object] : file["CityObjects"].items()) {
    for (const json& geometry : object.value("geometry", json::array())) {
      if (geometry["lod"] == lod) count_rings(file, geometry["boundaries"], id, counted);
    }
  }
  return counted;
}

json parse(const std::string& name) { return json::parse(std::ifstream(shared_data(name))); }

struct Case {
  const char* file;
  const char* lod;
  std::size_t objects;
};

class CityJsonFile : public ::testing::TestWithParam<Case> {};

TEST_P(CityJsonFile, HasTheObjectsAndSurfacesOfItsJson) {
  const Case& expected = GetParam();
  const std::string name = std::string("cityjson/") + expected.file;
  VANTAGE_REQUIRE_SHARED(name);
  const Counted counted = count(parse(name), expected.lod);
  SceneReadOptions options;
  options.lod = expected.lod;
  options.missing = MissingPolicy::warn;  // no stand-ins, of which shells that are not closed have some
  const Scene scene = read_scene(shared_data(name), options);
  EXPECT_EQ(scene.objects.size(), expected.objects);
  const std::vector<std::string> names = names_of(scene.objects);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()), counted.objects);
  EXPECT_EQ(scene.mesh.triangles.size(), counted.triangles);
  // Surfaces of real files are not quite flat, and maps not quite true: their areas differ a little.
  EXPECT_NEAR(surface_area(scene.mesh), counted.area, 2e-3 * counted.area);
}

INSTANTIATE_TEST_SUITE_P(All, CityJsonFile,
                         ::testing::Values(Case{"delft.city.json", "1", 570}, Case{"multi_lod.city.json", "1.2", 10},
                                           Case{"multi_lod.city.json", "1.3", 10},
                                           Case{"multi_lod.city.json", "2.2", 10},
                                           Case{"rotterdam_3-20-DELFSHAVEN.city.json", "2", 853},
                                           Case{"rotterdam_subset.city.json", "2", 16},
                                           Case{"twobuildings.city.json", "2", 2}));

TEST(CityJsonFiles, DelftLiesWhereItsMetadataSay) {
  VANTAGE_REQUIRE_SHARED("cityjson/delft.city.json");
  const json extent = parse("cityjson/delft.city.json")["metadata"]["geographicalExtent"];
  const Scene scene = read_scene(shared_data("cityjson/delft.city.json"));
  ASSERT_TRUE(scene.georeference);
  EXPECT_EQ(scene.georeference->vertical, "NAP height");
  EXPECT_EQ(scene.georeference->source_crs, "EPSG:7415");
  const geo::LocalFrame frame({scene.georeference->longitude_deg, scene.georeference->latitude_deg});
  const geo::CoordinateSystem rd("EPSG:28992", "test");
  Box box;
  for (const Vec3& vertex : scene.mesh.vertices) {
    const Eigen::Vector2d map = rd.from_lonlat(frame.to_lonlat(vertex.head<2>()));
    box.extend(Vec3(map.x(), map.y(), vertex.z()));
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(box.min[axis], extent[axis].get<double>(), 1e-3);
    EXPECT_NEAR(box.max[axis], extent[axis + 3].get<double>(), 1e-3);
  }
  EXPECT_LT(scene.mesh.vertices[0].head<2>().norm(), 400);
  EXPECT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].rfind("160 shells", 0), 0U) << scene.notes[0];
}

TEST(CityJsonFiles, TakesTheHighestLevelOfDetailUnlessAsked) {
  VANTAGE_REQUIRE_SHARED("cityjson/multi_lod.city.json");
  const auto file = shared_data("cityjson/multi_lod.city.json");
  const Scene highest = read_scene(file), asked = read_scene(file, {.lod = "2.2"}),
              two = read_scene(file, {.lod = "2"});
  EXPECT_EQ(highest.mesh.triangles, asked.mesh.triangles);
  EXPECT_EQ(highest.mesh.triangles, two.mesh.triangles);
  EXPECT_FALSE(highest.georeference);
  EXPECT_TRUE(highest.notes.empty());
  testing::expect_code([&] { read_scene(file, {.lod = "3"}); }, ErrorCode::level_of_detail_missing,
                       "multi_lod.city.json");
}

TEST(CityJsonFiles, SaysWhatIsInvalid) {
  const std::string name = "cityjson/twobuildings_invalid.city.json";
  VANTAGE_REQUIRE_SHARED(name);
  testing::expect_code([&] { read_scene(shared_data(name)); }, ErrorCode::mesh_syntax, "twobuildings_invalid");
}

TEST(CityJsonFiles, GoThroughEveryFormat) {
  VANTAGE_REQUIRE_SHARED("cityjson/delft.city.json");
  const testing::TemporaryDirectory directory;
  const Scene scene = read_scene(shared_data("cityjson/delft.city.json"));
  for (const char* name : {"a.obj", "a.glb"}) {
    write_scene(scene, directory / name);
    const Scene read = read_scene(directory / name);
    EXPECT_EQ(read.objects, scene.objects) << name;
    EXPECT_EQ(read.mesh.triangles.size(), scene.mesh.triangles.size()) << name;
    ASSERT_TRUE(read.georeference) << name;
    EXPECT_EQ(read.georeference->latitude_deg, scene.georeference->latitude_deg) << name;
    EXPECT_NEAR(surface_area(read.mesh), surface_area(scene.mesh), 1e-3) << name;
  }
}

}  // namespace
}  // namespace vantage
