// A folder that takes the place of another.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vantage::internal::core {

/// Moves `folder` to `place`, which is free or holds a folder. What was there is removed, or is in `folder` then: the
/// caller removes that. In one step where the file system can do it. Elsewhere the old folder is at `folder`-old for a
/// moment, with a lock (core/file_locks.h) and a mark (core/temporary_mark.h). False, with errno, where it cannot be
/// done: what was there is there. `try_in_one_step`: false for tests of the other way.
bool replace_folder(const std::filesystem::path& folder, const std::filesystem::path& place,
                    bool try_in_one_step = true);

/// Without a slash at the end, which would make the folder its own parent.
std::filesystem::path without_slash(const std::filesystem::path& folder);

/// What the name of a temporary folder beside `folder` begins with (vantage::TemporaryFolder): "stages" gives
/// ".NAME.vantage-stages-". A long name is cut, since a file system takes 255 bytes: a hash then keeps two of them
/// apart.
std::string temporary_prefix(const std::filesystem::path& folder, const std::string& purpose);

/// At the end of a temporary folder's name, as mkdtemp makes them; and after that where it has made room for another.
constexpr std::size_t kRandomCharacters = 6;
constexpr std::string_view kAside = "-old";
/// Whether it is PREFIXxxxxxx and an ending.
bool is_named_so(const std::string& name, std::string_view prefix, std::string_view ending);
/// Whether it is one of both.
bool is_temporary_name(const std::string& name, std::string_view prefix);

}  // namespace vantage::internal::core
