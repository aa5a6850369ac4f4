// A folder for a while.
#pragma once

#include <filesystem>
#include <string>

#include "vantage/export.h"

namespace vantage {

/// A new folder that only this user may read. It is removed with all that is in it when the object goes away; if the
/// process is killed before, by the next one that makes a folder of that kind in that place. It is known by a file
/// in it, .vantage-temporary; move_to() takes that away. A process that is killed while it makes or removes one may
/// leave a folder of that name that holds nothing, or nothing but an empty .vantage-temporary: that stays. Throws
/// ErrorCode::output_unwritable where none can be made.
class VANTAGE_API TemporaryFolder {
 public:
  /// In the folder for temporary files: TMPDIR, or /tmp.
  TemporaryFolder();

  /// In `parent`, with a name that begins with `prefix`: folders of other prefixes are left alone.
  TemporaryFolder(const std::filesystem::path& parent, const std::string& prefix);

  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

  /// Moves it to `place`, which is free or holds a folder; a folder that was there is removed. In one step where the
  /// file system can do it. Elsewhere a process that is killed between the two steps leaves the old folder beside,
  /// under the name of the temporary one with "-old" behind it, until the next move_to() of the same prefix has put a
  /// new one in place. A process that is killed just before or behind the move may leave the file .vantage-temporary in
  /// what is at `place`, to which it does no harm; the next move_to() there takes it away. Call once, last. False, with
  /// errno, where it cannot be done: what was there is there. EINVAL: `place` has a name of temporary folders of that
  /// prefix.
  bool move_to(const std::filesystem::path& place);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;  // holds a lock that says that somebody uses the folder
};

}  // namespace vantage
