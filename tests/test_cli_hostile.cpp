// The program on files that were made to mislead who reads its words, and on a system that refuses it something.
#include <fcntl.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <filesystem>

#include "common/input.h"
#include "support/cli_fixture.h"
#include "support/map_text.h"
#include "support/pbf_writer.h"
#include "support/places.h"
#include "support/sanitizers.h"
#include "support/shared_data.h"

namespace vantage::testing {
namespace {

const std::string kNames[] = {"\x1b]0;title\x07\x1b[31mred", "one\nvantage: proved", "a\u202efdp.exe", "c1\u009b2J"};

/// `text`, as a JSON or double-quoted YAML text.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(-1, ' ', true); }

class CliHostile : public Cli {
 protected:
  /// Runs, and expects that nothing that is printed acts on a terminal.
  ProgramRun run_safely(const std::vector<std::string>& arguments, int exit_code = 0) {
    ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    for (const std::string* text : {&result.out, &result.err}) {
      for (const std::string& line : lines(*text)) EXPECT_EQ(printable(line), line);
    }
    return result;
  }
};

TEST_F(CliHostile, NamesOfMeshesDoNotReachTheTerminal) {
  for (const std::string& name : kNames) {
    if (name.find('\n') != std::string::npos) continue;  // would end the line of an OBJ
    SCOPED_TRACE(printable(name));
    std::string city = kCity;
    city.replace(city.find("o block"), 7, "o " + name);
    write("city.obj", city);
    run_safely({"inspect", "city.obj"});
    const ProgramRun run = run_safely({"compute", "mission.yaml", "-o", "new.ply", "--verbose"});
    const std::string shown = printable(name).substr(printable(name).find_first_not_of(' '));
    EXPECT_NE(run.out.find(shown), std::string::npos) << run.out;
    write("points.csv", "x,y,z\n40,0,5\n");
    std::string in_table = shown;  // where a semicolon parts names
    for (std::size_t at = 0; (at = in_table.find_first_of(";\\", at)) != std::string::npos; at += 2) {
      in_table.insert(at, 1, '\\');
    }
    EXPECT_NE(run_safely({"query", "mission.yaml", "points.csv"}).out.find(in_table), std::string::npos);
    run_safely({"query", "mission.yaml", "points.csv", "--json"});
    // And back from the volume, and from a scene that is written.
    run_safely({"verify", "mission.yaml", "new.ply"});
    run_safely({"scene", "city.obj", "-o", "new.obj"});
    run_safely({"inspect", "new.obj", "--json"});
  }
}

TEST_F(CliHostile, NamesOfMissionsDoNotReachTheTerminal) {
  const auto named = [&](const std::string& name, const std::string& height) {
    return std::string(kScene) + "target: {name: " + quoted(name) + ", vertices: [[-5, -5, " + height + "], [5, -5, " +
           height + "], [5, 5, " + height + "], [-5, 5, " + height + "]]}\n" + kSensor;
  };
  const std::size_t usual = lines(run_safely({"compute", "mission.yaml", "-o", "new.ply"}).out).size();
  for (const std::string& name : kNames) {
    SCOPED_TRACE(printable(name));
    write("mission.yaml", named(name, "0"));
    const bool is_refused = name.find_first_of("\x1b\n") != std::string::npos;  // there is no need for such a name
    const ProgramRun run = run_safely({"compute", "mission.yaml", "-o", "new.ply"}, is_refused ? 2 : 0);
    const ProgramRun json = run_safely({"compute", "mission.yaml", "-o", "new.ply", "--json"}, is_refused ? 2 : 0);
    if (!is_refused) {
      EXPECT_EQ(lines(run.out).size(), usual);
      EXPECT_EQ(nlohmann::json::parse(json.out)["target"], name);  // JSON keeps it
    }
    write("mission.yaml", named(name, "-50"));  // a note on what is under the ground
    run_safely({"compute", "mission.yaml", "-o", "new.ply"}, is_refused ? 2 : 0);
    write("mission.yaml", std::string(kScene) + "target: {" + quoted(name) + ": 1}\n" + kSensor);
    run_safely({"compute", "mission.yaml", "-o", "new.ply"}, 2);
  }
}

TEST_F(CliHostile, NamesOfMapsDoNotReachTheTerminal) {
  constexpr std::int64_t kUnits = 10'000'000;
  for (const std::string& name : kNames) {
    SCOPED_TRACE(printable(name));
    const std::string nodes = pbf_field(2, pbf_field(1, pbf_packed_signed({1, 1, 1, 1})) +
                                               pbf_field(8, pbf_packed_signed({48 * kUnits, 0, 2000, 0})) +
                                               pbf_field(9, pbf_packed_signed({11 * kUnits, 2000, 0, -2000})));
    const std::string house =
        pbf_field(3, pbf_field(1, 10) + pbf_field(8, pbf_packed_signed({1, 1, 1, 1, -3})) +
                         pbf_field(2, pbf_packed({1, 3, 5})) + pbf_field(3, pbf_packed({2, 4, 4})));
    write("map.osm.pbf", pbf_header() + pbf_block({"", "building", "yes", "name", name, "height"}, {nodes, house}));
    run_safely({"inspect", "map.osm.pbf"});  // the height is no number, and said so
    const std::string shown = printable(name).substr(printable(name).find_first_not_of(' '));
    EXPECT_NE(run_safely({"inspect", "map.osm.pbf", "--named"}).out.find(shown), std::string::npos);
    const ProgramRun json = run_safely({"inspect", "map.osm.pbf", "--named", "--json"});
    EXPECT_EQ(nlohmann::json::parse(json.out)["features"][0]["properties"]["name"], name);
    run_safely({"scene", "map.osm.pbf", "-o", "map.obj"});
    run_safely({"inspect", "map.obj"});
    run_safely({"scene", "map.osm.pbf", "--json"});
    run_safely({"inspect", "map.osm.pbf", "--areas", name + "=x"}, 2);
  }
}

TEST_F(CliHostile, NamesOfCamerasAndZonesDoNotReachTheTerminal) {
  for (const std::string& name : kNames) {
    SCOPED_TRACE(printable(name));
    write("cameras.json", "{" + quoted(name) + ": 5.5, " + quoted("bad " + name) + ": -1}");
    run_safely({"cameras", "cameras.json"});
    run_safely({"cameras", "cameras.json", "--json"});
    write("mission.yaml", std::string(kScene) + kTarget + "sensor: {camera: " + quoted(name) + ", max_range: 60}\n");
    run_safely({"compute", "mission.yaml", "-o", "new.ply"}, 2);
  }
}

/// Standard output is a terminal: there, what passes through is made safe as well.
TEST_F(CliHostile, ATerminalSeesNoBytesThatItObeys) {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) GTEST_SKIP() << "no terminal can be made";
  write("points.csv", "x,y,z,note\n0,0,30,\x1b[31mred\u202e\n");
  options_.out_file = ::ptsname(master);
  const ProgramRun result = run({"query", "mission.yaml", "points.csv"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::array<char, 4096> bytes;
  const ssize_t got = ::read(master, bytes.data(), bytes.size());
  ::close(master);
  ASSERT_GT(got, 0);
  const std::string text(bytes.data(), static_cast<std::size_t>(got));
  EXPECT_NE(text.find(" [31mred\ufffd"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  // In a pipe they are the data of the user.
  options_.out_file.reset();
  EXPECT_NE(output_of({"query", "mission.yaml", "points.csv"}).find("\x1b[31mred\u202e"), std::string::npos);
}

TEST_F(CliHostile, LimitsOfTheSystemAreNoDefects) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, who can become a user without processes";
  MapText map;
  map.box(0, 0, 10, 10, {{"building", "yes"}});
  write("map.osm", map.text());
  become_nobody();
  options_.limits = {{RLIMIT_NPROC, 1}};
  expect_bad({"compute", "mission.yaml", "-o", "volume.ply"}, "vantage compute");
  expect_bad({"inspect", "map.osm"}, "vantage inspect");
}

TEST_F(CliHostile, ShortMemoryIsNoMissingLibrary) {
  if (kHasAddressSanitizer) GTEST_SKIP() << "the sanitizer needs terabytes of address space";
  VANTAGE_REQUIRE_SHARED("dsm/dsm.tif");
  const std::string raster = shared_data("dsm/dsm.tif").string();
  bool was_short = false;
  for (std::size_t megabytes = 60; megabytes <= 400; megabytes += 20) {
    options_.limits = {{RLIMIT_AS, megabytes << 20}};
    const ProgramRun result = run({"inspect", raster});
    if (result.exit_code == 127) continue;  // the program itself cannot be loaded
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2) << megabytes << " MB: " << result.err;
    EXPECT_EQ(result.err.find("installed"), std::string::npos) << megabytes << " MB: " << result.err;
    was_short = was_short || result.exit_code == 2;
  }
  EXPECT_TRUE(was_short);
}

/// One vertex of the volume was moved a little: what an obstacle hides of it is as thin as rounding, and got so many
/// corners when it was cut again and again that they took gigabytes.
TEST_F(CliHostile, AProofOfSliversNeedsLittleMemory) {
  if (kHasAddressSanitizer) GTEST_SKIP() << "the sanitizer needs terabytes of address space";
  write("slivers.obj",
        "v 0.13141613827526477 -81.702745544041235 36.245184464511993\n"
        "v -9.0000505817418492 -75.171937588731424 43.802480827975913\n"
        "v 34.498959921281539 -72.67885149648572 -2.9744286365591748\n"
        "v -55.263860008605235 47.137166355985975 17.457902501234564\n"
        "v -9.3538190487315163 66.243401304030527 57.577986340688618\n"
        "v -41.103623695879733 64.473791819849325 18.5131180788593\n"
        "v 13.923014096081404 -2.7503905534071245 26.137843360366677\n"
        "v 14.226611198797857 2.0528439395727007 30.922513102663903\n"
        "v 7.2775800998954976 -1.2611934279827028 25.583904457747487\n"
        "f 1 2 3\nf 4 5 6\nf 7 8 9\n");
  write("slivers.yaml",
        "scene: {mesh: slivers.obj}\ntarget: {vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]}\n"
        "sensor: {max_range: 130}\nexact: {tolerance: 6.5}\n");
  std::filesystem::copy_file(source_folder() / "tests" / "golden" / "thin_cuts.ply", folder_ / "slivers.ply");
  options_.limits = {{RLIMIT_AS, std::size_t{3000} << 20}};
  const ProgramRun result = run({"prove", "slivers.yaml", "slivers.ply"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
}

TEST_F(CliHostile, TooManyOpenFilesAreNoMissingLibrary) {
  if (kHasAddressSanitizer) GTEST_SKIP() << "the sanitizer opens files, and ends the program where it cannot";
  VANTAGE_REQUIRE_SHARED("dsm/dsm.tif");
  std::size_t refused = 0;
  for (const std::size_t files : {4, 5, 6, 7, 8}) {
    options_.limits = {{RLIMIT_NOFILE, files}};
    const ProgramRun result = run({"inspect", shared_data("dsm/dsm.tif").string()});
    EXPECT_NE(result.exit_code, 3) << files << ": " << result.err;
    EXPECT_EQ(result.err.find("install"), std::string::npos) << files << ": " << result.err;
    refused += result.exit_code == 2 && result.err.find("ulimit -n") != std::string::npos;
  }
  EXPECT_GT(refused, 0u);  // the limit was one
}

}  // namespace
}  // namespace vantage::testing
