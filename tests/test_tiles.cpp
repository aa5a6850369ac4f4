// A map in tiles: volumes are those of the whole map, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/bounds_distance.h"
#include "core/walk_bvh.h"
#include "exact/collect.h"
#include "support/map_text.h"
#include "support/random.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "target/lengths.h"
#include "target/range_region.h"
#include "vantage/city.h"
#include "vantage/ground.h"
#include "vantage/mission.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage::testing {
namespace {

// ---- the hierarchy over groups

struct Items {
  std::vector<core::Bounds> bounds;
  std::vector<std::uint64_t> groups;
  std::vector<std::uint32_t> names;
};

/// Boxes in squares of 10 m.
Items random_items(Random& random, std::size_t count) {
  Items items;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 middle = random.in_box({{0, 0, 0}, {100, 100, 20}});
    core::Bounds box{};
    for (int a = 0; a < 3; ++a) {
      const double half = random.uniform(0, 3);
      box.min[a] = static_cast<float>(middle[a] - half);
      box.max[a] = static_cast<float>(middle[a] + half);
    }
    items.bounds.push_back(box);
    items.groups.push_back(static_cast<std::uint64_t>(middle.x() / 10) * 100 +
                           static_cast<std::uint64_t>(middle.y() / 10));
    items.names.push_back(i);
  }
  return items;
}

/// The names of the items in the order met from a place, all nodes within reach entered but for some below groups.
std::vector<std::uint32_t> met(const Items& items, const Vec3& from, double reach) {
  std::vector<std::uint32_t> order, found;
  const core::Bvh bvh = core::build_bvh_of_groups(items.bounds, items.groups, order);
  const auto enter = [&](const core::BvhNode& node) {
    return bvh.is_above_groups(node) || !node.leaf() || node.bounds.min[0] < 80;
  };
  core::walk_nearest_first(
      bvh, [&](const core::Bounds& bounds) { return core::distance_to(bounds, from); }, reach, enter,
      [&](std::uint32_t item) { found.push_back(items.names[order[item]]); });
  return found;
}

TEST(GroupedBvh, IsMetInTheSameOrderWhateverOtherGroupsThereAre) {
  Random random(91);
  std::size_t found = 0;
  for (int round = 0; round < 50; ++round) {
    const Items all = random_items(random, 2000);
    const Vec3 from = random.in_box({{0, 0, 0}, {100, 100, 20}});
    const double reach = random.uniform(5, 40);
    std::map<std::uint64_t, core::Bounds> groups;
    for (std::size_t i = 0; i < all.names.size(); ++i) {
      core::Bounds& box = groups.try_emplace(all.groups[i], all.bounds[i]).first->second;
      for (std::size_t a = 0; a < 3; ++a) {
        box.min[a] = std::min(box.min[a], all.bounds[i].min[a]);
        box.max[a] = std::max(box.max[a], all.bounds[i].max[a]);
      }
    }
    Items some;
    for (std::size_t i = 0; i < all.names.size(); ++i) {
      // Of groups out of reach some are whole, some in part, and some are missing.
      if (core::distance_to(groups[all.groups[i]], from) > reach && random.chance(0.7)) continue;
      some.bounds.push_back(all.bounds[i]);
      some.groups.push_back(all.groups[i]);
      some.names.push_back(all.names[i]);
    }
    ASSERT_LT(some.names.size(), all.names.size());
    const std::vector<std::uint32_t> expected = met(all, from, reach);
    found += expected.size();
    EXPECT_EQ(met(some, from, reach), expected) << "round " << round;
  }
  EXPECT_GT(found, 10000U);
}

