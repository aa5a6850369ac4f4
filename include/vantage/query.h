// Point queries against the exact visibility of a target, without a mesh.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/fraction.h"
#include "vantage/fraction_field.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/target.h"

namespace vantage {

struct PointAnswer {
  bool inside = false;  ///< the whole target, or the VisibleShare of its sensor, is visible, all of it is in range and
                        ///< looked at from the front, and the point is within the limits
  double margin_m = 0;  ///< signed distance to the volume's boundary along the line to the target's centre, positive
                        ///< inside; navigation limits bound it too, the target itself, where the line ends, does not.
                        ///< Minus infinity where no point of that line is in the volume. NaN with a VisibleShare of
                        ///< less than 1: a line may enter and leave such a volume several times
  std::vector<std::string> blocked_by;  ///< names of the scene objects that hide part of the target, or enter the zone
                                        ///< of a link; sorted, no repeats. With a VisibleShare none where enough is
                                        ///< seen
  bool out_of_range = false;
  bool behind_target = false;  ///< never for a point that is seen from all sides
  /// Limits that the point breaks: "altitude min", "agl max", "ground edge", "boxes" (it is in none of them; "keep_in"
  /// where there are zones too), "keep_out 0", "keep_out zone NAME", "mesh NAME", "clearance"; of the sensor
  /// "min_range", "incidence", "pixel", "frame", "gimbal", "sun".
  std::vector<std::string> outside_of;
};

/// Of a point and several targets of which it must see one whole: inside where it is for one of the targets. Else it
/// says what is wrong with any of them; out of range, behind, and outside of a limit only where that holds for all. The
/// margin is the largest. At least one answer.
VANTAGE_API PointAnswer any_of(std::span<const PointAnswer> answers);

/// Of a point that must see all of them: the margin is the smallest, and what is wrong with any is wrong. At least one.
VANTAGE_API PointAnswer all_of(std::span<const PointAnswer> answers);

/// Answers questions about points, for one target in one scene: as many as there are, in portions of any size. What it
/// learns of the scene with the first points makes the later ones quick: some microseconds each in a city.
class VANTAGE_API PointQuery {
 public:
  /// A target in parts is seen where all its parts are. Holds on to the target and its scene. Throws as
  /// check_navigation.
  explicit PointQuery(const PreparedTarget& target, const Navigation& navigation = {});
  ~PointQuery();
  PointQuery(PointQuery&&) noexcept;
  PointQuery& operator=(PointQuery&&) noexcept;

  /// Answers in the order of the points (scene frame, metres), the same whatever was asked before. With a VisibleShare
  /// inside is where fractions() by area says at least that share. So there are points inside that the volume of
  /// compute_volume lacks: it counts cells of the target that are seen whole. There is no tolerance. What
  /// compute_visibility excepts from its guarantee (vantage/volume.h) is excepted here too: within five roundings of
  /// the largest coordinate of the boundary, a point may be called inside or outside.
  ///
  /// With a link (Sensor::link) the scene is compared with the point's own zone, an ellipsoid. Volumes leave out more
  /// than that (docs/camera.md): so a point may be inside here, and outside of the volume, but never the reverse. Each
  /// point costs two walks of the hierarchy along its line, some ten microseconds in a city.
  ///
  /// Uses the threads of the caller's arena (TBB); not for two callers at once. Cost: for the first points one walk of
  /// the scene's hierarchy each; then, once, O(n) in the polygons within reach of the target; from then on in
  /// proportion to what may hide the target from the point. And a few passes over the triangles of each navigation
  /// mesh. Throws Error(input) for a point that is not finite.
  std::vector<PointAnswer> answer(std::span<const Vec3> points);

  /// How much of the target each point sees, by line of sight alone, in the order of the points; the same whatever was
  /// asked before. Not sampled: the shadows of the scene's polygons on the target's plane are cut out of the target
  /// (docs/theory.md, "How much is seen").
  ///
  /// Of a target in parts: what is seen of all parts over the sum of the parts, where a part whose back the point sees
  /// counts as hidden. A point as a target is seen or not: 1 or 0. Throws Error(input) with a link, whose zone has no
  /// share that is seen.
  ///
  /// Errors: what rounding does to the coordinates of the scene, of the target and of the point (8 roundings of the
  /// largest of them) moves the borders of shadows, the more the farther they are thrown and the more the point looks
  /// along the target. The computation adds a few roundings of the distance between point and target, seen square to
  /// the line of sight, along the borders. Where it cannot tell two borders apart, the seen part between them counts as
  /// hidden.
  ///
  /// Threads, cost and errors thrown as answer(); beyond that, for each point, in proportion to the polygons that hide
  /// some of the target from it, and to the pieces that these leave: in a city some ten microseconds, some milliseconds
  /// where it looks through many gaps.
  std::vector<PointFraction> fractions(std::span<const Vec3> points, const FractionOptions& options = {});

  /// What is known of each voxel without looking from it, in the order of VoxelGrid. It holds for every point of the
  /// voxel; with `max_range_m`, beyond which nothing counts as seen, as FieldOptions says, for its centre alone. Boxes
  /// of voxels are divided until nothing is in the way from any of their points, all of the target is hidden from all
  /// of them, or they are single voxels (docs/theory.md, "How much is seen from a box"). Equal shares at the corners of
  /// a box are no reason not to divide it: so no region is missed, however small.
  ///
  /// Agrees with fractions(), but for what rounding does to the borders of shadows. Threads as answer(). Cost: O(n) in
  /// the polygons within reach for each 32^3 voxels, and for each box that is divided in proportion to what may hide
  /// the target from it. Throws Error(input) as check_grid, for a range that is not positive, and with a link;
  /// Error(cancelled).
  std::vector<KnownShare> known_shares(const VoxelGrid& grid,
                                       double max_range_m = std::numeric_limits<double>::infinity(),
                                       const Progress& progress = {});

  /// The share of the target that is seen from the centre of each voxel: fractions(), where known_shares() leaves it
  /// open. Errors and threads as known_shares(). Memory: 9 bytes for each voxel.
  FractionField fraction_field(const VoxelGrid& grid, const FieldOptions& options = {}, const Progress& progress = {});

 private:
  friend class ViewsQuery;
  struct Data;
  explicit PointQuery(std::unique_ptr<Data> data);
  /// Of limits that have been checked.
  static PointQuery unchecked(const PreparedTarget& target, const Navigation& navigation);

  std::unique_ptr<Data> data_;
};

/// Answers questions about points for all that one volume claims: its positions see, of each list of targets, one whole
/// or more. These are the lists of prepare_views (vantage/mission.h). The only place where answers about several
/// targets become one: all_of the lists, and any_of the targets of each.
class VANTAGE_API ViewsQuery {
 public:
  /// Holds on to the targets and their scene. Throws as check_navigation, and Error(input) for no list and for a list
  /// without targets.
  explicit ViewsQuery(const std::vector<std::vector<PreparedTarget>>& views, const Navigation& navigation = {},
                      const Progress& progress = {});

  /// As PointQuery::answer.
  std::vector<PointAnswer> answer(std::span<const Vec3> points);

  /// The one target, for questions about its share that is seen; null where there are several.
  PointQuery* single();

 private:
  std::vector<std::vector<PointQuery>> views_;
};

/// PointQuery for one portion of points.
VANTAGE_API std::vector<PointAnswer> query_points(const PreparedTarget& target, const Navigation& navigation,
                                                  const std::vector<Vec3>& points);

}  // namespace vantage
