// The command tour as a user meets it: what it writes, and what its exit code says.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/cli_fixture.h"
#include "support/plaza_text.h"

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
  EXPECT_EQ(run({"tour", "tour.yaml", "--no-bound"}).exit_code, 0) << "nobody asked for a gap";
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

TEST_F(CliTour, MistakesCostNoFile) {
  expect_bad({"tour", "none.yaml", "-o", "old.csv"}, "none.yaml");
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

}  // namespace
}  // namespace vantage::testing
