// KML and KMZ of volumes: where corners lie, what is in which folder, and what is refused.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/output.h"
#include "geo/ellipsoid.h"
#include "io/zip.h"
#include "support/internals.h"
#include "support/scenes.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/georeference.h"
#include "vantage/volume.h"

namespace vantage::testing {
namespace {

constexpr double kSeaLevelZM = -512.25;

Georeference munich() { return {48.1374, 11.5755, kFlatGround, "", "\u00a9 <somebody>"}; }

/// Of a square in a yard: with facets of the scene, of the range, of the target's plane and of navigation.
Volume volume_in_yard() {
  SceneBuilder builder;
  builder.ground("ground", 200, -0.5);
  builder.box("shed & <barn>\uFFFE\uFFFF", {6, -3, -0.5}, {9, 3, 8});
  Target square = Target::polygon({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  square.name = "square \"A\"";
  Navigation limits;
  limits.altitude = {-10, 20};
  Volume volume = compute_volume(PreparedTarget(PreparedScene(builder.scene()), square, {.max_range_m = 30}), limits,
                                 {.tolerance_m = 0.5});
  volume.georeference = munich();
  return volume;
}

std::string kml_of(const Volume& volume, std::optional<double> sea_level_z_m = kSeaLevelZM) {
  const TemporaryDirectory folder;
  const StagedVolume staged = stage_volume(volume, folder / "v.kml", UpAxis::z, 1, sea_level_z_m);
  commit_all(staged.files);
  return read_bytes(folder / "v.kml");
}

/// What stands between each `begin` and the next `end`.
std::vector<std::string> parts(const std::string& text, const std::string& begin, const std::string& end) {
  std::vector<std::string> found;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    at += begin.size();
    const std::size_t to = text.find(end, at);
    if (to == std::string::npos) break;
    found.push_back(text.substr(at, to - at));
  }
  return found;
}

/// Longitude, latitude and altitude of each corner of each ring.
std::vector<std::vector<Vec3>> rings(const std::string& kml) {
  std::vector<std::vector<Vec3>> rings;
  for (const std::string& text : parts(kml, "<LinearRing><coordinates>", "</coordinates>")) {
    std::vector<Vec3>& ring = rings.emplace_back();
    const char* at = text.c_str();
    while (*at != '\0') {
      Vec3 corner;
      for (int axis = 0; axis < 3; ++axis) {
        char* next = nullptr;
        corner[axis] = std::strtod(at, &next);
        at = *next == ',' || *next == ' ' ? next + 1 : next;
      }
      ring.push_back(corner);
    }
  }
  return rings;
}

/// Of the volume without its targets: a triangle for each ring, in the scene frame. Corners with the same numbers are
/// the same vertex.
Mesh mesh_of(const std::string& kml) {
  Mesh mesh;
  std::map<std::array<double, 3>, std::uint32_t> number;
  for (const std::vector<Vec3>& ring : rings(kml.substr(0, kml.find("<Folder><name>target</name>")))) {
    EXPECT_EQ(ring.size(), 4U);
    EXPECT_EQ(ring.front(), ring.back());
    Triangle& triangle = mesh.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [found, is_new] =
          number.try_emplace({ring[i].x(), ring[i].y(), ring[i].z()}, static_cast<std::uint32_t>(number.size()));
      triangle[i] = found->second;
      if (!is_new) continue;
      const Eigen::Vector2d at = scene_position(munich(), ring[i].x(), ring[i].y());
      mesh.vertices.push_back({at.x(), at.y(), ring[i].z() + kSeaLevelZM});
    }
  }
  return mesh;
}

TEST(WriteKml, HoldsTheMesh) {
  const Volume volume = volume_in_yard();
  ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  const Mesh read = mesh_of(kml_of(volume));
  const MeshMeasures before = measure(volume.mesh), after = measure(read);
  EXPECT_EQ(after.facets, before.facets);
  EXPECT_TRUE(after.closed && after.oriented);
  EXPECT_NEAR(after.volume_m3, before.volume_m3, 1e-5 * before.area_m2);
  EXPECT_NEAR(after.area_m2, before.area_m2, 1e-3);
}

TEST(WriteKml, MovesNoCornerByMoreThanItStates) {
  Volume volume = volume_in_yard();
  volume.mesh.vertices = {{0, 0, 0}, {1.0 / 3, 2000.123456789, 7}, {-1999.7654321, 1e-7, 30.1}, {5, 5, 99.9999999}};
  volume.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  volume.cause_of = {0, 0, 0, 0};
  volume.polygon_of.clear();
  const TemporaryDirectory folder;
  const StagedVolume staged = stage_volume(volume, folder / "v.kml", UpAxis::z, 1, kSeaLevelZM);
  EXPECT_EQ(staged.report.rounding_m, 1e-6);
  commit_all(staged.files);
  const Mesh read = mesh_of(read_bytes(folder / "v.kml"));
  ASSERT_EQ(read.vertices.size(), 4U);
  for (std::size_t t = 0; t < 4; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& written = volume.mesh.vertices[volume.mesh.triangles[t][i]];
      EXPECT_LE((read.vertices[read.triangles[t][i]] - written).norm(), 1e-6);
    }
  }
}

TEST(WriteKml, SortsFacetsByTheirCauses) {
  const Volume volume = volume_in_yard();
  const std::string kml = kml_of(volume);
  std::vector<std::string> kinds = parts(kml, "<Folder><name>", "</name>");
  EXPECT_EQ(kinds, (std::vector<std::string>{"scene", "range", "target_plane", "navigation", "target"}));
  std::size_t placemarks = parts(kml, "<Placemark>", "</Placemark>").size(), causes = volume.causes.size();
  EXPECT_EQ(placemarks, causes + 1) << "and the target";
  for (const std::string& used : parts(kml, "<styleUrl>#", "</styleUrl>")) {
    EXPECT_NE(kml.find("<Style id=\"" + used + "\">"), std::string::npos) << used;
  }
  EXPECT_NE(kml.find("<name>shed &amp; &lt;barn&gt;  </name>"), std::string::npos);
  EXPECT_NE(kml.find("\u00a9 &lt;somebody&gt;"), std::string::npos);
  EXPECT_EQ(parts(kml, "<altitudeMode>", "</altitudeMode>"),
            std::vector<std::string>(volume.mesh.triangles.size() + 1, "absolute"));
}

TEST(WriteKml, HoldsTheTarget) {
  const std::string kml = kml_of(volume_in_yard());
  const std::vector<std::vector<Vec3>> all = rings(kml.substr(kml.find("<Folder><name>target</name>")));
  ASSERT_EQ(all.size(), 1U);
  ASSERT_EQ(all[0].size(), 5U);
  const Eigen::Vector2d corner = scene_position(munich(), all[0][2].x(), all[0][2].y());
  EXPECT_NEAR(corner.x(), 2, 1e-6);
  EXPECT_NEAR(corner.y(), 2, 1e-6);
  EXPECT_NEAR(all[0][2].z(), -kSeaLevelZM, 1e-6);
  Volume raised = volume_in_yard();
  raised.provenance->target.offset_m = 0.75;
  const std::string higher = kml_of(raised);
  EXPECT_NEAR(rings(higher.substr(higher.find("<Folder><name>target</name>")))[0][2].z(), 0.75 - kSeaLevelZM, 1e-6);
  Volume of_point = volume_in_yard();
  of_point.provenance->target.parts = {{{1, 2, 3}}};
  EXPECT_EQ(parts(kml_of(of_point), "<Point>", "</Point>").size(), 1U);
  of_point.provenance.reset();
  EXPECT_EQ(kml_of(of_point).find("<Folder><name>target</name>"), std::string::npos);
}

TEST(WriteKml, HeightsAboveAGeoidNeedNoSeaLevel) {
  Volume volume = volume_in_yard();
  volume.georeference->vertical = "EGM96 geoid";
  EXPECT_EQ(kml_of(volume, std::nullopt), kml_of(volume, 0));
  EXPECT_NE(kml_of(volume, 1), kml_of(volume, 0));
}

// The frame of a scene of 3D Tiles touches the ellipsoid: what is level in it rises above the sea.
TEST(WriteKml, FramesOfTilesetsTouchTheEarth) {
  Volume volume = volume_in_yard();
  volume.mesh.vertices = {{0, 0, 0}, {5000, 0, 0}, {0, 5000, 0}, {0, 0, 100}};
  volume.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  volume.cause_of = {0, 0, 0, 0};
  volume.polygon_of.clear();
  volume.georeference->source_crs = internal::geo::kEarthCentred;
  volume.georeference->vertical = internal::geo::kEllipsoidalHeight;
  const std::vector<Vec3> ring = rings(kml_of(volume, 0)).front();
  EXPECT_NEAR(ring[0].z(), 0, 2e-6);
  for (const std::size_t i : {1U, 2U}) EXPECT_NEAR(ring[i].z(), 5000.0 * 5000 / (2 * 6.375e6), 0.01);
}

TEST(WriteKml, RefusesWhatCannotBePlaced) {
  const TemporaryDirectory folder;
  write_bytes(folder / "v.kml", "old");
  Volume volume = volume_in_yard();
  const auto write = [&] { write_volume(volume, folder / "v.kml"); };
  for (const char* vertical :
       {kFlatGround, "", "ellipsoidal height", "as in dem.tif", "WGS84 Ellipsoid height", "Unknown"}) {
    volume.georeference->vertical = vertical;
    expect_code(write, ErrorCode::height_unknown, "v.kml");
  }
  volume.georeference.reset();
  expect_code(write, ErrorCode::not_georeferenced, "v.kml");
  expect_code([&] { check_volume_place({"a.ply", folder / "v.kml"}, {}, 0); }, ErrorCode::not_georeferenced, "v.kml");
  EXPECT_NO_THROW(check_volume_place({"a.ply", "a.glb"}, {}, {}));
  const Scene scene = SceneBuilder().ground("ground", 9, 0);
  expect_code([&] { write_scene(scene, folder / "v.kml"); }, ErrorCode::output_format_unknown, "v.kml");
  expect_code([&] { check_scene_output(folder / "v.kmz"); }, ErrorCode::output_format_unknown, "v.kmz");
  EXPECT_EQ(read_bytes(folder / "v.kml"), "old");
}

TEST(WriteKml, IsKnownAsOwn) {
  const TemporaryDirectory folder;
  Volume volume = volume_in_yard();
  volume.georeference->vertical = "EGM96 geoid";
  for (const char* name : {"v.kml", "v.kmz"}) {
    write_volume(volume, folder / name);
    EXPECT_NO_THROW(check_derived_output(folder / name)) << name;
  }
  EXPECT_EQ(internal::io::unzipped(read_bytes(folder / "v.kmz"), "doc.kml", ".none", 10'000'000),
            read_bytes(folder / "v.kml"));
  const std::string kml = read_bytes(folder / "v.kml");
  write_bytes(folder / "w.kml", "<?xml version=\"1.0\"?>\n" + kml.substr(kml.find("<kml")));
  write_bytes(folder / "w.kmz", read_bytes(folder / "v.kmz").substr(0, 45));
  for (const char* name : {"w.kml", "w.kmz"}) {
    expect_code([&] { check_derived_output(folder / name); }, ErrorCode::output_of_others, name);
  }
}

}  // namespace
}  // namespace vantage::testing
