#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/solid_check.h"
#include "maps/city/occluders.h"
#include "support/osm_maps.h"
#include "support/random.h"
#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

using vantage::testing::Random;
using vantage::testing::tagged;

struct Built {
  std::vector<Shape> shapes;
  std::vector<TagRemark> remarks;

  Box box() const {
    Box box;
    for (const Shape& shape : shapes) box.extend(bounding_box(make_solid(shape, 0).mesh));
    return box;
  }
  double volume() const {
    double sum = 0;
    for (const Shape& shape : shapes) sum += enclosed_volume(make_solid(shape, 0).mesh);
    return sum;
  }
  bool has(TagFault fault, const std::string& key = "") const {
    return std::any_of(remarks.begin(), remarks.end(),
                       [&](const TagRemark& r) { return r.fault == fault && r.key == key; });
  }
};

void expect_sound(const Built& built) {
  for (const Shape& shape : built.shapes) {
    try {
      const Mesh mesh = make_solid(shape, 12.5).mesh;
      EXPECT_EQ(core::checked_solid(mesh, "shape").triangles.size(), mesh.triangles.size());
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

Built line(std::initializer_list<std::pair<std::string, std::string>> tags, const std::vector<Vec2>& points,
           double piece_m = 0) {
  Built built;
  built.shapes = shapes_of_line(tagged(tags), points, piece_m, OccluderDefaults(), BuildingDefaults(), built.remarks);
  expect_sound(built);
  return built;
}

Built point(std::initializer_list<std::pair<std::string, std::string>> tags) {
  Built built;
  built.shapes = shapes_of_point(tagged(tags), {100, 200}, OccluderDefaults(), BuildingDefaults(), built.remarks);
  expect_sound(built);
  return built;
}

const std::vector<Vec2> kStraight = {{0, 0}, {20, 0}};
const std::vector<Vec2> kRing = {{0, 0}, {20, 0}, {20, 10}, {0, 10}, {0, 0}};

TEST(CityOccluders, Kinds) {
  const auto kinds = [](std::initializer_list<std::pair<std::string, std::string>> tags) {
    std::string all;
    for (const Geometry geometry : {Geometry::point, Geometry::line, Geometry::area}) {
      const std::optional<ObjectKind> kind = kind_of(tagged(tags), geometry);
      all.append(kind ? name_of(*kind) : "").append("/");
    }
    EXPECT_EQ(wanted(tagged(tags)), all != "///");
    return all;
  };
  EXPECT_EQ(kinds({{"building", "yes"}}), "building//building/");
  EXPECT_EQ(kinds({{"building", "church"}, {"building:part", "yes"}}), "building part//building part/");
  EXPECT_EQ(kinds({{"building", "yes"}, {"building:part", "no"}}), "building//building/");
  EXPECT_EQ(kinds({{"building", "no"}}), "///");
  EXPECT_EQ(kinds({{"building", "yes"}, {"man_made", "tower"}}), "tower//building/");
  EXPECT_EQ(kinds({{"building", "entrance"}}), "building//building/");
  EXPECT_EQ(kinds({{"barrier", "fence"}, {"leisure", "garden"}}), "/wall//");
  EXPECT_EQ(kinds({{"barrier", "hedge"}, {"area", "yes"}}), "/wall/wall/");
  EXPECT_EQ(kinds({{"barrier", "hedge"}}), "/wall/wall/") << "nothing else makes it an area";
  EXPECT_EQ(kinds({{"barrier", "kerb"}}), "///");
  EXPECT_EQ(kinds({{"man_made", "chimney"}}), "tower//tower/");
  EXPECT_EQ(kinds({{"man_made", "pipeline"}}), "///");
  EXPECT_EQ(kinds({{"man_made", "pipeline"}, {"location", "overground"}, {"height", "3"}}),
            "stand-in/stand-in/stand-in/");
  EXPECT_EQ(kinds({{"man_made", "bridge"}}), "//bridge/");
  EXPECT_EQ(kinds({{"bridge", "yes"}, {"highway", "primary"}}), "/bridge/bridge/");
  EXPECT_EQ(kinds({{"bridge", "no"}, {"highway", "primary"}}), "///");
  EXPECT_EQ(kinds({{"bridge", "yes"}, {"railway", "razed"}}), "///");
  EXPECT_EQ(kinds({{"bridge", "yes"}}), "/bridge/bridge/");
  EXPECT_EQ(kinds({{"bridge", "yes"}, {"razed:railway", "rail"}}), "///");
  for (const auto& [key, value] :
       std::initializer_list<std::pair<std::string, std::string>>{{"waterway", "canal"},
                                                                  {"aeroway", "taxiway"},
                                                                  {"man_made", "pipeline"},
                                                                  {"railway", "platform"},
                                                                  {"railway", "abandoned"},
                                                                  {"highway", "construction"},
                                                                  {"natural", "water"}}) {
    EXPECT_EQ(kinds({{"bridge", "viaduct"}, {key, value}}), "/bridge/bridge/") << value;
  }
  EXPECT_EQ(kinds({{"bridge", "yes"}, {"barrier", "wall"}}), "/wall/wall/");
  EXPECT_EQ(kinds({{"building:levels", "5"}, {"amenity", "parking"}}), "stand-in/stand-in/stand-in/");
  EXPECT_EQ(kinds({{"natural", "tree"}}), "tree/stand-in/stand-in/") << "an area of trees";
  EXPECT_EQ(kinds({{"natural", "tree_row"}}), "/tree//");
  EXPECT_EQ(kinds({{"highway", "residential"}}), "///");
}

TEST(CityOccluders, Walls) {
  const Built plain = line({{"barrier", "wall"}}, kStraight);
  EXPECT_NEAR(plain.volume(), 20 * 0.25 * 2, 0.02);
  const Built high = line({{"barrier", "city_wall"}, {"height", "8 m"}, {"width", "3"}}, kStraight);
  EXPECT_NEAR(high.volume(), 20 * 3 * 8, 0.1);
  EXPECT_TRUE(high.remarks.empty());
  EXPECT_NEAR(line({{"barrier", "wall"}, {"wall", "noise_barrier"}}, kStraight).box().max.z(), 4, 1e-12);
  const Built garden = line({{"barrier", "hedge"}}, kRing);
  ASSERT_EQ(garden.shapes.size(), 1u);
  EXPECT_EQ(garden.shapes[0].footprint.holes.size(), 1u) << "the garden stays open";
  EXPECT_NEAR(garden.volume(), (21 * 11 - 19 * 9) * 1.5, 0.05);
  const Built nonsense = line({{"barrier", "fence"}, {"height", "tall"}, {"width", "-1"}}, kStraight);
  EXPECT_TRUE(nonsense.has(TagFault::no_value, "height"));
  EXPECT_TRUE(nonsense.has(TagFault::negative, "width"));
  EXPECT_NEAR(nonsense.box().max.z(), 1.5, 1e-12);
  EXPECT_TRUE(line({{"barrier", "wall"}}, {{3, 3}, {3, 3}}).has(TagFault::too_small));
  EXPECT_TRUE(line({{"barrier", "wall"}}, {}).shapes.empty());
  EXPECT_TRUE(line({{"barrier", "wall"}}, {{0, 0}, {std::nan(""), 1}}).has(TagFault::too_small));
}

TEST(CityOccluders, WallsInPiecesForSlopes) {
  const std::vector<Vec2> bent = {{0, 0}, {25, 0}, {25, 13}};
  const Built whole = line({{"barrier", "wall"}}, bent);
  const Built pieces = line({{"barrier", "wall"}}, bent, 10);
  EXPECT_EQ(whole.shapes.size(), 1u);
  EXPECT_EQ(pieces.shapes.size(), 4u);  // 9.5 m each
  EXPECT_NEAR(pieces.volume(), whole.volume(), 1e-2);
  EXPECT_EQ(line({{"barrier", "wall"}}, kRing, 10).shapes.size(), 6u);
  EXPECT_EQ(line({{"barrier", "wall"}}, kRing, 100).shapes[0].footprint.holes.size(), 1u);
}

TEST(CityOccluders, Towers) {
  const Built tank = point({{"man_made", "storage_tank"}, {"height", "12"}, {"diameter", "20"}});
  EXPECT_NEAR(tank.volume(), 12 * std::numbers::pi * 100 * 0.9745, 5);
  EXPECT_NEAR(tank.box().max.x(), 110, 1e-3);
  EXPECT_NEAR(point({{"man_made", "tower"}, {"tower:type", "lighting"}}).box().max.z(), 15, 1e-9);
  EXPECT_NEAR(point({{"man_made", "mast"}}).box().max.z(), 25, 1e-9);
  const Built high = point({{"man_made", "mast"}, {"height", "2000"}});
  EXPECT_NEAR(high.box().max.z(), 1500, 1e-9);
  EXPECT_TRUE(high.has(TagFault::too_large, "height") && high.remarks[0].unsure);
  const Built odd = point({{"man_made", "chimney"}, {"diameter", "1,5-2,5"}, {"height", "-4"}});
  EXPECT_TRUE(odd.has(TagFault::rough, "diameter"));
  EXPECT_TRUE(odd.has(TagFault::negative, "height"));
  EXPECT_NEAR(odd.box().max.z(), 30, 1e-9);
  const Built silo = point({{"man_made", "silo"}, {"height", "12"}, {"roof:shape", "dome"}, {"roof:height", "3"}});
  EXPECT_LT(silo.volume(), 12 * std::numbers::pi * 9);
  EXPECT_NEAR(silo.box().max.z(), 12, 1e-9);
  EXPECT_EQ(point({{"man_made", "mast"}, {"diameter", "0.01"}}).shapes.size(), 1u);
  Built area;
  area.shapes = shapes_of_area(tagged({{"man_made", "gasometer"}}), {{{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, {}}},
                               OccluderDefaults(), BuildingDefaults(), area.remarks);
  EXPECT_NEAR(area.volume(), 81 * 30, 1e-6);
}

TEST(CityOccluders, BridgesCanBeLookedUnder) {
  const Built road = line({{"bridge", "yes"}, {"highway", "primary"}, {"lanes", "2"}}, kStraight);
  EXPECT_NEAR(road.box().min.z(), 5, 1e-12);
  EXPECT_NEAR(road.volume(), 20 * 7 * 1, 0.05);
  EXPECT_NEAR(line({{"bridge", "yes"}, {"highway", "path"}, {"layer", "2"}}, kStraight).box().min.z(), 10, 1e-12);
  EXPECT_NEAR(line({{"bridge", "viaduct"}, {"railway", "rail"}, {"tracks", "2"}}, kStraight).volume(), 20 * 9, 0.05);
  EXPECT_NEAR(line({{"bridge", "yes"}, {"highway", "steps"}, {"min_height", "5;5.5"}}, kStraight).box().min.z(), 5,
              1e-12);
  const Built below = line({{"bridge", "yes"}, {"highway", "footway"}, {"layer", "-2"}}, kStraight);
  EXPECT_TRUE(below.has(TagFault::below_ground, "layer"));
  EXPECT_NEAR(below.box().min.z(), 0, 1e-12);
  EXPECT_TRUE(
      line({{"bridge", "yes"}, {"highway", "footway"}, {"layer", "x"}}, kStraight).has(TagFault::no_value, "layer"));
  EXPECT_NEAR(line({{"bridge", "yes"}, {"highway", "primary_link"}}, kStraight).volume(), 100, 0.05);
}

TEST(CityOccluders, BridgesAreAsWideAsWhatTheyCarry) {
  const OccluderDefaults usual;
  EXPECT_NEAR(line({{"bridge", "yes"}, {"aeroway", "taxiway"}}, kStraight).volume(), 20 * usual.ways.at("taxiway"),
              0.1);
  EXPECT_NEAR(line({{"bridge", "aqueduct"}, {"waterway", "canal"}, {"highway", "path"}}, kStraight).volume(),
              20 * usual.ways.at("canal"), 0.1);
}

TEST(CityOccluders, WallsOnBridgesStandAboveTheDeck) {
  const double deck = line({{"bridge", "yes"}, {"highway", "path"}}, kStraight).box().max.z();
  EXPECT_NEAR(line({{"bridge", "yes"}, {"barrier", "fence"}, {"height", "2"}}, kStraight).box().max.z(), deck + 2,
              1e-9);
  EXPECT_NEAR(line({{"bridge", "yes"}, {"highway", "path"}, {"barrier", "wall"}}, kStraight).box().max.z(), deck + 2,
              1e-9);
  EXPECT_NEAR(line({{"bridge", "no"}, {"barrier", "wall"}}, kStraight).box().max.z(), 2, 1e-9);
}

TEST(CityOccluders, BuildingHeightIsAHeightOfAnything) {
  const std::pair<std::string, std::string> height = {"building:height", "48"};
  EXPECT_NEAR(line({{"bridge", "yes"}, {"highway", "primary"}, height}, kStraight).box().max.z(), 48, 1e-9);
  EXPECT_NEAR(line({{"barrier", "wall"}, height}, kStraight).box().max.z(), 48, 1e-9);
  EXPECT_NEAR(point({{"natural", "tree"}, height}).box().max.z(), 48, 1e-9);
}

TEST(CityOccluders, BridgesAreHeldWhereverTheyMayBe) {
  const auto bridge = [](std::initializer_list<std::pair<std::string, std::string>> more) {
    osm::Tags tags = tagged({{"bridge", "yes"}, {"highway", "primary"}});
    for (const auto& tag : more) tags.all.push_back(tag);
    Built built;
    built.shapes = shapes_of_line(tags, kStraight, 0, OccluderDefaults(), BuildingDefaults(), built.remarks);
    return built;
  };
  const auto expect = [](const Built& built, double bottom_m, double top_m) {
    EXPECT_NEAR(built.box().min.z(), bottom_m, 1e-12);
    EXPECT_NEAR(built.box().max.z(), top_m, 1e-12);
  };
  const Built high = bridge({{"height", "134"}});
  expect(high, 5, 134);
  EXPECT_TRUE(high.has(TagFault::rough, "height") && high.remarks[0].unsure);
  expect(bridge({{"height", "3"}}), 2, 6);
  EXPECT_TRUE(bridge({{"height", "6"}}).remarks.empty());
  expect(bridge({{"min_height", "5;15"}}), 5, 16);
  expect(bridge({{"min_height", "8-15"}}), 0, 16);
  expect(bridge({{"layer", "1;2"}}), 5, 11);
}

TEST(CityOccluders, PipesAreAsWideAsTheyAre) {
  for (const char* diameter : {"600", "0.6"}) {
    const Built pipe = line(
        {{"man_made", "pipeline"}, {"location", "overground"}, {"height", "3"}, {"diameter", diameter}}, kStraight);
    EXPECT_NEAR(pipe.volume(), 20 * 0.6 * 3, 0.2) << diameter;
  }
}

TEST(CityOccluders, Trees) {
  const Built plain = point({{"natural", "tree"}});
  EXPECT_NEAR(plain.box().max.z(), 10, 1e-12);
  EXPECT_NEAR(plain.box().max.x() - plain.box().min.x(), 5, 1e-9);
  const Built tall = point({{"natural", "tree"}, {"height", "29"}, {"diameter_crown", "8"}, {"circumference", "300"}});
  EXPECT_NEAR(tall.box().max.z(), 29, 1e-12);
  EXPECT_NEAR(tall.shapes[0].tree->trunk_m, 3 / std::numbers::pi, 1e-12) << "in centimetres";
  const Built spruce = point({{"natural", "tree"}, {"leaf_type", "needleleaved"}});
  EXPECT_LT(spruce.volume(), plain.volume());
  EXPECT_GT(spruce.volume(), 10);
  EXPECT_NEAR(point({{"natural", "tree"}, {"height", "11"}, {"min_height", "7.5"}}).box().min.z(), 7.5, 1e-12);
  EXPECT_EQ(line({{"natural", "tree_row"}}, {{0, 0}, {40, 0}}).shapes.size(), 6u);
  EXPECT_EQ(line({{"natural", "tree_row"}}, {{0, 0}, {1, 0}}).shapes.size(), 2u);
  EXPECT_EQ(line({{"natural", "tree_row"}}, kRing).shapes.size(), 8u);
}

TEST(CityOccluders, RandomTagsAndLines) {
  Random random(61);
  const std::vector<std::string> values = {"0.01", "1", "3.5", "500", "-2", "x", "0", "150", "2;3", "5'11\""};
  const std::vector<std::vector<std::pair<std::string, std::string>>> kinds = {
      {{"barrier", "wall"}}, {{"barrier", "hedge"}},    {{"bridge", "yes"}, {"highway", "service"}},
      {{"natural", "tree"}}, {{"natural", "tree_row"}}, {{"man_made", "water_tower"}, {"roof:shape", "cone"}},
      {{"man_made", "mast"}}};
  for (int round = 0; round < 60; ++round) {
    osm::Tags tags{kinds[static_cast<std::size_t>(random.integer(0, static_cast<int>(kinds.size()) - 1))]};
    for (const char* key :
         {"height", "width", "min_height", "diameter", "layer", "lanes", "diameter_crown", "roof:height"}) {
      if (random.chance(0.4)) {
        tags.all.emplace_back(key,
                              values[static_cast<std::size_t>(random.integer(0, static_cast<int>(values.size()) - 1))]);
      }
    }
    std::vector<Vec2> points;
    for (int i = random.integer(2, 9); i > 0; --i) points.emplace_back(random.uniform(0, 40), random.uniform(0, 40));
    if (random.chance(0.3)) points.push_back(points.front());
    Built built;
    built.shapes =
        shapes_of_line(tags, points, random.chance(0.5) ? 7 : 0, OccluderDefaults(), BuildingDefaults(), built.remarks);
    for (Shape& shape : shapes_of_point(tags, points[0], OccluderDefaults(), BuildingDefaults(), built.remarks))
      built.shapes.push_back(shape);
    expect_sound(built);
    ASSERT_FALSE(built.shapes.empty()) << round;
  }
}

}  // namespace
}  // namespace vantage::internal::city
