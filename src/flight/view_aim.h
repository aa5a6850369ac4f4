// How a camera must look from a position, so that all of a target is in its picture.
#pragma once

#include <optional>
#include <vector>

#include "flight/gimbal.h"
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

}  // namespace vantage::internal::flight
