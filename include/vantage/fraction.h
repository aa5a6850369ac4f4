// How much of a target a point sees, and which part of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/devices.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"
#include "vantage/progress.h"
#include "vantage/target.h"

namespace vantage {

/// What the seen part and the whole target are measured by. Of a target in parts the parts add up.
enum class FractionMeasure : std::uint8_t {
  area,         ///< on the target
  solid_angle,  ///< from the point
  /// In the image of a pinhole camera (rectilinear, no distortion) at the point, that looks along the axis of the
  /// narrowest cone about the lines of sight to the target's corners. All of the target is then less than 90 degrees
  /// off that axis, so its image is finite. Of a target in parts the camera turns to each part in turn.
  pixels,
};

/// "area", "solid_angle", "pixels".
VANTAGE_API const char* name_of(FractionMeasure measure);

/// The measure of that name; nothing for other words.
VANTAGE_API std::optional<FractionMeasure> fraction_measure(std::string_view name);

/// A plane polygon with holes in the scene frame, metres. Rings run round once, without repeating their first corner:
/// the outer one counter-clockwise, holes clockwise, seen from the target's front. Rings may touch in points.
struct SeenPolygon {
  std::vector<Vec3> outer;
  std::vector<std::vector<Vec3>> holes;
};

struct FractionOptions {
  FractionMeasure measure = FractionMeasure::area;
  bool with_polygons = false;  ///< fill PointFraction::seen too; takes about as long again
};

/// What a point sees of a target.
struct PointFraction {
  /// 0 to 1. Exactly 1 where PointAnswer names nothing that hides some of the target (`blocked_by`), and the point is
  /// in front of all parts (`behind_target`); below 1 everywhere else. Range and navigation limits play no role.
  double fraction = 0;
  std::vector<SeenPolygon> seen;  ///< as asked for; the parts of the target in their order. Nothing for a single point
};

/// The seen parts of a target as GeoJSON (RFC 7946): a collection of one feature for each point, written as they come.
/// Positions are longitude, latitude (WGS 84, degrees) and the z of the scene. Without a place on the earth they are x,
/// y and z of the scene frame, metres, which the RFC leaves to agreement; "coordinate_frame" says which of the two.
class VANTAGE_API SeenGeoJson {
 public:
  explicit SeenGeoJson(std::optional<Georeference> place, FractionMeasure measure)
      : place_(std::move(place)), measure_(measure) {}

  /// Before the first feature, and after the last.
  std::string beginning() const;
  std::string end() const;

  /// A Polygon, a MultiPolygon, or no geometry where nothing is seen. Properties: "index", the number of the point from
  /// 0, "measure" and "fraction". `id`: the feature's, where it is given. Throws Error(input) for a polygon that is not
  /// on the earth.
  std::string feature(const PointFraction& answer, const std::optional<std::string>& id = std::nullopt);

 private:
  std::optional<Georeference> place_;
  FractionMeasure measure_;
  std::size_t count_ = 0;
};

// ---- How much of a target is seen from each voxel of a box

/// A box of cubes with edges along the axes of the scene frame. Arrays of one value for each voxel run along x first,
/// then y, then z: [(k * count[1] + j) * count[0] + i].
struct VoxelGrid {
  Vec3 low = Vec3::Zero();                       ///< lowest corner of the first voxel, metres
  double step_m = 1;                             ///< edge of a voxel
  std::array<std::size_t, 3> count = {1, 1, 1};  ///< voxels along x, y and z

  std::size_t size() const { return count[0] * count[1] * count[2]; }
  /// Of the centre of voxel `index` along `axis`, 0 to 2.
  double centre(int axis, std::size_t index) const { return low[axis] + step_m * (static_cast<double>(index) + 0.5); }
  Vec3 centre(std::size_t i, std::size_t j, std::size_t k) const { return {centre(0, i), centre(1, j), centre(2, k)}; }
};

/// Throws Error(input) for a grid without voxels, with more than 2^31 of them, with an edge that is not positive and
/// finite, or with a corner that is not finite or farther than 1e9 m from the origin.
VANTAGE_API void check_grid(const VoxelGrid& grid);

/// What holds for every point of a voxel.
enum class KnownShare : std::uint8_t {
  unknown,
  none,   ///< nothing of the target is seen: it is hidden, or the voxel is behind it
  whole,  ///< nothing hides any of it
};

struct FieldOptions {
  FractionMeasure measure = FractionMeasure::area;
  /// The share is 0 where a point of the target is farther from the voxel's centre than this, metres.
  double max_range_m = std::numeric_limits<double>::infinity();
};

struct FractionField {
  VoxelGrid grid;
  std::vector<double> shares;  ///< 0 to 1, for the centre of each voxel
  std::size_t evaluated = 0;   ///< voxels whose share was found by looking from their centre
};

// ---- How much of a target is seen from each voxel of a box, estimated from depth images

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