TEST(GroupedBvh, HoldsAllItemsUnderItsNodes) {
  Random random(92);
  for (const std::size_t count : {1, 2, 5, 300}) {
    const Items items = random_items(random, count);
    std::vector<std::uint32_t> order;
    const core::Bvh bvh = core::build_bvh_of_groups(items.bounds, items.groups, order);
    ASSERT_EQ(bvh.rank.size(), bvh.nodes.size());
    std::vector<std::uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, items.names);
    std::uint32_t next = 0;  // items come in the order of the leaves
    core::walk_bvh(
        bvh, [](const core::BvhNode&) { return true; }, [&](std::uint32_t item) { EXPECT_EQ(item, next++); });
    EXPECT_EQ(next, count);
    for (std::uint32_t item = 0; item < count; ++item) {
      const core::Bounds& wanted = items.bounds[order[item]];
      bool found = false;
      core::walk_bvh(
          bvh,
          [&](const core::BvhNode& node) {
            for (int a = 0; a < 3; ++a) {
              if (node.bounds.min[a] > wanted.min[a] || node.bounds.max[a] < wanted.max[a]) return false;
            }
            return true;
          },
          [&](std::uint32_t other) { found = found || other == item; });
      EXPECT_TRUE(found);
    }
  }
}

// ---- volumes

/// A town of 700 m: blocks of houses that share walls, towers of parts, courtyards, fences, a bridge, trees.
std::string town(Random& random) {
  MapText map;
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 7; ++column) {
      const double west = 100 * column, south = 100 * row;
      if (random.chance(0.1)) continue;  // a square
      double east = west;
      while (east < west + 60) {  // a terrace of houses that share their walls
        const double width = random.uniform(8, 25);
        const std::string height = std::to_string(random.uniform(5, 25));
        const char* const roof = random.chance(0.5) ? "gabled" : "flat";
        map.box(east, south, east + width, south + 12,
                {{"building", "yes"}, {"height", height}, {"roof:shape", roof}, {"roof:height", "3"}});
        east += width;
      }
      if (random.chance(0.5)) {
        map.box(west, south + 40, west + 45, south + 75, {{"building", "yes"}, {"height", "40"}});
        map.box(west, south + 40, west + 45, south + 60, {{"building:part", "yes"}, {"height", "20"}});
        map.box(west, south + 60, west + 45, south + 75,
                {{"building:part", "yes"}, {"height", std::to_string(random.uniform(30, 90))}});
      }
      map.node(west + 70, south + 50, {{"natural", "tree"}});
      map.line({{west, south + 85}, {west + 80, south + 85}}, {{"barrier", "wall"}, {"height", "3"}});
    }
  }
  map.box(150, 250, 560, 290, {{"building", "yes"}, {"height", "15"}, {"name", "Hall"}});  // much larger than a square
  // On either end of the hall a house with which it shares two corners.
  map.box(130, 250, 150, 290, {{"building", "yes"}, {"height", "15"}});
  map.box(560, 250, 580, 290, {{"building", "yes"}, {"height", "15"}});
  map.line({{-20, 395}, {720, 395}}, {{"highway", "primary"}, {"bridge", "yes"}, {"layer", "1"}});
  map.node(330, 330, {{"man_made", "tower"}, {"height", "60"}});
  return map.text();
}

/// What a cause is, whatever the scene's objects are numbered.
using Known = std::tuple<CauseKind, std::string, std::string, double>;

std::vector<Known> known_causes(const Volume& volume) {
  std::vector<Known> causes;
  for (const Cause& cause : volume.causes) {
    causes.emplace_back(cause.kind, cause.name, cause.source_id, cause.area_m2);
  }
  return causes;
}

bool are_same(const Volume& a, const Volume& b) {
  const auto same_bits = [](const Vec3& p, const Vec3& q) {
    return p.x() == q.x() && p.y() == q.y() && p.z() == q.z();
  };
  return a.outcome == b.outcome && a.mesh.vertices.size() == b.mesh.vertices.size() &&
         std::equal(a.mesh.vertices.begin(), a.mesh.vertices.end(), b.mesh.vertices.begin(), same_bits) &&
         a.mesh.triangles == b.mesh.triangles && a.cause_of == b.cause_of && known_causes(a) == known_causes(b);
}

/// A scene and what volumes in it need.
struct Built {
  Scene scene;
  PreparedScene prepared;

  Built(const std::filesystem::path& file, const CityRegion& region, const CityFrame& frame)
      : Built(file, [&] {
          CityOptions options;
          options.region = region;
          options.frame = frame;
          return options;
        }()) {}

  Volume volume(const Target& target, double range_m, const Navigation& navigation = {}) const {
    Sensor sensor;
    sensor.max_range_m = range_m;
    return compute_volume(PreparedTarget(prepared, target, sensor), navigation);
  }

