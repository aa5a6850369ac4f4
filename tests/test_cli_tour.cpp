// The command tour as a user meets it: what it writes, and what its exit code says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/cli_fixture.h"
#include "support/plaza_text.h"
#include "support/wording.h"
#include "vantage/mission.h"

namespace vantage::testing {
namespace {

using Json = nlohmann::json;

class CliTour : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    write("plaza.obj", plaza_obj());
    write("tour.yaml", plaza_mission("home: [-20, -20, 0], clearance: 4, gap: 0.3"));
    write("old.csv", kOldOutput);
  }
};

TEST_F(CliTour, WritesAPlanThatCheckAccepts) {
  const ProgramRun tour = run({"tour", "tour.yaml", "-o", "old.csv", "--json"});
  ASSERT_EQ(tour.exit_code, 0) << tour.err;
  const Json answer = Json::parse(tour.out);
  EXPECT_EQ(answer["visits"].size(), 3U);
  const ProgramRun check = run({"check", "tour.yaml", "old.csv", "--json"});
  EXPECT_EQ(check.exit_code, 0) << check.err << check.out;
  EXPECT_NEAR(Json::parse(check.out)["length_m"].get<double>(), answer["length_m"].get<double>(), 1e-3);
  EXPECT_EQ(Json::parse(check.out)["notes"], Json::array());
  const std::string table = output_of({"tour", "tour.yaml"});
  EXPECT_NE(table.find("above the"), std::string::npos) << table;
  // The flight does not keep what it was not planned for.
  EXPECT_EQ(run({"check", "tour.yaml", "old.csv", "--clearance", "40"}).exit_code, 1);
}

TEST_F(CliTour, WritesPlansForAircraftOfDji) {
  const std::string town = (source_folder() / "examples/town/tour.yaml").string();
  expect_bad({"tour", town, "--no-bound", "-o", "tour.kmz"}, "flight");
  for (const char* wrong : {"77", "77,x", "-1,0", "77,0,66,1", "77,,66"}) {
    expect_bad({"tour", town, "--no-bound", "-o", "tour.kmz", "--aircraft", wrong}, "--aircraft");
  }
  ASSERT_EQ(run({"tour", town, "--no-bound", "-q", "-o", "tour.kmz", "--aircraft", "77,0,66"}).exit_code, 0);
  const ProgramRun check = run({"check", town, "tour.kmz", "--json", "--undulation", "0"});
  const Json answer = Json::parse(check.out);
  EXPECT_EQ(answer["targets"].size(), 5U) << check.err;
  for (const Json& target : answer["targets"]) EXPECT_FALSE(target["seen"].empty()) << target["name"];
  // Where the mission names a known camera, its aircraft is known.
  std::string text = content(source_folder() / "examples/town/tour.yaml");
  text.replace(text.find("town.osm"), 8, (source_folder() / "examples/town/town.osm").string());
  text.insert(text.find("  max_range: 50"), "  camera: {model: dji_mavic_3t_wide}\n");
  write("known.yaml", text);
  const ProgramRun known = run({"tour", "known.yaml", "--no-bound", "-q", "-o", "known.kmz"});
  EXPECT_EQ(known.exit_code, 0) << known.err;
}

TEST_F(CliTour, AnOpenTourEndsWhereItEnds) {
  std::string town = content(source_folder() / "examples/town/tour.yaml");
  town.replace(town.find("town.osm"), 8, (source_folder() / "examples/town/town.osm").string());
  std::size_t notes_of_closed = 0;
  for (const std::string closed : {"true", "false"}) {
    const std::string home = "  home:";
    write("town.yaml", std::string(town).insert(town.find(home), "  closed: " + closed + "\n"));
    const ProgramRun tour = run({"tour", "town.yaml", "--no-bound", "-o", "tour.plan", "--json"});
    ASSERT_EQ(tour.exit_code, 0) << tour.err;
    const Json items = Json::parse(content(folder_ / "tour.plan"))["mission"]["items"];
    constexpr int kReturn = 20;
    EXPECT_EQ(items.back()["command"] == kReturn, closed == "true");
    const std::size_t notes = Json::parse(tour.out)["notes"].size();
    if (closed == "true") notes_of_closed = notes;
    EXPECT_EQ(notes, notes_of_closed + (closed == "true" ? 0 : 1)) << tour.out;
    const ProgramRun check = run({"check", "town.yaml", "tour.plan"});
    EXPECT_EQ(check.exit_code, 0) << check.out;
  }
}

