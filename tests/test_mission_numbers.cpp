// Numbers of mission files, and the names that are nearest to misspelled ones.
#include <gtest/gtest.h>

#include <utility>

#include "common/input.h"

namespace vantage {
namespace {

TEST(MissionNumbers, AreReadAsDecimals) {
  for (const auto& [text, value] : {std::pair("0", 0.0),
                                    {"-0", -0.0},
                                    {"12.5", 12.5},
                                    {"+3", 3.0},
                                    {".5", 0.5},
                                    {"5.", 5.0},
                                    {"1e3", 1000.0},
                                    {"1E-3", 0.001},
                                    {"010", 10.0},
                                    {"0.1", 0.1},
                                    {"1.7976931348623157e308", 1.7976931348623157e308}}) {
    const auto parsed = parse_number(text);
    EXPECT_EQ(parsed.fault, NumberFault::none) << text;
    EXPECT_EQ(parsed.value, value) << text;
  }
  for (const char* text :
       {"", " 1", "1 ", "+", "-", "+-1", "--1", "1e", "e5", "1.2.3", "0x1p3", "1_0", "1'0", "\xC2\xB2"}) {
    EXPECT_EQ(parse_number(text).fault, NumberFault::not_a_number) << text;
  }
}

TEST(MissionNumbers, LengthsMayHaveAUnit) {
  for (const auto& [text, metres] : {std::pair("12.5", 12.5),
                                     {"400 ft", 121.92},
                                     {"400ft", 121.92},
                                     {"+400\tFT", 121.92},
                                     {"-3 Ft", -0.9144},
                                     {"1 mi", 1609.344},
                                     {"0.5Mi", 804.672},
                                     {"1.2 km", 1200.0},
                                     {"2e3 m", 2000.0},
                                     {"7.5 cm", 0.075},
                                     {"30 mm", 0.03},
                                     {"0 ft", 0.0}}) {
    const ParsedNumber parsed = parse_length(text);
    EXPECT_EQ(parsed.fault, NumberFault::none) << text;
    EXPECT_EQ(parsed.value, metres) << text;
  }
  for (const char* text :
       {"400 M", "5 Mm", "400 nm", "400 f", "400 feet long", "3'", "400 ft ft", "400 yd", "60 deg", "5 %"}) {
    EXPECT_EQ(parse_length(text).fault, NumberFault::unknown_unit) << text;
  }
  for (const char* text :
       {"", "ft", "m 5", " 5 m", "5 ", "+-5 m", "--5 m", "five m", "1,000 ft", "1_000 m", "0x10 m", "5 m 3"}) {
    EXPECT_EQ(parse_length(text).fault, NumberFault::not_a_number) << text;
  }
  EXPECT_EQ(parse_length("inf").fault, NumberFault::not_finite);
  EXPECT_EQ(parse_length("1e400 ft").fault, NumberFault::out_of_range);
  EXPECT_EQ(parse_length("5 MM").value, 0.005);
  EXPECT_EQ(parse_length("1e308 ft").fault, NumberFault::none);
  EXPECT_NEAR(parse_length("1e308 ft").value / 3.048e307, 1, 1e-15);
  EXPECT_EQ(parse_length("1e308 mi").fault, NumberFault::out_of_range);
  EXPECT_EQ(parse_angle("60").value, 60);
  EXPECT_EQ(parse_angle("60 deg").value, 60);
  EXPECT_EQ(parse_angle("-90\u00b0").value, -90);
  EXPECT_EQ(parse_angle("60 rad").fault, NumberFault::unknown_unit);
  EXPECT_EQ(parse_angle("60 m").fault, NumberFault::unknown_unit);
}

TEST(MissionNumbers, AreWrittenShort) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(-1e9), "-1e+09");
  EXPECT_EQ(shortest(4785000), "4785000");
}

TEST(NearestName, CountsSlips) {
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("max_range", "max_range"), 0);
  EXPECT_EQ(edit_distance("max_rnage", "max_range"), 1) << "neighbours swapped";
  EXPECT_EQ(edit_distance("Max_Range", "max_range"), 0) << "case is not a slip";
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(nearest_name("altitud", {"boxes", "altitude", "meshes"}), "altitude");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(NearestName, WhatHoldsTheWordsComesFirst) {
  const std::string whole = "Zuccotti Park (Liberty Plaza Park)", shorter = "West Zuccotti Park";
  EXPECT_EQ(nearest_name("zuccotti park", {"Zuccatto Yard", whole, shorter}), shorter);
  EXPECT_EQ(nearest_name("Zuccotti Park", {"Zucchetti Park", whole}), whole);
  EXPECT_EQ(nearest_name("in", {"ground inside", "on"}), "on") << "two letters are in many names";
}

}  // namespace
}  // namespace vantage
