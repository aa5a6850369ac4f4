// vantage prove: verdicts, witnesses and exit codes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/cli_fixture.h"
#include "support/pipe.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/result.h"

namespace vantage {
namespace {

class CliProve : public testing::Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    // A block beside a square that looks up.
    write("city.obj",
          "o ground\nv -60 -60 0\nv 60 -60 0\nv 60 60 0\nv -60 60 0\nf 1 2 3 4\n"
          "o block\nv 10 -5 0\nv 14 -5 0\nv 14 5 0\nv 10 5 0\nv 10 -5 12\nv 14 -5 12\nv 14 5 12\nv 10 5 12\n"
          "f 5 8 7 6\nf 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n");
    write_mission("");
  }
  void write_mission(const std::string& more) {
    write("mission.yaml",
          "scene: {mesh: city.obj}\ntarget: {vertices: [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]}\n"
          "sensor: {max_range: 50}\n" +
              more);
  }
  /// Two boxes in one mesh, which is not convex: no proof is known for such a limit.
  void write_airspace() {
    std::string mesh;
    for (const int x : {-30, 0}) {
      for (const int z : {1, 20}) {
        for (const char* xy : {"0 -9", "9 -9", "9 9", "0 9"}) {
          const int across = xy[0] - '0' + x;
          mesh += "v " + std::to_string(across) + std::string(xy + 1) + " " + std::to_string(z) + "\n";
        }
      }
    }
    for (const int k : {0, 8}) {
      for (const auto& face :
           {std::array{1, 4, 3, 2}, {5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}}) {
        mesh += "f";
        for (const int corner : face) mesh += " " + std::to_string(corner + k);
        mesh += "\n";
      }
    }
    write("airspace.obj", mesh);
  }
};

TEST_F(CliProve, ProvesWhatWasComputed) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply", "-o", "v.glb", "-o", "v.stl"});
  for (const char* name : {"v.ply", "v.glb", "v.stl"}) {
    const std::string table = output_of({"prove", "mission.yaml", name});
    EXPECT_NE(table.find("\nproved for"), std::string::npos) << table;
    const auto json = nlohmann::json::parse(output_of({"prove", "mission.yaml", name, "--json"}));
    EXPECT_EQ(json.at("verdict"), "proved");
    EXPECT_EQ(json.at("unproved").size(), 0U);
    EXPECT_TRUE(json.at("witness").is_null());
    EXPECT_GT(json.at("tested_facets"), 100);
  }
}

