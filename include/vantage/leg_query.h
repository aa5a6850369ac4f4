// Exact answers along straight legs of a flight: from where all of a target is seen, which limits are broken, and how
// near the scene is.
//
// A leg may be taken with a tube: all positions within `radius_m` of it (acceptance radius, wind, position error). What
// is said then holds for every position in the tube. Nothing is sampled: what one polygon hides is convex, so it takes
// away one interval of the leg (docs/theory.md, "What one polygon blocks is convex"), and so does each convex limit.
// Grown by a ball it is convex still.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vantage/constraints.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/prepared_target.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage {

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
  std::vector<LegInterval> seen;      ///< from there, and from all of the tube, all of the target is seen, within
                                      ///< range and from the front
  std::vector<LegBlocker> hidden_by;  ///< by object; where some of the tube is in front and may be in range
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
  /// be free, or not, or the part is at most 1 mm long: then it counts as not free where a way over the scene is at most
  /// 2 mm too long for the zone. A tube counts as not free where it is at most 2 `radius_m` too long for the zone of a
  /// position of the leg: where it is longer, no vehicle in the tube has anything in its zone.
  ///
  /// Cost: what of the scene's hierarchy meets the convex hull of the leg, as far as it is in range, and the target.
  /// Throws Error(input) for a leg that is not finite or farther than 1e9 m from the origin of the scene frame, and for
  /// a radius that is negative or not finite.
  LegView look(const Leg& leg, double radius_m = 0) const;

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
};

/// What of the scene is nearest to a leg.
struct LegDistance {
  double distance_m = std::numeric_limits<double>::infinity();  ///< infinite where nothing is within the cut-off
  double share = 0;                                             ///< where on the leg, 0 to 1
  Vec3 point = Vec3::Zero();                                    ///< of the scene, scene frame
  std::uint32_t object = 0;                                     ///< of the scene; its display_name:
  std::string name = {};                                        ///< empty where nothing is within the cut-off
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
  std::vector<bool> is_left_out_;  // by object
};

}  // namespace vantage
