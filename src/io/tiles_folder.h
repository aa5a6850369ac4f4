// The folder of a tileset: it is written beside its place, and put there as a whole.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "common/temporary_folder.h"

namespace vantage::internal::io {

/// What is in such a folder, and nothing else.
inline constexpr const char *kTilesetFile = "tileset.json", *kTilesContent = "volume.glb";

/// Throws unless a tileset can be put at `folder`, which may end in a slash: its parent exists, and takes new folders;
/// the folder is free, empty, or holds a tileset that vantage wrote and nothing else. What was a link to a folder stays
/// one. Error(input) with ErrorCode::output_folder_missing or folder_in_use, or Error(output).
void check_tiles_place(const std::filesystem::path& folder);

class TilesFolder {
 public:
  /// Throws as check_tiles_place().
  explicit TilesFolder(const std::filesystem::path& folder);
  TilesFolder(const TilesFolder&) = delete;
  TilesFolder& operator=(const TilesFolder&) = delete;
  ~TilesFolder();

  /// Where to write the files.
  const std::filesystem::path& path() const { return temporary_->path(); }

  /// Puts it in its place. Call once, last. Throws as check_tiles_place(): what was there stays.
  void commit();

 private:
  std::filesystem::path asked_, folder_;
  std::unique_ptr<TemporaryFolder> temporary_;
};

}  // namespace vantage::internal::io
