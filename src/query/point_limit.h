// A limit for points and lines of sight: each room of src/limits/ defines that of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "query/ground_heights.h"
#include "query/ground_pool.h"
#include "query/view_ray.h"
#include "sensor/viewed.h"
#include "vantage/each_limit.h"

namespace vantage::internal::query {

class PointLimit {
 public:
  PointLimit() = default;
  PointLimit(const PointLimit&) = delete;
  PointLimit& operator=(const PointLimit&) = delete;
  virtual ~PointLimit() = default;

  /// Adds the names of what the point (scene frame) breaks. Borders belong to the allowed side.
  virtual void add_broken(const Vec3& point, std::vector<std::string>& broken) const = 0;

  /// Adds the distances along the line where it may pass the limit: a crossing too many does no harm, one too few
  /// within reach would.
  virtual void add_crossings(const ViewRay& line, std::vector<double>& cuts) const = 0;
};

using GroundPool = PoolOfGrounds<GroundHeights>;

/// Declared alone: a limit whose room has no answer for points does not link. The second one: of the sensor's limits.
template <Limit kLimit>
std::unique_ptr<const PointLimit> point_limit(const LimitValueOf<kLimit>& limit, GroundPool& grounds);
template <Limit kLimit>
std::unique_ptr<const PointLimit> point_limit(const LimitValueOf<kLimit>& limit,
                                              const std::shared_ptr<const sensor::SensorView>& view);

/// Of a line, which of its places are one interval.
enum class OneInterval { kept, broken };

/// A limit that a point breaks where it breaks it for one of the parts: `margin` is negative there, with the point
/// about Viewed::origin. Along a line it has one maximum or minimum, in that interval.
std::unique_ptr<const PointLimit> limit_of_parts(
    const char* name, const std::shared_ptr<const sensor::SensorView>& view, OneInterval interval,
    std::function<double(const sensor::ViewedPart& part, const Vec3& point)> margin);

}  // namespace vantage::internal::query
