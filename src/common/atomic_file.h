// Files that are written whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/export.h"

namespace vantage {

/// Collects what is written in a temporary file beside the target; commit() puts it in the target's place in one step.
/// When anything fails, or commit() is never called, the target stays as it was and the temporary file is removed.
/// Where the file system can keep a file without a name, a killed process leaves nothing. Elsewhere it leaves
/// ".NAME.vantage-K.tmp" or ".NAME.vantage-K.old", with the lowest free number K. The next writing of the target
/// removes these, up to the first four numbers that are free; of more than four processes that were killed at once some
/// may stay until as many write again. A target that is a symbolic link is followed; an existing file's permissions are
/// kept.
class VANTAGE_API AtomicFile {
 public:
  /// Throws ErrorCode::output_not_a_file for a directory, a device, a pipe or a socket, and output_unwritable for a
  /// missing directory or a place where no file can be made.
  explicit AtomicFile(const std::filesystem::path& target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// Throws Error(output), for instance when the disk is full.
  void write(std::string_view bytes);

  /// Brings everything to the disk, so that only putting it in place is left; commit() does it where it was not done.
  /// No write() may follow. Throws Error(output).
  void seal();

  /// Puts the file in place. Call once, last. Throws Error(output).
  void commit();

 private:
  friend void commit_all(const std::vector<std::unique_ptr<AtomicFile>>& files);

  void flush();
  void put_in_place();
  [[noreturn]] void fail(const std::string& problem, int error_number) const;

  std::filesystem::path asked_, target_;
  bool replaces_ = false;   // there is an old file
  bool is_sealed_ = false;  // all of it is on the disk
  std::vector<char> buffer_;
  struct Temporary;
  std::unique_ptr<Temporary> temporary_;
};

/// Commits a set of files: all of them, or none. Each is whole on the disk before the first is put in place; where one
/// cannot be put there, those before it are taken back. Old files are kept under a second name meanwhile: on a file
/// system without hard links those already replaced stay so, and the error names them. Call once, last; the files must
/// differ. Throws Error(output).
VANTAGE_API void commit_all(const std::vector<std::unique_ptr<AtomicFile>>& files);

/// Writes `bytes` to `file` as AtomicFile does.
VANTAGE_API void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace vantage
