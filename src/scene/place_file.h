// The small file beside a mesh whose format has no room for a place: "city.stl" has its place in "city.stl.place.json".
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scene/mesh_source.h"
#include "vantage/georeference.h"

namespace vantage::scene {

/// "city.stl.place.json" for "city.stl" and "city.stl.gz".
std::filesystem::path place_file(const std::filesystem::path& mesh_file);

/// {"vantage": {"georeference": {…}}}; null in place of the object when there is none.
std::string place_file_text(const std::optional<Georeference>& georeference);

/// Reads the file beside `mesh`; nothing when there is none. Throws Error(input) for one that cannot be read.
std::optional<Georeference> read_place_file(const MeshSource& mesh, const core::ProgressReporter& progress);

}  // namespace vantage::scene
