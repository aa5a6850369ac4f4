// Which navigation limits a point breaks.
#pragma once

#include <string>
#include <vector>

#include "vantage/constraints.h"

namespace vantage::query {

/// Names as in reports: "altitude min", "altitude max", "boxes" (the point is in none of them), "keep_out 2", "mesh
/// NAME". Borders belong to the allowed side. Cost: linear in the triangles of the navigation meshes.
std::vector<std::string> limits_broken(const Navigation& navigation, const Vec3& point);

}  // namespace vantage::query
