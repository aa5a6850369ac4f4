// Points that a volume claims, held against the definition.
#pragma once

#include <cstddef>
#include <vector>

#include "support/random.h"
#include "vantage/volume.h"

namespace vantage::testing {

struct Verdict {
  std::size_t looked = 0;  ///< points deeper inside the volume than 1e-6 of their distance to the target
  std::size_t hidden = 0;  ///< those from which a triangle hides some of the target
  double deepest = 0;      ///< of these, in parts of the distance to the target
};

/// Tries `count` points, most of them 2e-6 to 1e-2 of the distance below the volume's surface, by ClipOracle with that
/// margin. `polygon` as the user gave it, counter-clockwise seen from its front; it is raised as the volume says.
Verdict judge(const Volume& volume, const Mesh& scene, std::vector<Vec3> polygon, int count, double margin,
              Random& random);

}  // namespace vantage::testing
