// The regions of the sensor's limits: each room of src/limits/ adds its own.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "exact/chart_limits.h"
#include "exact/star_target.h"
#include "sensor/viewed.h"
#include "solid/kernel_point.h"
#include "solid/regions.h"
#include "vantage/each_limit.h"

namespace vantage::internal::solid {

/// Limits that are cut in the chart, where the volume is computed; in the frame of the target.
struct LimitsInChart {
  exact::ChartLimits limits;
  std::vector<Cause> causes;  ///< by label
  std::vector<Limit> done;    ///< these need no regions any more
};

/// Positions are relative to the origin of what is viewed.
class SensorRegionBuilder {
 public:
  /// Keeps references. `bounds`: of the volume, scene frame. Regions are added to `regions`.
  SensorRegionBuilder(const sensor::Viewed& viewed, const Sensor& sensor, const Box& bounds, Regions& regions);
  /// Half-spaces, convex meshes and those that are star-shaped about the frame's origin are added to `chart`, in
  /// `frame`; there may be no others.
  SensorRegionBuilder(const sensor::Viewed& viewed, const Sensor& sensor, const TargetFrame& frame,
                      LimitsInChart& chart);

  const sensor::Viewed& viewed() const { return viewed_; }
  const Sensor& sensor() const { return sensor_; }
  double reach() const { return reach_; }  ///< of viewpoints from the origin, at most; metres

  /// For facets of the cause of this name.
  std::uint32_t label_of(const std::string& name);
  Solid solid_of(Mesh mesh, std::vector<std::uint32_t> labels) const;
  Solid solid_of(const Mesh& mesh, const std::string& name) {
    return solid_of(mesh, std::vector<std::uint32_t>(mesh.triangles.size(), label_of(name)));
  }

  /// `explanation`: what the limit asks, as a clause; may be empty.
  void keep(const std::string& name, Solid solid, const std::string& explanation = {});
  void forbid(const std::string& name, Solid solid, const std::string& explanation = {});
  /// What the half-spaces share.
  void keep(const std::string& name, std::vector<HalfSpace> half_spaces, const std::string& explanation = {});
  /// What is in a convex mesh.
  void forbid(const std::string& name, const Mesh& convex);
  /// What is in a closed mesh that is star-shaped about the origin.
  struct Star {
    Mesh mesh;
    std::vector<std::size_t> name_of;  ///< per triangle: of the cause, among `names`
    std::string explanation;
  };
  /// `make` is called now or later: it refers to nothing. It is told how far the view reaches, if that is known.
  void forbid_star(const std::string& name, const std::vector<std::string>& names,
                   const std::function<Star(const exact::ChartLimits::Reach&)>& make);

 private:
  const sensor::Viewed& viewed_;
  const Sensor& sensor_;
  std::uint32_t label_in_chart(const std::string& name);

  Regions* regions_ = nullptr;
  LimitsInChart* chart_ = nullptr;
  const TargetFrame* frame_ = nullptr;  // of the chart
  Box box_;                             ///< about the volume and a little more
  double reach_ = 0;
};

Vec3 any_across(const Vec3& axis);
/// Unit vectors round an axis of unit length.
std::vector<Vec3> ring(const Vec3& axis, int count);
/// The largest product of a corner with the direction.
double most_along(const std::vector<Vec3>& corners, const Vec3& direction);

/// For each part of the target. Curved surfaces are made of facets on the safe side: they take away more, by what
/// docs/camera.md says, never less. Declared alone: a limit whose room has no cut does not link. The frame is of all
/// parts together, and comes last, by add_frame_region.
template <Limit kLimit>
void add_regions(const LimitValueOf<kLimit>& limit, const sensor::ViewedPart& part, SensorRegionBuilder& builder);
void add_frame_region(const Pinhole& camera, SensorRegionBuilder& builder);

/// Adds what the sensor's limits besides the range keep and forbid, but for those that are done. `bounds`: of the
/// volume, scene frame.
void add_sensor_regions(const sensor::Viewed& viewed, const Sensor& sensor, std::span<const Limit> done,
                        const Box& bounds, Regions& regions);

/// Whether a limit of the sensor is convex, or star-shaped, so that it can be cut in the chart.
bool is_cut_in_chart(Limit limit);

/// Those limits of the sensor, in the frame of the target.
LimitsInChart sensor_limits_in_chart(const exact::StarTarget& target, const Sensor& sensor);

}  // namespace vantage::internal::solid
