#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "app/point_json.h"
#include "common/atomic_file.h"
#include "common/input.h"
#include "common/output.h"
#include "common/stages.h"
#include "common/temporary_folder.h"
#include "core/format.h"
#include "core/replace_folder.h"
#include "core/temporary_mark.h"
#include "core/text.h"
#include "io/json_text.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/version.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kStory = "stages.json";

const char* name_of(SphereStage::Kind kind) {
  switch (kind) {
    case SphereStage::Kind::sphere:
      return "sphere";
    case SphereStage::Kind::pair:
      return "pair";
    case SphereStage::Kind::split:
      return "split";
    case SphereStage::Kind::partial:
      return "partial";
    case SphereStage::Kind::result:
      return "result";
  }
  return "unknown";
}

constexpr const char* kAgain = "write the folder again with \"vantage compute --method spheres --stages FOLDER\"";

StageFile stage_of(const nlohmann::json& json, const fs::path& folder) {
  StageFile stage;
  stage.kind = json.at("kind").get<std::string>();
  stage.name = json.at("name").get<std::string>();
  if (json.contains("file") && json.at("file").is_string() && !json.at("file").get<std::string>().empty()) {
    stage.mesh = folder / json.at("file").get<std::string>();
  }
  if (json.contains("euler") && json.at("euler").is_number_integer()) stage.euler = json.at("euler").get<long>();
  return stage;
}

/// "007_pair_0-1.ply".
std::string file_name(std::size_t order, std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return internal::core::format("{:03}_{}.ply", order, name);
}

/// Whether --stages writes files of this name: stages.json, and numbered meshes.
bool is_stage_file(const fs::directory_entry& entry) {
  std::error_code error;
  const std::string name = entry.path().filename().string();
  const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
  const bool is_mesh = digits >= 3 && name[digits] == '_' && entry.path().extension() == ".ply";
  return (is_mesh || name == kStory) && entry.is_regular_file(error);
}

/// What a killed process may leave in a folder that it has put in place.
bool is_left_mark(const fs::directory_entry& entry) {
  std::error_code error;
  return entry.path().filename() == internal::core::kTemporaryMark && entry.is_regular_file(error);
}

constexpr const char* kElsewhere = "name a folder that can be written, on a disk with room";

}  // namespace

StageFolder::StageFolder(fs::path folder) : asked_(std::move(folder)), folder_(internal::core::without_slash(asked_)) {
  std::error_code error;
  const fs::file_status status = fs::status(folder_, error);
  if (folder_.empty() || (fs::exists(status) && !fs::is_directory(status))) {
    throw Error(ErrorCode::output_folder_missing, "the place of the stages is not a folder", asked_.string(),
                "name a folder for --stages; it is made if it does not exist");
  }
  if (fs::exists(status)) check_replaceable();
  if (fs::is_symlink(folder_, error)) folder_ = fs::canonical(folder_, error);
  const fs::path parent = folder_.has_parent_path() ? folder_.parent_path() : fs::path(".");
  try {
    temporary_ = std::make_unique<TemporaryFolder>(parent, internal::core::temporary_prefix(folder_, "stages"));
  } catch (const Error& refused) {
    throw Error(refused.code(), "the folder of the stages cannot be made: " + refused.problem(), asked_.string(),
                kElsewhere);
  }
  // As other programs make folders; a temporary one is private.
  fs::permissions(temporary_->path(), fs::exists(status) ? status.permissions() : static_cast<fs::perms>(0755), error);
}

StageFolder::~StageFolder() = default;

void StageFolder::fail(const std::string& problem, int error_number) const {
  throw Error(ErrorCode::output_unwritable, problem + ": " + std::strerror(error_number), asked_.string(), kElsewhere);
}

