#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "maps/city/building_form.h"
#include "support/osm_maps.h"
#include "support/random.h"
#include "support/wording.h"

namespace vantage::internal::city {
namespace {

using vantage::testing::Random;
using vantage::testing::tagged;

struct Reading {
  BuildingForm form;
  std::vector<TagRemark> remarks;

  bool has(TagFault fault, const std::string& key = "") const {
    return std::any_of(remarks.begin(), remarks.end(),
                       [&](const TagRemark& r) { return r.fault == fault && r.key == key; });
  }
};

Reading read(std::initializer_list<std::pair<std::string, std::string>> all, const osm::Tags* outline = nullptr) {
  Reading reading;
  reading.form = read_form(tagged(all), outline, BuildingDefaults(), reading.remarks);
  return reading;
}

TEST(CityForm, Lengths) {
  const std::vector<std::pair<const char*, double>> lengths = {{"48.5", 48.5},
                                                               {"48.5 m", 48.5},
                                                               {"48,5m", 48.5},
                                                               {" 12.13 m ", 12.13},
                                                               {"160 ft", 48.768},
                                                               {"160'", 48.768},
                                                               {"5'11\"", 1.8034},
                                                               {"5' 11\"", 1.8034},
                                                               {"5'11", 1.8034},
                                                               {"7'0\"", 2.1336},
                                                               {"0.2 km", 200},
                                                               {"5;5.5", 5.5},
                                                               {"5.5;5;", 5.5},
                                                               {"250 cm", 2.5},
                                                               {"-3", -3},
                                                               {"+4", 4},
                                                               {".5", 0.5},
                                                               {"10 metres", 10},
                                                               {"10M", 10},
                                                               {"3 feet", 0.9144},
                                                               {"24\"", 0.6096},
                                                               {"24 in", 0.6096},
                                                               {"5\u203211\u2033", 1.8034},
                                                               {"-5'6\"", -1.6764}};
  for (const auto& [text, metres] : lengths) {
    const std::optional<double> length = parse_length_m(text);
    ASSERT_TRUE(length) << text;
    EXPECT_NEAR(*length, metres, 1e-12) << text;
  }
  for (const char* text :
       {"",    "concrete", "m",     "nan", "inf",    "-inf",   "1e3", "0x10", "10-12", "1,5-2,5", "12 storeys",
        "5;x", ";",        "1.2.3", "--3", "5'13\"", "5'-1\"", "5'x", "'",    "\"",    "4''5",    "."}) {
    EXPECT_FALSE(parse_length_m(text)) << text;
  }
  EXPECT_FALSE(parse_length_m(std::string(1000, '9'))) << "not finite";
}

TEST(CityForm, WhatIsNoPlainNumberIsTakenForTheMostThatItMayMean) {
  const std::vector<std::pair<const char*, double>> lengths = {{"13-22", 22},
                                                               {"~22", 22},
                                                               {"22 m (approx)", 22},
                                                               {"10 storeys", 30},
                                                               {"10-storey", 30},
                                                               {"10 (storeys)", 30},
                                                               {"G+5", 18},
                                                               {"2\u00bd m", 2.5},
                                                               {"1,250 ft", 381},
                                                               {"2,500", 2.5},  // and no 2500 m
                                                               {"0,125 m ?", 0.125},
                                                               {"0.3 km?", 300},
                                                               {"0.2 kilometres", 200},
                                                               {"12+3", 15},
                                                               {"~5'11\"", 1.8034},
                                                               {"R+5", 18},
                                                               {"GF + 5", 18},
                                                               {"22 + antenna", 22},
                                                               {"1\u00bd-2\u00bd", 2.5},
                                                               {"~2 1/2 m", 2.5},
                                                               {"built 2020, 35 m", 35},
                                                               {"35 m, built 2020", 35},
                                                               {"12 in height", 12},
                                                               {"~12 in", 0.3048},
                                                               {"2,000,000", 2e6},  // which is too large to be one
                                                               {"1'000", 1000},
                                                               {"1'050", 1050},
                                                               {"30'000 mm", 30},
                                                               {"30.000 mm", 30},
                                                               {"1.250 ft", 381},
                                                               {"1.250,5 ft", 381.1524},
                                                               {"1 250 ft", 381},
                                                               {"1\u00a0250 ft", 381},
                                                               {"1\u202f250 ft", 381},
                                                               {"~48.123", 48.123},
                                                               {"0.1 mi", 160.9344},
                                                               {"0.2\u202fkm", 200},
                                                               {"10 \u00e9tages", 30},
                                                               {"5F", 15},
                                                               {"5\u5c42", 15},
                                                               {"30..50", 50},
                                                               {"30\u00b12", 32},
                                                               {"10 m plus 5 m", 15},
                                                               {"2x15", 30},
                                                               {"2 \u00d7 15 m", 30},
                                                               {"2*15 ft", 9.144},
                                                               {"3 dam", 30},
                                                               {"1/50 mi", 32.18688},
                                                               {".1 NM", 185.2},
                                                               {"30/40", 40},
                                                               {"10 andares", 30},
                                                               {"10 etasjer", 30},
                                                               {"10 kat", 30},
                                                               {"10 v\u00e5ningar", 30},
                                                               {"10 V\u00c5NINGAR", 30},
                                                               {"10 emelet", 30}};
  for (const auto& [text, metres] : lengths) {
    const std::optional<double> length = any_length_m(text, 3);
    ASSERT_TRUE(length) << text;
    EXPECT_NEAR(*length, metres, 1e-9) << text;
  }
  for (const char* text : {"1,250 ft", "1.250 ft", "30.000 mm", "1'000"}) {
    EXPECT_FALSE(parse_length_m(text)) << text << ": a thousand, or one and a quarter";
  }
  EXPECT_EQ(parse_length_m("48.123 m"), 48.123);
  const std::vector<std::pair<const char*, double>> levels = {
      {"5+1", 6},      {"G+5", 6}, {"2-3", 3},    {"2\u00bd", 2.5}, {"2 \u00bd", 2.5}, {"~7", 7},       {"3+", 3},
      {"1,250", 1.25}, {"R+5", 6}, {"P+5+Pk", 7}, {"2019: 5", 5},   {"2 1/2", 2.5},    {"1,2,3,4,5", 5}};
  for (const auto& [text, count] : levels) EXPECT_EQ(roughly_levels(text), count) << text;
  for (const char* text : {"", "high", "-", "?"}) EXPECT_FALSE(any_length_m(text, 3)) << text;
}

TEST(CityForm, LevelsAndDirections) {
  EXPECT_EQ(parse_levels("3"), 3);
  EXPECT_EQ(parse_levels("2.5"), 2.5);
  EXPECT_EQ(parse_levels("2;3"), 3);
  EXPECT_EQ(parse_levels("0"), 0);
  for (const char* text : {"concrete", "", "3 m", "1-3", "three"}) EXPECT_FALSE(parse_levels(text)) << text;
  const std::vector<std::pair<const char*, double>> directions = {
      {"45", 45},     {"45°", 45},  {"NE", 45}, {"north", 0},     {"North-East", 45},         {"southwest", 225},
      {"nnw", 337.5}, {"-90", 270}, {"360", 0}, {"209.5", 209.5}, {"north-north-west", 337.5}};
  for (const auto& [text, degrees] : directions) {
    const std::optional<double> direction = parse_direction_deg(text);
    ASSERT_TRUE(direction) << text;
    EXPECT_EQ(*direction, degrees) << text;
  }
  for (const char* text : {"", "up", "forward", "northnorth", "45 m", "ns", "nan", "n e"}) {
    const std::optional<double> direction = parse_direction_deg(text);
    EXPECT_FALSE(direction) << text << " " << direction.value_or(-1);
  }
}

TEST(CityForm, RoofShapes) {
  for (int k = 0; k < kRoofShapes; ++k) {
    const auto shape = static_cast<RoofShape>(k);
    const std::optional<RoofShape> name = parse_roof_shape(text(shape));
    ASSERT_TRUE(name) << text(shape);
    EXPECT_EQ(*name, shape);
  }
  EXPECT_EQ(parse_roof_shape("half_hipped"), RoofShape::half_hipped);
  EXPECT_EQ(parse_roof_shape(" Pitched "), RoofShape::gabled);
  EXPECT_EQ(parse_roof_shape("lean-to"), RoofShape::skillion);
  for (const char* text : {"", "many", "9.0", "sawtooth", "double_saltbox", "cross_gabled"})
    EXPECT_FALSE(parse_roof_shape(text)) << text;
}

TEST(CityForm, HeightsAndTheirOrder) {
  const Reading plain = read({{"building", "yes"}});
  EXPECT_EQ(plain.form.top_m, 9);
  EXPECT_EQ(plain.form.bottom_m, 0);
  EXPECT_EQ(plain.form.roof, RoofShape::flat);
  EXPECT_TRUE(plain.remarks.empty());
  EXPECT_EQ(read({{"building", "bungalow"}}).form.top_m, 3);
  EXPECT_EQ(read({{"building", "yes"}, {"building:levels", "5"}}).form.top_m, 15);
  EXPECT_EQ(read({{"building", "yes"}, {"building:levels", "5"}, {"height", "21.5 m"}}).form.top_m, 21.5);
  EXPECT_EQ(read({{"building", "yes"}, {"est_height", "8"}}).form.top_m, 8);
  EXPECT_EQ(read({{"building", "yes"}, {"building:levels", "2"}, {"roof:levels", "1"}}).form.top_m, 8.5);
  EXPECT_EQ(read({{"building", "yes"}, {"building:levels", "2"}, {"roof:height", "4"}}).form.top_m, 10);
  const Reading part = read({{"building:part", "yes"}, {"height", "100"}, {"min_height", "5;5.5"}});
  EXPECT_EQ(part.form.bottom_m, 5) << "the lower one hides more";
  const Reading above = read({{"building:part", "yes"}, {"building:levels", "6"}, {"building:min_level", "2"}});
  EXPECT_EQ(above.form.bottom_m, 6);
  const Reading storeys =
      read({{"building:part", "yes"}, {"height", "84"}, {"building:levels", "21"}, {"building:min_level", "20"}});
  EXPECT_NEAR(storeys.form.bottom_m, 80, 1e-9) << "levels of 4 m";
}

TEST(CityForm, PartsInheritTheKindAlone) {
  const osm::Tags church = tagged({{"building", "church"}, {"height", "50"}, {"min_height", "3"}});
  const Reading part = read({{"building:part", "yes"}}, &church);
  EXPECT_EQ(part.form.top_m, 12);
  EXPECT_EQ(part.form.bottom_m, 0);
  EXPECT_EQ(read({{"building:part", "roof"}}, &church).form.deck_m, 0.5);
  const osm::Tags roof = tagged({{"building", "roof"}, {"height", "5"}});
  EXPECT_EQ(read({{"building:part", "yes"}, {"height", "5"}}, &roof).form.deck_m, 0) << "it does not say so itself";
}

TEST(CityForm, AHeightIsAGuessWhereNoTagSaysIt) {
  for (const auto& [key, value] : {std::pair{"name", "Hall"},
                                   {"height", "tall"},
                                   {"height", "-5"},
                                   {"height", "0"},
                                   {"building:levels", "0"},
                                   {"min_height", "20"},
                                   {"roof:height", "3"}}) {
    EXPECT_TRUE(read({{"building:part", "yes"}, {key, value}}).form.is_guessed) << key << "=" << value;
  }
  for (const auto& [key, value] : {std::pair{"height", "3"}, {"height", "10-30"}, {"building:levels", "2"}}) {
    EXPECT_FALSE(read({{"building:part", "yes"}, {key, value}}).form.is_guessed) << key << "=" << value;
  }
  EXPECT_FALSE(read({{"building:part", "yes"}, {"building:levels", "0"}, {"roof:height", "4"}}).form.is_guessed);
}

TEST(CityForm, NonsenseIsRemarkedOnAndTakenAsUntagged) {
  const Reading concrete = read({{"building", "yes"}, {"height", "concrete"}, {"building:levels", "concrete"}});
  EXPECT_EQ(concrete.form.top_m, 9);
  ASSERT_EQ(concrete.remarks.size(), 2u);
  EXPECT_TRUE(concrete.has(TagFault::no_value, "height"));
  EXPECT_TRUE(concrete.has(TagFault::no_value, "building:levels"));
  vantage::testing::expect_wording(concrete.remarks[0].for_people().text);
  const Reading negative = read({{"building", "yes"}, {"height", "-12"}, {"building:levels", "2"}});
  EXPECT_EQ(negative.form.top_m, 6);
  EXPECT_TRUE(negative.has(TagFault::negative, "height"));
  EXPECT_TRUE(read({{"building", "yes"}, {"height", "0"}}).has(TagFault::zero, "height"));
  EXPECT_EQ(read({{"building", "yes"}, {"height", "0"}, {"est_height", "7"}}).form.top_m, 7);
  const Reading large = read({{"building", "yes"}, {"height", "99999"}, {"building:levels", "2"}});
  EXPECT_TRUE(large.has(TagFault::too_large, "height"));
  EXPECT_TRUE(large.remarks[0].unsure);
  EXPECT_EQ(large.form.top_m, 1500) << "however few its storeys";
  EXPECT_EQ(read({{"building", "yes"}, {"est_height", "2 km"}}).form.top_m, 1500);
  EXPECT_EQ(read({{"building:part", "yes"}, {"height", "1600-1700"}, {"min_height", "20"}}).form.bottom_m, 20);
  EXPECT_TRUE(read({{"building", "yes"}, {"building:levels", "0"}}).has(TagFault::zero, "building:levels"));
  EXPECT_EQ(read({{"building", "yes"}, {"building:levels", "0"}}).form.top_m, 9);
  EXPECT_EQ(read({{"building", "yes"}, {"building:levels", "0"}, {"roof:height", "4"}}).form.top_m, 4);
  const Reading below = read({{"building", "retail"}, {"height", "19.9"}, {"building:min_level", "-1"}});
  EXPECT_EQ(below.form.bottom_m, 0);
  EXPECT_TRUE(below.has(TagFault::negative, "building:min_level"));
  const Reading many = read({{"building", "yes"}, {"roof:shape", "many"}, {"roof:direction", "up"}});
  EXPECT_TRUE(many.form.is_box);
  EXPECT_TRUE(many.has(TagFault::unknown_roof, "roof:shape"));
}

TEST(CityForm, MinHeightNotBelowHeight) {
  const Reading above = read({{"building:part", "yes"}, {"height", "48"}, {"min_height", "51"}});
  EXPECT_EQ(above.form.bottom_m, 0);
  EXPECT_EQ(above.form.top_m, 48);
  EXPECT_TRUE(above.has(TagFault::bottom_too_high, "min_height"));
  const Reading equal = read({{"building:part", "yes"}, {"height", "5"}, {"min_height", "5"}});
  EXPECT_EQ(equal.form.bottom_m, 4.5);
  EXPECT_EQ(equal.form.top_m, 5);
  EXPECT_TRUE(equal.has(TagFault::bottom_too_high, "min_height"));
  EXPECT_EQ(read({{"building:part", "yes"}, {"height", "5"}, {"min_height", "4.995"}}).form.bottom_m, 4.5);
  const Reading levels = read({{"building:part", "yes"}, {"building:levels", "2"}, {"building:min_level", "2"}});
  EXPECT_EQ(levels.form.bottom_m, 6);
  EXPECT_EQ(levels.form.top_m, 12);
  EXPECT_TRUE(levels.has(TagFault::bottom_too_high, "building:levels"));
  const Reading dome =
      read({{"building", "church"}, {"min_height", "18"}, {"roof:shape", "dome"}, {"roof:height", "5"}});
  EXPECT_EQ(dome.form.bottom_m, 18);
  EXPECT_EQ(dome.form.top_m, 23);
  EXPECT_EQ(dome.form.roof_m, 5);
  EXPECT_TRUE(dome.has(TagFault::no_height, "min_height"));
  EXPECT_EQ(read({{"building:part", "yes"}, {"min_height", "13"}}).form.top_m, 16);
}

TEST(CityForm, Roofs) {
  const Reading gabled = read(
      {{"building", "yes"}, {"height", "9"}, {"min_height", "7.9"}, {"roof:shape", "gabled"}, {"roof:height", "1.1"}});
  EXPECT_TRUE(gabled.remarks.empty());
  EXPECT_EQ(gabled.form.roof_m, 9 - 7.9);
  const Reading high = read({{"building", "yes"}, {"height", "9"}, {"roof:shape", "hipped"}, {"roof:height", "11"}});
  EXPECT_EQ(high.form.roof_m, 9);
  EXPECT_TRUE(high.has(TagFault::unknown_roof, "roof:height"));
  EXPECT_TRUE(high.form.is_box) << "no tent";
  const Reading open = read({{"building", "house"}, {"roof:shape", "gabled"}});
  ASSERT_TRUE(open.form.pitch);
  EXPECT_EQ(open.form.pitch->angle_deg, 30);
  EXPECT_TRUE(open.form.pitch->on_top);
  EXPECT_EQ(open.form.top_m, 6);
  const Reading angle = read({{"building", "yes"}, {"height", "9"}, {"roof:shape", "gabled"}, {"roof:angle", "45°"}});
  EXPECT_EQ(angle.form.pitch->angle_deg, 45);
  EXPECT_EQ(angle.form.pitch->most_share, 1);
  EXPECT_FALSE(angle.form.pitch->on_top);
  EXPECT_TRUE(read({{"building", "yes"}, {"roof:shape", "gabled"}, {"roof:angle", "95"}})
                  .has(TagFault::unknown_roof, "roof:angle"));
  const Reading turned = read({{"building", "yes"},
                               {"roof:shape", "skillion"},
                               {"roof:height", "2"},
                               {"roof:direction", "SW"},
                               {"roof:orientation", "across"}});
  EXPECT_EQ(turned.form.roof_direction_deg, 225);
  EXPECT_TRUE(turned.form.roof_across);
  EXPECT_TRUE(turned.remarks.empty());
  EXPECT_TRUE(read({{"building", "yes"}, {"roof:shape", "gabled"}, {"roof:orientation", "2"}})
                  .has(TagFault::unknown_roof, "roof:orientation"));
  EXPECT_TRUE(read({{"building", "yes"}, {"roof:shape", "skillion"}}).has(TagFault::no_direction, "roof:shape"));
  EXPECT_EQ(read({{"building", "yes"}, {"roof:shape", "gabled"}, {"roof:height", "0"}}).form.roof, RoofShape::flat);
}

TEST(CityForm, RoofsThatCannotBeReadAreBoxes) {
  const auto roof = [](const char* key, const char* value, const char* shape = "gabled") {
    return read({{"building", "yes"}, {"height", "20"}, {"roof:shape", shape}, {key, value}});
  };
  for (const char* height : {"2;15", "2-15", "30", "-3", "high"}) {
    const Reading box = roof("roof:height", height);
    EXPECT_TRUE(box.form.is_box) << height;
    ASSERT_EQ(box.remarks.size(), 1U) << height;
    EXPECT_TRUE(box.remarks[0].unsure) << height;
  }
  EXPECT_FALSE(roof("roof:height", "15").form.is_box);
  for (const char* angle : {"45 deg", "45 degrees", "45\u00b0", "45"}) {
    EXPECT_EQ(roof("roof:angle", angle).form.pitch->angle_deg, 45) << angle;
    EXPECT_FALSE(roof("roof:angle", angle).form.is_box) << angle;
  }
  for (const auto& [angle, degrees] :
       {std::pair{"40;50", 50.0}, {"~45", 60.0}, {"~70", 70.0}, {"100%", 60.0}, {"1:1", 60.0}, {"steep", 60.0}}) {
    const Reading box = roof("roof:angle", angle);
    EXPECT_TRUE(box.form.is_box && box.remarks[0].unsure) << angle;
    EXPECT_EQ(box.form.pitch->angle_deg, degrees) << angle;
  }
  for (const auto& [key, value] : {std::pair{"roof:direction", "up"}, {"roof:orientation", "accross"}}) {
    const Reading box = roof(key, value);
    EXPECT_TRUE(box.form.is_box) << key;
    EXPECT_TRUE(box.remarks[0].unsure) << key;
  }
  const Reading anywhere = roof("roof:height", "3", "skillion");
  EXPECT_TRUE(anywhere.form.is_box) << "any of its sides may be the high one";
  EXPECT_FALSE(anywhere.remarks[0].unsure) << "which is usual";
  EXPECT_FALSE(roof("roof:direction", "90", "skillion").form.is_box);
}

TEST(CityForm, WhereTheTopIsUnsureTheBottomIsTheLowest) {
  const Reading storeys =
      read({{"building:part", "yes"}, {"height", "10-30"}, {"building:levels", "5"}, {"building:min_level", "4"}});
  EXPECT_EQ(storeys.form.bottom_m, 0);
  EXPECT_EQ(storeys.form.top_m, 30);
  EXPECT_EQ(read({{"building", "yes"}, {"height", "8-10"}, {"min_height", "10"}}).form.bottom_m, 0);
  EXPECT_EQ(read({{"building", "yes"}, {"height", "8-10"}, {"min_height", "3"}}).form.bottom_m, 3);
  for (const char* height : {"4-10", "4;10"}) {
    EXPECT_EQ(read({{"building", "roof"}, {"height", height}}).form.deck_m, 0) << height;
  }
}

TEST(CityForm, RoofsOnPosts) {
  const Reading roof = read({{"building", "roof"}, {"height", "6"}});
  EXPECT_EQ(roof.form.deck_m, 0.5);
  EXPECT_EQ(roof.form.bottom_m, 0);
  EXPECT_EQ(read({{"building", "roof"}, {"height", "6"}, {"min_height", "5.8"}}).form.deck_m, 0);
  EXPECT_EQ(read({{"building", "carport"}}).form.top_m, 3);
  const Reading open = read({{"building", "yes"}, {"wall", "no"}});
  EXPECT_EQ(open.form.top_m, 3);
  EXPECT_EQ(open.form.deck_m, 0.5);
}

TEST(CityForm, JoinedFormsHoldBoth) {
  const auto form = [](std::initializer_list<std::pair<std::string, std::string>> tags) { return read(tags).form; };
  const BuildingForm high = form({{"height", "20"}}), raised = form({{"height", "12"}, {"min_height", "3"}});
  EXPECT_EQ(joined(high, raised), high);
  EXPECT_EQ(joined(form({{"height", "20"}, {"min_height", "5"}}), raised).bottom_m, 3);
  EXPECT_EQ(joined(form({{"building", "roof"}, {"height", "5"}}), form({{"building", "roof"}, {"height", "6"}})).deck_m,
            0);
  const BuildingForm tent = form({{"height", "20"}, {"roof:shape", "gabled"}, {"roof:height", "5"}});
  EXPECT_EQ(joined(tent, form({{"height", "15"}})), tent);
  EXPECT_TRUE(joined(tent, form({{"height", "16"}})).is_box);
  const BuildingForm pitched = form({{"building:levels", "6"}, {"roof:shape", "gabled"}});
  const BuildingForm both = joined(high, pitched);
  EXPECT_EQ(both.top_m, 20);
  EXPECT_TRUE(both.is_box && both.pitch && both.pitch->on_top) << "its roof may rise above both";
  EXPECT_EQ(joined(pitched, form({{"building:levels", "5"}, {"roof:shape", "gabled"}})), pitched);
}

TEST(CityForm, RandomTagsAlwaysMakeAForm) {
  Random random(43);
  const std::vector<std::string> keys = {"height",           "min_height",   "building:levels", "building:min_level",
                                         "roof:height",      "roof:levels",  "roof:angle",      "roof:shape",
                                         "roof:direction",   "building",     "est_height",      "wall",
                                         "roof:orientation", "building:part"};
  const std::vector<std::string> values = {"0",      "-1",       "3",      "12.5",  "1e9", "concrete", "5;5.5",
                                           "30",     "roof",     "dome",   "yes",   "no",  "onion",    "SW",
                                           "across", "0.001",    "gabled", "house", "nan", "100 ft",   ";",
                                           "",       "skillion", "3000",   "1500"};
  for (int round = 0; round < 20000; ++round) {
    osm::Tags tags;
    for (const std::string& key : keys) {
      if (random.chance(0.5))
        tags.all.emplace_back(key, values[random.integer(0, static_cast<int>(values.size()) - 1)]);
    }
    std::vector<TagRemark> remarks;
    const BuildingForm form = read_form(tags, nullptr, BuildingDefaults(), remarks);
    ASSERT_TRUE(std::isfinite(form.top_m));
    ASSERT_GE(form.bottom_m, 0);
    ASSERT_GT(form.top_m, form.bottom_m);
    ASSERT_GE(form.roof_m, 0);
    ASSERT_LE(form.roof_m, form.top_m - form.bottom_m);
    ASSERT_FALSE(form.pitch && form.roof_m > 0);
  }
}

}  // namespace
}  // namespace vantage::internal::city
