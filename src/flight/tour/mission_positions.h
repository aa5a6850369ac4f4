// The fewest positions for the targets of a mission.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/mission_tour.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/tour.h"

namespace vantage::internal::flight::tour {

/// Whether the mission's one target is a volume itself.
bool is_volume(const Mission& one);

/// The missions of all targets, each by itself.
std::vector<Mission> each_of(const Mission& mission);

/// So deep in its volume each target is viewed: then all that is as near is in the volume, too.
double view_depth_m(const Mission& mission);

/// Throws Error(input) for a tour that cannot have such positions: of a fixed wing, with positions that are given, and
/// with a certificate of a bound.
void check_can_hover(const TourSettings& settings, const MissionTourOptions& options);

/// Positions from which the targets are seen, `slack_m` deeper than the tour's margin: the vehicle may be so far off.
/// What is as near must be allowed by the airspace, too. A target is asked for by the exact query of its mission. Notes
/// say what was cut short. Throws as fewest_positions, and as outer_volume.
FewestPositions positions_for(const Mission& mission, const std::vector<MissionTourTarget>& targets,
                              const PreparedScene& scene, const std::shared_ptr<const Airspace>& airspace,
                              double slack_m, const MissionTourOptions& options, std::vector<std::string>& notes,
                              const Progress& progress);

/// For each target where it is viewed from. Of an unseen one a point that lies deep in its volume: what stands there is
/// found when the tour is planned.
std::vector<Vec3> position_of_each(const FewestPositions& found, const std::vector<MissionTourTarget>& targets,
                                   double margin_m);

}  // namespace vantage::internal::flight::tour