TEST_F(CliTour, PrintsATable) {
  const std::string text = output_of({"tour", "tour.yaml"});
  for (const char* word : {"multirotor, 3 of 3 targets", "length", "bound", "gap", "it ignores", "west", "south"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
  EXPECT_EQ(output_of({"tour", "tour.yaml", "--no-bound"}).find("bound"), std::string::npos);
  EXPECT_EQ(output_of({"tour", "tour.yaml", "--no-bound", "-q"}), "");
}

TEST_F(CliTour, TheExitCodeSaysWhatIsMissing) {
  write("tour.yaml", plaza_mission("home: [-20, -20, 0], gap: 0, time_limit: 0.2"));
  EXPECT_EQ(run({"tour", "tour.yaml", "-o", "tour.csv"}).exit_code, 4) << "the gap was not reached";
  EXPECT_NE(content(folder_ / "tour.csv"), "");
  EXPECT_EQ(run({"tour", "tour.yaml", "--no-bound"}).exit_code, 0) << "nobody asked for a bound";
  write("tour.yaml", plaza_mission("home: [-20, -20, 0], time_limit: 0.2"));
  const ProgramRun without = run({"tour", "tour.yaml"});
  EXPECT_EQ(without.exit_code, 0) << "nobody asked for a gap";
  EXPECT_EQ(without.out.find("asked for"), std::string::npos) << without.out;
  write("tour.yaml", plaza_mission("home: [-20, -20, 0], gap: 0.3",
                                   "navigation: {keep_in: [{min: [-150, -150, 0], max: [20, 150, 100]}, "
                                   "{min: [80, -150, 0], max: [150, 150, 100]}]}\n"));
  const ProgramRun left_out = run({"tour", "tour.yaml", "-o", "tour.csv"});
  EXPECT_EQ(left_out.exit_code, 1);
  EXPECT_NE(left_out.out.find("left out"), std::string::npos);
  EXPECT_NE(left_out.out.find("east"), std::string::npos);
}

TEST_F(CliTour, WritesACertificateThatIsAccepted) {
  const Json tour = Json::parse(output_of({"tour", "tour.yaml", "--json", "--certificate", "tour.cert"}));
  const std::string script = (source_folder() / "tools/check_tour.py").string();
  const ProgramRun judge = run_program("/usr/bin/env", {"python3", script, "tour.cert"}, options_);
  EXPECT_EQ(judge.exit_code, 0) << judge.err;
  const Json answer = Json::parse(output_of({"verify-tour", "tour.cert", "--json"}));
  EXPECT_EQ(answer["accepted"], true);
  EXPECT_EQ(answer["bound_m"], tour["bound"]["length_m"]);
  EXPECT_GE(answer["proved_m"], answer["bound_m"]);
  EXPECT_EQ(answer["regions"].size(), 4U) << "three targets and the home";
  EXPECT_EQ(answer["regions"][0]["name"], "west");
  const std::string text = output_of({"verify-tour", "tour.cert", "--length", "1000"});
  for (const char* word : {"accepted", "bound", "gap", "regions", "south", "it ignores", "obstacles"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
}

TEST_F(CliTour, ACertificateThatWasTamperedWithIsRefused) {
  output_of({"tour", "tour.yaml", "-q", "--certificate", "tour.cert"});
  const std::string text = content(folder_ / "tour.cert");
  const std::string key = "\"bound_m\":";
  write("more.cert", std::string(text).insert(text.find(key) + key.size(), "1"));
  const ProgramRun refused = run({"verify-tour", "more.cert"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.out.find("refused"), std::string::npos);
  EXPECT_EQ(Json::parse(run({"verify-tour", "more.cert", "--json"}).out)["accepted"], false);
  write("half.cert", text.substr(0, text.size() / 2));
  expect_refused({"verify-tour", "half.cert"}, "half.cert");
  expect_bad({"verify-tour", "none.cert"}, "none.cert");
  expect_bad({"verify-tour", "tour.cert", "--length", "-5"}, "--length");
  fs::remove(folder_ / "tour.region1.ply");
  expect_bad({"verify-tour", "tour.cert"}, "tour.region1.ply");
  write("tour.region1.ply", content(folder_ / "tour.region2.ply"));
  EXPECT_EQ(run({"verify-tour", "tour.cert"}).exit_code, 1);
}

TEST_F(CliTour, HoversAtAsFewPositionsAsPossible) {
  // From nowhere all corners of two squares are within 60 m.
  write("tour.yaml", plaza_mission("home: [-20, -20, 0], clearance: 4"));
  const ProgramRun tour = run({"tour", "tour.yaml", "--fewest", "-o", "old.csv"});
  ASSERT_EQ(tour.exit_code, 0) << tour.err;
  for (const char* word : {"necessary", "no position sees two of these", "hovers at", "views", "west", "south"}) {
    EXPECT_NE(tour.out.find(word), std::string::npos) << word << "\n" << tour.out;
  }
  EXPECT_EQ(run({"check", "tour.yaml", "old.csv"}).exit_code, 0);
  const Json answer = Json::parse(output_of({"tour", "tour.yaml", "--fewest", "--json"}));
  const Json& positions = answer["positions"];
  EXPECT_EQ(positions["found"].size(), positions["necessary"]);
  EXPECT_EQ(positions["apart"].size(), positions["necessary"]);
  const std::string quick = output_of({"tour", "tour.yaml", "--fewest", "--no-bound"});
  EXPECT_EQ(quick.find("necessary"), std::string::npos) << quick;
  expect_bad({"tour", "tour.yaml", "--fewest", "--certificate", "tour.cert", "-o", "old.csv"}, "--certificate");
  write("tour.yaml", plaza_mission("vehicle: {kind: fixed_wing}"));
  expect_bad({"tour", "tour.yaml", "--fewest", "-o", "old.csv"}, "tour.vehicle.kind");
  write("tour.yaml", plaza_mission("view: {margin: 70}"));
  expect_bad({"tour", "tour.yaml", "--fewest", "-o", "old.csv"}, "west");
}

TEST_F(CliTour, MistakesCostNoFile) {
  expect_bad({"tour", "none.yaml", "-o", "old.csv"}, "none.yaml");
  fs::create_directory(folder_ / "folder");
  fs::create_directory(folder_ / "folder.plan");
  expect_bad({"tour", "tour.yaml", "-o", "folder"}, "folder");
  expect_bad({"tour", "tour.yaml", "-o", "folder.plan"}, "folder.plan");
  expect_bad({"tour", "tour.yaml", "-o", "folder/none/"}, "folder/none/");
  expect_bad({"tour", "tour.yaml", "--certificate", "folder"}, "folder");
  expect_bad({"tour", "tour.yaml", "-o", "tour.plan"}, "QGroundControl");  // the plaza lies nowhere on the earth
  expect_bad({"tour", "tour.yaml", "-o", "tour.docx"}, "tour.docx");
  expect_bad({"tour", "tour.yaml", "-o", "plaza.obj"}, "plaza.obj");
  expect_bad({"tour", "tour.yaml", "-o", "tour.yaml"}, "tour.yaml");
  expect_bad({"tour", "tour.yaml", "-o", "nowhere/tour.csv"}, "nowhere");
  expect_bad({"tour", "tour.yaml", "-o", "old.csv", "--certificate", "old.csv"}, "old.csv");
  expect_bad({"tour", "tour.yaml", "--no-bound", "--certificate", "tour.cert"}, "--certificate");
  expect_bad({"tour", "tour.yaml", "--certificate", "plaza.obj"}, "plaza.obj");
  write("tour.region1.ply", kOldOutput);
  expect_bad({"tour", "tour.yaml", "-o", "old.csv", "--certificate", "tour.cert"}, "tour.region1.ply");
  write("tour.yaml", plaza_mission("home: [0, 70, 8]"));
  expect_bad({"tour", "tour.yaml", "-o", "old.csv"}, "hall");
  write("tour.yaml", plaza_mission("time_limit: .nan"));
  expect_bad({"tour", "tour.yaml", "-o", "old.csv"}, "tour.yaml");
}

TEST_F(CliTour, AScenesOwnMeshIsNotReplacedByARegion) {
  // A scene whose file has the name of a region: written by vantage itself, so only that it is an input speaks for it.
  output_of({"tour", "tour.yaml", "-q", "--certificate", "a.cert"});
  write("plaza.obj", plaza_obj());
  write("tour.yaml", "scene: {mesh: a.region0.ply}\n" + std::string(kPlazaTargets) + kPlazaSensor);
  expect_bad({"tour", "tour.yaml", "--certificate", "a.cert"}, "a.region0.ply");
}

/// Boxes, each from its lowest to its highest corner, as one closed mesh: a PLY file.
std::string boxes_ply(const std::vector<std::array<Vec3, 2>>& boxes, bool is_open = false, bool is_inside_out = false) {
  std::string vertices, faces;
  std::size_t count = 0;
  for (const auto& [min, max] : boxes) {
    const std::size_t first = 8 * (count++);
    for (std::size_t i = 0; i < 8; ++i) {
      for (const int axis : {0, 1, 2}) {
        vertices += std::to_string(((i >> static_cast<unsigned>(axis) & 1U) == 0 ? min : max)[axis]) + " ";
      }
      vertices += "\n";
    }
    constexpr std::array<std::array<std::size_t, 4>, 6> kQuads = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const std::array<std::size_t, 4>& quad : kQuads) {
      if (is_open && &quad == &kQuads.back()) continue;
      for (const std::array<std::size_t, 3>& three : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}}) {
        faces += "3";
        for (std::size_t k = 0; k < 3; ++k) {
          faces += " " + std::to_string(first + quad.at(three.at(is_inside_out ? 2 - k : k)));
        }
        faces += "\n";
      }
    }
  }
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(8 * count) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
         std::to_string((12 - 2 * static_cast<int>(is_open)) * count) +
         "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + faces;
}

constexpr const char* kNothingToSee = "the target is a volume to fly through, and nothing of it is to be seen";
constexpr const char* kWest = "{name: west, vertices: [[-83, -3, 0.1], [-77, -3, 0.1], [-77, 3, 0.1], [-83, 3, 0.1]]}";

class CliTourVolumes : public CliTour {
 protected:
  void SetUp() override {
    CliTour::SetUp();
    write("region.ply", boxes_ply({{Vec3(80, -60, 20), Vec3(100, -40, 60)}}));
  }
  /// Volumes alone, which need no sensor.
  void write_mission(const std::string& targets, const std::string& more = "") {
    write("tour.yaml", std::string(kPlazaScene) + "targets: [" + targets + "]\n" + more);
  }
};

TEST_F(CliTourVolumes, TheFlightAndTheBoundHoldThem) {
  write("gate.ply", boxes_ply({{Vec3(-10, 95, 30), Vec3(10, 99, 50)}, {Vec3(-190, 95, 30), Vec3(-180, 99, 50)}}));
  write_mission(std::string(kWest) + ", {volume: region.ply}, {volume: gate.ply, name: gate}",
                std::string(kPlazaSensor) + "tour: {home: [-20, -20, 0], clearance: 4, gap: 0.99}\n");
  const ProgramRun tour = run({"tour", "tour.yaml", "-o", "tour.csv", "--certificate", "tour.cert", "--json"});
  ASSERT_EQ(tour.exit_code, 0) << tour.err;
  const Json answer = Json::parse(tour.out);
  std::map<std::string, std::vector<double>> from;
  for (const Json& visit : answer["visits"]) {
    from[visit["target"]] = visit["from"].get<std::vector<double>>();
    EXPECT_EQ(visit.value("volume", false), visit["target"] != "west");
  }
  ASSERT_EQ(from.size(), 3U);
  const std::vector<double>& region = from.at("region");
  EXPECT_TRUE(region[0] >= 81 && region[0] <= 99 && region[1] >= -59 && region[1] <= -41 && region[2] >= 21 &&
              region[2] <= 59)
      << "the margin is a metre";
  EXPECT_GT(answer["bound"]["length_m"].get<double>(), 0);
  EXPECT_LE(answer["bound"]["length_m"].get<double>(), answer["length_m"].get<double>());
  EXPECT_EQ(run({"verify-tour", "tour.cert"}).exit_code, 0);
  const ProgramRun judge = run_program("/usr/bin/env", {"python3", (source_folder() / "tools/check_tour.py").string(),
                                                        (folder_ / "tour.cert").string()});
  EXPECT_EQ(judge.exit_code, 0) << judge.err;
  EXPECT_NE(content(folder_ / "tour.region1.ply").find("vantage region: given"), std::string::npos);
  const ProgramRun check = run({"check", "tour.yaml", "tour.csv", "--json"});
  EXPECT_EQ(check.exit_code, 0) << check.err << check.out;
  const Json targets = Json::parse(check.out)["targets"];
  EXPECT_EQ(targets[0].count("volume"), 0U);
  EXPECT_EQ(targets[1]["volume"], true);
  EXPECT_EQ(targets[1]["gimbal"], nullptr);
  // No flight through another volume is as short: the bound is of what is given.
  write("region.ply", boxes_ply({{Vec3(180, -190, 20), Vec3(190, -180, 60)}}));
  EXPECT_EQ(run({"check", "tour.yaml", "tour.csv"}).exit_code, 1);
  const Json far = Json::parse(run({"tour", "tour.yaml", "--json"}).out);
  EXPECT_GT(far["bound"]["length_m"].get<double>(), answer["length_m"].get<double>());
}

// Trusted as a region to fly through, and not as all that sees its target.
TEST_F(CliTourVolumes, AComputedOneIsToldOf) {
  write("seen.yaml", std::string(kPlazaScene) + "target: " + kWest + "\n" + kPlazaSensor);
  ASSERT_EQ(run({"compute", "seen.yaml", "-o", "seen.ply"}).exit_code, 0);
  write_mission("{volume: seen.ply}, {volume: region.ply}",
                "tour: {home: [-20, -20, 0], gap: 0.99}\nlinks: [{name: pilot, point: [-20, -20, 2]}]\n");
  // A program that reads JSON alone is told the same.
  const ProgramRun quiet = run({"tour", "tour.yaml", "--json", "-q"});
  ASSERT_EQ(quiet.exit_code, 0) << quiet.err;
  EXPECT_EQ(quiet.err, "");
  const std::vector<std::string> notes = Json::parse(quiet.out)["notes"];
  EXPECT_EQ(notes.size(), 2U);
  expect_wording(notes);
  const ProgramRun tour = run({"tour", "tour.yaml"});
  for (const std::string& note : notes) EXPECT_NE(tour.err.find(note), std::string::npos) << tour.err;
}

TEST_F(CliTourVolumes, CheckTellsWhereTheFlightIsInsideAndNeverTooLong) {
  write("two.ply", boxes_ply({{Vec3(10, -5, 50), Vec3(20, 5, 60)}, {Vec3(30, -5, 50), Vec3(50, 5, 60)}}));
  write_mission("{volume: two.ply}");
  write("flight.csv", "x,y,z\n0,0,55\n60,0,55\n");
  const std::vector<std::string> check = {"check", "tour.yaml", "flight.csv", "--heights", "scene", "--json"};
  const auto seen = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = check;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Json::parse(run(arguments).out)["targets"][0]["seen"];
  };
  for (const double tube : {0.0, 2.0}) {
    const Json spans = seen({"--tube", std::to_string(tube)});
    ASSERT_EQ(spans.size(), 2U);
    const double exact[2][2] = {{10 + tube, 20 - tube}, {30 + tube, 50 - tube}};
    for (std::size_t i = 0; i < 2; ++i) {
      const double begin = spans[i]["begin_m"], end = spans[i]["end_m"];
      EXPECT_GE(begin, exact[i][0]);
      EXPECT_LE(end, exact[i][1]);
      EXPECT_NEAR(begin, exact[i][0], 1e-6);
      EXPECT_NEAR(end, exact[i][1], 1e-6);
    }
  }
  EXPECT_TRUE(seen({"--tube", "6"}).empty()) << "no ball of 6 m fits";
  EXPECT_EQ(
      run({"check", "tour.yaml", "flight.csv", "--heights", "scene", "--speed", "5", "--dwell", "3.99"}).exit_code, 0);
  const ProgramRun longer =
      run({"check", "tour.yaml", "flight.csv", "--heights", "scene", "--speed", "5", "--dwell", "4.1"});
  EXPECT_EQ(longer.exit_code, 1) << longer.out;
  write("flight.csv", "x,y,z\n0,0,49\n60,0,49\n");
  const ProgramRun below = run({"check", "tour.yaml", "flight.csv", "--heights", "scene", "-o", "check.csv"});
  EXPECT_EQ(below.exit_code, 1) << below.out;
  EXPECT_NE(content(folder_ / "check.csv").find("two,outside,,0,60"), std::string::npos);
}

TEST_F(CliTourVolumes, LimitsOfNavigationCutThem) {
  write_mission("{volume: region.ply}", "navigation: {altitude: [0, 30]}\ntour: {home: [0, 0, 0], gap: 0.99}\n");
  const ProgramRun tour = run({"tour", "tour.yaml", "--json"});
  ASSERT_EQ(tour.exit_code, 0) << tour.err;
  const Json answer = Json::parse(tour.out);
  EXPECT_LE(answer["visits"][0]["from"][2].get<double>(), 29);
  EXPECT_NE(answer["bound"]["ignored"].dump().find("navigation"), std::string::npos);
  write_mission("{volume: region.ply}", "navigation: {altitude: [0, 15]}\n");
  expect_bad({"tour", "tour.yaml", "-o", "old.csv"}, "tour.yaml:2:");
}

TEST_F(CliTourVolumes, BadOnesAreRefused) {
  const std::array<Vec3, 2> box = {Vec3(0, 0, 50), Vec3(9, 9, 59)};
  const auto expect = [&](const std::string& name, const std::string& bytes) {
    write(name, bytes);
    write_mission("{volume: " + name + "}");
    expect_bad({"tour", "tour.yaml", "-o", "old.csv"}, name);
    expect_refused({"check", "tour.yaml", "old.csv", "--heights", "scene"}, "old.csv");  // the plan comes first
  };
  expect("open.ply", boxes_ply({box}, true));
  expect("turned.ply", boxes_ply({box}, false, true));
  expect("crossed.ply", boxes_ply({box, {Vec3(5, 5, 55), Vec3(14, 14, 64)}}));
  expect("empty.ply", "");
  expect("none.ply", boxes_ply({}));
  std::string nan = boxes_ply({box});
  expect("nan.ply", nan.replace(nan.find("9.0"), 3, "nan"));
  for (const char* target : {"{volume: missing.ply}", "{volume: [1, 2]}", "{volume: region.ply, sides: both}",
                             "{volume: region.ply, point: [0, 0, 9]}", "{volume: region.ply, feature: a}",
                             "{volume: region.ply, offset: 1}"}) {
    write_mission(target);
    expect_bad({"tour", "tour.yaml", "-o", "old.csv"}, "tour.yaml:2:");
  }
  write_mission(std::string(kWest) + ", {volume: region.ply}");
  expect_bad({"tour", "tour.yaml"}, "tour.yaml");  // what is seen needs a sensor
}

TEST_F(CliTourVolumes, OtherCommandsSayThatNothingIsToBeSeen) {
  write("points.csv", "x,y,z\n90,-50,40\n");
  for (const bool is_alone : {true, false}) {
    write_mission(is_alone ? "{volume: region.ply}" : std::string(kWest) + ", {volume: region.ply}",
                  is_alone ? "" : kPlazaSensor);
    for (const std::vector<std::string>& command : {std::vector<std::string>{"compute", "tour.yaml", "-o", "new.ply"},
                                                    {"query", "tour.yaml", "points.csv"},
                                                    {"verify", "tour.yaml", "region.ply"},
                                                    {"prove", "tour.yaml", "region.ply"},
                                                    {"stand", "tour.yaml"},
                                                    {"orbit", "tour.yaml"},
                                                    {"render", "tour.yaml", "-o", "new.png"}}) {
      const std::string said = expect_refused(command, "tour.yaml:2:");
      EXPECT_EQ(said.substr(0, said.find('\n')), "vantage: " + std::string(kNothingToSee)) << command[0];
    }
  }
}

TEST_F(CliTourVolumes, AreReadWrittenAndHashed) {
  write_mission("{volume: region.ply, name: a box}", "combine: each\n");
  const MissionFile read = read_mission(folder_ / "tour.yaml");
  const std::string text = mission_text(read, folder_);
  EXPECT_EQ(mission_text(read_mission_text(text, folder_ / "tour.yaml"), folder_), text);
  EXPECT_NE(text.find("volume: \"region.ply\""), std::string::npos) << text;
  const std::string hash = mission_hash(resolve_mission(read));
  EXPECT_EQ(mission_hash(resolve_mission(read_mission_text(text, folder_ / "tour.yaml"))), hash);
  write("region.ply", boxes_ply({{Vec3(80, -60, 20), Vec3(100, -40, 61)}}));
  EXPECT_NE(mission_hash(resolve_mission(read)), hash) << "what the file holds counts";
  const std::vector<fs::path> inputs = input_files(read);
  EXPECT_NE(std::find(inputs.begin(), inputs.end(), fs::canonical(folder_ / "region.ply")), inputs.end());
}

TEST_F(CliTourVolumes, AVolumeOfAnotherSceneIsTold) {
  output_of({"compute", "mission.yaml", "-q", "-o", "square.ply"});
  write_mission("{volume: square.ply}", "tour: {gap: 0.99}\n");
  expect_wording(run({"tour", "tour.yaml"}).err);
  write("tour.yaml", "scene: {mesh: city.obj}\ntarget: {volume: square.ply}\ntour: {gap: 0.99}\n");
  expect_wording(run({"tour", "tour.yaml"}).err);  // not of another scene
}

}  // namespace
}  // namespace vantage::testing
