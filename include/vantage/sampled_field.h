// How much of a target is seen from each voxel of a box, estimated from depth images.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "vantage/devices.h"
#include "vantage/export.h"
#include "vantage/fraction_field.h"
#include "vantage/progress.h"
#include "vantage/target.h"

namespace vantage {

struct SampleOptions {
  std::size_t samples = 256;  ///< points of the target, 1 to 65,535
  int cubemap = 512;          ///< texels along the side of a depth image, 1 to 8192
  DeviceChoice device;
  double max_range_m = std::numeric_limits<double>::infinity();  ///< as FieldOptions::max_range_m
};

struct SampledField {
  FractionField field;  ///< shares are multiples of 1 / samples
  RenderDevice device;
  std::string device_note;  ///< why the CPU is used instead of a graphics processor; may be empty
};

/// Points of the target, raised as it is (scene frame, metres): `count` of them, by area over all parts, the same for
/// the same target. They are points of the sequence R2 (Roberts, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", 2018), mapped to the triangles of the parts.
VANTAGE_API std::vector<Vec3> target_samples(const PreparedTarget& target, std::size_t count);

/// Where a depth image and the distance of a voxel differ by less than this, in parts of the distance, either may be
/// the nearer: what devices may differ by. It counts as hidden.
inline constexpr double kDepthError = 1e-4;

/// What PointQuery::fraction_field computes, by area, with an estimate where PointQuery::known_shares leaves the share
/// open: the part of the samples that sees the voxel's centre. A depth cube map is made from each sample, and the
/// voxel's distance compared with the depth at the centre of the texel that holds it. So near the border of a shadow a
/// voxel may be taken for one that lies up to half a texel aside (at 512 texels 1.5 mm for each metre of distance).
///
/// All devices look from the same samples. What they may disagree about is a voxel within kDepthError of a surface, and
/// the depth of a texel whose centre is on the edge of a surface, where either side of the edge may be met.
///
/// Throws Error(input) as PointQuery::known_shares, for options out of range, a device that was insisted on and is not
/// there, and a point as a target; Error(cancelled). Uses the threads of the caller's arena. Cost: a depth image of six
/// faces for each sample, and one look-up for each sample and open voxel. Memory: some 16 bytes for each voxel.
VANTAGE_API SampledField estimate_fraction_field(const PreparedTarget& target, const VoxelGrid& grid,
                                                 const SampleOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
