// Calls about files that POSIX and Windows name and mean differently: system_files.cpp, and windows/ beside it.
#pragma once

#include <filesystem>
#include <functional>

namespace vantage::internal::core {

enum class Access { read, write, make_files_in };

/// 0, or the number of the error (errno) by which this process may not.
int access_error(const std::filesystem::path& path, Access wanted);

/// Opens a file to read its bytes. A pipe that nobody writes to is not waited for. -1, with errno, where it fails.
int open_to_read(const std::filesystem::path& file);

/// 0 once all that was written to the file is on its disk, or the number of the error.
int synchronise(int descriptor);

/// A rename must reach the disk too. Not every file system lets a folder be synchronised: nothing is told then.
void synchronise_folder(const std::filesystem::path& folder);

/// Gives an open file the permissions of another one, as far as that can be done.
void copy_permissions(const std::filesystem::path& from, int to_descriptor);

/// Runs a step too short to be stopped: signals that ask to end wait. Where another thread takes them, as Python's may,
/// it changes nothing. Windows has none.
void with_signals_held(const std::function<void()>& step);

/// The memory of the machine, or as much of it as this process may use.
double memory_bytes();

}  // namespace vantage::internal::core
