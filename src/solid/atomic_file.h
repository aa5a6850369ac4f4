// Files that are written whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::solid {

/// Collects what is written in a temporary file beside the target; commit() puts it in the target's place in one step.
/// When anything fails, or commit() is never called, the target stays as it was and the temporary file is removed.
/// A target that is a symbolic link is followed; an existing file's permissions are kept.
class AtomicFile {
 public:
  /// Throws Error(input) for a directory, Error(output) for a missing directory, a target that is a device, a pipe or a
  /// socket, or a place where no file can be made.
  explicit AtomicFile(const std::filesystem::path& target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// Throws Error(output), for instance when the disk is full.
  void write(std::string_view bytes);

  /// Flushes to the disk and renames. Call once, last. Throws Error(output).
  void commit();

 private:
  void flush();
  [[noreturn]] void fail(const std::string& problem, int error_number) const;

  std::filesystem::path asked_, target_, temporary_;
  std::vector<char> buffer_;
  int descriptor_ = -1;
};

/// Writes `bytes` to `file` as AtomicFile does.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace vantage::solid