/// The old folder is removed as a whole: nothing in it may be anybody else's.
void StageFolder::check_replaceable() const {
  const auto refuse = [&](const std::string& reason) {
    throw Error(ErrorCode::folder_in_use, "the folder of the stages holds other things: " + reason, asked_.string(),
                "name an empty or a new folder, or one that holds what --stages wrote and nothing else");
  };
  std::error_code error;
  fs::directory_iterator entry(folder_, error);
  if (error) fail("the folder of the stages cannot be read", error.value());
  std::vector<fs::path> files;
  bool has_story = false;
  for (; entry != fs::directory_iterator(); entry.increment(error)) {
    if (is_left_mark(*entry)) continue;
    if (!is_stage_file(*entry)) refuse(entry->path().filename().string());
    files.push_back(entry->path());
    has_story |= files.back().filename() == kStory;
  }
  if (error) fail("the folder of the stages cannot be read", error.value());
  if (!files.empty() && !has_story) refuse(std::string("no ") + kStory);
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {  // others' files may have such names
    try {
      check_derived_output(file);
    } catch (const Error& refused) {
      if (refused.code() != ErrorCode::output_of_others) throw;
      refuse(file.filename().string() + ", which vantage did not write");
    }
  }
}

StageSink StageFolder::sink() {
  return [this](const SphereStage& stage) { add(stage); };
}

void StageFolder::add(const SphereStage& stage) {
  Told told{name_of(stage.kind),   stage.name,      "",           stage.points, stage.euler,
            stage.component_euler, stage.volume_m3, stage.seconds};
  if (stage.mesh && !stage.mesh->empty()) {
    told.file = file_name(stages_.size(), stage.name);
    Volume volume = volume_of_mesh(*stage.mesh, stage.name);
    volume.georeference = stage.georeference;
    write_volume(volume, temporary_->path() / told.file);
  }
  stages_.push_back(std::move(told));
}

void StageFolder::write_story(const Mission& mission, const Result& result) {
  Json story;
  story["version"] = VANTAGE_VERSION;
  story["mission"] = mission.as_written.file.string();
  story["target"] = mission.target.name;
  story["max_range_m"] = range_limit_m(mission.sensor);
  story["outcome"] = vantage::name_of(result.volume.outcome);
  story["reason"] = result.volume.reason;
  story["run"] = Json::parse(spheres_json({mission.as_written.spheres, *result.spheres}));
  story["stages"] = Json::array();
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    const Told& told = stages_[i];
    Json points = Json::array();
    for (const Vec3& point : told.points) points.push_back(point_json(point));
    Json stage = {{"order", i}, {"kind", told.kind}, {"name", told.name}, {"points", points}};
    if (told.kind != "split") {
      stage["euler"] = told.euler;
      stage["component_euler"] = told.component_euler;
      stage["volume_m3"] = told.volume_m3;
      stage["seconds"] = told.seconds;
      stage["file"] = told.file.empty() ? Json(nullptr) : Json(told.file);
    }
    story["stages"].push_back(std::move(stage));
  }
  write_whole_file(temporary_->path() / kStory,
                   internal::core::escaped_json(story.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n");
  std::error_code error;
  if (fs::exists(folder_, error)) check_replaceable();  // the run may have taken long
}

void StageFolder::commit() {
  std::error_code error;
  if (fs::exists(folder_, error)) check_replaceable();
  if (!temporary_->move_to(folder_)) fail("the folder of the stages cannot be put in place", errno);
  temporary_.reset();
}

std::vector<StageFile> read_stages(const fs::path& folder) {
  const fs::path file = folder / "stages.json";
  check_readable(file, "the story of the stages", "");
  std::vector<StageFile> stages;
  try {
    std::ifstream stream(file);
    const nlohmann::json json = nlohmann::json::parse(stream);
    for (const nlohmann::json& stage : json.at("stages")) stages.push_back(stage_of(stage, folder));
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::record_garbled, "the story of the stages is garbled: " + internal::io::words_of(error),
                file.string() + ", stage " + std::to_string(stages.size()), kAgain);
  }
  if (stages.empty()) throw Error(ErrorCode::record_garbled, "the story of the stages is empty", file.string(), kAgain);
  return stages;
}

}  // namespace vantage
