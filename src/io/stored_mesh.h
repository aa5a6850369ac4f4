// A volume as a file holds it: its vertices rounded to the numbers of the format, and the mesh as readers find it then.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vantage/volume.h"

namespace vantage::internal::io {

/// Told apart by position the vertices make a closed mesh, as that of the volume was, without facets that have no area.
/// By index two triangles meet at each edge, as in the volume, also where its surface touches itself; in single
/// precision but for some edges that are a step or two of the grid long.
struct StoredMesh {
  Mesh mesh;                            ///< scene frame; each position is exactly what reads back
  std::vector<std::uint32_t> cause_of;  ///< per triangle
  Vec3 origin = Vec3::Zero();           ///< the numbers in the file are relative to it; exact
  double rounding_m = 0;                ///< no point of the surface has moved farther
  std::size_t turned_facets = 0;        ///< facets that rounding turned over: narrower than the rounding

  bool is_mended = false;  ///< whether vertices fell together, so that facets had to go
};

/// Double precision, in metres: nothing is rounded.
StoredMesh stored_as_doubles(const Volume& volume);
/// Double precision, in units of `scale` metres (> 0).
StoredMesh stored_in_units(const Volume& volume, double scale);
/// Single precision, about the scene's origin.
StoredMesh stored_as_floats(const Volume& volume);
/// Single precision, about an origin in the middle of the volume.
StoredMesh stored_as_local_floats(const Volume& volume);

}  // namespace vantage::internal::io
