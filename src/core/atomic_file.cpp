#include "common/atomic_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <system_error>

#include "core/system_files.h"
#include "core/temporary_file.h"
#include "vantage/error.h"

namespace vantage {
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

std::string advice_for(int error_number) {
  switch (error_number) {
    case ENOSPC:
#ifdef EDQUOT  // Windows has neither this one nor ESTALE
    case EDQUOT:
#endif
      return "free some space or write elsewhere; the old file, if any, is as it was";
    case EFBIG:
      return "raise the limit on file sizes or write elsewhere; the old file, if any, is as it was";
    case ENOENT:
    case ENOTDIR:
      return "create the directory or name another";
    case EACCES:
    case EPERM:
    case EROFS:
      return "write to a directory that you may write to";
#ifdef ESTALE
    case ESTALE:
      return "another program took the name of the temporary file; write again, into a folder of your own";
#endif
    default:
      return "write elsewhere; the old file, if any, is as it was";
  }
}

/// Where the file really lies: symbolic links are followed, so that a link to a result stays a link.
std::filesystem::path resolved(const std::filesystem::path& target) {
  std::error_code error;
  std::filesystem::path path = target;
  for (int hops = 0; hops < 40 && std::filesystem::is_symlink(path, error); ++hops) {
    const std::filesystem::path link = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = link.is_absolute() ? link : path.parent_path() / link;
  }
  return path;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

}  // namespace

struct AtomicFile::Temporary : internal::core::TemporaryFile {
  using TemporaryFile::TemporaryFile;
};

AtomicFile::AtomicFile(const std::filesystem::path& target) : asked_(target), target_(resolved(target)) {
  if (target.empty())
    throw Error(ErrorCode::output_name_missing, "no output file was named", "", "give the name of a file");
  std::error_code unknown;
  const std::filesystem::file_status old = std::filesystem::status(target_, unknown);
  const bool exists = !unknown && std::filesystem::exists(old);
  if (unknown == std::errc::too_many_symbolic_link_levels) fail("cannot create the file", ELOOP);
  if ((exists && std::filesystem::is_directory(old)) || target_.filename().empty()) {
    throw Error(ErrorCode::output_not_a_file, "the output is a directory", asked_.string(), "give the name of a file");
  }
  if (exists && !std::filesystem::is_regular_file(old)) {
    throw Error(ErrorCode::output_not_a_file, "the output is a device, a pipe or a socket, not a file", asked_.string(),
                "give the name of a file");
  }
  // A rename would replace a file that its owner has protected.
  using internal::core::Access;
  const int denied = exists ? internal::core::access_error(target_, Access::write) : 0;
  if (denied) fail("cannot write the file", denied);
  buffer_.reserve(kBufferBytes);
  try {
    temporary_ = std::make_unique<Temporary>(target_);
  } catch (const std::system_error& error) {
    fail("cannot create the file", error.code().value());
  }
  replaces_ = exists;
  if (exists) internal::core::copy_permissions(target_, temporary_->descriptor());
}

AtomicFile::~AtomicFile() = default;

void AtomicFile::fail(const std::string& problem, int error_number) const {
  const bool lacks_folder = error_number == ENOENT || error_number == ENOTDIR;
  throw Error(lacks_folder ? ErrorCode::output_folder_missing : ErrorCode::output_unwritable,
              problem + ": " + std::strerror(error_number), asked_.string(), advice_for(error_number));
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t taken = std::min(bytes.size(), kBufferBytes - buffer_.size());
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken));
    bytes.remove_prefix(taken);
    if (buffer_.size() == kBufferBytes) flush();
  }
}

void AtomicFile::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written = ::write(temporary_->descriptor(), buffer_.data() + done, buffer_.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot write the file", errno);
    done += static_cast<std::size_t>(written);
  }
  buffer_.clear();
}

void AtomicFile::seal() {
  if (is_sealed_) return;
  flush();
  // Some file systems report a full disk only here. It stays open: with it goes the lock that says whose it is.
  if (const int error = internal::core::synchronise(temporary_->descriptor())) fail("cannot write the file", error);
  is_sealed_ = true;
}

void AtomicFile::put_in_place() {
  try {
    temporary_->put_in_place();
  } catch (const std::system_error& error) {
    fail("cannot put the file in place", error.code().value());
  }
}

void AtomicFile::commit() {
  seal();
  put_in_place();
  internal::core::synchronise_folder(folder_of(target_));
}

void commit_all(const std::vector<std::unique_ptr<AtomicFile>>& files) {
  for (const auto& file : files) file->seal();
  if (files.size() > 1) {  // one rename needs no way back
    for (const auto& file : files) {
      if (file->replaces_) file->temporary_->keep_old();
    }
  }
  std::size_t done = 0;
  try {
    for (; done < files.size(); ++done) files[done]->put_in_place();
  } catch (const Error& error) {
    std::string lost;
    std::error_code ignored;
    while (done-- > 0) {
      const AtomicFile& file = *files[done];
      const bool is_as_before =
          file.replaces_ ? file.temporary_->give_back() : std::filesystem::remove(file.target_, ignored);
      if (!is_as_before) lost += (lost.empty() ? "" : ", ") + file.asked_.string();
      internal::core::synchronise_folder(folder_of(file.target_));
    }
    if (lost.empty()) throw;
    throw error.with_fix("write elsewhere; already replaced: " + lost);
  }
  std::set<std::filesystem::path> folders;
  for (const auto& file : files) folders.insert(folder_of(file->target_));
  for (const auto& folder : folders) internal::core::synchronise_folder(folder);
}

void write_whole_file(const std::filesystem::path& file, std::string_view bytes) {
  AtomicFile output(file);
  output.write(bytes);
  output.commit();
}

}  // namespace vantage
