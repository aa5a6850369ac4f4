// Files that are written beside the file whose place they take, and the removal of those that killed processes left.
#pragma once

#include <filesystem>
#include <string>

namespace vantage::internal::core {

/// A file beside `target` that will take its place. Where the file system can do it (O_TMPFILE), it has no name until
/// then: whatever ends the process, nothing stays. Elsewhere, and for a moment before it is put in place, it is named
/// ".NAME.vantage-K.tmp", K from 0. Whoever has such a file holds a lock on it (flock), which ends with the process:
/// what nobody holds was left by a process that was killed, and the next file for the same target removes it. That one
/// looks at K from 0 until it finds kUsualNumbers of them free.
class TemporaryFile {
 public:
  /// The last one is the first where a file without a name cannot be given one: it is copied then. For tests.
  enum class Names { only_where_needed, from_the_start, by_copy };

  /// Failures of the system are thrown as std::system_error, here and below.
  explicit TemporaryFile(const std::filesystem::path& target, Names names = Names::only_where_needed);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  int descriptor() const { return descriptor_; }

  /// Gives the file that is there a second name, ".NAME.vantage-K.old". Where that cannot be done, there is none.
  void keep_old();

  /// Takes the target's place in one step. ESTALE where something else has the name of this file by now: that is not
  /// put in the target's place.
  void put_in_place();

  /// Puts the old file back under its name. False where there is none, or where something else has its second name.
  bool give_back();

  static constexpr int kUsualNumbers = 4;
  static constexpr int kMostNumbers = 256;  ///< as many processes may write the same file at once

 protected:  // the steps of keep_old(), for tests
  bool hold_old();
  int link_old_as(const std::filesystem::path& candidate);

 private:
  std::filesystem::path numbered(int number, const char* ending) const;
  void remove_abandoned_ones() const;
  bool open_without_name();
  void open_with_name();
  void give_name();
  bool try_to_link();
  void copy_to_named_file();

  std::filesystem::path target_, name_, kept_;
  int descriptor_ = -1, old_descriptor_ = -1;
  Names names_;
};

/// Removes a regular file that no process holds a lock on. Anything else stays.
void remove_if_abandoned(const std::filesystem::path& path);

}  // namespace vantage::internal::core
