// Volumes with fewer facets that stay inside: what planners and games can use of a volume, as safe as the whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"
#include "vantage/volume.h"

namespace vantage {

/// One of the two, or both: as few facets as are asked for, but nothing is lost that lies farther off than allowed.
struct SimplifyOptions {
  std::optional<std::size_t> facets;  ///< stop at so many; at least 4
  std::optional<double> error_m;      ///< no point of the volume may be farther than this from the result; at least 0.
                                      ///< What is flat but for rounding may be lost all the same: up to 8 roundings of
                                      ///< the largest coordinate, 1e-11 of the size where that is more (8e-9 m at map
                                      ///< coordinates), and what rounding does to a bound that small
};

struct SimplifiedVolume {
  Mesh mesh;                            ///< closed, oriented; the vertices are the numbers that the subset is true of
  std::vector<std::uint32_t> facet_of;  ///< per triangle: the one of the volume that it came from, about there
  std::size_t facets_before = 0;
  double volume_before_m3 = 0, volume_after_m3 = 0;
  double lost_bound_m = 0;     ///< no point of the volume is farther than this from the result (solid to solid);
                               ///< all that is rounded is in it: 256 roundings of the size for each of the collapses
                               ///< that came one after the other in one place
  double lost_measured_m = 0;  ///< of the volume's vertices, the one farthest from the result is so far from it
  std::size_t pieces = 0;      ///< that are left
  std::size_t pieces_dropped = 0;  ///< small ones that were left out
  bool reached = true;  ///< not: more facets are left than were asked for, as none can go without leaving the volume,
                        ///< losing more than error_m, or passing through another part of the surface
};

/// Fewer facets, and no point that was not in `volume`: {winding number > 0} of the result is a subset of that of
/// `volume`, decided exactly on the numbers as they are (docs/simplify.md has the argument). So what was proved of the
/// volume holds of the result where neither winds round a point less than 0 times. So it is with a volume that does not
/// pass through itself. Any other may get such points, which prove_volume counts as inside: prove the result. Edges are
/// collapsed, those first that lose least, to the point that loses least.
///
/// `volume` is any closed, oriented mesh with its outside outward; vertices in one place count as one. Where it does
/// not pass through itself neither does the result. Cavities and handles stay. A volume that has no more facets than
/// asked for, and no `error_m`, is returned as it is.
///
/// The result does not depend on the number of threads. Cost: O(n log n), some seconds for 100,000 facets; besides n
/// for each piece that is dropped, and up to 64 n for each that is inside out. Throws Error(input) for options that are
/// missing or out of range and for a mesh that has no triangles, is not closed, not oriented or encloses nothing, or
/// has an index or a coordinate that is out of range; Error(cancelled).
VANTAGE_API SimplifiedVolume simplify_volume(const Mesh& volume, const SimplifyOptions& options,
                                             const Progress& progress = {});

/// A volume with the mesh that simplifying its own left: each facet has the cause of the one that it came from, and the
/// tolerance is larger by what was lost. Throws Error(input) where the two do not belong together.
VANTAGE_API Volume with_mesh(Volume volume, SimplifiedVolume simplified);

}  // namespace vantage
