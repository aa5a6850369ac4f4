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
#include "support/random.h"
#include "support/raster_writer.h"
#include "support/shared_data.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/ground.h"
#include "vantage/mission.h"
#include "vantage/result.h"

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
        ASSERT_GE(*height, post.z() - 1e-8) << post.transpose();  // what it leaves out hides nothing less
      }
      EXPECT_NEAR(worst_m, few.report.largest_error_m, 1e-9);
    }
  }
}

/// A plain at 400 m, in posts of a metre.
TestRaster plain(int columns, int rows) {
  TestRaster raster = make_raster(columns, rows, [](int, int) { return 400; });
  raster.transform = {500000, 1, 0, 5000000, 0, -1};
  return raster;
}

void make_void(TestRaster& raster, int column, int row, int columns, int rows) {
  for (int y = row; y < row + rows; ++y) {
    for (int x = column; x < column + columns; ++x) raster.at(x, y) = -9999;
  }
}

/// The lowest and the highest surface in the middle of a raster of 80 x 80 posts of a metre, every post kept.
GroundLevels::Range middle_of(const RasterScene& result) {
  return GroundLevels(ground_of(result.scene).value()).at(0, 0).value();
}

RasterScene every_post_of(const std::filesystem::path& file, const HeightOptions& heights = {},
                          MissingPolicy missing = MissingPolicy::block) {
  RasterOptions options;
  options.max_error_m = 0;
  options.heights = heights;
  options.missing = missing;
  return scene_from_raster(file, options);
}

TEST(RasterScene, NarrowVoidsAreAsHighAsTheHighestPostAtTheirRim) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = plain(80, 80);
  make_void(raster, 30, 30, 20, 20);
  raster.at(29, 33) = 430;  // a mast beside it
  raster.at(50, 50) = 390;  // and, across its corner, a pit
  const auto file = write_raster(folder.path(), "dsm", raster);
  const RasterScene result = every_post_of(file);
  EXPECT_EQ(result.report.voids, 400u);
  EXPECT_NEAR(middle_of(result).highest_m, 430, 1e-6);
  EXPECT_NEAR(middle_of(result).lowest_m, 390, 1e-6);
  ASSERT_EQ(result.scene.objects.size(), 2U);
  EXPECT_EQ(result.scene.objects[1].name.rfind("surface beneath", 0), 0U);
  ASSERT_EQ(result.scene.ledger.size(), 1u);
  const LedgerEntry& entry = result.scene.ledger[0];
  EXPECT_EQ(entry.object.kind, ObjectKind::surface);
  EXPECT_EQ(entry.stand_in, 0u);
  EXPECT_TRUE(entry.may_be_larger);
  ASSERT_TRUE(entry.box);
  EXPECT_NEAR(entry.box->min.x(), -10, 0.1);
  EXPECT_NEAR(entry.box->max.y(), 10, 0.1);
  testing::expect_wording(entry.what + "; " + entry.reason + "; " + entry.instead);

  // Simplified it hides as much; heights above the ground are measured from both.
  const RasterScene simple = scene_from_raster(file, {});
  EXPECT_GE(middle_of(simple).highest_m, 430);
  EXPECT_LE(middle_of(simple).lowest_m, 390);

  // As it was: the mean of the nearest values.
  const RasterScene warned = every_post_of(file, {}, MissingPolicy::warn);
  EXPECT_NEAR(middle_of(warned).highest_m, 400, 2);
  EXPECT_EQ(middle_of(warned).highest_m, middle_of(warned).lowest_m);
  ASSERT_EQ(warned.scene.ledger.size(), 1u);
  EXPECT_FALSE(warned.scene.ledger[0].stand_in);
  testing::expect_wording(warned.scene.ledger[0].reason);
}

