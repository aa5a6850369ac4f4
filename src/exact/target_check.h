// Whether a target can be seen at all where it lies.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "scene/prepared_data.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage::exact {

/// Scene geometry stands on the target or passes through it. Those who know what the object is may have better advice.
class PiercedTarget : public Error {
 public:
  PiercedTarget(std::string problem, std::string where, std::string fix, std::uint32_t object)
      : Error(ErrorKind::input, std::move(problem), std::move(where), std::move(fix)), object_(object) {}

  std::uint32_t object() const { return object_; }  ///< of the scene

 private:
  std::uint32_t object_;
};

/// How far the target must be raised to clear the surface that it lies on, and polygons within `reach` metres that rise
/// less than numerics::kClear above its plane: 0 to numerics::kMaxLift and three times numerics::kClear.
/// Throws PiercedTarget when scene geometry stands on the target or passes through it (names the object, the place and
/// the smallest offset that clears it, or how much is missing where that is more than a few metres), Error(input) when
/// the target is under the ground (the same, with the offset where raising it leads out).
double clearing_lift(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame, double reach);

/// How far a point that is seen from all sides must be raised for all that passes within numerics::kMaxLift straight
/// below or above it to lie numerics::kClear and the polygon's diameter twice below: 0 where nothing does. The frame
/// holds a small polygon about it.
double height_off_surface(const PreparedScene::Data& scene, const TargetFrame& frame);

/// Throws Error(input) when a steep surface passes within numerics::kMaxLift of a point that is seen from all sides:
/// which side of it is meant rounding would decide.
void refuse_steep_nearby(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame);

}  // namespace vantage::exact
