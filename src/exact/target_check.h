// Whether a target can be seen at all where it lies.
#pragma once

#include "scene/prepared_data.h"
#include "vantage/target.h"

namespace vantage::exact {

/// How far the target must be raised to clear the surface that it lies on, and polygons within `reach` metres that rise
/// less than numerics::kClear above its plane: 0 to numerics::kMaxLift and three times numerics::kClear.
/// Throws Error(input) when scene geometry stands on the target or passes through it (names the object, the place and
/// the smallest offset that clears it), and when the target is under the ground (the same, with the offset where
/// raising it leads out).
double clearing_lift(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame, double reach);

}  // namespace vantage::exact