// Below the fill a target is seen from below the fill, whatever is there.
TEST(RasterScene, ATargetUnderWhatFillsAVoidIsRefused) {
  const testing::TemporaryDirectory folder;
  enable_maps();
  TestRaster raster = plain(80, 80);
  make_void(raster, 30, 30, 20, 20);
  raster.at(29, 33) = 430;
  write_raster(folder.path(), "dsm", raster);
  const auto mission_at = [&](double x, double z, const std::string& missing) {
    const std::string height = ", " + std::to_string(z) + "], ", west = "[" + std::to_string(x) + ", ",
                      east = "[" + std::to_string(x + 2) + ", ";
    testing::write_bytes(folder / "mission.yaml", "scene: {raster: dsm.tif, missing: " + missing +
                                                      "}\ntarget: {vertices: [" + west + "0" + height + east + "0" +
                                                      height + east + "2" + height + west + "2" + height +
                                                      "]}\nsensor: {max_range: 60}\n");
    return resolve_mission(read_mission(folder / "mission.yaml"));
  };
  const auto prepare = [](const Mission& mission) { prepare_target(mission, PreparedScene(mission.scene())); };
  const Mesh volume = testing::make_box_mesh({0, 0, 403}, {1, 1, 404});
  for (const double z : {402, 399, 429}) {
    const Mission mission = mission_at(0, z, "block");
    const Error error = testing::expect_code([&] { prepare(mission); }, ErrorCode::target_inside_solid);
    if (z == 402) testing::expect_wording(error.what());
    testing::expect_code([&] { prove_volume(mission, volume); }, ErrorCode::target_inside_solid);
    testing::expect_code([&] { verify_volume(mission, volume); }, ErrorCode::target_inside_solid);
  }
  EXPECT_NO_THROW(prepare(mission_at(0, 431, "block")));
  EXPECT_NO_THROW(prepare(mission_at(20, 402, "block")));
  const Mission open = mission_at(0, 402, "warn");
  EXPECT_NO_THROW(prepare(open));
  EXPECT_NO_THROW(prove_volume(open, volume));
}

TEST(RasterScene, AGivenHeightOfVoidsNeverOpensANarrowOne) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = plain(80, 80);
  make_void(raster, 38, 20, 6, 40);  // a wall of which nothing is left: the rim does not tell of it
  const auto file = write_raster(folder.path(), "wall", raster);
  EXPECT_NEAR(middle_of(every_post_of(file)).highest_m, 400, 1e-6);
  const auto high = middle_of(every_post_of(file, {.void_m = 430}));
  EXPECT_NEAR(high.highest_m, 430, 1e-6);
  EXPECT_NEAR(high.lowest_m, 400, 1e-6);
  const auto low = middle_of(every_post_of(file, {.void_m = 0}));
  EXPECT_NEAR(low.highest_m, 400, 1e-6);
  EXPECT_NEAR(low.lowest_m, 0, 1e-6);
}

