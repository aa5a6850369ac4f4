// Whether a camera can have all of a target in one picture: a search over its orientations.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/sensor.h"

namespace vantage::internal::verify {

/// What was found for one limit at one viewpoint.
enum class Finding { kept, broken, undecided };

/// Radians, as Mount has them: yaw clockwise from +y, pitch up from level.
struct Orientation {
  double yaw = 0, pitch = 0;
};

class FrameSearch {
 public:
  struct Result {
    Finding finding = Finding::broken;
    Orientation orientation;  ///< that has all in the picture, where the finding is that there is one
    std::size_t cells = 0;    ///< that were looked at
  };

  FrameSearch(const Pinhole& camera, const Mount& mount);

  /// Unit directions from the camera to all that must be in the picture. `broken` is certain: every orientation of the
  /// mount leaves one of them out by more than kAngleSlack. `kept` comes with an orientation that leaves none out by
  /// more. Else the best orientation is so close to tangent that the search gave up (kMostCells, kSmallestCell).
  Result search(const std::vector<Vec3>& directions) const;

  /// The smallest sine of the angle by which a direction is inside an edge of the picture; negative: outside.
  double margin(const std::vector<Vec3>& directions, const Orientation& orientation) const;

 private:
  struct Cell;
  class Polygon;

  Eigen::Quaterniond turn(const Orientation& orientation) const;
  Cell whole() const;
  bool clip(const std::vector<Vec3>& directions, const Cell& cell, Polygon& polygon) const;

  std::array<Vec3, 4> edges_;  ///< unit normals, inwards, of a level camera that looks north
  double roll_;
  Orientation least_, most_;
};

}  // namespace vantage::internal::verify
