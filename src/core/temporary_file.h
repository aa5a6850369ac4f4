// Files and folders on the way to their place, and what is left of them when a process is killed.
#pragma once

#include <filesystem>
#include <string>

namespace vantage::internal::core {

/// A file beside `target` that will take its place. Where the file system can do it (O_TMPFILE), it has no name until
/// then: whatever ends the process, nothing stays. Elsewhere, and for a moment before it is put in place, it is named
/// ".NAME.vantage-K.tmp". Whoever has such a file holds a lock on it (flock), which ends with the process: what nobody
/// holds was left by a process that was killed, and the next file for the same target removes it.
class TemporaryFile {
 public:
  enum class Names { only_where_needed, from_the_start };

  /// Failures of the system are thrown as std::system_error, here and below.
  explicit TemporaryFile(const std::filesystem::path& target, Names names = Names::only_where_needed);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  int descriptor() const { return descriptor_; }

  /// Gives the file that is there a second name, ".NAME.vantage-K.old". Where that cannot be done, there is none.
  void keep_old();

  /// Takes the target's place in one step.
  void put_in_place();

  /// Puts the old file back under its name. False where there is none.
  bool give_back();

 private:
  std::filesystem::path numbered(int number, const char* ending) const;
  bool open_without_name();
  void open_with_name();
  void give_name();

  std::filesystem::path target_, name_, kept_;
  int descriptor_ = -1, old_descriptor_ = -1;
};

/// Removes a regular file that no process holds a lock on. Anything else stays.
void remove_if_abandoned(const std::filesystem::path& path);

}  // namespace vantage::internal::core
