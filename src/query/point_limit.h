// A limit of navigation for points and lines of sight: each room of src/limits/ defines that of its own.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "query/ground_heights.h"
#include "query/view_ray.h"
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

/// The ground of all limits above one, each surface once.
class GroundPool {
 public:
  std::shared_ptr<const GroundHeights> of(const Ground& ground);

 private:
  std::vector<std::pair<Ground, std::shared_ptr<const GroundHeights>>> known_;
};

/// Declared alone: a limit whose room has no answer for points does not link.
template <Limit kLimit>
std::unique_ptr<const PointLimit> point_limit(const LimitValueOf<kLimit>& limit, GroundPool& grounds);

}  // namespace vantage::internal::query