TEST_F(CliProve, RefutesWithAWitness) {
  // A box over the square that reaches behind the block.
  write("box.obj",
        "v -4 -4 1\nv 30 -4 1\nv 30 4 1\nv -4 4 1\nv -4 -4 20\nv 30 -4 20\nv 30 4 20\nv -4 4 20\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const auto run_json = run({"prove", "mission.yaml", "box.obj", "--json"});
  EXPECT_EQ(run_json.exit_code, 1) << run_json.err;
  const auto json = nlohmann::json::parse(run_json.out);
  EXPECT_EQ(json.at("verdict"), "wrong");
  EXPECT_EQ(json.at("witness").at("object"), "block");
  EXPECT_GT(json.at("witness").at("depth_m"), 1);
  const auto table = run({"prove", "mission.yaml", "box.obj"});
  EXPECT_EQ(table.exit_code, 1);
  EXPECT_NE(table.out.find("hidden from"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("WRONG"), std::string::npos) << table.out;
}

TEST_F(CliProve, TellsWhatHasNoProof) {
  write_airspace();
  write_mission("navigation: {meshes: [airspace.obj]}\n");
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  const auto result = run({"prove", "mission.yaml", "v.ply", "--json"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("verdict"), "not proved");
  EXPECT_EQ(json.at("claims").back().at("name"), "meshes");
  EXPECT_EQ(json.at("unproved").size(), 0U);
}

TEST_F(CliProve, TellsWhetherTheVolumeIsMaximal) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  const auto json = nlohmann::json::parse(output_of({"prove", "mission.yaml", "v.ply", "--maximal", "--json"}));
  const auto& maximal = json.at("maximal");
  EXPECT_GT(maximal.at("proved_share"), 0.999);
  EXPECT_TRUE(maximal.at("conditions_hold"));
  EXPECT_EQ(maximal.at("open").size(), 0U);
  EXPECT_EQ(maximal.at("tolerance_m"), 0.01);
  double sum = 0;
  for (const auto& row : maximal.at("witnesses")) sum += row.at("area_share").get<double>();
  EXPECT_NEAR(sum, 1, 1e-9);
  const std::string table = output_of({"prove", "mission.yaml", "v.ply", "--maximal"});
  EXPECT_NE(table.find("hidden"), std::string::npos) << table;
  EXPECT_NE(table.find("condition"), std::string::npos) << table;
  EXPECT_NE(table.find("is missing"), std::string::npos) << table;
  EXPECT_TRUE(nlohmann::json::parse(output_of({"prove", "mission.yaml", "v.ply", "--json"})).at("maximal").is_null());
}

/// One tooth of a saw on the far side is cut off: so little that four decimals would say all.
TEST_F(CliProve, AllIsSaidOnlyOfAll) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  const Mission mission = resolve_mission(read_mission(folder_ / "mission.yaml"));
  VolumeFile read = read_volume(folder_ / "v.ply", mission.scene());
  Mesh& mesh = read.volume.mesh;
  const auto highest = std::ranges::max_element(mesh.vertices, {}, [](const Vec3& v) { return v.z(); });
  // In the place of that vertex a small pit, a tenth of a millimetre wide.
  const auto top = static_cast<std::uint32_t>(highest - mesh.vertices.begin());
  const Vec3 at = *highest;
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<std::uint32_t, 3> t = {a, b, c};
    const auto place = std::ranges::find(t, top);
    if (place == t.end()) {
      triangles.push_back(t);
      continue;
    }
    const std::uint32_t next = t[(place - t.begin() + 1) % 3], last = t[(place - t.begin() + 2) % 3];
    const auto rim = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::uint32_t v : {next, last}) {
      mesh.vertices.push_back(at + 1e-4 * (mesh.vertices[v] - at).normalized());
    }
    triangles.insert(triangles.end(), {{top, rim, rim + 1}, {rim, next, last}, {rim, last, rim + 1}});
  }
  mesh.vertices[top].z() -= 0.02;
  mesh.triangles = triangles;
  read.volume.cause_of.resize(triangles.size(), 0);
  write_volume(read.volume, folder_ / "pit.ply");
  const std::string table = output_of({"prove", "mission.yaml", "pit.ply", "--maximal"});
  EXPECT_NE(table.find("99.9999 %"), std::string::npos) << table;
  EXPECT_EQ(table.find("100.0000 %"), std::string::npos) << table;
  EXPECT_EQ(table.find("is missing"), std::string::npos) << table;
}

