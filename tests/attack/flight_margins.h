// How far a position is from breaking each limit, by the definitions of the limits alone: those of limits/.
#pragma once

#include <string>
#include <vector>

#include "limit_attack.h"
#include "seen_target.h"
#include "vantage/navigation.h"
#include "vantage/sensor.h"

namespace attack {

/// The limits of navigation, which must live as long. Positions are in the scene frame.
class NavigationMargins {
 public:
  explicit NavigationMargins(const vantage::Navigation& navigation);
  NavigationMargins(const NavigationMargins&) = delete;
  NavigationMargins& operator=(const NavigationMargins&) = delete;

  /// One for each limit that is given; those of one name are one.
  std::vector<Margin> at(const Vec3& position) const;

 private:
  SeenBy nobody_;
  std::vector<AddMargins> limits_;
};

/// The limits of a target's sensor.
class SensorMargins {
 public:
  /// `parts`: of the target, as used. Positions are in the coordinates of the parts.
  SensorMargins(const vantage::Sensor& sensor, const std::vector<SeenTarget>& parts);
  SensorMargins(const SensorMargins&) = delete;
  SensorMargins& operator=(const SensorMargins&) = delete;

  /// With its range ("max_range") and its front ("behind").
  std::vector<Margin> at(const Vec3& position) const;
  std::vector<Margin> of_limits(const Vec3& position) const;

 private:
  SeenBy by_;
  double range_m_;
  std::vector<AddMargins> limits_;
};

/// The first limit that is surely broken; empty: none.
std::string broken_among(const std::vector<Margin>& margins);

}  // namespace attack
