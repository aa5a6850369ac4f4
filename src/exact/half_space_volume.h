// What is seen of a target from one side of its plane: all steps of docs/theory.md from blockers to the closed mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "exact/chart_limits.h"
#include "exact/floor.h"
#include "target/range_region.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::internal::exact {

struct HalfSpaceVolume {
  Mesh mesh;                                        ///< target's frame, closed
  std::vector<std::uint32_t> cause_of, polygon_of;  ///< as in Volume
  std::vector<Cause> causes;
  StageCounts counts;
  double height = 0;        ///< up to which the mesh reaches over the target's plane, metres
  double range_height = 0;  ///< up to which the range alone would let it reach, straight over the centre

  /// Whether the scene, not the range, ends it that close to the target's plane.
  bool ends_within(double distance) const { return height < distance && range_height > distance; }
};

/// The frame's polygon has at least 3 vertices; `range` is about the frame's origin. Throws Error(cancelled), and
/// Error(input) for a tolerance too fine for the range.
HalfSpaceVolume compute_half_space(const PreparedScene& scene, const TargetFrame& frame,
                                   const target::RangeRegion& range, const ExactOptions& options,
                                   const core::ProgressReporter& progress);

/// The same of a target that is what several convex polygons cover, which all hold the frame's origin in their interior
/// (docs/theory.md, "Targets of several parts"). The frame's polygon is their convex hull, about whose corners the
/// range is. Cost: as for each of them, but one triangulation.
HalfSpaceVolume compute_half_space(const PreparedScene& scene, const TargetFrame& frame,
                                   std::span<const std::vector<Eigen::Vector2d>> cover,
                                   const target::RangeRegion& range, const ExactOptions& options,
                                   const core::ProgressReporter& progress);

/// Limits, ready to be cut in the chart.
struct LimitsOfView {
  std::vector<ChartLimits::Side> ceilings;
  Floor floor;  ///< of all but `stars`
  std::vector<ChartLimits::StarMaker> stars;
  std::vector<Cause> causes;  ///< by label
};

/// nullopt where booleans are needed: docs/theory.md, "Limits in the chart".
std::optional<LimitsOfView> limits_of_view(const ChartLimits& limits, std::vector<Cause> causes,
                                           const TargetFrame& frame, const target::RangeRegion& range);

/// As compute_half_space, but only what keeps the limits. Its mesh may be empty. nullopt where floor and envelope meet
/// in a way that could not be triangulated.
std::optional<HalfSpaceVolume> compute_half_space_within(const PreparedScene& scene, const TargetFrame& frame,
                                                         std::span<const std::vector<Eigen::Vector2d>> cover,
                                                         const target::RangeRegion& range, const LimitsOfView& limits,
                                                         const ExactOptions& options,
                                                         const core::ProgressReporter& progress);

/// Both sides of a point as one solid in the front's frame, without the wall between them. `back` is in the frame
/// turned about the u axis. What is left of the wall, where the two differ by their tolerance, gets the cause of what
/// is next to it. Cost: O(n log n) in the vertices in the plane, and linear in the facets.
HalfSpaceVolume join_half_spaces(const HalfSpaceVolume& front, const HalfSpaceVolume& back);

/// What most of the boundary is due to, but for the target's plane.
const Cause& widest_cause(const std::vector<Cause>& causes);

}  // namespace vantage::internal::exact
