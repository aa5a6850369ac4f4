// Targets that lie in files.
#pragma once

#include "core/progress_reporter.h"
#include "geo/on_globe.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// Reads the file of `given.source`, a TargetFile, and puts what it says in the place of that: the polygons of one
/// feature as a GroundTarget, in the frame. A target without a name gets the feature's. Throws Error(input) for what
/// parse_zones refuses, for a feature that is not there or one of several, for what is no polygon, lies far away, or
/// has heights that mean nothing in the scene.
void read_target_file(const Mission& mission, const geo::OnGlobe& globe, const core::ProgressReporter& progress,
                      MissionTarget& given);

/// Reads the closed mesh of `given.source`, a TargetFile, into the frame, as Target::volume in the place of that. A
/// target without a name gets the file's. What its file says of another frame or scene goes to the mission's notes.
/// Throws Error(input) as read_volume and core::checked_solid do.
void read_target_volume(Mission& mission, const Progress& progress, MissionTarget& given);

}  // namespace vantage::internal::app
