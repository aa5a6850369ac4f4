// Targets that lie in the streets of a city: drawn at random, kept when buildings stand all round.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage::bench {

struct StreetSearch {
  std::uint64_t seed = 1;
  double side_m = 20;           ///< of the equilateral triangle
  double enclosed = 0.9;        ///< share of horizontal directions, 2 m over the ground, that meet a wall ...
  double enclosed_within = 80;  ///< ... within this many metres of the centre
};

struct StreetTarget {
  Target target;
  Vec3 centre;
  double enclosed;  ///< the share that was found
};

/// The first `count` that fit: centre in the middle three fifths of the scene, open to the sky, level on the lowest
/// surface of the scene, not pierced, seen at once. Depends on the scene and the search alone. Fewer when thousands of
/// draws do not hold that many.
std::vector<StreetTarget> find_street_targets(const Scene& scene, const PreparedScene& prepared,
                                              const StreetSearch& search, std::size_t count);

}  // namespace vantage::bench
