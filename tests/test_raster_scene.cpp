#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "core/stopwatch.h"
#include "geo/local_frame.h"
#include "maps/terrain/height_grid.h"
#include "maps/terrain/triangulate.h"
#include "support/internals.h"
#include "support/objects.h"
#include "support/raster_writer.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/ground.h"

namespace vantage {
namespace {

using testing::make_raster;
using testing::TestRaster;
using testing::write_raster;

double area(const Mesh& mesh, const Triangle& t) {
  const Vec3 b = mesh.vertices[t[1]] - mesh.vertices[t[0]], c = mesh.vertices[t[2]] - mesh.vertices[t[0]];
  return (b.x() * c.y() - b.y() * c.x()) / 2;
}

double flat_area(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    EXPECT_GT(area(mesh, t), 0);  // upwards
    sum += area(mesh, t);
  }
  return sum;
}

double block(int column, int row) {  // a house of 8 x 6 posts on a slope
  return 0.1 * column + (column > 9 && column < 18 && row > 11 && row < 18 ? 20 : 0);
}

TEST(RasterScene, KeepsEveryPostWhenNoErrorIsAllowed) {
  const testing::TemporaryDirectory folder;
  const auto file = write_raster(folder.path(), "dsm", make_raster(30, 25, block));
  RasterOptions options;
  options.max_error_m = 0;
  const RasterScene result = scene_from_raster(file, options);
  const Mesh& mesh = result.scene.mesh;
  ASSERT_EQ(mesh.vertices.size(), 30u * 25u);
  EXPECT_EQ(mesh.triangles.size(), 2u * 29 * 24);
  EXPECT_NEAR(flat_area(mesh), 290 * 240, 0.01 * 290 * 240);  // the scale of UTM, 0.9996, squared
  EXPECT_EQ(result.report.columns, 30u);
  EXPECT_EQ(result.report.rows, 25u);
  EXPECT_EQ(result.report.largest_error_m, 0);
  EXPECT_EQ(result.report.lowest_m, 0);
  EXPECT_FLOAT_EQ(static_cast<float>(result.report.highest_m), 21.7f);
  EXPECT_EQ(names_of(result.scene.objects), std::vector<std::string>{"surface"});
  EXPECT_EQ(result.scene.object_of, std::vector<std::uint32_t>(mesh.triangles.size(), 0));
  EXPECT_EQ(result.scene.source, file);

  // Each post where its coordinates put it, in the frame of the middle.
  ASSERT_TRUE(result.scene.georeference);
  const Georeference& place = *result.scene.georeference;
  testing::expect_wording(place.vertical);
  EXPECT_EQ(place.source_crs, "EPSG:32632");
  const geo::LocalFrame frame({place.longitude_deg, place.latitude_deg});
  const geo::CoordinateSystem utm("EPSG:32632", "test");
  for (int row = 0; row < 25; ++row) {
    for (int column = 0; column < 30; ++column) {
      const Vec3& vertex = mesh.vertices[static_cast<std::size_t>(row) * 30 + static_cast<std::size_t>(column)];
      const Eigen::Vector2d expected = frame.to_local(utm.to_lonlat({500005 + 10 * column, 4999995 - 10 * row}));
      EXPECT_LT((vertex.head<2>() - expected).norm(), 1e-4);
      EXPECT_NEAR(vertex.z(), block(column, row), 1e-5);
    }
  }
  const Box box = bounding_box(mesh);
  EXPECT_NEAR((box.min + box.max).head<2>().norm(), 0, 1);  // the origin is in the middle
}

TEST(RasterScene, StaysWithinTheErrorUpToTheOutermostPosts) {
  const testing::TemporaryDirectory folder;
  for (const bool north : {false, true}) {
    TestRaster raster = make_raster(60, 50, [](int c, int r) { return 9 * std::sin(c / 7.0) * std::cos(r / 5.0); });
    raster.srs = "EPSG:4326";  // its border is curved in the frame
    raster.transform = {7, 0.001, 0, 60, 0, north ? 0.001 : -0.001};
    const auto file = write_raster(folder.path(), "dsm", raster);
    RasterOptions all;
    all.max_error_m = 0;
    const RasterScene every = scene_from_raster(file, all);
    for (const double error_m : {0.05, 0.25, 3.0}) {
      RasterOptions options;
      options.max_error_m = error_m;
      const RasterScene few = scene_from_raster(file, options);
      EXPECT_NEAR(flat_area(few.scene.mesh), flat_area(every.scene.mesh), 1e-6 * flat_area(every.scene.mesh));
      EXPECT_LT(few.scene.mesh.triangles.size(), every.scene.mesh.triangles.size());
      EXPECT_LE(few.report.largest_error_m, error_m + 1e-6);
      EXPECT_EQ(few.scene.object_of.size(), few.scene.mesh.triangles.size());
      const terrain::TriangulatedTerrain surface(few.scene.mesh);
      double worst_m = 0;
      for (const Vec3& post : every.scene.mesh.vertices) {
        const auto height = surface.height(post.head<2>());
        ASSERT_TRUE(height) << post.transpose();
        worst_m = std::max(worst_m, std::abs(*height - post.z()));
      }
        ASSERT_GE(*height, post.z() - 1e-8) << post.transpose();  // what it leaves out hides nothing less
      EXPECT_NEAR(worst_m, few.report.largest_error_m, 1e-9);
    }
  }
}

TEST(RasterScene, TakesPartsOfARaster) {
  const testing::TemporaryDirectory folder;
  const auto file = write_raster(folder.path(), "dsm", make_raster(100, 80, block));
  const geo::CoordinateSystem utm("EPSG:32632", "test");
  const geo::LonLat middle = utm.to_lonlat({500500, 4999600});

  RasterOptions circle;
  circle.region.center_deg = {middle.latitude_deg, middle.longitude_deg};
  circle.region.radius_m = 150;
  circle.origin_deg = circle.region.center_deg;
  const RasterScene round = scene_from_raster(file, circle);
  EXPECT_EQ(round.scene.georeference->latitude_deg, middle.latitude_deg);
  const Box box = bounding_box(round.scene.mesh);
  EXPECT_LE(box.min.head<2>().maxCoeff(), -150);  // covers what was asked for, and little more
  EXPECT_GE(box.min.head<2>().minCoeff(), -185);
  EXPECT_GE(box.max.head<2>().minCoeff(), 150);
  EXPECT_LE(box.max.head<2>().maxCoeff(), 185);

  RasterOptions degrees;
  degrees.region.bbox_deg = {middle.longitude_deg - 0.001, middle.latitude_deg - 0.001, middle.longitude_deg + 0.001,
                             middle.latitude_deg + 0.001};
  const Box in_degrees = bounding_box(scene_from_raster(file, degrees).scene.mesh);
  EXPECT_NEAR(in_degrees.max.y() - in_degrees.min.y(), 222 + 50, 25);

  RasterOptions pixels;
  pixels.region.pixels = {5, 6, 20, 10};
  EXPECT_EQ(scene_from_raster(file, pixels).report.columns, 20u);
}

TEST(RasterScene, RefusesWhatMakesNoScene) {
  const testing::TemporaryDirectory folder;
  const auto file = write_raster(folder.path(), "dsm", make_raster(100, 80, block));
  const auto refused = [&](const std::function<void(RasterOptions&)>& change) {
    RasterOptions options;
    change(options);
    return testing::code_of([&] { scene_from_raster(file, options); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused([](RasterOptions& o) { o.region.center_deg = {45, 9}; }), ErrorCode::region_invalid);
  EXPECT_EQ(refused([&](RasterOptions& o) {
              o.region.center_deg = {45, 9};
              o.region.radius_m = nan;
            }),
            ErrorCode::region_invalid);
  EXPECT_EQ(refused([](RasterOptions& o) { o.region.bbox_deg = {9, 45, 9, 46}; }), ErrorCode::region_invalid);
  EXPECT_EQ(refused([](RasterOptions& o) { o.region.bbox_deg = {9, 46, 10, 45}; }), ErrorCode::region_invalid);
  EXPECT_EQ(refused([&](RasterOptions& o) { o.region.bbox_deg = {9, nan, 10, 45}; }), ErrorCode::region_invalid);
  EXPECT_EQ(refused([](RasterOptions& o) { o.region.pixels = {0, 0, 1, 5}; }), ErrorCode::region_invalid);
  EXPECT_EQ(refused([](RasterOptions& o) {
              o.region.pixels = {0, 0, 5, 5}, o.region.bbox_deg = {9, 45, 10, 46};
            }),
            ErrorCode::conflicting_keys);
  EXPECT_EQ(refused([](RasterOptions& o) { o.max_error_m = -1; }), ErrorCode::value_out_of_range);
  EXPECT_EQ(refused([](RasterOptions& o) { o.origin_deg = {91, 0}; }), ErrorCode::not_on_earth);
  EXPECT_EQ(refused([](RasterOptions& o) {
              o.region.center_deg = {9, 45};
              o.region.radius_m = 10;
            }),
            ErrorCode::region_outside);  // the other way round
}

/// Pixels that a wrong header makes too small or too large for a scene.
TEST(RasterScene, PostsMustLieSideBySide) {
  const testing::TemporaryDirectory folder;
  TestRaster small = make_raster(12, 10, block);
  small.transform = {500000, 1e-5, 0, 5000000, 0, -1e-5};
  TestRaster world = make_raster(36, 18, block);
  world.srs = "EPSG:4326";
  world.transform = {-180, 10, 0, 90, 0, -10};
  for (const TestRaster& raster : {small, world}) {
    const auto file = write_raster(folder.path(), "dsm", raster);
    testing::expect_error([&] { scene_from_raster(file, {}); }, ErrorCode::raster_grid_unsupported, "dsm.tif");
  }
}

TEST(RasterScene, SurfaceOfDelft) {
  VANTAGE_REQUIRE_SHARED("dsm/delft-dsm-0.5m.tif");
  for (const char* file : {"dsm/delft-dsm-0.5m.tif", "dsm/delft-dtm-0.5m.tif", "dsm/dsm.tif"}) {
    for (const double error_m : {0.0, 0.25, 1.0}) {
      RasterOptions options;
      options.max_error_m = error_m;
      const core::Stopwatch stopwatch;
      const RasterScene result = scene_from_raster(testing::shared_data(file), options);
      const double seconds = stopwatch.seconds();
      std::cout << file << ", " << error_m << " m: " << result.report.columns << " x " << result.report.rows
                << " posts, " << result.report.voids << " voids, " << result.scene.mesh.triangles.size()
                << " triangles, largest error " << result.report.largest_error_m << " m, " << seconds << " s\n";
      EXPECT_LE(result.report.largest_error_m, error_m + 1e-6);
      const Box box = bounding_box(result.scene.mesh);
      const double spacing = std::string(file) == "dsm/dsm.tif" ? 1 : 0.5;
      const double size =
          std::hypot(static_cast<double>(result.report.columns - 1), static_cast<double>(result.report.rows - 1)) *
          spacing;
      EXPECT_NEAR((box.max - box.min).head<2>().norm(), size, 0.15 * size);  // turned against the grid
      EXPECT_NEAR(flat_area(result.scene.mesh),
                  static_cast<double>(result.report.columns - 1) * static_cast<double>(result.report.rows - 1) *
                      spacing * spacing,
                  0.001 * size * size);
    }
  }
}

}  // namespace
}  // namespace vantage
