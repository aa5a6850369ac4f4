// The formats that volumes and scenes are written in, in one table.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "common/atomic_file.h"
#include "common/output.h"
#include "io/stored_mesh.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::internal::io {

/// The axes of a format that is in those of the scene's file, and the metres in one of its units.
struct FileFrame {
  UpAxis up = UpAxis::z;
  double scale = 1;
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
  double (*write_scene)(const Scene& scene, AtomicFile& file);  ///< how far it moves a vertex, metres
};

std::span<const OutputFormat> output_formats();

/// The one that the extension names, upper or lower case; null for another.
const OutputFormat* find_output_format(const std::filesystem::path& file);

/// Throws Error(output) for another, and says which there are: also those that volumes alone are written in, or not.
const OutputFormat& output_format(const std::filesystem::path& file, bool is_volume);

}  // namespace vantage::internal::io
