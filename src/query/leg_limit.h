// A limit along a leg: each room of src/limits/ defines that of its own.
#pragma once

#include <memory>
#include <vector>

#include "query/ground_pool.h"
#include "query/leg_limits.h"
#include "sensor/viewed.h"
#include "vantage/each_limit.h"

namespace vantage::internal::query {

class LegLimit {
 public:
  LegLimit() = default;
  LegLimit(const LegLimit&) = delete;
  LegLimit& operator=(const LegLimit&) = delete;
  virtual ~LegLimit() = default;

  /// Adds where the tube breaks the limit, and by how much, by the names that answers for points have.
  virtual void add_breaks(const Tube& tube, std::vector<LegBreak>& breaks) const = 0;
};

using LegGroundPool = PoolOfGrounds<LegGround>;

/// Declared alone: a limit whose room has no answer for legs does not link. The second one: of the sensor's limits.
template <Limit kLimit>
std::unique_ptr<const LegLimit> leg_limit(const LimitValueOf<kLimit>& limit, LegGroundPool& grounds);
template <Limit kLimit>
std::unique_ptr<const LegLimit> leg_limit(const LimitValueOf<kLimit>& limit,
                                          const std::shared_ptr<const sensor::SensorView>& view);

}  // namespace vantage::internal::query
