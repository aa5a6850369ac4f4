// Maps where longitudes break: across the antimeridian, and round the poles. The same map there as on the equator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/solid_check.h"
#include "support/map_text.h"
#include "support/raster_writer.h"
#include "support/temporary_directory.h"
#include "vantage/city.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage {
namespace {

using geo::LonLat;
using testing::MapText;
using testing::TemporaryDirectory;
using testing::write_bytes;

/// Houses on all sides of the origin, one of them round it with a court, an L across the axes, a wall, a bridge, a tree
/// and a square to look at.
MapText district(LonLat origin) {
  MapText map(origin);
  const MapText::TagList house = {{"building", "yes"}, {"height", "9"}};
  for (const double x : {-300.0, -40.0, 60.0, 280.0}) {
    for (const double y : {-310.0, -50.0, 70.0, 290.0}) map.box(x, y, x + 20, y + 14, house);
  }
  // A U whose arms reach across the seam: in longitude and latitude its sides would cross each other.
  map.area({{-90, -20}, {-30, -20}, {-30, 20}, {-90, 20}, {-90, 12}, {-38, 12}, {-38, -12}, {-90, -12}}, house);
  map.area({{30, -150}, {-30, -150}, {-30, -190}, {30, -190}, {30, -182}, {-22, -182}, {-22, -158}, {30, -158}}, house);
  map.area({{-150, 30}, {-150, -30}, {-190, -30}, {-190, 30}, {-182, 30}, {-182, -22}, {-158, -22}, {-158, 30}}, house);
  const long outer = map.box(-15, -15, 15, 15, {}), inner = map.box(-8, -8, 8, 8, {});
  map.relation({{"way", outer, "outer"}, {"way", inner, "inner"}},
               {{"type", "multipolygon"}, {"building", "yes"}, {"height", "12"}, {"name", "Court"}});
  map.line({{-60, 100}, {60, 110}}, {{"barrier", "wall"}, {"height", "3"}});
  map.line({{100, -60}, {110, 60}}, {{"barrier", "wall"}, {"height", "3"}});
  map.line({{-70, 150}, {70, 150}}, {{"highway", "primary"}, {"bridge", "yes"}});
  map.node(0, 25, {{"natural", "tree"}});
  map.box(-6, -6, 6, 6, {{"leisure", "park"}, {"name", "Square"}});
  return map;
}

struct Seam {
  std::string name;
  LonLat origin;
};

const std::vector<Seam> kSeams = {{"antimeridian", {180, 12.5}},
                                  {"a little west of it", {179.9998, -17.3}},
                                  {"a little east", {-179.9995, 62}},
                                  {"north pole", {0, 90}},
                                  {"south pole", {0, -90}},
                                  {"near a pole", {123, -89.999}},
                                  {"farther from it", {-179.999, 89.9}}};

class CitySeams : public ::testing::Test {
 protected:
  City build(LonLat origin, const CityOptions& options = {}) {
    write_bytes(folder_ / "city.osm", district(origin).text());
    return build_city(folder_ / "city.osm", options);
  }

  TemporaryDirectory folder_;
};

double volume_of(const Scene& scene, std::size_t object) {
  Mesh mesh;
  mesh.vertices = scene.mesh.vertices;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    if (scene.object_of[i] == object) mesh.triangles.push_back(scene.mesh.triangles[i]);
  }
  return enclosed_volume(core::checked_solid(mesh, display_name(scene.objects[object])));
}

/// The same objects, as large, and as far apart; the file holds positions to 1e-7 degrees.
void expect_same(const City& city, const City& plain) {
  ASSERT_EQ(city.report.records.size(), plain.report.records.size());
  for (std::size_t i = 0; i < plain.report.records.size(); ++i) {
    const CityRecord &record = city.report.records[i], &wanted = plain.report.records[i];
    EXPECT_EQ(record.object.source_id, wanted.object.source_id);
    EXPECT_NEAR(record.footprint_m2, wanted.footprint_m2, 1 + 0.01 * wanted.footprint_m2) << record.object.source_id;
  }
  EXPECT_EQ(city.report.passed_over.size(), plain.report.passed_over.size());
  EXPECT_EQ(city.scene.ledger.size(), plain.scene.ledger.size());
  ASSERT_EQ(city.scene.objects, plain.scene.objects);
  for (std::size_t i = 0; i < plain.scene.objects.size(); ++i) {
    if (plain.scene.objects[i].kind == ObjectKind::ground) continue;
    const double volume = volume_of(plain.scene, i);
    EXPECT_NEAR(volume_of(city.scene, i), volume, 1 + 0.01 * volume) << display_name(plain.scene.objects[i]);
  }
}

TEST_F(CitySeams, AMapIsTheSameWhereLongitudesBreak) {
  CityOptions options;
  options.region.radius_m = 1000;
  options.region.center_deg = {0.5, 11.5};
  const City plain = build({11.5, 0.5}, options);
  ASSERT_TRUE(plain.report.passed_over.empty());
  for (const Seam& seam : kSeams) {
    SCOPED_TRACE(seam.name);
    options.region.center_deg = {seam.origin.latitude_deg, seam.origin.longitude_deg};
    expect_same(build(seam.origin, options), plain);
    const City whole = build(seam.origin);  // the origin found in the file
    expect_same(whole, plain);
    const geo::LocalFrame frame(seam.origin);
    const Georeference& place = whole.report.georeference;
    const Eigen::Vector2d middle = frame.to_local({place.longitude_deg, place.latitude_deg});
    EXPECT_LT(middle.norm(), 60) << middle.transpose();
  }
}

