// How the place of a mesh on the earth goes into the files that are written.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "io/sidecar.h"
#include "vantage/atomic_file.h"
#include "vantage/georeference.h"

namespace vantage::internal::io {

/// A line for OBJ or the header of PLY, `start` ("# ", "comment ") before it; nothing without a place.
std::string place_comment(const std::optional<Georeference>& georeference, const char* start);

/// STL has no room for a place and a rounding: they go into a second file. Nothing for another format, and where there
/// is neither, unless there is such a file from an earlier run, which would lie; that is then replaced by one that
/// holds null.
std::unique_ptr<AtomicFile> stage_sidecar(const io::Sidecar& content, const std::filesystem::path& mesh_file);

}  // namespace vantage::internal::io
