// Hashes that say which scene and which volume is meant: docs/hashes.md. mission_hash is in vantage/mission.h.
#pragma once

#include <string>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage {

/// SHA-256 (FIPS 180-4) of the scene's triangles: the corners as doubles in the scene frame and the index of the
/// object, in order. 64 hexadecimal digits. Names, vertices that no triangle uses and how the vertices are numbered do
/// not count. Throws Error(input) for an index out of range. Cost: linear; 0.3 s for a million triangles.
VANTAGE_API std::string scene_hash(const Scene& scene);

/// SHA-256 of a volume's mesh: the corners of its facets as doubles, in order. Causes and how the vertices are numbered
/// do not count. 64 hexadecimal digits. Throws Error(input) for an index out of range.
VANTAGE_API std::string volume_hash(const Mesh& mesh);

}  // namespace vantage
