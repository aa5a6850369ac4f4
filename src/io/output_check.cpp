#include <algorithm>
#include <cstring>
#include <system_error>

#include "common/input.h"
#include "common/output.h"
#include "core/system_files.h"
#include "core/temporary_file.h"
#include "io/output_formats.h"
#include "io/sidecar.h"
#include "io/tiles_folder.h"
#include "io/written_marks.h"
#include "vantage/error.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Asks the file system itself: permissions alone do not tell of a read-only disk, a quota or a network share. By a
/// file with a name, as the output will have one: some folders take files without a name, and no others.
void try_to_make_a_file_beside(const fs::path& file) {
  using internal::core::TemporaryFile;
  try {
    // Whoever is ended here leaves no trial behind.
    internal::core::with_signals_held([&] { const TemporaryFile trial(file, TemporaryFile::Names::from_the_start); });
  } catch (const std::system_error& error) {
    throw Error(ErrorCode::output_unwritable, "no file can be made in the output folder: " + error.code().message(),
                file.string(), "make the folder writable, or write elsewhere");
  }
}

/// "-" where it means nothing; a file of that name is "./-".
void check_is_no_stream(const fs::path& file) {
  if (file != "-") return;
  throw Error(ErrorCode::output_not_a_file, "standard output is not taken here", "-",
              "name a file; only the -o of compute, query and render takes -");
}

void check_output(const fs::path& file, const internal::io::OutputFormat& (*format_of)(const fs::path&)) {
  check_is_no_stream(file);
  // A folder is told first: "out" has no extension, but that is not what is wrong with it.
  std::error_code error;
  if (fs::is_directory(file, error)) return check_can_write(file);
  const internal::io::OutputFormat& format = format_of(file);
  check_can_write(file);
  if (format.has_sidecar) check_derived_output(internal::io::sidecar_file(file));
}

}  // namespace

void check_can_write(const fs::path& file) {
  check_is_no_stream(file);
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (fs::is_directory(status)) {
    throw Error(ErrorCode::output_not_a_file, "the output is a folder", file.string(),
                "name a file, such as " + (file / "volume.ply").string());
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(ErrorCode::output_not_a_file, "the output is not a regular file", file.string(), "name a file on disk");
  }
  if (!file.has_filename()) {
    throw Error(ErrorCode::output_name_missing, "the output has no file name", in_quotes(file.string()),
                "name a file, such as volume.ply");
  }
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) {
    throw Error(ErrorCode::output_folder_missing, "the output folder does not exist", file.string(),
                "make it first: mkdir -p " + folder.string());
  }
  using internal::core::Access;
  const int denied = fs::exists(status) ? internal::core::access_error(file, Access::write) : 0;
  if (denied) {
    throw Error(ErrorCode::output_unwritable,
                std::string("the output file is write-protected: ") + std::strerror(denied), file.string(),
                "change its permissions, or name another file");
  }
  try_to_make_a_file_beside(file);
}

std::string format_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

void check_derived_output(const fs::path& file) {
  if (is_folder_format(file)) return internal::io::check_tiles_place(file);
  check_can_write(file);
  std::error_code error;
  if (!fs::exists(file, error) || internal::io::is_own_file(file)) return;
  throw Error(ErrorCode::output_of_others,
              "the output " + in_quotes(file.filename().string()) + " would replace a file that vantage did not write",
              file.string(), "move that file away, or give the output another name with -o");
}

void check_certificate_output(const fs::path& file) {
  try {
    check_derived_output(file);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::output_of_others) throw;
    throw error.with_fix("move that file away, or give the certificate another name");
  }
}

void check_volume_output(const fs::path& file) {
  check_is_no_stream(file);
  if (is_folder_format(file)) return internal::io::check_tiles_place(file);
  check_output(file, internal::io::output_format);
}

void check_scene_output(const fs::path& file) { check_output(file, internal::io::scene_format); }

void check_not_an_input(const fs::path& output, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    std::error_code error;
    const fs::path folder = input.has_parent_path() ? input.parent_path() : fs::path(".");
    const bool is_inside = is_folder_format(output) && fs::equivalent(output, folder, error) && !error;
    if (!is_inside && (!fs::equivalent(output, input, error) || error)) continue;
    throw Error(ErrorCode::output_overwrites_input, "the output would overwrite an input of the same run",
                output.string(), "give the output another name");
  }
}

}  // namespace vantage
