// The regions of navigation limits: each room of src/limits/ adds its own.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/progress_reporter.h"
#include "solid/regions.h"
#include "vantage/each_limit.h"

namespace vantage::internal::solid {

/// Causes of a box's six sides: at min x, y, z, then at max x, y, z.
using SideCauses = std::array<std::uint32_t, 6>;

class RegionBuilder {
 public:
  /// `bounds`: of the volume. `meshes`: of Limit::meshes, checked and welded.
  RegionBuilder(const std::vector<Cause>& volume_causes, const std::vector<FacetSource>& volume_sources,
                const Box& bounds, const std::vector<Mesh>& meshes, core::ProgressReporter progress);

  const Box& bounds() const { return bounds_; }
  const Box& outer() const { return outer_; }  ///< a little more than the bounds
  const Vec3& origin() const { return result_.origin; }
  const std::vector<Mesh>& meshes() const { return meshes_; }
  const core::ProgressReporter& progress() const { return progress_; }

  std::uint32_t add_cause(const std::string& name);
  std::uint32_t add_source(const FacetSource& source);  ///< a label
  void keep(Region region) { result_.kept.push_back(std::move(region)); }
  void forbid(Region region) { result_.forbidden.push_back(std::move(region)); }

  /// The part of a box that lies about the volume; sides outside of that are moved in, but stay clear of the volume.
  Solid make_side_labelled_box(const Box& box, const SideCauses& causes);
  /// The volume is cut to what is between two z.
  void keep_between(const std::string& name, double min_z, double max_z, const char* min_cause, const char* max_cause);
  /// The two heights, which may be infinite, moved in to where they still lie beyond the volume on the same side, and
  /// the lower one below the upper one: booleans round to a part of the largest coordinate.
  std::pair<double, double> heights_near(const AboveGround& heights) const;

  Regions take() { return std::move(result_); }

 private:
  Box bounds_, outer_;
  const std::vector<Mesh>& meshes_;
  core::ProgressReporter progress_;
  Regions result_;
};

bool contains(const Box& outer, const Box& inner);
bool insides_meet(const Box& a, const Box& b);
/// "20 to 120 m"
std::string metres_from_to(double min_m, double max_m);

/// Declared alone: a limit whose room has no cut does not link. The clearance is cut last, by add_clearance_region.
template <Limit kLimit>
void add_regions(const LimitValueOf<kLimit>& limit, RegionBuilder& builder);

}  // namespace vantage::internal::solid
