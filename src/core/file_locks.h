// Locks that say whether a process still uses a file or a folder: they end with it, however it ends.
#pragma once

#include <filesystem>

namespace vantage::internal::core {

/// Marks what is open as in use, beside others. False where somebody has it alone, and so is about to remove it. Not
/// every file system has locks: where there are none, this is true, and lock_alone() false, so that nothing is removed.
bool lock_with_others(int descriptor);

/// True where nobody else has it open with a lock.
bool lock_alone(int descriptor);

/// Whether `path` leads to what `descriptor` is open on, without following a link.
bool leads_to(const std::filesystem::path& path, int descriptor);

}  // namespace vantage::internal::core
