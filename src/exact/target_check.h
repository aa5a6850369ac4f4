// Whether a target can be seen at all where it lies.
#pragma once

#include "scene/prepared_data.h"
#include "vantage/target.h"

namespace vantage::exact {

/// How far the target must be raised to clear the surface that it lies on: 0 to numerics::kMaxLift.
/// Throws Error(input) when scene geometry stands on the target or passes through it (names the object, the place and
/// the smallest offset that clears it), and when the target is under the ground (the same, with the offset where
/// raising it leads out).
double clearing_lift(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame);

}  // namespace vantage::exact