/// It is safe, so the exit code is that of what is proved.
TEST_F(CliProve, AVolumeThatIsTooSmallIsNotMaximal) {
  write("small.obj",
        "v -2 -2 1\nv 2 -2 1\nv 2 2 1\nv -2 2 1\nv -2 -2 9\nv 2 -2 9\nv 2 2 9\nv -2 2 9\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const auto json = nlohmann::json::parse(output_of({"prove", "mission.yaml", "small.obj", "--maximal", "--json"}));
  EXPECT_EQ(json.at("verdict"), "proved");
  EXPECT_EQ(json.at("maximal").at("proved_share"), 0);
  EXPECT_FALSE(json.at("maximal").at("conditions_hold"));
  EXPECT_EQ(json.at("maximal").at("open").size(), 12U);
}

TEST_F(CliProve, OfSeveralTargetsAnyOneIsTheWitness) {
  write("mission.yaml",
        "scene: {mesh: city.obj}\nsensor: {max_range: 50}\n"
        "targets:\n"
        "  - {name: a, vertices: [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]}\n"
        "  - {name: b, vertices: [[-8, -2, 0], [-6, -2, 0], [-6, 2, 0], [-8, 2, 0]]}\n");
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  const auto json = nlohmann::json::parse(output_of({"prove", "mission.yaml", "v.ply", "--maximal", "--json"}));
  EXPECT_GT(json.at("maximal").at("proved_share"), 0.999);
  EXPECT_FALSE(json.at("maximal").at("conditions_hold"));
}

/// Of two boxes one is behind the block for both sides of the one target, the other one for the other target.
TEST_F(CliProve, OfSeveralTargetsAllOpenFacetsAreTold) {
  const std::string a = "{name: a, vertices: [[-9, 0, 1], [-3, 0, 1], [-3, 0, 4], [-9, 0, 4]], sides: both}";
  const std::string b = "{name: b, vertices: [[22, -2, 0], [26, -2, 0], [26, 2, 0], [22, 2, 0]]}";
  write("boxes.obj",
        "v 15 -1 1\nv 19 -1 1\nv 19 1 1\nv 15 1 1\nv 15 -1 2\nv 19 -1 2\nv 19 1 2\nv 15 1 2\n"
        "v 6 -1 1\nv 9 -1 1\nv 9 1 1\nv 6 1 1\nv 6 -1 2\nv 9 -1 2\nv 9 1 2\nv 6 1 2\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
        "f 9 12 11 10\nf 13 14 15 16\nf 9 10 14 13\nf 10 11 15 14\nf 11 12 16 15\nf 12 9 13 16\n");
  const auto open_for = [&](const std::string& targets) {
    write("mission.yaml", "scene: {mesh: city.obj}\nsensor: {max_range: 50}\ntargets: [" + targets + "]\n");
    const auto result = run({"prove", "mission.yaml", "boxes.obj", "--json"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    return nlohmann::json::parse(result.out);
  };
  const auto of_a = open_for(a), of_b = open_for(b), of_both = open_for(a + ", " + b);
  const auto numbers = [](const nlohmann::json& json) { return json.at("unproved").get<std::vector<int>>(); };
  std::vector<int> all;
  std::ranges::set_union(numbers(of_a), numbers(of_b), std::back_inserter(all));
  EXPECT_GT(all.size(), std::max(numbers(of_a).size(), numbers(of_b).size()));
  EXPECT_EQ(numbers(of_both), all);
  const auto share = [](const nlohmann::json& json) { return json.at("unproved_area_share").get<double>(); };
  EXPECT_GT(share(of_both), std::max(share(of_a), share(of_b)) + 0.1);
  EXPECT_LE(share(of_both), std::min(1.0, share(of_a) + share(of_b)));
}

/// A wall that is seen from one side or the other, and all of several targets.
TEST_F(CliProve, SidesAndListsOfTargets) {
  const auto write_targets = [&](const std::string& targets, const std::string& sensor) {
    write("mission.yaml", "scene: {mesh: city.obj}\n" + targets + "sensor: {max_range: 30" + sensor + "}\n");
  };
  const std::string fence = "{name: fence, vertices: [[-9, 0, 1], [-3, 0, 1], [-3, 0, 4], [-9, 0, 4]], sides: both";
  const std::string roof = "{name: roof, vertices: [[11, -3, 12.1], [13, -3, 12.1], [13, 3, 12.1]]}";
  for (const char* offset : {"}", ", offset: 0.2}"}) {
    for (const char* sensor :
         {"", ", min_range: 2", ", incidence: 50", ", sun: {azimuth: 10, elevation: 40, exclude: 30}"}) {
      write_targets("target: " + fence + offset + "\n", sensor);
      output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
      const std::string table = output_of({"prove", "mission.yaml", "v.ply"});
      EXPECT_NE(table.find("\nproved for"), std::string::npos) << table;
    }
  }
  // Both sides grown a little, so that it reaches between the planes.
  write_targets("target: " + fence + ", offset: 0.2}\n", "");
  write("slab.obj",
        "v -7 -1 2\nv -6 -1 2\nv -6 1 2\nv -7 1 2\nv -7 -1 3\nv -6 -1 3\nv -6 1 3\nv -7 1 3\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  EXPECT_EQ(run({"prove", "mission.yaml", "slab.obj"}).exit_code, 1);
  write_targets("target: " + fence + "}\n", "");
  EXPECT_EQ(run({"prove", "mission.yaml", "slab.obj"}).exit_code, 0);
  // Behind the block, and every facet passes through the plane.
  write("behind.obj", "v 16 1 2\nv 20 1 3\nv 17 -1 2\nv 18 -1 5\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
  EXPECT_EQ(run({"prove", "mission.yaml", "behind.obj"}).exit_code, 1);
  write_targets("target: " + fence + "}\n", ", min_range: 2");
  EXPECT_EQ(run({"prove", "mission.yaml", "slab.obj"}).exit_code, 1);

  write_targets("combine: all\ntargets: [" + fence + "}, " + roof + "]\n", "");
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  const std::string table = output_of({"prove", "mission.yaml", "v.ply"});
  EXPECT_NE(table.find("\nproved for"), std::string::npos) << table;
  write_targets("combine: any\ntargets: [" + fence + "}, " + roof + "]\n", "");
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  expect_bad({"prove", "mission.yaml", "v.ply"}, "targets");
}

TEST_F(CliProve, TellsWhereALimitIsBroken) {
  write_mission("navigation: {keep_out: [{min: [-5, -5, 10], max: [5, 5, 15]}]}\n");
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  EXPECT_EQ(nlohmann::json::parse(output_of({"prove", "mission.yaml", "v.ply", "--json"})).at("verdict"), "proved");
  write_mission("navigation: {keep_out: [{min: [-5, -5, 10], max: [5.5, 5, 15]}]}\n");
  const auto result = run({"prove", "mission.yaml", "v.ply", "--json"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const auto claim = nlohmann::json::parse(result.out).at("claims").back();
  EXPECT_EQ(claim.at("verdict"), "wrong");
  EXPECT_NEAR(claim.at("broken_by_m"), 0.5, 1e-6);
  EXPECT_NEAR(claim.at("place").at(0), 5, 1e-6);
}

TEST_F(CliProve, RefusesWhatItCannotJudge) {
  write("open.obj", "v 0 0 1\nv 5 0 1\nv 0 5 1\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  expect_bad({"prove", "mission.yaml", "open.obj"}, "open.obj");
  expect_bad({"prove", "mission.yaml", "missing.ply"}, "missing.ply");
  expect_bad({"prove", "mission.yaml", "city.obj", "--shrink", "2"});
}

/// Before anything is read: the volume is not there.
TEST_F(CliProve, RefusesPicturesThatCannotBeDrawn) {
  expect_bad({"prove", "mission.yaml", "missing.ply", "--view", "top"}, "--view");
  expect_bad({"prove", "mission.yaml", "missing.ply", "--size", "800x600"}, "--size");
  expect_bad({"prove", "mission.yaml", "missing.ply", "--picture", "p.png", "--view", "sideways"}, "--view");
  expect_bad({"prove", "mission.yaml", "missing.ply", "--picture", "p.png", "--size", "800"}, "--size");
  expect_bad({"prove", "mission.yaml", "missing.ply", "--picture", "p.jpg"}, "p.jpg");
}

TEST_F(CliProve, WritesACertificateAndItsScene) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply", "-o", "v.stl"});
  const std::string told = output_of({"prove", "mission.yaml", "v.ply", "--certificate", "v.cert"});
  EXPECT_NE(told.find("v.cert"), std::string::npos) << told;
  const auto json = nlohmann::json::parse(testing::content(folder_ / "v.cert"));
  EXPECT_EQ(json.at("format"), "vantage certificate 1");
  EXPECT_EQ(json.at("scene").at("file"), "v.scene.ply");
  EXPECT_EQ(json.at("volume").at("file"), "v.ply");
  ASSERT_EQ(json.at("parts").size(), 1u);
  const auto proof = nlohmann::json::parse(output_of({"prove", "mission.yaml", "v.ply", "--json"}));
  const auto facets = json.at("parts")[0].at("facets").get<std::string>();
  EXPECT_EQ(1 + std::count(facets.begin(), facets.end(), ' '), proof.at("tested_facets"));

  const auto stl = run({"prove", "mission.yaml", "v.stl", "--certificate", "stl.cert"});
  EXPECT_EQ(stl.exit_code, 2);
  EXPECT_NE(stl.err.find("v.stl"), std::string::npos) << stl.err;
  const auto over = run({"prove", "mission.yaml", "v.ply", "--certificate", "v.ply"});
  EXPECT_EQ(over.exit_code, 2) << over.err;
  EXPECT_EQ(run({"prove", "mission.yaml", "v.ply", "--certificate", "none/v.cert"}).exit_code, 2);
}

TEST_F(CliProve, JsonNamesTheCertificate) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  const auto named = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"prove", "mission.yaml", "v.ply", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return nlohmann::json::parse(output_of(arguments)).at("certificate");
  };
  EXPECT_TRUE(named({}).is_null());
  EXPECT_EQ(named({"--certificate", "v.cert"}), "v.cert");
}

/// The exit code is 0 with or without: who asks for one must be told before.
TEST_F(CliProve, RefusesACertificateOfBothSides) {
  write("mission.yaml",
        "scene: {mesh: city.obj}\nsensor: {max_range: 30}\n"
        "target: {vertices: [[-9, 0, 1], [-3, 0, 1], [-3, 0, 4], [-9, 0, 4]], sides: both}\n");
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  write("v.cert", testing::kOldOutput);
  output_of({"prove", "mission.yaml", "v.ply", "-q"});
  expect_bad({"prove", "mission.yaml", "v.ply", "--certificate", "v.cert"}, "targets");
  expect_refused({"prove", "mission.yaml", "v.ply", "--certificate", "v.cert", "--json"});
  expect_refused({"prove", "mission.yaml", "v.ply", "--certificate", "v.cert", "-q"});
}

/// What the checker would refuse.
TEST_F(CliProve, WritesNoCertificateThatCannotBeChecked) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  std::filesystem::create_directory(folder_ / "other");
  expect_bad({"prove", "mission.yaml", "v.ply", "--certificate", "other/v.cert"}, "other/v.cert");
  output_of({"prove", "mission.yaml", "other/../v.ply", "--certificate", "v.cert"});  // the same folder
  EXPECT_EQ(nlohmann::json::parse(testing::content(folder_ / "v.cert")).at("volume").at("file"), "v.ply");

  const std::string bytes = testing::content(folder_ / "v.ply");
  const auto with = [&](const std::string& old, const std::string& changed) {
    std::string text = bytes;
    const std::size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), changed);
  };
  write("other_name.ply", with("vertex_indices", "vertex_index"));
  write("rounded.ply", with("rounding_m 0\n", "rounding_m 9\n"));
  write("mission_of_other.ply", with("\"mission_hash\":\"", "\"mission_hash\":\"0"));
  write("text.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 5\n2 0 5\n0 2 5\n0 0 7\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
  for (const char* file : {"text.ply", "other_name.ply", "rounded.ply", "mission_of_other.ply"}) {
    expect_bad({"prove", "mission.yaml", file, "--certificate", "w.cert", "-q"}, file);
  }
  // What other programs may read otherwise.
  write("longer.ply", bytes + "more");
  write("ends_twice.ply", with("1.0\n", "1.0\ncomment end_header\n"));
  write("blanks.ply", with("element vertex", "element  vertex"));
  write("unknown.ply", with("1.0\n", "1.0\nobj_info made by hand\n"));
  write("late_comment.ply", with("element face", "comment faces\nelement face"));
  write("next_line.ply", with("1.0\n", "1.0\ncomment vantage cause a\u2028b\n"));
  write("not_ascii.ply", with("1.0\n", "1.0\ncomment Stra\u00dfe\n"));
  write("said_within.ply", with("1.0\n", "1.0\ncomment see vantage rounding_m 0\n"));
  write("coordinates.ply", with("property double x\n", "property int x\nproperty int a\n"));
  for (const char* file : {"longer.ply", "ends_twice.ply", "blanks.ply", "unknown.ply", "late_comment.ply",
                           "next_line.ply", "not_ascii.ply", "said_within.ply", "coordinates.ply"}) {
    const auto result = run({"prove", "mission.yaml", file, "--certificate", "w.cert", "-q"});
    EXPECT_EQ(result.exit_code, 2) << file << result.err;
    EXPECT_NE(result.err.find(file), std::string::npos) << result.err;
  }
  // Another mesh than the one that the header names, and another place on the earth.
  write("changed.ply", with("\"volume_hash\":\"", "\"volume_hash\":\"0"));
  write("elsewhere.ply",
        with("1.0\n", "1.0\ncomment vantage georeference: {\"latitude_deg\":48.0,\"longitude_deg\":11.0}\n"));
  for (const char* file : {"changed.ply", "elsewhere.ply"}) {
    expect_bad({"prove", "mission.yaml", file, "--certificate", "w.cert", "-q"}, file);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "w.cert"));
  output_of({"simplify", "text.ply", "--facets", "1000000000", "-q", "-o", "binary.ply"});  // the advice
  output_of({"prove", "mission.yaml", "binary.ply", "--certificate", "w.cert"});
  EXPECT_TRUE(std::filesystem::exists(folder_ / "w.cert"));
}

/// A volume about another origin is moved when it is read: its file has other numbers.
TEST_F(CliProve, WritesNoCertificateOfAMeshThatWasMoved) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  const Mission mission = resolve_mission(read_mission(folder_ / "mission.yaml"));
  VolumeFile read = read_volume(folder_ / "v.ply", mission.scene());
  const std::filesystem::path file = folder_ / "v.cert";
  write_certificate({}, mission, read, file);
  std::filesystem::remove(file);
  read.volume.mesh.vertices[0].x() += 1e-9;
  testing::expect_error([&] { write_certificate({}, mission, read, file); }, ErrorCode::not_applicable, "v.ply");
  EXPECT_FALSE(std::filesystem::exists(file));
}

/// It may have come there during the proof, which may take long.
TEST_F(CliProve, ACertificateReplacesNoSceneOfOthers) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  const Mission mission = resolve_mission(read_mission(folder_ / "mission.yaml"));
  const VolumeFile read = read_volume(folder_ / "v.ply", mission.scene());
  check_certificate_files(folder_ / "v.cert", folder_ / "v.ply", {});
  write("v.scene.ply", "mine");
  testing::expect_error([&] { write_certificate({}, mission, read, folder_ / "v.cert"); }, ErrorCode::output_of_others,
                        "v.scene.ply");
  EXPECT_EQ(testing::content(folder_ / "v.scene.ply"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "v.cert"));
  std::filesystem::remove(folder_ / "v.scene.ply");
  for (int time = 0; time < 2; ++time) write_certificate({}, mission, read, folder_ / "v.cert");
}

