// What a computation leaves on the disk: all files or none.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "common/output.h"
#include "core/png_mark.h"
#include "core/progress_reporter.h"
#include "support/formats.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/version.h"

namespace vantage::internal::app {
namespace {

using vantage::testing::make_hemisphere;
using vantage::testing::read_bytes;
using vantage::testing::TemporaryDirectory;
using vantage::testing::write_bytes;
using Names = std::vector<std::string>;

const Names kFiles = {"a.glb", "a.ply", "a.report.json", "b.obj", "b.report.json"};

/// Of an earlier run: a report that vantage did not write is never replaced.
std::string old_content(const std::string& name) {
  const bool is_report = name.ends_with(".json");
  return is_report ? report_json(Volume(), MeshMeasures()) : "old";
}

Names sorted_names(const TemporaryDirectory& directory) {
  Names names = directory.names();
  std::sort(names.begin(), names.end());
  return names;
}

/// A request for three formats, and old files of all names that it stands for.
ResultRequest request_over_old_files(const TemporaryDirectory& directory) {
  for (const std::string& name : kFiles) write_bytes(directory / name, old_content(name));
  ResultRequest request;
  request.volumes = {directory / "a.ply", directory / "a.glb", directory / "b.obj"};
  request.source.target = "plaza";
  return request;
}

void expect_old_files(const TemporaryDirectory& directory) {
  EXPECT_EQ(sorted_names(directory), kFiles);
  for (const std::string& name : kFiles) EXPECT_EQ(read_bytes(directory / name), old_content(name)) << name;
}

TEST(ResultFiles, ComeInAllFormatsWithAReportBesideEach) {
  const TemporaryDirectory directory;
  const ResultRequest request = request_over_old_files(directory);
  Volume volume = make_hemisphere(Vec3::Zero(), 100);
  volume.seconds.total = 1;
  std::vector<std::string> stages;
  const core::ProgressReporter::AskAlways ask_always;
  const WrittenResults written = write_results(volume, request, [&](std::string_view stage, double fraction) {
    stages.emplace_back(stage);
    return fraction >= 0 && fraction <= 1;
  });
  EXPECT_EQ(stages, Names(5, "writing"));  // at the beginning, before each file and at the end
  EXPECT_EQ(sorted_names(directory), kFiles);
  for (const std::string& name : kFiles) EXPECT_GT(read_bytes(directory / name).size(), 500u) << name;
  EXPECT_EQ(written.reports,
            (std::vector<std::filesystem::path>{directory / "a.report.json", directory / "b.report.json"}));
  EXPECT_EQ(written.report, read_bytes(directory / "a.report.json"));
  const auto report = nlohmann::json::parse(read_bytes(directory / "b.report.json"));
  EXPECT_EQ(report.at("volume"), (directory / "b.obj").string());
  EXPECT_EQ(report.at("target"), "plaza");
  EXPECT_EQ(report.at("facets"), written.measures.facets);
  EXPECT_EQ(report.at("seconds").at("write"), volume.seconds.write);
  EXPECT_GT(volume.seconds.write, 0);
  EXPECT_EQ(volume.seconds.total, 1 + volume.seconds.write);
}

// A picture that is cut off anywhere, one byte at a time, is still a file of somebody.
TEST(ResultFiles, APictureIsOwnWhereItsTextSaysSo) {
  const TemporaryDirectory directory;
  const std::string header = std::string("\x89PNG\r\n\x1a\n") + std::string(25, 'h');
  const std::string marked = core::with_png_mark(header + "pixels");
  EXPECT_TRUE(marked.starts_with(header));
  EXPECT_TRUE(marked.ends_with("pixels"));
  const std::size_t end = marked.size() - std::string("pixels").size();  // of the chunk, with its checksum
  ASSERT_NE(marked.find("vantage " VANTAGE_VERSION), std::string::npos);
  for (std::size_t bytes = 0; bytes <= marked.size(); ++bytes) {
    write_bytes(directory / "a.png", marked.substr(0, bytes));
    std::optional<ErrorCode> code;
    try {
      check_derived_output(directory / "a.png");
    } catch (const Error& error) {
      code = error.code();
    }
    EXPECT_EQ(code, bytes < end ? std::optional(ErrorCode::output_of_others) : std::nullopt) << bytes;
  }
}

// By another library.
TEST(ResultFiles, TheTextOfAPictureHasItsChecksum) {
  const std::string header(33, 'h');
  const std::string chunk = core::with_png_mark(header).substr(header.size());
  ASSERT_GT(chunk.size(), 12u);
  const auto number_at = [&](std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(chunk[at + i]);
    return number;
  };
  EXPECT_EQ(number_at(0), chunk.size() - 12);
  const std::string counted = chunk.substr(4, chunk.size() - 8);
  const auto bytes = static_cast<uInt>(counted.size());
  EXPECT_EQ(number_at(chunk.size() - 4), ::crc32(0, reinterpret_cast<const Bytef*>(counted.data()), bytes));
}

TEST(ResultFiles, AVolumeThatIsNotClosedIsNotWritten) {
  const TemporaryDirectory directory;
  const ResultRequest request = request_over_old_files(directory);
  const Volume sound = make_hemisphere(Vec3::Zero(), 100);
  Volume open = sound, turned = sound;
  open.mesh.triangles.pop_back();
  open.cause_of.pop_back();
  std::swap(turned.mesh.triangles[7][0], turned.mesh.triangles[7][1]);
  for (const auto& [volume, problem] : {std::pair<Volume*, std::string>(&open, "the volume is not closed"),
                                        {&turned, "the volume's facets do not all face outward"}}) {
    try {
      write_results(*volume, request);
      FAIL() << problem;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::internal);
      EXPECT_EQ(error.problem(), problem);
      EXPECT_FALSE(error.where().empty());
      EXPECT_FALSE(error.fix().empty());
    }
    expect_old_files(directory);
  }
}

TEST(ResultFiles, AFailureOfTheLastLeavesAllOldFiles) {
  const TemporaryDirectory directory;
  ResultRequest request = request_over_old_files(directory);
  Volume volume = make_hemisphere(Vec3::Zero(), 100);
  request.obj_scale = 0;  // the OBJ comes third
  EXPECT_THROW(write_results(volume, request), Error);
  expect_old_files(directory);
  request.obj_scale = 1;
  request.volumes.push_back(directory / "none" / "c.ply");
  EXPECT_THROW(write_results(volume, request), Error);
  expect_old_files(directory);
}

TEST(ResultFiles, CancellingLeavesAllOldFiles) {
  const TemporaryDirectory directory;
  const ResultRequest request = request_over_old_files(directory);
  const core::ProgressReporter::AskAlways always;
  for (int last = 0; last < 5; ++last) {
    Volume volume = make_hemisphere(Vec3::Zero(), 100);
    int asked = 0;
    try {
      write_results(volume, request, [&](std::string_view, double) { return asked++ < last; });
      FAIL() << last;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
    EXPECT_EQ(asked, last + 1);
    expect_old_files(directory);
  }
}

TEST(ResultFiles, WithoutAVolumeOnlyReportsAreWritten) {
  const TemporaryDirectory directory;
  const ResultRequest request = request_over_old_files(directory);
  Volume volume;
  volume.outcome = Outcome::outside_limits;
  volume.reason = "too high";
  write_results(volume, request);
  EXPECT_EQ(sorted_names(directory), kFiles);
  for (const char* name : {"a.ply", "a.glb", "b.obj"}) EXPECT_EQ(read_bytes(directory / name), "old") << name;
  const auto report = nlohmann::json::parse(read_bytes(directory / "b.report.json"));
  EXPECT_EQ(report.at("reason"), "too high");
  EXPECT_FALSE(report.contains("volume"));
}

// A name that was not given may be that of a file of somebody's own.
TEST(ResultFiles, AFileThatVantageDidNotWriteIsNotReplacedByWhatLiesBesideAnOutput) {
  const TemporaryDirectory directory;
  Volume volume = make_hemisphere(Vec3::Zero(), 100);
  const auto write_to = [&](const char* name) {
    ResultRequest request;
    request.volumes = {directory / name};
    write_results(volume, request);
  };
  for (const auto& [file, beside, own] :
       {std::tuple("a.ply", "a.report.json", "{\"version\": \"mine\", \"days\": [1, 2]}"),
        {"a.ply", "a.report.json", "no JSON"},
        {"a.ply", "a.report.json", ""},
        {"b.stl", "b.report.json", "[]"},
        {"b.stl", "b.stl.place.json", "{\"place\": \"home\"}"}}) {
    const char* const output = file;
    write_bytes(directory / beside, own);
    vantage::testing::expect_error([&] { check_result_files({directory / output}, {}); }, ErrorCode::output_of_others,
                                   beside);
    vantage::testing::expect_code([&] { write_to(output); }, ErrorCode::output_of_others, beside);
    EXPECT_EQ(read_bytes(directory / beside), own);
    EXPECT_FALSE(std::filesystem::exists(directory / output));
    std::filesystem::remove(directory / beside);
  }
  for (const char* const output : {"a.ply", "b.stl"}) {
    write_to(output);
    write_to(output);  // over what vantage wrote
  }
}

TEST(ResultFiles, WhatVantageWroteIsKnownByItsBeginning) {
  const TemporaryDirectory directory;
  const Volume volume = make_hemisphere(Vec3::Zero(), 100);
  for (const std::string& name : vantage::testing::in_each_format("v")) {
    write_bytes(directory / name, "mine");
    vantage::testing::expect_code([&] { check_derived_output(directory / name); }, ErrorCode::output_of_others, name);
    write_volume(volume, directory / name);
    check_derived_output(directory / name);
  }
  check_derived_output(directory / "v.stl.place.json");
  write_bytes(directory / "v.table.csv", "target,area\n");
  vantage::testing::expect_code([&] { check_derived_output(directory / "v.table.csv"); }, ErrorCode::output_of_others);
  write_bytes(directory / "v.table.csv", table_csv({}));
  check_derived_output(directory / "v.table.csv");
  check_derived_output(directory / "none.ply");
}

/// What a writer wrote, with other bytes in one place.
struct Changed {
  const char* name;
  std::string from, to;
};

// "# vantage points of the old town" is how a file of somebody's own may begin.
TEST(ResultFiles, WhatOnlyBeginsLikeAFileOfVantageIsOfOthers) {
  const TemporaryDirectory directory;
  const Volume volume = make_hemisphere(Vec3::Zero(), 100);
  const auto write_changed = [&](const Changed& changed) {
    write_volume(volume, directory / changed.name);
    std::string bytes = read_bytes(directory / changed.name);
    const std::size_t at = bytes.find(changed.from);
    ASSERT_NE(at, std::string::npos) << changed.name << ": " << changed.from;
    write_bytes(directory / changed.name, bytes.replace(at, changed.from.size(), changed.to));
  };
  const std::string version = "vantage " VANTAGE_VERSION;
  for (const Changed& changed :
       std::vector<Changed>{{"v.obj", version + " visibility volume: computed", "vantage points of the old town"},
                            {"v.obj", version, "vantage 0.1"},
                            {"v.obj", "volume: computed", "volume: computed by hand"},
                            {"v.obj", "volume: computed", "volume: "},
                            {"v.ply", version + " visibility volume: computed", "vantage points of the old town"},
                            {"v.ply", "comment " + version, "comment my own\ncomment " + version},
                            {"v.stl", version + " visibility", "vantage points by Ann"},
                            {"v.stl", ", metres, ", ", inches, "},
                            {"v.glb", version, "vantage points 1"},
                            {"v.glb", "\"generator\":\"" + version, "\"copyright\":\"" + version}}) {
    write_changed(changed);
    const std::string own = read_bytes(directory / changed.name);
    vantage::testing::expect_code([&] { check_derived_output(directory / changed.name); }, ErrorCode::output_of_others,
                                  changed.name);
    EXPECT_EQ(read_bytes(directory / changed.name), own);
  }
  for (const std::string& name : vantage::testing::in_each_format("v")) {
    write_changed({name.c_str(), version, "vantage 12.0.345"});
    check_derived_output(directory / name);  // of another version
  }
  Scene scene;
  scene.mesh = volume.mesh;
  scene.object_of.assign(scene.mesh.triangles.size(), 0);
  scene.objects.resize(1);
  for (const std::string& name : vantage::testing::in_each_format("s")) {
    write_scene(scene, directory / name);
    check_derived_output(directory / name);
  }
}

}  // namespace
}  // namespace vantage::internal::app
