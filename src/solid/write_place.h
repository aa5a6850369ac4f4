// How the place of a mesh on the earth goes into the files that are written.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "solid/atomic_file.h"
#include "vantage/georeference.h"

namespace vantage::solid {

/// A line for OBJ or the header of PLY, `start` ("# ", "comment ") before it; nothing without a place.
std::string place_comment(const std::optional<Georeference>& georeference, const char* start);

/// STL has no room for a place: it goes into a second file. Nothing for another format, and for a mesh without a place
/// unless there is such a file from an earlier run, which would lie; that is then replaced by one that holds null.
std::unique_ptr<AtomicFile> stage_place(const std::optional<Georeference>& georeference,
                                        const std::filesystem::path& mesh_file);

}  // namespace vantage::solid
