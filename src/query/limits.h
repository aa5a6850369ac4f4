// Which limits, of navigation and of the sensor, a point breaks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "query/point_limit.h"
#include "query/view_ray.h"
#include "vantage/navigation.h"
#include "vantage/target.h"

namespace vantage::internal::query {

class Limits {
 public:
  /// None.
  Limits() = default;
  Limits(const Navigation& navigation, const PreparedTarget& target);

  /// Names as in reports: "altitude min", "altitude max", "agl min", "agl max", "ground edge" (no ground above or below
  /// the point), "keep_in" (the point is in none of these zones), "keep_out zone 2", "keep_out zone NAME", "mesh NAME",
  /// "clearance", "min_range", "incidence", "pixel", "frame", "gimbal" (a camera of the same picture would do that
  /// could look anywhere), "sun". Borders belong to the allowed side. Cost: linear in the corners of zones and in the
  /// triangles of navigation meshes whose boxes hold the point.
  std::vector<std::string> broken(const Vec3& point) const;

  /// Signed distance, along the line, from the point at `at` metres from its origin (negative: behind the target) to
  /// the boundary of the part of the line that is within reach and all limits: positive inside, minus infinity where
  /// there is no such part. The origin, where the line ends on the target, does not count as boundary. `is_inside`:
  /// what is known of the point by tests of its own, which this follows. Cost: as broken() for each crossing with a
  /// limit that lies nearer than that boundary.
  double signed_margin(const ViewRay& line, double at, bool is_inside) const;

 private:
  std::vector<double> cut_line(const ViewRay& line) const;

  std::vector<std::unique_ptr<const PointLimit>> limits_;
};

}  // namespace vantage::internal::query
