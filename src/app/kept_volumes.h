// The volumes that a run takes from the one before.
#pragma once

#include <functional>
#include <memory>

#include "vantage/mission.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage::internal::app {

/// To call when a run begins to compute, its targets checked: drops what the last one did not use. `kept` may be null.
void begin_run(const std::shared_ptr<KeptVolumes>& kept);

/// The exact volume of a target before limits: one that is kept, or what `compute` returns. `kept` may be null.
Volume kept_or_computed(const std::shared_ptr<KeptVolumes>& kept, const PreparedTarget& target, double tolerance_m,
                        const std::function<Volume()>& compute);

}  // namespace vantage::internal::app
