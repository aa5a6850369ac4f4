// "-" on the command line: standard input for a mission or points, standard output for a result.
#pragma once

#include <filesystem>
#include <string>

#include "common/temporary_folder.h"
#include "vantage/mission.h"

namespace vantage::cli {

inline bool is_standard_stream(const std::string& file) { return file == "-"; }

/// Reads the mission that the argument MISSION names; "-" is standard input, where paths start from the current folder.
MissionFile read_mission_argument(const std::string& argument);

/// A file on the way to standard output: it is written in a folder of its own, which goes away with the object, and
/// sent when it is whole. So a run that fails sends nothing.
class OutgoingFile {
 public:
  /// `extension` begins with a dot. Throws Error(output) where no temporary file can be made; Error(input) for a format
  /// that is not text when standard output is a terminal.
  explicit OutgoingFile(const std::string& extension);
  OutgoingFile(const OutgoingFile&) = delete;
  OutgoingFile& operator=(const OutgoingFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Throws as print() does.
  void send() const;

 private:
  std::string extension_;
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace vantage::cli
