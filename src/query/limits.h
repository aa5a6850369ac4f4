// Which limits, of navigation and of the sensor, a point breaks.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "query/ground_heights.h"
#include "query/obstacle_distance.h"
#include "sensor/sensor_limits.h"
#include "vantage/navigation.h"

namespace vantage::internal::query {

/// A line of sight: from the target's centre to the front. Scene frame.
struct ViewRay {
  Vec3 origin, direction;  ///< unit length
  double reach = 0;        ///< metres from the origin up to which the whole target is visible and in range; 0: nowhere

  Vec3 at(double distance) const { return origin + distance * direction; }
};

class Limits {
 public:
  Limits(Navigation navigation, sensor::SensorLimits sensor);

  /// Names as in reports: "altitude min", "altitude max", "agl min", "agl max", "ground edge" (no ground above or below
  /// the point), "keep_in" (the point is in none of these zones), "keep_out zone 2", "keep_out zone NAME", "mesh NAME",
  /// "clearance", then the sensor's (SensorLimits::broken). Borders belong to the allowed side. Cost: linear in the
  /// corners of zones and in the triangles of navigation meshes whose boxes hold the point.
  std::vector<std::string> broken(const Vec3& point) const;

  /// Signed distance, along the line, from the point at `at` metres from its origin (negative: behind the target) to
  /// the boundary of the part of the line that is within reach and all limits: positive inside, minus infinity where
  /// there is no such part. The origin, where the line ends on the target, does not count as boundary. `is_inside`:
  /// what is known of the point by tests of its own, which this follows. Cost: as broken() for each crossing with a
  /// limit that lies nearer than that boundary.
  double signed_margin(const ViewRay& line, double at, bool is_inside) const;

 private:
  std::vector<double> cut_line(const ViewRay& line) const;
  void add_broken_above_ground(const Vec3& point, std::vector<std::string>& broken) const;
  void add_ground(const Ground& ground);
  const GroundHeights& heights_of(const Ground& ground) const;
  void add_above_ground_crossings(const AboveGround& limit, const ViewRay& line, std::vector<double>& cuts) const;
  bool is_at_height(const Zone& zone, const Vec3& point) const;
  bool is_clear_of_heights(const Zone& zone, const Vec3& point) const;

  Navigation navigation_;
  sensor::SensorLimits sensor_;
  std::vector<Box> mesh_boxes_, keep_in_boxes_, keep_out_boxes_;  ///< of meshes and of zones
  std::vector<std::pair<Ground, GroundHeights>> grounds_;         ///< of all limits above a ground, each once
  std::optional<ObstacleDistance> obstacles_;                     ///< where a clearance from them is asked
};

}  // namespace vantage::internal::query
