// A point as JSON: [x, y, z].
#pragma once

#include <nlohmann/json.hpp>

#include "vantage/geometry.h"

namespace vantage {

inline nlohmann::ordered_json point_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace vantage
