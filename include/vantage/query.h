// Point queries against the exact visibility of a target, without a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/fraction.h"
#include "vantage/geometry.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
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
  /// Limits that the point breaks: "altitude min", "agl max", "ground edge", "keep_in" (it is in none of these
  /// zones), "keep_out zone 1", "keep_out zone NAME", "mesh NAME", "clearance"; of the sensor "min_range", "incidence",
  /// "pixel", "frame", "gimbal", "sun".
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

// ---- Exact answers along straight legs of a flight
//
// A leg may be taken with a tube: all positions within `radius_m` of it (acceptance radius, wind, position error). What
// is said then holds for every position in the tube. Nothing is sampled: what one polygon hides is convex, so it takes
// away one interval of the leg (docs/theory.md, "What one polygon blocks is convex"), and so does each convex limit.
// Grown by a ball it is convex still.

/// A straight piece of a flight.
struct Leg {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< scene frame, metres; may be the same point
};

/// A part of a leg, in shares of its length: 0 at its beginning, 1 at its end. Closed.
struct LegInterval {
  double begin = 0, end = 0;  ///< 0 <= begin <= end <= 1

  bool operator==(const LegInterval&) const = default;
};

/// An object of the scene that hides part of the target, or enters the zone of a link, and from where on the leg.
struct LegBlocker {
  std::uint32_t object = 0;  ///< of the scene
  std::string name;          ///< display_name of it
  std::vector<LegInterval> intervals;
};

/// What is seen of a target along a leg. All lists of intervals are sorted, and disjoint.
struct LegView {
  std::vector<LegInterval> seen;           ///< from there, and from all of the tube, all of the target is seen, within
                                           ///< range and from the front
  std::vector<LegBlocker> hidden_by;       ///< by object; where some of the tube is in front and may be in range
  std::vector<LegInterval> out_of_range;   ///< some of the tube is
  std::vector<LegInterval> behind_target;  ///< some of the tube is; never for a point that is seen from all sides
};

/// Of a leg and several targets of which one is enough: seen where one of them is. Elsewhere it says what hides any of
/// them; out of range and behind only where that holds for all. At least one view; all of one scene.
VANTAGE_API LegView any_of(std::span<const LegView> views);

/// Of a leg from which all targets must be seen: what is wrong with any is wrong. At least one view.
VANTAGE_API LegView all_of(std::span<const LegView> views);

/// Tells from where on legs all of a target is seen. Immutable after it is made: any number of threads may ask.
class VANTAGE_API LegViews {
 public:
  /// A target in parts is seen where all its parts are. Holds on to the target and its scene. Throws
  /// Error(not_applicable) for a VisibleShare of less than 1: from where enough is seen is no matter of one interval
  /// for each polygon.
  explicit LegViews(const PreparedTarget& target);

  /// For lists of targets as ViewsQuery has them: all_of the lists, and any_of the targets of each. Throws Error(input)
  /// for no list and for a list without targets.
  explicit LegViews(const std::vector<std::vector<PreparedTarget>>& views);
  ~LegViews();
  LegViews(LegViews&&) noexcept;
  LegViews& operator=(LegViews&&) noexcept;

  /// For the tube of `radius_m` >= 0 about the leg.
  ///
  /// Errs on the safe side: what touches within rounding hides, is out of range, or is behind. So `seen` is shorter
  /// than what is seen exactly, never longer, but for what compute_visibility excepts from its guarantee
  /// (docs/theory.md, "What is guaranteed, and what is not"). What a polygon hides is grown by 1e-10 of its planes'
  /// distance from the target's centre, by the slack w of that page, by 8 roundings of the largest coordinate of the
  /// leg, and where it is nearly in the target's plane by a millionth of the distance, as volumes are. At a leg that
  /// meets a border at an angle a, this moves the border by so much over sin a.
  ///
  /// The grown shape of a polygon is exact (its corners and edges are round): it is approached from outside by
  /// tangent planes, until it is met to 1e-12 of the distance.
  ///
  /// With a link (Sensor::link) the zone has no such intervals. The leg is halved until all its positions are known to
  /// be free, or not, or the part is at most 1 mm long, and 1e-5 of the leg: then it counts as not free where a way
  /// over the scene is at most twice that too long for the zone. A tube counts as not free where a way is at most
  /// 2 `radius_m` too long for the zone of a position of the leg: where none is, no vehicle in the tube has anything in
  /// its zone.
  ///
  /// Cost: what of the scene's hierarchy meets the convex hull of the leg, as far as it is in range, and the target.
  /// Throws Error(input) for a leg that is not finite or farther than 1e9 m from the origin of the scene frame, and for
  /// a radius that is negative or not finite.
  LegView look(const Leg& leg, double radius_m = 0, const Progress& progress = {}) const;

