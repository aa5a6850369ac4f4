// The scene of a site's solids and its ground.
#pragma once

#include <string>
#include <vector>

#include "maps/city/ground.h"
#include "maps/city/site.h"
#include "vantage/scene.h"

namespace vantage::internal::city {

/// One object per item that has triangles, then the ground.
Scene assemble(const Site& site, const std::vector<Mesh>& solids, const Ground& ground, MissingPolicy missing);

}  // namespace vantage::internal::city
