// A mesh around all that belongs to a mission's volume: what computed volumes, which lie inside, cannot show is that
// a position outside of them is of no use.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/volume.h"

namespace vantage {

struct OuterOptions {
  double tolerance_m = 0;        ///< how coarse facets of the range may be; >= 0. 0: a thousandth of the range
  double limit_margin_m = 0.01;  ///< limits of navigation are made wider by so much on every side; > 0
};

struct OuterVolume {
  Volume volume;  ///< closed; empty only where no position is within range of all corners of a target, or limits leave
                  ///< nothing
  std::size_t facets = 0;            ///< of the star-shaped meshes that it is made of
  std::size_t open_facets = 0;       ///< of these, those without a witness: they were moved out beyond the range
  std::vector<std::string> ignored;  ///< limits that it is not cut to: it is larger than it could be, and right
};

/// Holds every position from which the mission's target, raised by PreparedTarget::lift_m, is seen whole, in range and
/// within the limits. For each part of each target the exact volume of sight and range is moved out from the target's
/// centre by twice its tolerance, and prove_maximal looks at each facet: beyond those that have a witness there is no
/// position. What has none is moved out further, and at last beyond the range. So nothing is taken on trust from the
/// method that computes volumes. The union or the intersection for several targets is as the mission says.
///
/// It is cut to altitude, heights above the ground and boxes (to stay in without zones, to stay out of), all made wider
/// by limit_margin_m, which is far above the rounding of booleans and of cleaning. An incidence of up to 85 degrees
/// cuts it to pyramids round the cones at up to eight corners of the target, as much wider. Other limits of navigation
/// and of the sensor, besides the range, only make the true volume smaller: they are ignored, and named. With a
/// VisibleShare (sensor.visible) all that is in range and in front of the target is taken.
///
/// Left out, as in docs/proof.md, "Maximal": positions lower over the target's plane than a millionth of their distance
/// from its centre, and those that see the target only past triangles without width. A target that is a point is taken
/// for a ball of 0.5 mm.
///
/// `options.threads`: at most so many. Throws as run_mission, and Error(input) for a tolerance or a margin that is no
/// such number. Cost: of a computation with that tolerance, and of prove_maximal, up to three times.
VANTAGE_API OuterVolume outer_volume(const Mission& mission, const RunOptions& options = {},
                                     const OuterOptions& outer = {}, const Progress& progress = {});

}  // namespace vantage
