// Targets that lie in files.
#pragma once

#include "core/progress_reporter.h"
#include "geo/local_frame.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// Reads the file of `given.target_file`, and puts what it says in the place of that: the polygons of one feature as a
/// `ground_target`, in the frame. A target without a name gets the feature's. Throws Error(input) for what parse_zones
/// refuses, for a feature that is not there or one of several, for what is no polygon, lies far away, or has heights
/// that mean nothing in the scene.
void read_target_file(const Mission& mission, const geo::LocalFrame& frame, const core::ProgressReporter& progress,
                      MissionTarget& given);

}  // namespace vantage::internal::app
