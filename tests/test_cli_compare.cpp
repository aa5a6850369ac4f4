// `vantage compare`, and point targets through all commands.
#include "support/cli_fixture.h"

namespace vantage::testing {
namespace {

using CliCompare = Cli;
using CliPoint = Cli;

/// A box in the axes and the unit of its file.
std::string box_obj(double x0, double x1, bool y_up = false, double unit = 1, double shift = 0) {
  std::ostringstream obj;
  obj.precision(17);
  for (int i = 0; i < 8; ++i) {
    const double x = ((i & 1 ? x1 : x0) + shift) / unit, y = ((i & 2 ? 3 : 0) + shift) / unit,
                 z = (i & 4 ? 2 : 0) / unit;
    if (y_up) {
      obj << "v " << x << ' ' << z << ' ' << -y << "\n";
    } else {
      obj << "v " << x << ' ' << y << ' ' << z << "\n";
    }
  }
  obj << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  return obj.str();
}

TEST_F(CliCompare, TellsVolumesDifferencesAndDistances) {
  write("a.obj", box_obj(0, 4));
  write("b.obj", box_obj(1, 6));
  const std::string table = output_of({"compare", "a.obj", "b.obj"});
  for (const char* expected : {"A: a.obj", "B: b.obj", "24.000", "30.000", "18.000",
                               "m3, 75.0000 % of A, 60.0000 % of B", "m3, 25.0000 % of A", "m3, 40.0000 % of B",
                               "1.000000", "2.000000", "m from the other, at 6.00", "none is over 2.000000"}) {
    EXPECT_NE(table.find(expected), std::string::npos) << expected << "\n" << table;
  }
  const auto json = nlohmann::json::parse(output_of({"compare", "a.obj", "b.obj", "--json"}));
  EXPECT_NEAR(json.at("volume_a_m3").get<double>(), 24, 1e-9);
  EXPECT_NEAR(json.at("intersection_m3").get<double>(), 18, 1e-9);
  EXPECT_NEAR(json.at("only_a_percent").get<double>(), 25, 1e-9);
  EXPECT_NEAR(json.at("only_b_m3").get<double>(), 12, 1e-9);
  EXPECT_NEAR(json.at("worst_only_b_m").get<double>(), 2, 1e-9);
  const auto worst = json.at("worst_only_b_point").get<std::vector<double>>();
  EXPECT_NEAR(worst.at(0), 6, 1e-9);
  EXPECT_EQ(json.at("written").size(), 0U);
  EXPECT_EQ(output_of({"compare", "a.obj", "b.obj", "-q"}), "");
}

TEST_F(CliCompare, SameMeshesInAnyFormatDifferInNothing) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply", "-o", "v.obj", "-o", "v.stl", "-o", "v.glb"});
  auto json = nlohmann::json::parse(output_of({"compare", "v.ply", "v.obj", "--json"}));
  EXPECT_EQ(json.at("only_a_m3"), 0.0);
  EXPECT_EQ(json.at("only_b_m3"), 0.0);
  EXPECT_EQ(json.at("intersection_m3"), json.at("volume_a_m3"));
  EXPECT_TRUE(json.at("worst_only_a_point").is_null());
  for (const char* rounded : {"v.stl", "v.glb"}) {
    json = nlohmann::json::parse(output_of({"compare", "v.ply", rounded, "--json"}));
    EXPECT_LT(json.at("only_a_percent").get<double>(), 1e-4) << rounded;
    EXPECT_LT(json.at("worst_only_a_m").get<double>(), 1e-4);
  }
}

TEST_F(CliCompare, ObjTakesAxesAndUnit) {
  write("z.obj", box_obj(0, 4));
  write("y.obj", box_obj(0, 4, true, 0.001));
  output_of({"compare", "z.obj", "z.obj", "--json"});
  // Into PLY, so that it stays in the scene frame.
  write("far.obj", box_obj(10, 11));
  output_of({"compare", "z.obj", "far.obj", "--only-a", "z.ply", "-q"});
  const auto json =
      nlohmann::json::parse(output_of({"compare", "z.ply", "y.obj", "--up", "y", "--scale", "0.001", "--json"}));
  EXPECT_NEAR(json.at("only_a_m3").get<double>(), 0, 1e-6);
  EXPECT_NEAR(json.at("only_b_m3").get<double>(), 0, 1e-6);
  // What is written as OBJ comes in the same axes and unit.
  write("y2.obj", box_obj(0, 6, true, 0.001));
  output_of({"compare", "z.ply", "y2.obj", "--up", "y", "--scale", "0.001", "--only-b", "rest.obj", "-q"});
  write("rest_by_hand.obj", box_obj(4, 6, true, 0.001));
  const auto rest = nlohmann::json::parse(
      output_of({"compare", "rest.obj", "rest_by_hand.obj", "--up", "y", "--scale", "0.001", "--json"}));
  EXPECT_NEAR(rest.at("volume_a_m3").get<double>(), 12, 1e-6);
  EXPECT_NEAR(rest.at("intersection_m3").get<double>(), 12, 1e-6);
  EXPECT_NE(output_of({"compare", "z.ply", "far.obj"}).find("--up y, --scale S"), std::string::npos)
      << "nothing shared: the table asks about axes and unit";
  const auto volume_at = [&](const std::string& scale) {
    const auto found = nlohmann::json::parse(output_of({"compare", "far.obj", "far.obj", "--scale", scale, "--json"}));
    return found.at("volume_a_m3").get<double>();
  };
  EXPECT_EQ(volume_at("1 ft"), volume_at("0.3048"));
  EXPECT_LT(volume_at("1 ft"), 0.1 * volume_at("1"));
  expect_bad({"compare", "z.ply", "y.obj", "--scale", "1 yd"}, "command line");
  expect_bad({"compare", "z.ply", "z.ply", "--up", "y"}, "command line");
  expect_bad({"compare", "z.ply", "y.obj", "--scale", "0"}, "command line");
  expect_bad({"compare", "z.ply", "y.obj", "--up", "x"}, "command line");
}

TEST_F(CliCompare, WritesWhatOnlyOneClaims) {
  write("a.obj", box_obj(0, 4, false, 1, 4785000));
  write("b.obj", box_obj(1, 6, false, 1, 4785000));
  const std::string table = output_of({"compare", "a.obj", "b.obj", "--only-a", "volume.ply", "--only-b", "b.glb"});
  for (const char* file : {"volume.ply", "b.glb"}) {
    EXPECT_NE(table.find(std::string("wrote ") + file), std::string::npos) << table;
  }
  const auto json = nlohmann::json::parse(output_of({"compare", "volume.ply", "a.obj", "--json"}));
  EXPECT_NEAR(json.at("volume_a_m3").get<double>(), 6, 1e-6);
  EXPECT_NEAR(json.at("only_a_m3").get<double>(), 0, 1e-6);
  EXPECT_NE(content(folder_ / "volume.ply").find("a.obj"), std::string::npos);
}

TEST_F(CliCompare, WritesNothingWhereNothingDiffers) {
  write("a.obj", box_obj(0, 4));
  const std::string table = output_of({"compare", "a.obj", "a.obj", "--only-a", "volume.ply"});
  EXPECT_NE(table.find("not written"), std::string::npos) << table;
  testing::expect_wording(lines(table).back());
  EXPECT_EQ(content(folder_ / "volume.ply"), kOldOutput);
}

TEST_F(CliCompare, RefusesBadInputAndKeepsOutputs) {
  write("a.obj", box_obj(0, 4));
  write("open.obj", box_obj(0, 4).substr(0, box_obj(0, 4).rfind("f ")));
  write("inside_out.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  std::string crossing = box_obj(0, 4) + box_obj(1, 2).replace(0, 0, "");
  crossing = crossing.substr(0, crossing.rfind("f 1 3 4 2"));
  crossing += "f 9 11 12 10\nf 13 14 16 15\nf 9 10 14 13\nf 11 15 16 12\nf 9 13 15 11\nf 10 12 16 14\n";
  write("overlap.obj", crossing);
  const std::vector<std::string> output = {"--only-a", "volume.ply"};
  const auto with = [&](const std::string& a, const std::string& b) {
    return std::vector<std::string>{"compare", a, b, output[0], output[1]};
  };
  expect_bad(with("open.obj", "a.obj"), "open.obj");
  expect_bad(with("a.obj", "open.obj"), "open.obj");
  expect_bad(with("a.obj", "inside_out.obj"), "inside_out.obj");
  expect_bad(with("overlap.obj", "a.obj"), "overlap.obj");
  expect_bad(with("city.obj", "a.obj"), "city.obj");
  expect_bad(with("none.obj", "a.obj"), "none.obj");
  expect_bad(with("mission.yaml", "a.obj"), "mission.yaml");
  expect_bad({"compare", "a.obj"}, "command line");
  expect_bad({"compare", "a.obj", "a.obj", "--only-a", "a.obj"}, "a.obj");
  expect_bad({"compare", "a.obj", "a.obj", "--only-a", "x.ply", "--only-b", "./x.ply"}, "x.ply");
  expect_bad({"compare", "a.obj", "a.obj", "--only-a", "x.txt"}, "x.txt");
  expect_bad({"compare", "a.obj", "a.obj", "--only-b", "no/where.ply"}, "no/where.ply");
}

TEST_F(CliCompare, HelpHasExamples) {
  const std::string help = output_of({"compare", "--help"});
  for (const char* expected : {"EXAMPLES", "--only-a", "--up", "vantage compare spheres.ply exact.ply"}) {
    EXPECT_NE(help.find(expected), std::string::npos) << help;
  }
}

TEST_F(CliPoint, ComputesVerifiesAndAnswers) {
  for (const char* target : {"point: [0, 0, 6]", "point: [0, 0, 0]", "point: [20, 0, 6]\n  front: [-1, 0, 0]",
                             "point: [25, 0, 12]\n  name: roof"}) {
    SCOPED_TRACE(target);
    write("mission.yaml", std::string(kScene) + kSensor + "target:\n  " + target + "\n");
    const std::string summary = output_of({"compute", "mission.yaml", "-o", "volume.ply"});
    EXPECT_EQ(summary.find("target plane") == std::string::npos,
              std::string(target).find("front") == std::string::npos);
    const auto json = nlohmann::json::parse(output_of({"verify", "mission.yaml", "volume.ply", "--json"}));
    EXPECT_EQ(json.at("right"), true) << json;
    EXPECT_EQ(json.at("euler"), 2);
    EXPECT_LE(json.at("under_claimed").get<int>(), 20);
  }
  write("mission.yaml", std::string(kScene) + kSensor + "target: {point: [0, 0, 6]}\n");
  write("points.csv", "0,0,1\n40,0,6\n0,0,-3\n");
  const std::vector<std::string> answers = lines(output_of({"query", "mission.yaml", "points.csv"}));
  ASSERT_EQ(answers.size(), 4U);
  EXPECT_EQ(answers[1].rfind("0,0,1,true,", 0), 0U) << answers[1];
  EXPECT_NE(answers[2].find(",block,false,"), std::string::npos) << answers[2];
  EXPECT_NE(answers[3].find(",ground,false,"), std::string::npos) << answers[3];
  for (const std::size_t i : {2, 3}) EXPECT_NE(answers[i].find(",false,false,"), std::string::npos) << answers[i];
}

TEST_F(CliPoint, ErrorsSayWhatToDo) {
  const auto mission = [](const std::string& target) {
    return std::string(kScene) + kSensor + "target: {" + target + "}\n";
  };
  expect_bad_mission(mission("point: [20, 0, 6]"), "mission.yaml:3:17");
  expect_bad_mission(mission("point: [0, 0, 6], vertices: []"));
  expect_bad_mission(mission("point: [0, 0]"));
}

}  // namespace
}  // namespace vantage::testing
