// The content of a tileset of one volume: a GLB whose facets know their causes.
#pragma once

#include <string>
#include <vector>

#include "common/atomic_file.h"
#include "io/stored_mesh.h"
#include "vantage/volume.h"

namespace vantage::internal::io {

/// A row of the property table.
struct TileFeature {
  std::string kind;  ///< name_of(CauseKind), or "target"
  std::string name;
  double area_m2 = 0;
};

/// A target, as it is drawn: convex polygons, or the place of a point.
struct TileTarget {
  TileFeature feature;
  std::vector<std::vector<Vec3>> parts;
};

/// Writes `stored` and the targets, all in the frame of the tile (z up, about the volume's middle: stored.origin is not
/// added). Feature ids are indices into Volume::causes, and behind them of the targets; the property table has kind,
/// name and area_m2 of each. glTF 2.0 with EXT_mesh_features and EXT_structural_metadata. Vertices are 32-bit numbers
/// that facets of one cause share; facets that meet in a border of two causes have vertices of their own there.
/// Throws Error(output) for more causes or vertices than the format can count.
void write_tile_content(const Volume& volume, const StoredMesh& stored, const std::vector<TileTarget>& targets,
                        AtomicFile& file);

}  // namespace vantage::internal::io
