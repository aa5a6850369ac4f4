// Whether a target can be seen at all where it lies.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/prepared_data.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage::internal::target {

struct Clearance {
  double lift_m = 0;           ///< the target must be raised this far
  std::vector<Warning> notes;  ///< what people should know of where it lies: buried_note
};

/// How far the target must be raised to clear the surface that it lies on, and polygons within range that rise less
/// than Lengths::clear above its plane: 0 to Lengths::lift and three times Lengths::clear. `is_off_surface`: it was
/// raised off the surface that it lies on before, and what is higher is another one: 0 to four times Lengths::clear.
/// Throws ErrorCode::target_pierced when scene geometry stands on the target or passes through it (names the object,
/// the place and the smallest offset that clears it).
Clearance clear_target(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                       double max_range, bool is_off_surface = false);

/// How far a point that is seen from all sides must be raised for all that passes within Lengths::lift straight below
/// or above it to lie Lengths::clear and the polygon's diameter twice below: 0 where nothing does. The frame holds a
/// small polygon about it.
double height_off_surface(const PreparedScene::Data& scene, const TargetFrame& frame, double max_range);

/// Throws ErrorCode::target_pierced when a steep surface passes within Lengths::lift of a point that is seen from all
/// sides: which side of it is meant rounding would decide.
void refuse_steep_nearby(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                         double max_range);

}  // namespace vantage::internal::target
