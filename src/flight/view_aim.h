// How a camera must look from a position, so that all of a target is in its picture.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "flight/gimbal.h"
#include "vantage/flight.h"
#include "vantage/mission.h"
#include "vantage/sensor.h"

namespace vantage::internal::flight {

struct AimedCamera {
  Aim aim;
  bool is_centred = true;  ///< whether it looks at the centre; else the target is whole in the picture, if it can be
};

/// How a camera looks at the target of one volume.
class ViewAim {
 public:
  explicit ViewAim(const Mission& mission);

  /// At the centre, where the mount allows it and all of the target is in the picture then. Else what fit_in_picture
  /// finds; of several targets of which one is enough, for the one with the most room. Without a camera, and where no
  /// orientation has the target whole, the nearest to the centre that the mount allows.
  AimedCamera at(const Vec3& position, const Vec3& centre) const;

 private:
  std::vector<std::vector<Vec3>> choices_;  ///< corners of what must be in the picture: one of these is enough
  std::optional<Pinhole> camera_;
  Mount mount_;
};

/// The aircraft of the camera that a mission names, as DJI numbers it. Nothing where it is not known.
std::optional<DjiAircraft> aircraft_of_camera(const Mission& mission);

/// The lowest and the highest pitch that a plan asks for, degrees.
class AskedPitches {
 public:
  void add(double pitch_deg) {
    lowest_deg_ = std::min(lowest_deg_, pitch_deg);
    highest_deg_ = std::max(highest_deg_, pitch_deg);
  }
  /// Where the gimbal does not reach them, or it is not known whether it does. Nothing where it does, and for none.
  std::optional<std::string> note(const Mission& mission) const;

 private:
  double lowest_deg_ = std::numeric_limits<double>::infinity(), highest_deg_ = -lowest_deg_;
};

}  // namespace vantage::internal::flight
