// A volume of which the proof of sight has left some facets open.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "prove/sight.h"

namespace vantage::internal::prove {

struct OpenVolume {
  const Mesh& whole;                          ///< the shrunk volume, closed, about View::origin
  const std::vector<Vec3>& vertices;          ///< of the facets that were tested
  const std::vector<Triangle>& facets;        ///< likewise
  const std::vector<std::uint32_t>& numbers;  ///< of these, in the volume that was given
  const std::vector<OpenFacet>& open;
  double rounding_m = 0;  ///< how far a file's numbers, and cutting, may have moved the surface
};

/// How far the surface lies beside what was meant because its numbers are doubles, whatever the file: a corner where
/// three planes meet by a few units of 2^-53 of the largest coordinate.
inline double rounding_of_numbers_m(double largest) {
  constexpr double kUnits = 8;
  return kUnits * std::numeric_limits<double>::epsilon() / 2 * largest;
}

/// How far the surface may lie beside where cutting meant it to be: Manifold leaves a corner within 1e-12 of the
/// largest coordinate about a local origin, cleaning adds up to twenty times that (src/solid/clean.h), and a volume is
/// cut up to three times. It reaches no farther than its range.
inline double rounding_of_cuts_m(double range_m) { return 0x1p-34 * range_m; }

}  // namespace vantage::internal::prove
