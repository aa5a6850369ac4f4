// Limits of the sensor that are of each part of the target, along a leg: what is kept is convex, or what is broken.
#pragma once

#include <functional>
#include <memory>

#include "query/leg_convex.h"
#include "query/leg_limit.h"

namespace vantage::internal::query {

/// What a leg breaks where it breaks it for one of the parts. Tubes and places are about Viewed::origin.
struct LegPartLimit {
  const char* name;
  LegBreak::Unit unit;
  std::function<LegIntervals(const sensor::ViewedPart& part, const Tube& tube)> broken;
  /// By how much a ball of the tube about a place breaks it; negative where it keeps it.
  std::function<double(const sensor::ViewedPart& part, const Vec3& place, double radius)> amount;
};

std::unique_ptr<const LegLimit> leg_limit_of_parts(LegPartLimit limit,
                                                   const std::shared_ptr<const sensor::SensorView>& view);

/// Where a convex function of the share of the leg is less than `level`.
template <typename Function>
LegIntervals where_below(const Function& value, double level) {
  const auto part = below_level(value, level);
  return part ? LegIntervals{*part} : LegIntervals{};
}

/// The angle that the radius subtends at a distance, degrees.
double turn_by(double radius, double distance);

}  // namespace vantage::internal::query
