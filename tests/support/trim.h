// Cutting a solid by a plane.
#pragma once

#include <cstdint>

#include "solid/csg.h"
#include "support/internals.h"

namespace vantage::testing {

/// The part of `solid` with normal·x <= offset; the cut face gets `label`. `normal` is of unit length; where it is an
/// axis the cut is exact.
solid::Solid trim(const solid::Solid& solid, const Vec3& normal, double offset, std::uint32_t label);

}  // namespace vantage::testing
