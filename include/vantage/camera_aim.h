// Where to turn a camera so that it has something in its picture.
#pragma once

#include <optional>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/sensor.h"

namespace vantage {

/// An orientation of a camera, but for its roll.
struct CameraAim {
  double yaw_deg = 0;    ///< clockwise from +y of the scene (north), in [0, 360)
  double pitch_deg = 0;  ///< 0 is level, -90 straight down
};

/// Whether all points (relative to the camera, scene axes) are in the picture.
VANTAGE_API bool is_in_picture(const Pinhole& camera, double roll_deg, const CameraAim& aim,
                               const std::vector<Vec3>& points);

struct FittingAim {
  CameraAim aim;
  double room_deg = 0;  ///< between the edges of the picture and the points: an angle; negative where some are outside
};

/// Of the orientations that the mount allows the one with the most room between all points (relative to the camera,
/// scene axes) and the edges of the picture, to 0.01 degrees of room. Nothing where none has all of them in the
/// picture, and for points that are not finite; where one is on its edge, within 0.0001 degrees, either answer may
/// come. `outside_deg`: points may also lie so far outside of the edges, which must be less than 90 degrees. Cost: some
/// hundred microseconds.
VANTAGE_API std::optional<FittingAim> fit_in_picture(const Pinhole& camera, const Mount& mount,
                                                     const std::vector<Vec3>& points, double outside_deg = 0);

}  // namespace vantage