TEST_F(CliProve, ACertificateReplacesNothingOfOthers) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  const auto ask = [&](const char* name) {
    const auto result = run({"prove", "mission.yaml", "v.ply", "--certificate", name});
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_NE(result.err.find("not write"), std::string::npos) << result.err;
  };
  for (const char* text : {"mine", "", R"({"format": "vantage certificate 1"})", R"({"format":"vantage certificate"})",
                           R"({"format":"vantage certificate 1 is what I need"})"}) {
    for (const char* name : {"notes.txt", "notes.json", "notes.cert"}) {
      write(name, text);
      std::filesystem::create_symlink(folder_ / name, folder_ / "link.cert");
      ask(name);
      ask("link.cert");
      EXPECT_EQ(testing::content(folder_ / name), text);
      std::filesystem::remove(folder_ / "link.cert");
    }
  }
  for (int time = 0; time < 2; ++time) {
    for (const char* name : {"v.cert", "v.json", "v"}) {
      output_of({"prove", "mission.yaml", "v.ply", "--certificate", name});
      EXPECT_EQ(nlohmann::json::parse(testing::content(folder_ / name)).at("format"), "vantage certificate 1");
    }
  }
  // As it may come there during the proof.
  const Mission mission = resolve_mission(read_mission(folder_ / "mission.yaml"));
  const VolumeFile read = read_volume(folder_ / "v.ply", mission.scene());
  testing::expect_code([&] { write_certificate({}, mission, read, folder_ / "notes.cert"); },
                       ErrorCode::output_of_others, "notes.cert");
}

