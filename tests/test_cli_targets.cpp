// The program with several targets: their files, tables and rows, and the files of the user beside them.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/cli_fixture.h"
#include "support/temporary_directory.h"
#include "support/wording.h"

namespace vantage {
namespace {

class CliTargets : public testing::Cli {
 protected:
  void of(const std::string& combine) {
    write("mission.yaml", std::string(testing::kScene) + testing::kSensor + "combine: " + combine +
                              "\ntargets:\n  - {name: a square, vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0]]}\n"
                              "  - {object: block, part: facade, facing: west}\n");
  }
};

TEST_F(CliTargets, EachHasAVolumeAndARow) {
  of("each");
  output_of({"compute", "mission.yaml", "-o", "made.ply"});
  const std::vector<std::string> table = testing::lines(testing::content(folder_ / "made.table.csv"));
  ASSERT_EQ(table.size(), 3U);
  testing::expect_wording(table[0]);
  const std::string square = "a square,computed,,", facade = "\"block, facade facing west\",computed,,",
                    last = ",made.a_square.ply";
  EXPECT_EQ(table[1].rfind(square, 0), 0U) << table[1];
  EXPECT_TRUE(table[1].ends_with(last)) << table[1];
  EXPECT_EQ(table[2].rfind(facade, 0), 0U) << table[2];
  const std::string wall = "made.block__facade_facing_west.ply";
  output_of({"verify", "mission.yaml", "made.a_square.ply", "--points", "500"});
  output_of({"verify", "mission.yaml", wall, "--points", "500"});
  EXPECT_EQ(run({"verify", "mission.yaml", wall, "--points", "500", "--target", "a square"}).exit_code, 1)
      << "of another target";
  expect_bad({"verify", "mission.yaml", wall, "--target", "b square"}, "--target");
  const std::filesystem::path report = folder_ / "made.a_square.report.json";
  EXPECT_TRUE(std::filesystem::exists(report));
}

TEST_F(CliTargets, NoVolumeOverwritesAnother) {
  write("mission.yaml", std::string(testing::kScene) + testing::kSensor +
                            "combine: each\ntargets:\n  - {name: b.c, point: [0, 0, 5]}\n"
                            "  - {name: c, point: [20, 0, 5]}\n");
  expect_bad({"compute", "mission.yaml", "-o", "o.ply", "-o", "o.b.ply"}, "o.b.c.ply");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "o.c.ply"));
}

TEST_F(CliTargets, TellsWhichTargetHasNoVolume) {
  const auto targets = [&](const std::string& of_low) {
    write("mission.yaml", std::string(testing::kScene) + testing::kSensor +
                              "combine: each\ntargets:\n  - {name: low, " + of_low +
                              "}\n  - {name: high, point: [0, 0, 500]}\n" + "navigation: {altitude: [495, 510]}\n");
  };
  targets("point: [0, 0, 502]");
  EXPECT_EQ(run({"compute", "mission.yaml", "-o", "o.ply"}).exit_code, 0);
  targets("point: [0, 0, 5]");
  const auto again = run({"compute", "mission.yaml", "-o", "o.ply", "-o", "o.stl"});
  EXPECT_EQ(again.exit_code, 1);
  testing::expect_wording(again.err);
}

TEST_F(CliTargets, QueriesMeanTheSame) {
  write("points.csv", "x,y,z\n0,0,6\n60,0,1\n");
  of("each");
  const std::vector<std::string> each = testing::lines(output_of({"query", "mission.yaml", "points.csv"}));
  ASSERT_EQ(each.size(), 5U);
  testing::expect_wording(each[0]);
  const std::string square = ",a square", facade = ",\"block, facade facing west\"";
  EXPECT_TRUE(each[1].ends_with(square)) << each[1];
  EXPECT_TRUE(each[2].ends_with(facade)) << each[2];
  const std::vector<std::string> one =
      testing::lines(output_of({"query", "mission.yaml", "points.csv", "--target", "a square"}));
  EXPECT_EQ(one.size(), 3U);
  of("any");
  EXPECT_NE(output_of({"query", "mission.yaml", "points.csv"}).find("0,0,6,true,"), std::string::npos);
  expect_bad({"query", "mission.yaml", "points.csv", "--fraction", "area"}, "--fraction");
  output_of({"compute", "mission.yaml", "-o", "any.ply"});
  EXPECT_EQ(run({"verify", "mission.yaml", "any.ply", "--points", "500"}).exit_code, 0);
}

TEST_F(CliTargets, WhatOneVolumeHasAlone) {
  of("each");
  expect_bad({"compute", "mission.yaml", "-o", "made.ply", "--json"}, "--json");
  expect_bad({"compute", "mission.yaml", "-o", "-", "--format", "ply"}, "-o -");
  expect_bad({"verify", "mission.yaml", "city.obj"}, "city.obj");
  write("made.table.csv/old", "a folder");
  expect_bad({"compute", "mission.yaml", "-o", "made.ply"}, "made.table.csv");
}

TEST_F(CliTargets, NoFileOfTheUsersOwnIsReplaced) {
  of("each");
  write("table.csv", "my,own,table\n");
  output_of({"compute", "mission.yaml", "-q", "-o", "made.ply"});
  EXPECT_EQ(testing::content(folder_ / "table.csv"), "my,own,table\n");
  output_of({"compute", "mission.yaml", "-q", "-o", "made.ply"});  // over what the last run wrote
  for (const char* const name :
       {"made.table.csv", "made.a_square.ply", "made.a_square.report.json", "made.block__facade_facing_west.ply"}) {
    const std::string own = testing::content(folder_ / name);
    write(name, "my,own,table\n");
    expect_bad({"compute", "mission.yaml", "-o", "made.ply"}, name);
    write(name, own);
  }
  output_of({"compute", "mission.yaml", "-q", "-o", "made.ply"});
}

/// Nor one that came while the run took long.
TEST_F(CliTargets, NoFileThatCameDuringTheRunIsReplaced) {
  std::string targets;
  for (int i = 10; i < 50; ++i)
    targets += "  - {name: t" + std::to_string(i) + ", point: [0, 0, " + std::to_string(i) + "]}\n";
  write("mission.yaml", std::string(testing::kScene) + testing::kSensor + "combine: each\ntargets:\n" + targets);
  for (const std::string name : {"made.t10.ply", "made.t49.ply", "made.t49.report.json", "made.table.csv"}) {
    bool was_late = false;
    testing::RunOptions options = options_;
    options.shows_progress = true;
    options.signal = SIGCONT;  // is never sent
    options.signal_when = [&](const std::string& err) {
      const std::filesystem::path file = folder_ / name;
      if (err.find("vantage: targets") == std::string::npos || was_late || testing::content(file) == "mine")
        return false;
      was_late = std::filesystem::exists(file);
      if (!was_late) testing::write_bytes(file, "mine");
      return false;
    };
    const testing::ProgramRun refused = testing::run_program(
        testing::program_file(), {"compute", "mission.yaml", "-o", "made.ply", "--progress"}, options);
    ASSERT_FALSE(was_late) << name;
    EXPECT_EQ(refused.exit_code, 2) << name << refused.err;
    EXPECT_NE(refused.err.find(name), std::string::npos) << refused.err;
    EXPECT_EQ(testing::content(folder_ / name), "mine");
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      if (entry.path().filename().string().starts_with("made.")) std::filesystem::remove(entry.path());
    }
  }
}

}  // namespace
}  // namespace vantage
