// vantage simplify: what it writes can be proved, and what its exit code says.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "support/cli_fixture.h"

namespace vantage {
namespace {

class CliSimplify : public testing::Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    write("mission.yaml",
          std::string(testing::kScene) + testing::kTarget + testing::kSensor + "exact: {tolerance: 0.2}\n");
    output_of({"compute", "mission.yaml", "-q", "-o", "v.ply", "-o", "v.stl"});
  }
};

TEST_F(CliSimplify, WhatItWritesIsProved) {
  for (const char* name : {"small.ply", "small.obj"}) {
    const std::string table = output_of({"simplify", "v.ply", "--facets", "200", "-o", name});
    EXPECT_NE(table.find(name), std::string::npos) << table;
    const auto proof = nlohmann::json::parse(output_of({"prove", "mission.yaml", name, "--json"}));
    EXPECT_EQ(proof.at("verdict"), "proved");
    EXPECT_EQ(proof.at("facets"), 200);
    const auto difference = nlohmann::json::parse(output_of({"compare", name, "v.ply", "--json"}));
    EXPECT_LT(difference.at("only_a_percent"), 1e-9);
    const double kept = difference.at("volume_a_m3"), whole = difference.at("volume_b_m3");
    EXPECT_GT(kept, 0.9 * whole);
  }
}

/// Nobody need say again what the volume is for, and causes are those of the facets that were there.
TEST_F(CliSimplify, TheFileSaysWhatItIsFor) {
  output_of({"simplify", "v.ply", "--error", "0.5", "-q", "-o", "small.ply"});
  const std::string small = testing::content(folder_ / "small.ply").substr(0, 4000),
                    whole = testing::content(folder_ / "v.ply").substr(0, 4000);
  for (const char* key : {"\"lift_m\"", "\"scene_hash\"", "cause 0", "rounding_m 0"}) {
    EXPECT_NE(small.find(key), std::string::npos) << key;
    EXPECT_NE(whole.find(key), std::string::npos) << key;
  }
  const auto result = run({"prove", "mission.yaml", "small.ply"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(result.err, "");  // no warning of another mission, or a mesh that was changed
}

TEST_F(CliSimplify, APlaceThatIsMissingIsSaidBeforeTheWork) {
  write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");  // no volume: the work would fail
  for (const char* output : {"out.kml", "out.tiles"}) {
    const auto simplified = run({"simplify", "open.obj", "--facets", "4", "-o", output, "--json"});
    EXPECT_EQ(simplified.exit_code, 2);
    EXPECT_NE(simplified.err.find(output), std::string::npos) << simplified.err;
    const auto compared = run({"compare", "open.obj", "open.obj", "--only-b", output});
    EXPECT_EQ(compared.exit_code, 2);
    EXPECT_NE(compared.err.find(output), std::string::npos) << compared.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / output));
  }
}

TEST_F(CliSimplify, TheErrorHasUnits) {
  const auto size = [&](const std::string& error) {
    const auto json =
        nlohmann::json::parse(output_of({"simplify", "v.ply", "--error", error, "-o", "s.ply", "--json"}));
    return json.at("facets").get<std::size_t>();
  };
  const std::size_t feet = size("1 ft");
  EXPECT_EQ(feet, size("0.3048"));
  EXPECT_NE(feet, size("1"));
  expect_bad({"simplify", "v.ply", "--error", "1 yd", "-o", "s.ply"}, "command line");
}

TEST_F(CliSimplify, SinglePrecisionSaysSo) {
  const auto json =
      nlohmann::json::parse(output_of({"simplify", "v.stl", "--facets", "200", "-o", "small.stl", "--json"}));
  EXPECT_GT(json.at("rounding_m"), 0);
  const auto exact =
      nlohmann::json::parse(output_of({"simplify", "v.ply", "--facets", "200", "-o", "b.ply", "--json"}));
  EXPECT_EQ(exact.at("rounding_m"), 0);
  EXPECT_EQ(exact.at("facets"), 200);
  EXPECT_EQ(exact.at("reached"), true);
  EXPECT_EQ(exact.at("pieces"), 1);
  EXPECT_EQ(exact.at("written"), "b.ply");
  EXPECT_NEAR(exact.at("kept_percent").get<double>(),
              100 * exact.at("volume_after_m3").get<double>() / exact.at("volume_before_m3").get<double>(), 1e-9);
  const auto of_stl = nlohmann::json::parse(testing::content(folder_ / "v.stl.place.json"));
  const auto kept = nlohmann::json::parse(output_of({"simplify", "v.stl", "--facets", "200", "-o", "c.ply", "--json"}));
  EXPECT_EQ(kept.at("rounding_m"), of_stl.at("vantage").at("rounding_m"));
  const std::string sidecar = testing::content(folder_ / "small.stl.place.json");
  EXPECT_NE(sidecar.find("rounding_m"), std::string::npos) << sidecar;
}

TEST_F(CliSimplify, MoreFacetsThanAskedForIsOne) {
  const auto result = run({"simplify", "v.ply", "--facets", "10", "--error", "0.1", "-o", "small.ply", "--json"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out).at("reached"), false);
  EXPECT_GT(nlohmann::json::parse(result.out).at("facets"), 10);
  EXPECT_EQ(run({"prove", "mission.yaml", "small.ply", "-q"}).exit_code, 0);
}

TEST_F(CliSimplify, RefusesWhatItCannotDo) {
  expect_bad({"simplify", "v.ply", "-o", "small.ply"}, "command line");
  expect_bad({"simplify", "v.ply", "--facets", "3", "-o", "small.ply"}, "facets");
  expect_bad({"simplify", "v.ply", "--error", "-0.1", "-o", "small.ply"}, "error_m");
  expect_bad({"simplify", "v.ply", "--facets", "100", "-o", "v.ply"}, "v.ply");
  expect_bad({"simplify", "v.ply", "--facets", "100", "-o", "small.txt"}, "small.txt");
  expect_bad({"simplify", "missing.ply", "--facets", "100", "-o", "small.ply"}, "missing.ply");
  expect_bad({"simplify", "v.ply", "--facets", "100", "--up", "y", "-o", "small.ply"}, "command line");
  expect_bad({"simplify", "city.obj", "--facets", "4", "-o", "small.ply"}, "city.obj");
}

}  // namespace
}  // namespace vantage