 private:
  Built(const std::filesystem::path& file, const CityOptions& options)
      : scene(build_city(file, options).scene), prepared(scene) {}
};

/// What the engine finds round a target, in its order: nothing that follows depends on anything else of the scene.
struct FoundBlockers {
  std::vector<Vec3> planes, corners;
  std::vector<std::uint8_t> visible, confined;
  std::vector<std::string> objects;

  bool operator==(const FoundBlockers&) const = default;
};

FoundBlockers blockers_round(const Built& built, const Target& target, double range_m) {
  Sensor sensor;
  sensor.max_range_m = range_m;
  const PreparedTarget prepared(built.prepared, target, sensor);
  const vantage::internal::target::RangeRegion range(prepared.frame().polygon, range_m);
  const auto lengths = vantage::internal::target::lengths_of(built.prepared.data(), prepared.frame(), range.radius());
  const auto local =
      vantage::internal::target::make_local_target(prepared.frame().polygon, lengths.slack, lengths.rounding);
  exact::BlockerSet blockers;
  exact::DirectionTree tree(blockers, range);
  exact::collect_blockers(built.prepared.data(), prepared.frame(), local, range, blockers, tree, {});
  FoundBlockers found{blockers.planes, blockers.corners, blockers.visible, blockers.confined, {}};
  for (const std::uint32_t polygon : blockers.polygon) {
    found.objects.push_back(display_name(built.scene.objects[built.prepared.object_of_polygon(polygon)]));
  }
  return found;
}

/// A rectangle at some height over a place that is in the open, or nothing.
std::optional<Volume> volume_over(const Built& built, const Vec3& at, double range_m) {
  Target target = Target::polygon({at, at + Vec3(6, 0, 0), at + Vec3(6, 5, 0), at + Vec3(0, 5, 0)});
  try {
    return built.volume(target, range_m);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::target_pierced) throw;
    return std::nullopt;
  }
}

class TiledTown : public ::testing::Test {
 protected:
  void SetUp() override { write_bytes(file(), town(random_)); }
  std::filesystem::path file() const { return folder_ / "town.osm"; }

  /// How many of random targets have another volume in their tile than in the whole.
  std::size_t count_differing(const TilePlan& plan, double range_m, std::size_t count) {
    const Built whole(file(), {}, plan.frame);
    std::map<std::size_t, Built> tiles;
    std::size_t differing = 0, compared = 0;
    while (compared < count) {
      const Vec3 at = random_.in_box({{0, 0, 0.5}, {690, 690, 45}});
      const std::size_t tile = plan.tile_at(at.x() + 3, at.y() + 2.5);
      const Built& part = tiles.try_emplace(tile, file(), plan.tiles[tile].region, plan.frame).first->second;
      const auto expected = volume_over(whole, at, range_m), found = volume_over(part, at, range_m);
      EXPECT_EQ(expected.has_value(), found.has_value());
      if (!expected || !found) continue;
      ++compared;
      differing += !are_same(*expected, *found);
    }
    EXPECT_GT(tiles.size(), 4U);
    for (const auto& [index, part] : tiles) {
      EXPECT_LT(part.scene.objects.size(), whole.scene.objects.size()) << "tile " << index << " is no part";
    }
    return differing;
  }

  Random random_{20261123};
  TemporaryDirectory folder_;
};

TEST_F(TiledTown, HasTheVolumesOfTheWhole) { EXPECT_EQ(count_differing(plan_tiles(file(), {}, 150, 60), 60, 120), 0U); }

/// Of random targets in a box. Returns how many of them see something.
std::size_t expect_same_blockers(const std::filesystem::path& file, const TilePlan& plan, double range_m,
                                 const Box& box, std::size_t count, Random& random) {
  const Built whole(file, {}, plan.frame);
  std::map<std::size_t, Built> tiles;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 at = random.in_box(box);
    const Target target = Target::polygon({at, at + Vec3(6, 0, 0), at + Vec3(6, 5, 0), at + Vec3(0, 5, 0)});
    const std::size_t tile = plan.tile_at(at.x() + 3, at.y() + 2.5);
    const Built& part = tiles.try_emplace(tile, file, plan.tiles[tile].region, plan.frame).first->second;
    try {
      const FoundBlockers expected = blockers_round(whole, target, range_m);
      EXPECT_TRUE(blockers_round(part, target, range_m) == expected) << "at " << at.transpose();
      compared += !expected.planes.empty();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::target_pierced) throw;
    }
  }
  return compared;
}