  /// The same for many legs, in their order. Uses the threads of the caller's arena. Error(cancelled) when told to
  /// stop.
  std::vector<LegView> look(std::span<const Leg> legs, double radius_m = 0, const Progress& progress = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// What LegDistances leaves out.
struct LegDistanceOptions {
  double cutoff_m = std::numeric_limits<double>::infinity();  ///< what is farther away is not looked for; >= 0
  bool without_ground = false;                                ///< objects of ObjectKind::ground
  std::vector<std::uint32_t> without_objects = {};            ///< indices of objects of the scene
  bool without_overhead = false;                              ///< Scene::overhead
};

/// What of the scene is nearest to a leg.
struct LegDistance {
  double distance_m = std::numeric_limits<double>::infinity();  ///< infinite where nothing is within the cut-off
  double share = 0;                                             ///< where on the leg, 0 to 1
  Vec3 point = Vec3::Zero();                                    ///< of the scene, scene frame
  std::uint32_t object = 0;  ///< of the scene; behind all of these, of Scene::overhead. Its display_name:
  std::string name = {};     ///< empty where nothing is within the cut-off
};

/// Measures how near legs come to the surfaces of a scene. Immutable: any number of threads may ask.
class VANTAGE_API LegDistances {
 public:
  /// Holds on to the scene. Throws Error(input) for an index of an object out of range, and for a cut-off that is
  /// negative or not a number.
  explicit LegDistances(const PreparedScene& scene, const LegDistanceOptions& options = {});

  /// The smallest distance of any point of the leg from any point of the scene's polygons; 0 where they meet, also
  /// inside of solids at their surface only. The distance is not more than the true one, and less by at most twice
  /// what rounding may do: 16 roundings of the largest coordinate, and what merged triangles may be out of one plane
  /// (a nanometre, 2^-46 of the scene's size). Of several at the same distance, any, always the same. What preparing
  /// dropped (triangles without width, docs/theory.md) is not met.
  ///
  /// Nearest first through the scene's hierarchy. Throws Error(input) as LegViews::look.
  LegDistance nearest(const Leg& leg) const;

  /// The same for many legs, in their order. Uses the threads of the caller's arena. Error(cancelled) when told to
  /// stop.
  std::vector<LegDistance> nearest(std::span<const Leg> legs, const Progress& progress = {}) const;

 private:
  PreparedScene scene_;
  double cutoff_m_;
  bool with_overhead_;
  std::vector<bool> is_left_out_;  // by object
};

/// A limit that is broken along a leg, and by how much.
struct LegBreak {
  enum class Unit { metres, degrees };

  std::string limit;                   ///< as PointAnswer::outside_of names it
  std::vector<LegInterval> intervals;  ///< where some position of the tube breaks it; sorted, disjoint, at least one
  double worst = 0;                    ///< by how much at worst; see LegLimits
  Unit unit = Unit::metres;
  double worst_share = 0;  ///< where on the leg that is
};

/// The parts of a leg where nothing is broken.
VANTAGE_API std::vector<LegInterval> kept_parts(std::span<const LegBreak> broken);

/// Tells where legs break limits: those of navigation, and those of a target's sensor besides its range. That, with a
/// pixel of PixelLimit::Kind::perpendicular, is a matter of LegViews. Immutable after it is made: any number of threads
/// may ask.
///
/// Borders are allowed, as everywhere, where rounding can tell: heights and boxes are compared as they are. Else what
/// is within a few roundings of a border may be taken for either side.
///
/// - "altitude min", "altitude max", "keep_in", "keep_out zone 2", "mesh NAME", "agl min", "agl max", "ground edge" (in
///   plan) and "clearance" are exact: intervals of linear functions, and of distances from convex pieces, which are
///   convex along the leg. So are "min_range", "incidence", "pixel" and "sun", and the "frame" and "gimbal" of a fixed
///   camera. Ends are right to rounding.
/// - "frame" and "gimbal" of a camera that turns: the leg is halved until one orientation does for all of a part, or
///   none for any of it, or it is at most 1 mm long, and 1e-5 of the leg: then it counts as broken, as does what is
///   left after 20,000 pieces, of a leg along the picture's border. Each position of a tube may have its own
///   orientation; cubes in the tube are divided down to a 32nd of its radius, and the leg as finely. A cube, and a
///   part of the leg, for which no single orientation is found counts as broken.
///
/// A tube breaks "keep_in" where no single one of these zones holds all of it, also where two that touch do so
/// together. Of a zone of `keep_out` with heights above ground it counts as in it where it comes near enough to
/// its plan, to its heights and to where there is ground, each by itself: more than exact, never less.
///
/// `worst`: for the middle of the tube, plus what the radius adds. Metres: how far it is past the limit (of zones,
/// boxes and meshes to leave: how far into them, or out of them; heights vertically; "pixel": beyond the ball that
/// keeps it; "ground edge": in plan from the ground). Degrees: "incidence", "sun", and of "frame" and "gimbal" how far
/// at least a corner of the target is out of the picture. The radius adds itself, or the angle that it subtends at
/// the nearest corner. It is searched for among 17 places of each interval and about the best of these; that of a
/// picture to a hundredth of a degree.
class VANTAGE_API LegLimits {
 public:
  /// Of navigation alone. Throws as check_navigation.
  explicit LegLimits(const Navigation& navigation);
  /// And of the target's sensor. Holds on to nothing of the target.
  LegLimits(const PreparedTarget& target, const Navigation& navigation);
  ~LegLimits();
  LegLimits(LegLimits&&) noexcept;
  LegLimits& operator=(LegLimits&&) noexcept;

  /// What is broken, in the order of PointAnswer::outside_of. Throws Error(input) as LegViews::look. Cost: linear in
  /// the corners of zones whose boxes are near, and in the triangles near the leg; a camera that turns some
  /// milliseconds.
  std::vector<LegBreak> broken(const Leg& leg, double radius_m = 0, const Progress& progress = {}) const;

  /// The same for many legs, in their order. Uses the threads of the caller's arena. Error(cancelled) when told to
  /// stop.
  std::vector<std::vector<LegBreak>> broken(std::span<const Leg> legs, double radius_m = 0,
                                            const Progress& progress = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace vantage
