// The formats that volumes and scenes are written in, in one table.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "common/atomic_file.h"
#include "io/stored_mesh.h"
#include "vantage/export.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::internal::io {

/// The axes of an OBJ, and the metres in one of its units.
struct ObjFrame {
  UpAxis up = UpAxis::z;
  double scale = 1;
};

struct OutputFormat {
  std::string_view extension;  ///< in lower case, with its dot
  bool is_single;              ///< its coordinates have single precision
  bool has_sidecar;  ///< it has no room for a georeference, a rounding and a statement: they are in a file beside it
  StoredMesh (*store)(const Volume& volume, const ObjFrame& obj);
  void (*write_volume)(const Volume& volume, const StoredMesh& stored, const ObjFrame& obj, AtomicFile& file);
  double (*write_scene)(const Scene& scene, AtomicFile& file);  ///< how far it moves a vertex, metres
};

std::span<const OutputFormat> output_formats();

/// The one that the extension names, upper or lower case; null for another.
const OutputFormat* find_output_format(const std::filesystem::path& file);

/// Throws Error(output) for another, and says which there are.
const OutputFormat& output_format(const std::filesystem::path& file);

}  // namespace vantage::internal::io
