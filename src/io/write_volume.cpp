// Checks a volume and has it written, and holds what the writers share.
#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/output.h"
#include "core/volume_check.h"
#include "io/output_formats.h"
#include "io/sidecar.h"
#include "io/volume_statement.h"
#include "io/write_tiles.h"
#include "io/writers.h"
#include "vantage/error.h"

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

namespace {

/// The mesh as the file will hold it. Errors of rounding are told of the file.
StoredMesh stored_for(const Volume& volume, const std::filesystem::path& file, const OutputFormat& format,
                      const FileFrame& frame) {
  try {
    return format.store(volume, frame);
  } catch (const Error& error) {
    throw error.with_where(file.string());
  }
}

}  // namespace
}  // namespace vantage::internal::io

namespace vantage {

void check_volume_place(const std::vector<std::filesystem::path>& files,
                        const std::optional<Georeference>& georeference, std::optional<double> sea_level_z_m) {
  using namespace internal::io;
  for (const std::filesystem::path& file : files) {
    if (is_folder_format(file)) {
      check_tiles_georeference(georeference, file);
      continue;
    }
    if (!output_format(file).is_for_maps) continue;
    try {
      check_kml_place(georeference, sea_level_z_m);
    } catch (const Error& error) {
      throw error.with_where(file.string());
    }
  }
}

StagedVolume stage_volume(const Volume& volume, const std::filesystem::path& file, UpAxis obj_up, double obj_scale,
                          std::optional<double> sea_level_z_m) {
  using namespace internal::io;
  if (is_folder_format(file)) {
    internal::core::check_volume(volume);
    return stage_tiles(volume, file);
  }
  auto output = std::make_unique<AtomicFile>(file);
  const OutputFormat& format = output_format(file);
  internal::core::check_volume(volume);
  const FileFrame frame{obj_up, obj_scale, sea_level_z_m};
  check_volume_place({file}, volume.georeference, sea_level_z_m);
  if (format.check_frame) format.check_frame(volume, frame);
  StoredMesh stored = stored_for(volume, file, format, frame);
  stored.rounding_m += volume.read_rounding_m;
  format.write_volume(volume, stored, frame, *output);
  StagedVolume staged;
  staged.report = {stored.rounding_m, stored.mesh.triangles.size(), stored.turned_facets};
  staged.files.push_back(std::move(output));
  const auto stated = format.has_sidecar ? statement_json(volume, stored.mesh) : std::nullopt;
  const std::string statement =
      stated ? stated->dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) : "";
  if (format.has_sidecar) stage_sidecar({volume.georeference, stored.rounding_m, statement}, file, staged.files);
  return staged;
}

void commit_volumes(std::vector<StagedVolume> volumes, std::vector<std::unique_ptr<AtomicFile>> others) {
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (StagedVolume& volume : volumes) std::move(volume.files.begin(), volume.files.end(), std::back_inserter(files));
  std::move(others.begin(), others.end(), std::back_inserter(files));
  for (const std::unique_ptr<AtomicFile>& file : files) file->seal();
  for (const StagedVolume& volume : volumes) {
    if (volume.folder) volume.folder->commit();
  }
  commit_all(files);
}

WrittenVolume write_volume(const Volume& volume, const std::filesystem::path& file, UpAxis obj_up, double obj_scale) {
  std::vector<StagedVolume> staged;
  staged.push_back(stage_volume(volume, file, obj_up, obj_scale));
  const WrittenVolume report = staged.front().report;
  commit_volumes(std::move(staged));
  return report;
}

}  // namespace vantage