TEST_F(TiledTown, ShowsTheEngineTheSameBlockers) {
  const TilePlan plan = plan_tiles(file(), {}, 100, 60);
  EXPECT_GT(expect_same_blockers(file(), plan, 60, {{0, 0, 0.5}, {690, 690, 45}}, 2000, random_), 400U);
}

TEST_F(TiledTown, ShowsAMarginThatIsTooSmall) {
  // The comparison sees it: what is built ends well within reach of the targets.
  EXPECT_GT(count_differing(plan_tiles(file(), {}, 60, 0), 350, 20), 0U);
}

TEST_F(TiledTown, HasTheTrianglesOfTheMap) {
  const TilePlan plan = plan_tiles(file(), {}, 200, 100);
  const Built whole(file(), {}, plan.frame);
  const Scene plain = build_city(file()).scene;
  EXPECT_EQ(whole.scene.mesh.vertices, plain.mesh.vertices);
  EXPECT_EQ(whole.scene.mesh.triangles, plain.mesh.triangles);
  EXPECT_FALSE(plain.whole);
  // Each object is in each tile either as it is in the whole, or not at all; and they keep their order.
  for (const Tile& tile : plan.tiles) {
    const Built part(file(), tile.region, plan.frame);
    std::size_t in_whole = 0, t = 0;
    for (std::size_t i = 0; i < part.scene.mesh.triangles.size(); ++i) {
      const SceneObject& object = part.scene.objects[part.scene.object_of[i]];
      while (in_whole < plain.mesh.triangles.size() && plain.objects[plain.object_of[in_whole]] != object) ++in_whole;
      ASSERT_LT(in_whole, plain.mesh.triangles.size()) << display_name(object);
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(part.scene.mesh.vertices[part.scene.mesh.triangles[i][k]],
                  plain.mesh.vertices[plain.mesh.triangles[in_whole][k]]);
      }
      ++in_whole;
      ++t;
    }
    EXPECT_GT(t, 0U);
  }
}

TEST_F(TiledTown, KeepsLimitsAndRoofs) {
  const TilePlan plan = plan_tiles(file(), {}, 350, 90);
  const Built whole(file(), {}, plan.frame);
  std::vector<Built> tiles;
  for (const Tile& tile : plan.tiles) tiles.emplace_back(file(), tile.region, plan.frame);
  std::size_t compared = 0;
  for (std::uint32_t object = 0; object < whole.scene.objects.size() && compared < 6; object += 17) {
    const std::vector<Face> roofs = FaceFinder(whole.scene).faces({&object, 1}, FaceKind::roof);
    if (roofs.empty() || whole.scene.objects[object].kind == ObjectKind::ground) continue;
    const Vec3 corner = roofs[0].parts[0][0];
    const Built& tile = tiles[plan.tile_at(corner.x(), corner.y())];
    const auto same = std::find(tile.scene.objects.begin(), tile.scene.objects.end(), whole.scene.objects[object]);
    ASSERT_NE(same, tile.scene.objects.end());
    const auto index = static_cast<std::uint32_t>(same - tile.scene.objects.begin());
    const std::vector<Face> found = FaceFinder(tile.scene).faces({&index, 1}, FaceKind::roof);
    ASSERT_EQ(found.size(), roofs.size());
    EXPECT_EQ(found[0].parts, roofs[0].parts);
    const auto limited = [&](const Built& built, const Face& roof) {
      Navigation navigation;
      navigation.above_ground = AboveGround{5, 60, *ground_of(built.scene)};
      navigation.clearance = Clearance{2, obstacles_of(built.scene, {})};
      return built.volume(target_of(std::vector{roof}, "roof"), 50, navigation);
    };
    const Volume expected = limited(whole, roofs[0]);
    EXPECT_TRUE(are_same(expected, limited(tile, found[0]))) << display_name(whole.scene.objects[object]);
    compared += !expected.mesh.empty();
  }
  EXPECT_GT(compared, 2U);
}

