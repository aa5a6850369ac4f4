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

/// Of the target of one volume.
class ViewAim {
 public:
  explicit ViewAim(const Mission& mission);

  /// At the centre, where the mount allows it and all of the target is in the picture then. Else the orientation with
  /// the most room between the target and the edges of the picture, to 0.01 degrees of the best; of several targets of
  /// which one is enough, for the one that has the most. Without a camera, and where none has the target whole, the
  /// nearest to the centre that the mount allows. Cost: a microsecond, or some hundreds where it is not the centre.
  AimedCamera at(const Vec3& position, const Vec3& centre) const;

 private:
  struct Fit {
    Aim aim;
    double room = 0;  ///< sine of the angle
  };
  bool has_all(const std::vector<Vec3>& corners, const Vec3& position, const Aim& aim) const;
  std::optional<Fit> best_fit(const std::vector<Vec3>& corners, const Vec3& position) const;

  std::vector<std::vector<Vec3>> choices_;  ///< corners of what must be in the picture: one of these is enough
  std::optional<Pinhole> camera_;
  Mount mount_;
};

}  // namespace vantage::internal::flight
