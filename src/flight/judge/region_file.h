// The meshes of regions, as they lie beside certificates.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "vantage/geometry.h"

namespace vantage::internal::flight::judge {

/// All of a file. Throws Error(input) for one that is longer than `most`, or cannot be read.
std::string bytes_of(const std::filesystem::path& file, std::uintmax_t most);

/// Binary PLY of doubles whose comment says which kind of region it is, to the letter as vantage writes it. Throws
/// Refusal for a computed volume (it lies inside the true one), a region of another kind than `kind`, a face that is no
/// triangle of the mesh's vertices, and a coordinate that is not finite or larger than 1e9 m; Error(input) for a file
/// that is no mesh of a region.
Mesh read_region_mesh(const std::filesystem::path& file, const std::string& kind);

}  // namespace vantage::internal::flight::judge