TEST(TilePlan, KnowsTheTileOfAPlace) {
  const TemporaryDirectory folder;
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  map.box(300, 100, 320, 120, {{"building", "yes"}});
  write_bytes(folder / "map.osm", map.text());
  const TilePlan plan = plan_tiles(folder / "map.osm", {}, 100, 50);
  EXPECT_EQ(plan.columns, 5U) << "320 m, and 50 m of ground round it";
  EXPECT_EQ(plan.rows, 3U);
  ASSERT_EQ(plan.tiles.size(), 15U);
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    const auto& [west, south, east, north] = plan.tiles[i].square_m;
    EXPECT_EQ(plan.tile_at((west + east) / 2, (south + north) / 2), i);
    EXPECT_EQ(plan.tile_at(west + 1e-6, south + 1e-6), i);
  }
  EXPECT_EQ(plan.tile_at(-1e6, -1e6), 0U);
  EXPECT_EQ(plan.tile_at(1e6, 1e6), 14U);
  EXPECT_EQ(plan.tile_at(1e300, -1e300), 4U);
  // A tile without buildings is flat ground.
  CityOptions options;
  options.frame = plan.frame;
  options.region.bbox_deg = {11.6, 48.2, 11.601, 48.201};
  const City none = build_city(folder / "map.osm", options);
  ASSERT_EQ(none.scene.objects.size(), 1U);
  EXPECT_EQ(none.scene.objects[0].kind, ObjectKind::ground);
}

