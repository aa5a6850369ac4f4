// Checks a volume, chooses the writer by the file's extension, and holds what the writers share.
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/volume_check.h"
#include "io/volume_statement.h"
#include "io/write_sidecar.h"
#include "io/writers.h"
#include "vantage/error.h"
#include "vantage/output.h"

namespace vantage::internal::io {

void check_count(std::uint64_t count, std::uint64_t limit, const char* what, const char* format) {
  if (count <= limit) return;
  throw Error(ErrorCode::format_too_small, std::to_string(count) + " " + what + " are too many for " + format,
              "at most " + std::to_string(limit), "write another format or compute with a larger tolerance");
}

void append_exact(std::string& text, double number) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  text.append(digits.data(), end);
}

std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return line;
}

std::string output_extension(const std::filesystem::path& file) {
  std::error_code ignored;
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool known = extension == ".ply" || extension == ".obj" || extension == ".stl" || extension == ".glb";
  if (known || std::filesystem::is_directory(file, ignored)) return extension;
  throw Error(ErrorCode::output_format_unknown,
              extension.empty() ? "the output file has no extension"
                                : "unknown output format \"" + file.extension().string() + "\"",
              file.string(), "name a file that ends in .ply, .obj, .stl or .glb");
}

namespace {

/// The mesh as the file will hold it. Errors of rounding are told of the file.
StoredMesh stored_for(const Volume& volume, const std::filesystem::path& file, const std::string& extension,
                      double obj_scale) {
  try {
    if (extension == ".stl") return stored_as_floats(volume);
    if (extension == ".glb") return stored_as_local_floats(volume);
    if (extension == ".obj" && obj_scale != 1) return stored_in_units(volume, obj_scale);
    return stored_as_doubles(volume);
  } catch (const Error& error) {
    throw error.with_where(file.string());
  }
}

}  // namespace
}  // namespace vantage::internal::io

namespace vantage {

StagedVolume stage_volume(const Volume& volume, const std::filesystem::path& file, UpAxis obj_up, double obj_scale) {
  using namespace internal::io;
  const std::string extension = output_extension(file);
  internal::core::check_volume(volume);
  if (extension == ".obj") check_obj_scale(volume, obj_scale);
  auto output = std::make_unique<AtomicFile>(file);
  const StoredMesh stored = stored_for(volume, file, extension, obj_scale);
  if (extension == ".ply") write_ply(volume, stored, *output);
  if (extension == ".obj") write_obj(volume, stored, obj_up, obj_scale, *output);
  if (extension == ".stl") write_stl(stored, *output);
  if (extension == ".glb") write_glb(volume, stored, *output);
  StagedVolume staged;
  staged.report = {stored.rounding_m, stored.mesh.triangles.size(), stored.turned_facets};
  staged.files.push_back(std::move(output));
  const auto stated = extension == ".stl" ? statement_json(volume, stored.mesh) : std::nullopt;
  const std::string statement =
      stated ? stated->dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) : "";
  if (auto beside = stage_sidecar({volume.georeference, stored.rounding_m, statement}, file)) {
    staged.files.push_back(std::move(beside));
  }
  return staged;
}

WrittenVolume write_volume(const Volume& volume, const std::filesystem::path& file, UpAxis obj_up, double obj_scale) {
  const StagedVolume staged = stage_volume(volume, file, obj_up, obj_scale);
  commit_all(staged.files);
  return staged.report;
}

}  // namespace vantage
