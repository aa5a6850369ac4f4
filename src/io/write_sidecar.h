// How the place of a mesh on the earth goes into the files that are written.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/sidecar.h"
#include "vantage/atomic_file.h"
#include "vantage/georeference.h"

namespace vantage::internal::io {

/// A line for OBJ or the header of PLY, `start` ("# ", "comment ") before it; nothing without a place.
std::string place_comment(const std::optional<Georeference>& georeference, const char* start);

/// Adds the file beside a mesh, of a format that has no room for a place and a rounding. Nothing where there is
/// neither, unless there is such a file from an earlier run, which would lie; that is then replaced by one that holds
/// null.
void stage_sidecar(const Sidecar& content, const std::filesystem::path& mesh_file,
                   std::vector<std::unique_ptr<AtomicFile>>& files);

}  // namespace vantage::internal::io
