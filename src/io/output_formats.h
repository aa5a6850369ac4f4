// The formats that volumes and scenes are written in, in one table.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "common/atomic_file.h"
#include "common/output.h"
#include "io/stored_mesh.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::internal::io {

/// What formats need of the scene besides the volume: the axes of its file and the metres in one of its units, for
/// those that are written in these; and the z of the mean sea level, where it is known, for maps.
struct FileFrame {
  UpAxis up = UpAxis::z;
  double scale = 1;
  std::optional<double> sea_level_z_m = {};
};

struct OutputFormat : FormatFacts {
  bool has_sidecar;  ///< it has no room for a georeference, a rounding and a statement: they are in a file beside it
  bool is_local;     ///< in single precision: its numbers are about an origin of the file's own
  /// Whether a file that begins so was written by vantage.
  bool (*is_own)(std::string_view beginning);
  /// Throws Error(input) for a frame that it cannot be written in; null where the frame is nothing to it.
  void (*check_frame)(const Volume& volume, const FileFrame& frame);
  StoredMesh (*store)(const Volume& volume, const FileFrame& frame);
  void (*write_volume)(const Volume& volume, const StoredMesh& stored, const FileFrame& frame, AtomicFile& file);
  double (*write_scene)(const Scene& scene, AtomicFile& file);  ///< how far it moves a vertex, metres; null: no scenes
};

std::span<const OutputFormat> output_formats();

/// The one that the extension names, upper or lower case; null for another.
const OutputFormat* find_output_format(const std::filesystem::path& file);

/// Throws Error(output) for another, and says which there are. scene_format: also for one that has no scenes.
const OutputFormat& output_format(const std::filesystem::path& file);
const OutputFormat& scene_format(const std::filesystem::path& file);

}  // namespace vantage::internal::io
