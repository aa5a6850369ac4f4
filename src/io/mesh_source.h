// The bytes of a mesh file, and how errors point into them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "core/progress_reporter.h"
#include "core/read_limits.h"
#include "vantage/error.h"

namespace vantage::internal::io {

/// A file's content, decompressed.
class MeshSource {
 public:
  MeshSource(std::filesystem::path file, std::string bytes, bool compressed = false)
      : file_(std::move(file)), bytes_(std::move(bytes)), compressed_(compressed) {}

  const std::filesystem::path& file() const { return file_; }
  std::string_view bytes() const { return bytes_; }

  /// The file's name without ".gz" and without its extension: "city" for "data/city.obj.gz".
  std::string stem() const;
  /// The extension before ".gz", in lower case: ".obj" for "data/City.OBJ.gz".
  std::string extension() const;

  // Each throws Error(input) that names the file and the place in it.
  [[noreturn]] void fail(ErrorCode code, std::string problem, std::string fix) const;
  [[noreturn]] void fail_at_line(ErrorCode code, std::uint64_t line, std::string problem, std::string fix) const;
  [[noreturn]] void fail_at_byte(ErrorCode code, std::uint64_t byte, std::string problem, std::string fix) const;

 private:
  std::filesystem::path file_;
  std::string bytes_;
  bool compressed_;
};

/// The content of a regular file, as it is. Throws Error(input) for a missing or unreadable file, a directory, a pipe
/// or device, and an empty file.
std::string read_file_bytes(const std::filesystem::path& file, const core::ProgressReporter& progress);

/// The content of a file, decompressed if it begins with gzip's magic bytes. Throws as read_file_bytes does, and for
/// corrupt gzip data, and such that grows beyond the limits.
MeshSource load_mesh_source(const std::filesystem::path& file, const core::ProgressReporter& progress,
                            const core::ReadLimits& limits = {});

/// Decompresses gzip data, all members of it. `file` is for messages.
std::string decompress_gzip(std::string_view compressed, const std::filesystem::path& file,
                            const core::ProgressReporter& progress, const core::ReadLimits& limits = {});

}  // namespace vantage::internal::io
