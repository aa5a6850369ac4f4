// Planes that do not pass through the origin.
#pragma once

#include "vantage/geometry.h"

namespace vantage::internal::core {

/// The plane g . x = 1. `g` is an inverse length: on the direction d the plane is met at distance 1 / (g . d), so that
/// g . d is the inverse depth.
using Plane = Vec3;

}  // namespace vantage::internal::core
