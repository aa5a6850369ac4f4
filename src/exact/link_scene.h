// The scene as a radio link sees it: grown by the zone's radius, so that what blocks the straight line in it are the
// positions whose zone something enters. docs/theory.md, "Radio links".
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/progress_reporter.h"
#include "exact/half_space_volume.h"
#include "exact/zone_pieces.h"
#include "scene/prepared_data.h"
#include "target/range_region.h"
#include "vantage/target.h"

namespace vantage::internal::exact {

class LinkScene {
 public:
  /// The scene for a point with a link. `range` is about it. Keeps references.
  LinkScene(const PreparedTarget& target, const target::RangeRegion& range);

  /// A polygon that is so near to the antenna that it enters the zone of every position, if there is one.
  std::optional<std::uint32_t> polygon_at_antenna() const;

  /// As exact::compute_half_space for one side of the point. Polygons and objects are those of the original scene.
  /// Cost: that of growing what is seen, preparing it, and computing. Throws as that.
  HalfSpaceVolume compute_half_space(const TargetFrame& frame, const ExactOptions& options,
                                     const core::ProgressReporter& progress) const;

 private:
  struct Grown {
    Scene scene;                            ///< about the antenna; an object for each polygon that is in it
    std::vector<std::uint32_t> polygon_of;  ///< of each object
  };
  Grown grow(const TargetFrame& frame, const core::ProgressReporter& progress) const;
  void name_originals(const Grown& grown, HalfSpaceVolume& side) const;
  std::vector<Vec3> corners_of(std::uint32_t polygon) const;

  const PreparedScene& scene_;
  const target::RangeRegion& range_;
  Vec3 antenna_;  ///< relative to the scene's origin
  ZoneRadius radius_;
  double clear_;  ///< from the antenna, so that surfaces are clear of the triangle that stands for it
};

}  // namespace vantage::internal::exact
