// How far a position is from breaking each limit, by the definitions of the limits alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "closed_mesh.h"
#include "seen_target.h"
#include "vantage/navigation.h"
#include "vantage/sensor.h"

namespace attack {

/// Above 0 the limit is kept by every position nearer than that, below 0 it is broken by every such one; metres. Where
/// rounding decides (at the borders of ground, seen from above) `low` and `high` differ.
struct Margin {
  std::string limit;  ///< as PointAnswer::outside_of has it
  double low = 0, high = 0;
};

/// The limits of navigation. Positions are in the scene frame.
class NavigationMargins {
 public:
  explicit NavigationMargins(const vantage::Navigation& navigation);

  /// One for each limit that is given; those of one name are one.
  std::vector<Margin> at(const Vec3& position) const;

 private:
  struct ClosedLimit {
    std::string limit;
    Vec3 origin;
    ClosedMesh mesh;
  };
  const vantage::Navigation& navigation_;
  std::vector<ClosedLimit> meshes_;
};

/// The limits of a target's sensor, with its range ("max_range") and its front ("behind").
class SensorMargins {
 public:
  /// `parts`: of the target, as used. Positions are in the coordinates of the parts.
  SensorMargins(const vantage::Sensor& sensor, const std::vector<SeenTarget>& parts) : sensor_(sensor), parts_(parts) {}

  std::vector<Margin> at(const Vec3& position) const;

 private:
  /// Of the best orientation of the camera that a search finds.
  double in_picture(const Vec3& position) const;
  /// `low`: that. `high`: no orientation has more.
  Margin picture_margin(const Vec3& position) const;
  /// False only where no orientation has all corners at least `depth` inside of the picture's sides.
  bool may_be_in_picture(const Vec3& position, double depth, double farthest) const;

  vantage::Sensor sensor_;
  std::vector<SeenTarget> parts_;
};

/// Above 0 inside of the box: how far from its border.
double margin_in_box(const vantage::Box& box, const Vec3& position);

}  // namespace attack