TEST_F(CliProve, APipeInThePlaceOfTheReportIsNotOpened) {
  write("v.ply",  // which says nothing of how it was made
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 5\n2 0 5\n0 2 5\n0 0 7\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
  const testing::Pipe pipe(folder_ / "v.report.json");
  for (const char* const command : {"prove", "verify"}) {
    const auto result = run({command, "mission.yaml", "v.ply", "-q"});
    EXPECT_EQ(result.exit_code, 2) << command << result.err;
    EXPECT_NE(result.err.find("v.report.json"), std::string::npos) << result.err;
  }
  EXPECT_FALSE(pipe.was_opened());
}

TEST_F(CliProve, APipeIsNoVolumeForACertificate) {
  const testing::Pipe pipe(folder_ / "v.ply");
  testing::expect_code([&] { check_certificate_files(folder_ / "v.cert", pipe.file(), {}); }, ErrorCode::not_a_file,
                       "v.ply");
  EXPECT_FALSE(pipe.was_opened());
}

TEST_F(CliProve, WritesNoCertificateOfWhatIsWrong) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply"});
  output_of({"prove", "mission.yaml", "v.ply", "-q", "--certificate", "v.cert"});
  const std::string before = testing::content(folder_ / "v.cert");
  write_mission("navigation: {altitude: [1, 20]}\n");
  const auto result = run({"prove", "mission.yaml", "v.ply", "--certificate", "v.cert"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  testing::expect_wording(result.err);
  EXPECT_EQ(testing::content(folder_ / "v.cert"), before);
  const auto quiet = run({"prove", "mission.yaml", "v.ply", "--certificate", "v.cert", "-q"});
  EXPECT_EQ(quiet.exit_code, 1);
  EXPECT_NE(quiet.err.find("v.cert"), std::string::npos) << quiet.err;
  EXPECT_EQ(quiet.out, "");
  testing::fs::remove(folder_ / "v.cert");
  const auto json = run({"prove", "mission.yaml", "v.ply", "--certificate", "v.cert", "--json"});
  EXPECT_EQ(json.exit_code, 1);
  EXPECT_NE(json.err, "");
  EXPECT_TRUE(nlohmann::json::parse(json.out).at("certificate").is_null());
  EXPECT_FALSE(testing::fs::exists(folder_ / "v.cert"));
  write("mission.yaml",
        "scene: {mesh: city.obj}\ntarget: {vertices: [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]}\n"
        "sensor: {max_range: 49}\n");
  const auto wrong = run({"prove", "mission.yaml", "v.ply", "--certificate", "v.cert"});
  EXPECT_EQ(wrong.exit_code, 1) << wrong.err;
  EXPECT_FALSE(testing::fs::exists(folder_ / "v.cert"));
}

TEST_F(CliProve, ComputeWritesOnlyWhatIsProved) {
  output_of({"compute", "mission.yaml", "-q", "-o", "v.ply", "--prove"});
  EXPECT_GT(testing::content(folder_ / "v.ply").size(), 1000u);
  write_airspace();
  write_mission("navigation: {meshes: [airspace.obj]}\n");
  const auto result = run({"compute", "mission.yaml", "-o", "w.ply", "--prove"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.err.find("meshes"), std::string::npos) << result.err;
  EXPECT_FALSE(testing::fs::exists(folder_ / "w.ply"));
  EXPECT_EQ(run({"compute", "mission.yaml", "-o", "v.ply", "--prove", "-q"}).exit_code, 4);
  EXPECT_EQ(run({"compute", "mission.yaml", "-o", "-", "--format", "ply", "--prove"}).out, "");
}

/// The rays of such spheres pass by the edges of the block.
TEST_F(CliProve, ComputeWritesNothingThatIsWrong) {
  write_mission("method: spheres\nspheres: {sphere: centers, cubemap: 16, device: cpu}\n");
  write("v.ply", testing::kOldOutput);
  const auto result = run({"compute", "mission.yaml", "-o", "v.ply", "--prove"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err.find("v.ply"), std::string::npos) << result.err;
  EXPECT_EQ(testing::content(folder_ / "v.ply"), testing::kOldOutput);
}

TEST_F(CliProve, ComputeWritesEachOrNone) {
  write("mission.yaml",
        "scene: {mesh: city.obj}\nsensor: {max_range: 50}\ncombine: each\nmethod: spheres\n"
        "spheres: {sphere: centers, cubemap: 16, device: cpu}\n"
        "targets:\n"
        "  - {name: near, vertices: [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]}\n"
        "  - {name: roof, vertices: [[11, -2, 12], [13, -2, 12], [13, 2, 12], [11, 2, 12]]}\n");
  const auto before = files();
  const auto wrong = run({"compute", "mission.yaml", "-o", "v.ply", "--prove"});
  EXPECT_EQ(wrong.exit_code, 1) << wrong.err;
  testing::expect_wording(wrong.err);
  EXPECT_TRUE(files() == before);
  output_of({"compute", "mission.yaml", "-o", "v.ply", "-q"});
  EXPECT_EQ(run({"prove", "mission.yaml", "v.near.ply"}).exit_code, 1);
  EXPECT_EQ(run({"prove", "mission.yaml", "v.roof.ply"}).exit_code, 0) << "not all of them are wrong";
}

/// PLY keeps the numbers that were proved.
TEST_F(CliProve, ComputeTellsWhatWasRoundedAfterTheProof) {
  const auto result = run({"compute", "mission.yaml", "-o", "v.ply", "-o", "v.stl", "-o", "v.obj", "--prove"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("v.stl"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("v.ply"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("v.obj"), std::string::npos) << result.err;
  EXPECT_EQ(output_of({"compute", "mission.yaml", "-o", "v.stl", "--prove", "-q"}), "");
}

TEST_F(CliProve, ComputeAsksFirstWhetherThereIsAProof) {
  const std::string one = "{name: a, vertices: [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]}";
  const std::string other = "{name: b, vertices: [[11, -2, 12], [13, -2, 12], [13, 2, 12], [11, 2, 12]]}";
  const auto expect_early = [&](const std::string& text, const std::string& where) {
    write("mission.yaml", "scene: {mesh: city.obj}\n" + text);
    expect_bad({"compute", "mission.yaml", "-o", "v.ply", "--prove"}, where);
    const std::string stage = "preparing";
    const auto with = run({"compute", "mission.yaml", "-o", "v.ply", "--prove", "--progress"});
    EXPECT_EQ(with.err.find(stage), std::string::npos) << with.err;
    const auto without = run({"compute", "mission.yaml", "-o", "v.ply", "--progress"});
    EXPECT_NE(without.err.find(stage), std::string::npos) << without.err;
  };
  expect_early("sensor: {max_range: 50}\ncombine: any\ntargets: [" + one + ", " + other + "]\n", "targets");
  expect_early("sensor: {max_range: 50, visible: 0.5}\ntarget: " + one + "\n", "sensor.visible");
  const std::string point = "{point: [0, 0, 3]}";
  expect_early("sensor: {max_range: 50, link: {frequency: 2.4}}\ntarget: " + point + "\n", "sensor.link");
}

}  // namespace
}  // namespace vantage
