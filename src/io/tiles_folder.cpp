#include "io/tiles_folder.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "common/input.h"
#include "core/replace_folder.h"
#include "core/system_files.h"
#include "core/temporary_mark.h"
#include "core/version_text.h"
#include "io/written_marks.h"
#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOtherPlace = "name a folder that can be written, on a disk with room";
constexpr std::uintmax_t kMostTilesetBytes = 1'000'000;  // vantage writes some thousand

[[noreturn]] void fail_tiles(const std::string& problem, const fs::path& folder, int error_number) {
  throw Error(ErrorCode::output_unwritable, problem + ": " + std::strerror(error_number), folder.string(), kOtherPlace);
}

/// By what vantage writes into its "asset".
bool is_own_tileset(const fs::path& file) {
  std::error_code error;
  if (fs::file_size(file, error) > kMostTilesetBytes || error) return false;
  std::ifstream stream(file, std::ios::binary);
  const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
  const nlohmann::json::json_pointer place("/asset/extras/vantage/version");
  return json.is_object() && json.contains(place) && json[place].is_string() &&
         core::is_version(json[place].get<std::string>());
}

/// The old folder is removed as a whole: nothing in it may be anybody else's.
void check_tiles_replaceable(const fs::path& folder, const fs::path& asked) {
  const auto refuse = [&](const std::string& reason) {
    throw Error(ErrorCode::folder_in_use, "the folder of the tileset holds other things: " + reason, asked.string(),
                "name an empty or a new folder, or one that holds a tileset that vantage wrote and nothing else");
  };
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  if (error) fail_tiles("the folder of the tileset cannot be read", asked, error.value());
  bool has_files = false, has_tileset = false;
  for (; entry != fs::directory_iterator(); entry.increment(error)) {
    const fs::path& file = entry->path();
    const std::string name = file.filename().string();
    std::error_code ignored;
    const bool is_file = entry->symlink_status(ignored).type() == fs::file_type::regular;
    if (name == core::kTemporaryMark && is_file) continue;  // a killed process may leave it
    if (!is_file || (name != kTilesetFile && name != kTilesContent)) refuse(in_quotes(name));
    const bool is_own = name == kTilesetFile ? is_own_tileset(file) : is_own_file(file);
    if (!is_own) refuse(in_quotes(name) + ", which vantage did not write");
    has_files = true;
    has_tileset |= name == kTilesetFile;
  }
  if (error) fail_tiles("the folder of the tileset cannot be read", asked, error.value());
  if (has_files && !has_tileset) refuse(std::string("no ") + kTilesetFile);
}

fs::path parent_of(const fs::path& folder) { return folder.has_parent_path() ? folder.parent_path() : fs::path("."); }

}  // namespace

void check_tiles_place(const fs::path& asked) {
  fs::path folder = core::without_slash(asked);
  std::error_code error;
  if (fs::is_symlink(folder, error)) {
    folder = fs::canonical(folder, error);
    if (error) {
      throw Error(ErrorCode::output_folder_missing, "the output is a link, and what it leads to is not there",
                  asked.string(), "make that folder, or remove the link");
    }
  }
  const fs::file_status status = fs::status(folder, error);
  if (folder.empty() || (fs::exists(status) && !fs::is_directory(status))) {
    throw Error(ErrorCode::output_folder_missing, "a tileset is a folder, and its place is taken by something else",
                asked.string(), "name a folder, such as volume.tiles; it is made if it does not exist");
  }
  if (!fs::is_directory(parent_of(folder), error)) {
    throw Error(ErrorCode::output_folder_missing, "the output folder does not exist", asked.string(),
                "make it first: mkdir -p " + parent_of(folder).string());
  }
  if (const int denied = core::access_error(parent_of(folder), core::Access::make_files_in)) {
    fail_tiles("the folder of the tileset cannot be made", asked, denied);
  }
  if (fs::exists(status)) check_tiles_replaceable(folder, asked);
}

TilesFolder::TilesFolder(const fs::path& folder) : asked_(folder), folder_(core::without_slash(folder)) {
  check_tiles_place(asked_);
  std::error_code error;
  if (fs::is_symlink(folder_, error)) folder_ = fs::canonical(folder_, error);
  try {
    temporary_ = std::make_unique<TemporaryFolder>(parent_of(folder_), core::temporary_prefix(folder_, "tiles"));
  } catch (const Error& refused) {
    throw Error(refused.code(), "the folder of the tileset cannot be made: " + refused.problem(), asked_.string(),
                kOtherPlace);
  }
  // As other programs make folders; a temporary one is private.
  const fs::file_status status = fs::status(folder_, error);
  fs::permissions(path(), fs::exists(status) ? status.permissions() : static_cast<fs::perms>(0755), error);
}

TilesFolder::~TilesFolder() = default;

void TilesFolder::commit() {
  check_tiles_place(asked_);  // the run may have taken long
  if (!temporary_->move_to(folder_)) fail_tiles("the folder of the tileset cannot be put in place", asked_, errno);
  temporary_.reset();
}

}  // namespace vantage::internal::io
