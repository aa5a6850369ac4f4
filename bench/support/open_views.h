// Two targets in real scenes from which much of the sky is seen: for benchmarks of the check.
#pragma once

#include <utility>

#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage::bench {

struct OpenView {
  const char* file;  ///< under data/ of the shared folder
  UpAxis up;
  Vec3 target;  ///< centre of a 20 m square that looks up
  double range;
};

// Charlotte: an open street crossing. openfoam-buildings: the sky over the tallest roof, from which all of it is seen.
inline const OpenView kStreetCrossing{"charlotte/uptownCharlotte.obj", UpAxis::y, {-350, -60, 1}, 300};
inline const OpenView kAboveRoofs{"mesh/openfoam-buildings.obj.gz", UpAxis::z, {120, 90, 1}, 200};

inline Target square_at(const Vec3& centre) {
  Target target;
  for (const auto& [x, y] : {std::pair{-10, -10}, {10, -10}, {10, 10}, {-10, 10}})
    target.parts[0].push_back(centre + Vec3(x, y, 0));
  return target;
}

}  // namespace vantage::bench