TEST(RasterScene, WideVoidsAreFilledFromTheirNeighboursOrAsGiven) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = plain(80, 80);
  make_void(raster, 29, 29, 21, 21);
  raster.at(28, 33) = 430;
  const auto file = write_raster(folder.path(), "dsm", raster);
  const RasterScene filled = every_post_of(file);
  EXPECT_NEAR(middle_of(filled).highest_m, 400, 2);
  EXPECT_EQ(middle_of(filled).highest_m, middle_of(filled).lowest_m);
  ASSERT_EQ(filled.scene.ledger.size(), 1u);
  EXPECT_EQ(filled.scene.ledger[0].stand_in, 0u);
  testing::expect_wording(filled.scene.ledger[0].instead);
  const RasterScene given = every_post_of(file, {.void_m = -3});
  EXPECT_NEAR(middle_of(given).highest_m, -3, 1e-6);
  EXPECT_FALSE(given.scene.ledger.at(0).may_be_larger);
  testing::expect_wording(given.scene.ledger[0].instead);
  testing::expect_code([&] { every_post_of(file, {.void_m = 20'000}); }, ErrorCode::value_out_of_range, "dsm.tif");
}

TEST(RasterScene, ALongVoidTakesTheRimThatIsNear) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = plain(400, 9);
  make_void(raster, 3, 4, 394, 1);
  raster.at(200, 3) = 430;
  const RasterScene result = every_post_of(write_raster(folder.path(), "canal", raster));
  const GroundLevels levels(ground_of(result.scene).value());
  EXPECT_NEAR(levels.at(0, 0).value().highest_m, 430, 0.1);
  EXPECT_NEAR(levels.at(-19, 0).value().highest_m, 430, 0.1);
  EXPECT_NEAR(levels.at(-50, 0).value().highest_m, 400, 0.1);
  EXPECT_NEAR(levels.at(50, 0).value().highest_m, 400, 0.1);
}

/// Whatever is void, block hides what the rim does, and nothing but voids differs from what the file says.
TEST(RasterScene, RandomVoidsAreHeldByTheirRims) {
  const testing::TemporaryDirectory folder;
  testing::Random random(48);
  for (int run = 0; run < 20; ++run) {
    TestRaster raster = make_raster(40, 40, [&](int, int) { return random.integer(0, 50); });
    raster.transform = {500000, 1, 0, 5000000, 0, -1};
    for (int i = 0; i < 6; ++i) {
      const int columns = random.integer(1, 12), rows = random.integer(1, 12);
      make_void(raster, random.integer(0, 40 - columns), random.integer(0, 40 - rows), columns, rows);
    }
    const terrain::HeightGrid grid = terrain::read_height_grid(write_raster(folder.path(), "dsm", raster));
    const terrain::HeightGrid mean =
        terrain::read_height_grid(write_raster(folder.path(), "dsm", raster), {}, {}, {.missing = MissingPolicy::warn});
    std::size_t posts = 0;
    for (const terrain::VoidRegion& region : grid.void_regions) posts += region.posts;
    EXPECT_EQ(posts, grid.voids);
    for (int row = 0; row < 40; ++row) {
      for (int column = 0; column < 40; ++column) {
        const auto at = static_cast<std::size_t>(row * 40 + column);
        if (raster.at(column, row) != -9999) {
          EXPECT_EQ(grid.at(column, row), raster.at(column, row));
          continue;
        }
        EXPECT_GE(grid.at(column, row), mean.at(column, row));
        EXPECT_LE(grid.lowest_m.empty() ? grid.at(column, row) : grid.lowest_m[at], mean.at(column, row));
      }
    }
  }
}

TEST(RasterScene, EastingsInFeetNeedAUnitOfHeight) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = make_raster(20, 20, [](int, int) { return 400; });
  raster.srs = "EPSG:2263";  // New York, US survey feet
  raster.transform = {980000, 3, 0, 200000, 0, -3};
  const auto file = write_raster(folder.path(), "feet", raster);
  testing::expect_error([&] { scene_from_raster(file); }, ErrorCode::height_unknown, "feet.tif");
  const auto height_of = [&](const std::filesystem::path& of, HeightOptions heights) {
    RasterOptions options;
    options.heights = heights;
    return scene_from_raster(of, options).report.highest_m;
  };
  EXPECT_NEAR(height_of(file, {.unit = HeightUnit::us_survey_foot}), 400 * 1200.0 / 3937, 1e-4);
  EXPECT_NEAR(height_of(file, {.unit = HeightUnit::foot}), 400 * 0.3048, 1e-4);
  EXPECT_EQ(height_of(file, {.unit = HeightUnit::metre}), 400);
  raster.srs = "EPSG:2263+6360";  // heights likewise
  EXPECT_NEAR(height_of(write_raster(folder.path(), "compound", raster), {}), 400 * 1200.0 / 3937, 1e-4);
  raster.srs = "EPSG:2263";
  raster.unit = "m";
  EXPECT_EQ(height_of(write_raster(folder.path(), "stated", raster), {}), 400);
}

TEST(RasterScene, ARasterWithoutASystemCanBeGivenOne) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = make_raster(20, 20, block);
  const RasterScene known = scene_from_raster(write_raster(folder.path(), "known", raster));
  raster.srs.clear();
  const auto file = write_raster(folder.path(), "bare", raster);
  testing::expect_error([&] { scene_from_raster(file); }, ErrorCode::crs_missing, "bare.tif");
  RasterOptions options;
  options.crs = "EPSG:32632";
  const RasterScene given = scene_from_raster(file, options);
  EXPECT_EQ(given.scene.mesh.vertices, known.scene.mesh.vertices);
  EXPECT_EQ(given.scene.georeference->source_crs, "EPSG:32632");
  options.crs = "EPSG:0";
  testing::expect_code([&] { scene_from_raster(file, options); }, ErrorCode::crs_unknown, "bare.tif");
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
  TestRaster wound = make_raster(12, 30000, block);  // quadratic, were it triangulated: half a minute
  wound.srs = "EPSG:4326";
  wound.transform = {11, -1844674407370955.2, 0, 48, 0, -1e-4};
  for (const TestRaster& raster : {small, world, wound}) {
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
      Mesh surface = result.scene.mesh;                                      // without what lies beneath voids
      surface.triangles.resize(static_cast<std::size_t>(
          std::count(result.scene.object_of.begin(), result.scene.object_of.end(), std::uint32_t{0})));
      EXPECT_NEAR(flat_area(surface),
                  static_cast<double>(result.report.columns - 1) * static_cast<double>(result.report.rows - 1) *
                      spacing * spacing,
                  0.001 * size * size);
    }
  }
}

}  // namespace
}  // namespace vantage
