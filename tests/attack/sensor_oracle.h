// What limits of the sensor are made of, by their definitions: docs/camera.md.
#pragma once

#include <optional>

#include "oracle.h"
#include "vantage/sensor.h"

namespace attack {

double distance_to_target(const SeenTarget& target, const Vec3& point);

/// By how much the target reaches into the cone about the direction to the sun: metres, above 0 where it does. It
/// changes by at most twice what the viewpoint moves.
double depth_in_sun(const vantage::SunLimit& sun, const SeenTarget& target, const Vec3& point);

/// A triangle that enters the zone of a link between an antenna and a vehicle.
std::optional<std::size_t> entering_zone(const vantage::RadioLink& link, const Blockers& blockers, const Vec3& antenna,
                                         const Vec3& vehicle);

}  // namespace attack
