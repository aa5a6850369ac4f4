// The file by which a temporary folder says that vantage made it, and may remove it with all that is in it.
#pragma once

#include <filesystem>

namespace vantage::internal::core {

/// The name of the file; python/vantage/_folders.py writes the same one.
inline constexpr const char* kTemporaryMark = ".vantage-temporary";

/// Puts the mark into the open folder. False, with errno, where that cannot be done, or something has its name.
bool put_temporary_mark(int folder);

/// Whether the mark is there: a file of this user with the text that put_temporary_mark() writes, and no link.
bool has_temporary_mark(int folder);

/// Takes the mark away again. False, with errno, where it is there and stays.
bool take_temporary_mark(int folder);

/// Removes a folder whose process was killed before the mark was whole, or after it was taken away: only this user may
/// read it, as mkdtemp makes it, and nothing is in it but for the beginning of the mark. What others put there at the
/// same moment stays: the folder goes while it is empty or not at all. `opened`: the same folder.
void remove_unmarked_folder(const std::filesystem::path& folder, int opened);

/// Removes the folder with all that is in it, the mark last: what a killed process leaves of it is still marked. Links
/// are not followed. What cannot be removed stays.
void remove_temporary_folder(const std::filesystem::path& folder);

}  // namespace vantage::internal::core