TEST_F(CitySeams, ARegionHoldsWhatItHoldsElsewhere) {
  for (const double radius : {12.0, 40.0, 170.0}) {
    CityOptions options;
    options.region.radius_m = radius;
    options.region.center_deg = {0.5, 11.5};
    const City plain = build({11.5, 0.5}, options);
    ASSERT_GT(plain.report.outside, 0u);
    for (const Seam& seam : kSeams) {
      SCOPED_TRACE(seam.name);
      options.region.center_deg = {seam.origin.latitude_deg, seam.origin.longitude_deg};
      const City city = build(seam.origin, options);
      expect_same(city, plain);
      EXPECT_EQ(city.report.outside, plain.report.outside);
    }
  }
}

TEST_F(CitySeams, AnAreaRoundTheCentreBelongsToTheRegion) {
  for (const Seam& seam : kSeams) {
    SCOPED_TRACE(seam.name);
    MapText map(seam.origin);
    map.box(-40, -30, 50, 60, {{"building", "yes"}, {"height", "9"}});
    map.box(60, 30, 90, 60, {{"building", "yes"}, {"height", "9"}});
    map.box(-90, -60, -60, 60, {{"building", "yes"}, {"height", "9"}});
    write_bytes(folder_ / "city.osm", map.text());
    CityOptions options;
    options.region.center_deg = {seam.origin.latitude_deg, seam.origin.longitude_deg};
    options.region.radius_m = 5;
    const City city = build_city(folder_ / "city.osm", options);
    ASSERT_EQ(city.report.records.size(), 1u);
    EXPECT_EQ(city.report.records[0].object.source_id, "way/1");
    EXPECT_NEAR(city.report.records[0].footprint_m2, 8100, 5);
  }
}

TEST_F(CitySeams, ABoxMayCrossTheAntimeridianOrLieRoundAPole) {
  CityOptions options;
  const double half = 0.0012;  // degrees: 133 m
  options.region.bbox_deg = {11.5 - half, -half, 11.5 + half, half};
  const City plain = build({11.5, 0}, options);
  options.region.bbox_deg = {180 - half, -half, -180 + half, half};
  const City city = build({180, 0}, options);
  expect_same(city, plain);
  EXPECT_EQ(city.report.outside, plain.report.outside);
  EXPECT_NEAR(std::abs(city.report.georeference.longitude_deg), 180, 1e-9);
  EXPECT_GT(city.report.bounds_deg[0], 179);
  EXPECT_LT(city.report.bounds_deg[2], -179);
  options.region.bbox_deg = {-180, 89.9988, 180, 90};
  const City polar = build({0, 90}, options);
  EXPECT_EQ(polar.report.georeference.latitude_deg, 90);
  EXPECT_GE(polar.report.records.size(), 8u);
  EXPECT_GT(polar.report.outside, 5u);

  options.region.bbox_deg = {11.6, -half, 11.4, half};  // its ends mixed up
  EXPECT_THROW(build({11.5, 0}, options), Error);
  options.region.bbox_deg = {-180, 60, 180, 60.1};  // as large as the earth
  EXPECT_THROW(build({11.5, 60.05}, options), Error);
}

TEST_F(CitySeams, TerrainGoesOnAcrossTheAntimeridian) {
  const LonLat origin{180, 12.5};
  const geo::LocalFrame frame(origin);
  testing::TestRaster raster = testing::make_raster(36000, 12, [&](int column, int row) {
    const double longitude = -180 + (column + 0.5) * 0.01, latitude = 12.56 - (row + 0.5) * 0.01;
    return std::abs(longitude) < 179 ? 0 : 400 + 0.1 * frame.to_local({longitude, latitude}).x();
  });
  raster.srs = "EPSG:4326";
  raster.transform = {-180, 0.01, 0, 12.56, 0, -0.01};
  CityOptions options;
  options.terrain = testing::write_raster(folder_.path(), "world", raster);
  const City city = build(origin, options);
  const LonLat middle{city.report.georeference.longitude_deg, city.report.georeference.latitude_deg};
  ASSERT_LT(geo::geodesic_m(origin, middle), 60);
  Box ground;
  for (const Vec3& vertex : city.scene.mesh.vertices) ground.extend(vertex);
  EXPECT_NEAR(ground.min.z(), 400 + 0.1 * (ground.min.x() + frame.to_local(middle).x()), 0.6);
  EXPECT_EQ(city.report.records.size(), build(origin).report.records.size());
}

TEST_F(CitySeams, SaysThatARegionLiesOutside) {
  CityOptions options;
  options.region.radius_m = 500;
  for (const auto& [latitude, longitude] : std::vector<std::array<double, 2>>{{12.5, 0}, {12.5, 90}, {12.5, -179}}) {
    options.region.center_deg = {latitude, longitude};
    EXPECT_THROW(build({180, 12.5}, options), Error) << longitude;
  }
}

TEST_F(CitySeams, AMissionIsComputedThere) {
  std::vector<double> volumes;
  for (const LonLat origin : {LonLat{11.5, 0.5}, LonLat{180, 12.5}, LonLat{0, 90}, LonLat{0, -90}}) {
    write_bytes(folder_ / "city.osm", district(origin).text());
    write_bytes(folder_ / "mission.yaml",
                "scene: {osm: city.osm, without: [trees]}\n"
                "target: {osm: way/25}\n"
                "sensor: {max_range: 40}\nmethod: exact\n");
    const Volume volume = run_mission(resolve_mission(read_mission(folder_ / "mission.yaml"))).volume;
    ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
    EXPECT_TRUE(volume.notes.empty()) << volume.notes.front().text;
    volumes.push_back(measure(volume.mesh).volume_m3);
    EXPECT_NEAR(volumes.back(), volumes.front(), 0.01 * volumes.front());
  }
}

}  // namespace
}  // namespace vantage
