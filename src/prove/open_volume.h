// A volume of which the proof of sight has left some facets open.
#pragma once

#include <cstdint>
#include <vector>

#include "prove/sight.h"

namespace vantage::internal::prove {

struct OpenVolume {
  const Mesh& whole;                          ///< the shrunk volume, closed, about View::origin
  const std::vector<Vec3>& vertices;          ///< of the facets that were tested
  const std::vector<Triangle>& facets;        ///< likewise
  const std::vector<std::uint32_t>& numbers;  ///< of these, in the volume that was given
  const std::vector<OpenFacet>& open;
  double rounding_m = 0;  ///< how far a file's numbers may have moved the surface
};

}  // namespace vantage::internal::prove
