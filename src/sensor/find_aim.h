// Whether a camera at a point can take in all of a target.
#pragma once

#include <optional>
#include <span>

#include "sensor/aim.h"

namespace vantage::internal::sensor {

/// By how much the corners must be in the picture, or may be out of it.
struct AimRoom {
  double inside_m = 0;  ///< metres from the planes through the camera and the edges of the picture; negative: outside
  double outside = 0;   ///< and outside of them by the angle with this sine; -1 to 1, negative: inside
};

struct FoundAim {
  std::optional<Aim> aim;  ///< nothing where there is none, or none was found in time
  bool is_open = false;    ///< whether it is the latter
};

/// An orientation that the mount allows and that has all `corners` (positions relative to the camera) in the picture.
/// Where the best orientation has a corner within `slack` radians of an edge of the picture either answer may come.
/// `most_pitches`: that are tried. Directions of corners in the camera itself are taken to be in the picture.
/// Cost: some microseconds, more where the answer is close, most where it is for a wide range of pitches.
FoundAim find_aim(const Pinhole& camera, const Mount& mount, std::span<const Vec3> corners, double slack = 1e-6,
                  const AimRoom& room = {}, int most_pitches = 4000);

}  // namespace vantage::internal::sensor
