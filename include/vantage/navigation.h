// Volumes as solids: cut to limits of the sensor and of navigation, and intersected.
#pragma once

#include <vector>

#include "vantage/constraints.h"
#include "vantage/export.h"
#include "vantage/prepared_target.h"
#include "vantage/progress.h"
#include "vantage/volume.h"

namespace vantage {

/// Cuts a volume to the navigation limits. The result may have several pieces; each is closed. Facets keep their
/// causes; cut faces are CauseKind::navigation. An empty result is Outcome::outside_limits with a reason. Adds its time
/// to `navigation` and `total` of the volume's Seconds. Uses the threads of the caller's arena (TBB).
///
/// Cost: one boolean operation, O(n log n) in the facets of the volume and the limits, and the check of each mesh for
/// self-intersections, O(m log m) in its triangles. The clearance takes as many booleans as there are obstacles near
/// what the other limits leave: more than `work_limit` allows is refused before they begin.
///
/// Throws Error(input) as check_navigation does, and for a volume whose arrays do not fit together;
/// Error(work_too_large); Error(cancelled) when told to stop; Error(internal) when a boolean operation fails.
VANTAGE_API Volume cut_to_navigation(const Volume& volume, const Navigation& navigation, const Progress& progress = {},
                                     double work_limit = kWorkLimit);

/// Cuts a volume to the limits of the target's sensor, besides the range, and to the navigation limits, at once. Facets
/// that a limit of the sensor makes are CauseKind::sensor, by the names "min_range", "incidence", "pixel", "frame",
/// "gimbal" and "sun". As cut_to_navigation otherwise. A link is no such limit: compute_visibility takes it into
/// account.
///
/// Guaranteed from the inside: the surfaces are made of facets, which take away more than the limit does, never less.
/// How much more is in docs/camera.md. Cost: besides the boolean milliseconds, with a gimbal tens of them.
VANTAGE_API Volume cut_to_limits(const Volume& volume, const PreparedTarget& target, const Navigation& navigation = {},
                                 const Progress& progress = {}, double work_limit = kWorkLimit);

/// What all the volumes claim: that of a target in parts is the intersection of its parts' volumes. May have several
/// pieces, each closed; facets keep their causes, and causes of the same kind and name become one. Tolerance and lift
/// are the largest of the volumes', the frame is the first one's, seconds and counts are sums, notes are those of all.
/// Where one of the volumes is empty, so is the result, with its outcome and reason; where they have nothing in common,
/// Outcome::no_common_view.
/// Throws Error(input) for no volumes and for one whose arrays do not fit together; Error(work_too_large);
/// Error(cancelled) when told to stop; Error(internal) when a boolean operation fails. Cost: a boolean operation per
/// volume, O(n log n) in the facets.
VANTAGE_API Volume intersect_volumes(const std::vector<Volume>& volumes, const Progress& progress = {},
                                     double work_limit = kWorkLimit);

/// What at least one of the volumes claims: that of targets of which one is enough. As intersect_volumes otherwise;
/// volumes that are empty for a good reason add nothing. Where all are, so is the result, with the first one's outcome.
VANTAGE_API Volume unite_volumes(const std::vector<Volume>& volumes, const Progress& progress = {},
                                 double work_limit = kWorkLimit);

/// The volume of a target of any number of parts, before limits besides the range: compute_visibility of each part,
/// intersected. Where no position is in front of all parts, and within range of them, that is told at once.
///
/// Of a target whose sensor has a VisibleShare: what sees at least that part of its area, is within range of all of it
/// and in front of all its parts. Guaranteed from the inside: the parts are cut into convex cells, and from each point
/// of the result so many of them are seen whole that their area is the share or more. Parts get cells in proportion to
/// their area, at least one each; what a cell of a part costs is rounded up to an eighth of an average cell. The result
/// has all that so many whole cells allow but where there are more than 16 of them, or parts: then some of what is
/// missed is rounded up. It may have several pieces and holes, and is not star-shaped. Where all cells must be seen it
/// is the volume of the whole target. Where nothing is left, Outcome::no_common_view. Cost: a volume for each cell, and
/// booleans in proportion to the cells times the root of what may be missed; docs/camera.md has figures.
///
/// Throws as compute_visibility and intersect_volumes do.
VANTAGE_API Volume compute_parts(const PreparedTarget& target, const ExactOptions& options = {},
                                 const Progress& progress = {});

/// All that a vehicle may use: compute_parts, cut to the limits of the sensor and of navigation. Throws as these do.
/// Cost: the sum of theirs.
VANTAGE_API Volume compute_volume(const PreparedTarget& target, const Navigation& navigation = {},
                                  const ExactOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
