// The target as a sensor looks at it: corners and normals about an origin near it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/sensor.h"
#include "vantage/target.h"

namespace vantage::internal::sensor {

/// A convex polygon, or a single point. Positions are relative to Viewed::origin; axes of the scene.
struct ViewedPart {
  Vec3 centre = Vec3::Zero();  ///< strictly inside the polygon
  std::vector<Vec3> corners;   ///< in order round the polygon
  std::optional<Vec3> normal;  ///< unit length, to the front; none for a point that is seen from all sides
};

struct Viewed {
  Vec3 origin = Vec3::Zero();  ///< scene frame: the first part's centre, in the convex hull of all corners
  std::vector<ViewedPart> parts;
  std::vector<Vec3> corners;  ///< of all parts

  double radius() const;  ///< of a ball about the origin that holds all corners, metres
};

/// A sensor, and the target that it looks at.
struct SensorView {
  Sensor sensor;
  Viewed target;
};

/// The parts as they are used, lifts included.
Viewed viewed_of(const PreparedTarget& target);

/// Convex polygons in a frame, which hold its origin in their interior.
Viewed viewed_of(const TargetFrame& frame, std::span<const std::vector<Eigen::Vector2d>> polygons);

// All of the part's positions and of the points are about Viewed::origin.

/// Distance from a point to a convex polygon (of one corner: to the point), metres.
double distance_to(const ViewedPart& part, const Vec3& point);

/// The least angle, in radians, between a direction of unit length and that in which a point of the part is seen from
/// `point`.
double least_angle(const ViewedPart& part, const Vec3& point, const Vec3& direction);

/// Metres from the nearest of the cones about the normal, one at each corner, with the angle between; negative outside.
double cone_margin(const ViewedPart& part, const Vec3& point, double angle_deg);

}  // namespace vantage::internal::sensor
