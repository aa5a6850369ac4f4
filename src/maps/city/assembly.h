// The scene of a site's solids and its ground.
#pragma once

#include <string>
#include <vector>

#include "maps/city/site.h"
#include "vantage/scene.h"

namespace vantage::city {

/// What an object is called in the scene: "way/265517 Empire State Building".
std::string object_name(const CityRecord& record);

/// One object per item that has triangles, named "way/265517 Empire State Building", then the ground.
Scene assemble(const Site& site, const std::vector<Mesh>& solids, const Mesh& ground);

}  // namespace vantage::city