TEST(TilePlan, RefusesWhatCannotBeCut) {
  const TemporaryDirectory folder;
  const auto file = folder / "map.osm";
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  map.box(3000, 2000, 3020, 2020, {{"building", "yes"}});
  write_bytes(file, map.text());
  for (const double bad : {0.0, -5.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    expect_error([&] { plan_tiles(file, {}, bad, 100); }, ErrorCode::value_out_of_range, "size");
  }
  for (const double bad : {-5.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    expect_error([&] { plan_tiles(file, {}, 100, bad); }, ErrorCode::value_out_of_range, "margin");
  }
  expect_error([&] { plan_tiles(file, {}, 1, 100); }, ErrorCode::value_out_of_range, "size");
  CityOptions options;
  options.terrain = "terrain.tif";
  expect_error([&] { plan_tiles(file, options, 100, 100); }, ErrorCode::not_applicable, "tiles");
  options = {};
  options.region.bbox_deg = {11, 48, 12, 49};
  expect_error([&] { plan_tiles(file, options, 100, 100); }, ErrorCode::not_applicable, "tiles");
  MapText none;
  none.line({{0, 0}, {10, 0}}, {{"highway", "path"}});
  write_bytes(folder / "none.osm", none.text());
  expect_error([&] { plan_tiles(folder / "none.osm", {}, 100, 100); }, ErrorCode::map_empty, "none.osm");
}

TEST(CityFrames, AreChecked) {
  const TemporaryDirectory folder;
  const auto file = folder / "map.osm";
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  write_bytes(file, map.text());
  const auto build = [&](const CityFrame& frame, const std::string& terrain = "") {
    CityOptions options;
    options.frame = frame;
    options.terrain = terrain;
    build_city(file, options);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CityFrame good{{48.1374, 11.5755}, {-50, -50, 70, 70}, 40};
  EXPECT_NO_THROW(build(good));
  expect_error([&] { build({good.origin_deg, {70, -50, -50, 70}, 40}); }, ErrorCode::value_out_of_range, "frame");
  expect_error([&] { build({good.origin_deg, {-50, nan, 70, 70}, 40}); }, ErrorCode::value_out_of_range, "frame");
  expect_error([&] { build({good.origin_deg, {-50, -50, 1e9, 70}, 40}); }, ErrorCode::value_out_of_range, "frame");
  expect_error([&] { build({good.origin_deg, good.ground_m, -1}); }, ErrorCode::value_out_of_range, "frame");
  expect_error([&] { build({{99, 11}, good.ground_m, 40}); }, ErrorCode::not_on_earth, "origin");
  expect_error([&] { build(good, "terrain.tif"); }, ErrorCode::not_applicable, "terrain");
}

/// A mission file can name a tile, and says it again.
TEST(CityFrames, AreKeysOfMissions) {
  const TemporaryDirectory folder;
  MapText map;
  map.box(0, 0, 20, 20, {{"building", "yes"}});
  write_bytes(folder / "map.osm", map.text());
  write_bytes(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto file = folder / "mission.yaml";
  const std::string text =
      "scene: {osm: map.osm, bbox: [11.57, 48.13, 11.58, 48.14],\n"
      "        frame: {origin: [48.1374, 11.5755], ground: [-50, -60.5, 70, 80], reach: 40.25}}\n"
      "target: {osm: way/1}\nsensor: {max_range: 50}\n";
  const MissionFile read = read_mission_text(text, file);
  ASSERT_TRUE(read.scene.city.frame);
  EXPECT_EQ(read.scene.city.frame->ground_m, (std::array<double, 4>{-50, -60.5, 70, 80}));
  const MissionFile again = read_mission_text(mission_text(read, folder.path()), file);
  ASSERT_TRUE(again.scene.city.frame);
  EXPECT_EQ(again.scene.city.frame->origin_deg, read.scene.city.frame->origin_deg);
  EXPECT_EQ(again.scene.city.frame->ground_m, read.scene.city.frame->ground_m);
  EXPECT_EQ(again.scene.city.frame->reach_m, 40.25);
  const auto refuse = [&](const std::string& scene, ErrorCode code) {
    const std::string bad = "scene: " + scene + "\ntarget: {osm: way/1}\nsensor: {max_range: 50}\n";
    expect_error([&] { read_mission_text(bad, file); }, code, "mission.yaml");
  };
  refuse("{osm: map.osm, frame: {origin: [48, 11], ground: [0, 0, 1, 1]}}", ErrorCode::missing_key);
  refuse("{osm: map.osm, frame: {origin: [48, 11], ground: [0, 0, 1], reach: 1}}", ErrorCode::wrong_type);
  refuse("{osm: map.osm, frame: [1, 2]}", ErrorCode::wrong_type);
  refuse("{mesh: a.obj, frame: {origin: [48, 11], ground: [0, 0, 1, 1], reach: 1}}", ErrorCode::not_applicable);
}

TEST(HeavyTiles, OfManhattanShowTheEngineTheSameBlockers) {
  VANTAGE_REQUIRE_SHARED("osm/manhattan-midtown.osm.pbf");
  const auto file = shared_data("osm/manhattan-midtown.osm.pbf");
  const TilePlan plan = plan_tiles(file, {}, 700, 200);
  Random random(8);
  EXPECT_GT(expect_same_blockers(file, plan, 200, {{-1500, -900, 0.2}, {1500, 900, 120}}, 1000, random), 300U);
}

/// Random targets in the middle of Manhattan.
TEST(HeavyTiles, OfManhattanHaveTheVolumesOfTheWhole) {
  VANTAGE_REQUIRE_SHARED("osm/manhattan-midtown.osm.pbf");
  const auto file = shared_data("osm/manhattan-midtown.osm.pbf");
  constexpr double kRange = 300;
  const TilePlan plan = plan_tiles(file, {}, 700, kRange);
  const Built whole(file, {}, plan.frame);
  Random random(7);
  std::map<std::size_t, std::vector<Vec3>> targets;
  for (int i = 0; i < 60; ++i) {
    const Vec3 at = random.in_box({{-1500, -900, 0.2}, {1500, 900, 120}});
    targets[plan.tile_at(at.x() + 3, at.y() + 2.5)].push_back(at);
  }
  std::size_t compared = 0;
  for (const auto& [tile, places] : targets) {
    const Built part(file, plan.tiles[tile].region, plan.frame);
    for (const Vec3& at : places) {
      const auto expected = volume_over(whole, at, kRange), found = volume_over(part, at, kRange);
      ASSERT_EQ(expected.has_value(), found.has_value()) << at.transpose();
      if (!expected || !found) continue;
      ++compared;
      EXPECT_TRUE(are_same(*expected, *found)) << at.transpose();
    }
  }
  EXPECT_GT(compared, 20U);
}

}  // namespace
}  // namespace vantage::testing
