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

/// How far a point that is seen from all sides must be raised for all that passes within numerics::kMaxLift straight
/// below or above it to lie numerics::kClear and the polygon's diameter twice below: 0 where nothing does. The frame
/// holds a small polygon about it.
double height_off_surface(const PreparedScene::Data& scene, const TargetFrame& frame);

/// Throws Error(input) when a steep surface passes within numerics::kMaxLift of a point that is seen from all sides:
/// which side of it is meant rounding would decide.
void refuse_steep_nearby(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame);

}  // namespace vantage::exact
