// One side of a target, and what it has learned of the scene: what all questions about points share.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/walk_bvh.h"
#include "exact/segment_cover.h"
#include "query/blocker_index.h"
#include "query/limits.h"
#include "query/link_query.h"
#include "scene/prepared_data.h"
#include "target/local_target.h"
#include "target/prepared_target_data.h"
#include "target/range_region.h"

namespace vantage::internal::query {

/// What blocks from points up to some distance.
struct Reach {
  double metres = std::numeric_limits<double>::infinity();  ///< from the target's centre
  std::unique_ptr<BlockerIndex> index;                      ///< once it pays
  std::vector<std::uint32_t> leaves;  ///< that the index is to hold; found when it is first thought of
  std::size_t polygons = 0;           ///< in them
  std::atomic<std::size_t> work = 0;  ///< blockers built without the index
};

/// A point as seen from the target's centre.
struct Bearing {
  Vec3 direction = Vec3::Zero();  ///< local, unit length; zero at the centre
  double distance = 0;
  bool in_front = false, in_range = false;
};

/// What one side of a target asks of the scene; shared by all threads.
struct Side {
  /// `range_region` is about the frame's origin.
  Side(const PreparedScene::Data& scene_data, const Limits& navigation, const TargetFrame& target_frame,
       const target::RangeRegion& range_region, double max_range, bool reachable);

  const PreparedScene::Data& scene;
  const Limits& limits;
  TargetFrame frame;
  target::LocalTarget target;
  target::RangeRegion range;
  bool is_reachable;  // else no point at all is in range
  std::array<Reach, 2> reaches;
  std::optional<LinkQuery> link;  ///< instead of the line of sight

  Bearing bearing_of(const Vec3& scene_point) const;
  bool is_behind(const Bearing& bearing) const { return !frame.all_sides && !bearing.in_front; }

  /// All that may hide the target from points along `direction` (local, unit length), up to `farthest` metres, is here.
  Reach& reach_for(double farthest) { return reaches[farthest <= reaches[0].metres ? 0 : 1]; }
  /// And overlaps this box, which is relative to the scene's origin.
  Box pyramid(const Vec3& direction, double farthest) const;

  /// The indexes are made as soon as building blockers for single points has cost as much: so no one who asks about a
  /// few points waits for them, and no one pays much more than the cheaper of the two. Not while points are answered.
  void consider_indexes();

  /// The index of what may block from points up to `farthest` metres, made now if it is not there. Not while points are
  /// answered.
  const BlockerIndex& index_for(double farthest);

 private:
  Box box_within(double metres) const;
  void find_leaves(Reach& reach) const;
  void make_index(Reach& reach) const;
  void consider_index(Reach& reach) const;
};

using Sides = std::vector<std::unique_ptr<Side>>;

/// One side; both of a point that is seen from all sides, the front first.
Sides make_sides(const PreparedTarget::Data& target, const PreparedTarget::Data::Part& part, const Limits& limits);

bool overlap(const core::Bounds& bounds, const Box& box);

/// Calls visit(polygon) for the polygons of the leaves that overlap a box relative to the scene's origin.
template <typename Visit>
void for_each_polygon(const PreparedScene::Data& scene, const Box& box, const Visit& visit) {
  core::walk_bvh(
      scene.bvh, [&](const core::BvhNode& node) { return overlap(node.bounds, box); }, visit);
}

/// Whether a blocker hides some of the target from the point at `distance` along `direction`. It does from what is
/// behind all of its planes; each is sure to its own rounding, which of a plane that passes the centre of a thin target
/// within nanometres is wide.
inline bool hides(std::span<const core::Plane> planes, const Vec3& direction, double distance) {
  return std::all_of(planes.begin(), planes.end(), [&](const core::Plane& plane) {
    return plane.dot(direction) * distance > 1 + exact::tie_margin(plane, distance);
  });
}

/// Calls look(side, i) for every point, with the side of the target that it is on, on any thread. In portions that
/// grow, as what the first ones cost decides about the indexes.
template <typename Look>
void look_from_all(const Sides& sides, std::span<const Vec3> points, const Look& look) {
  for (std::size_t done = 0, portion = 16; done < points.size(); done += portion, portion *= 2) {
    const std::size_t count = std::min(portion, points.size() - done);
    parallel::for_ranges(count, 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = done + begin; i < done + end; ++i) {
        const bool is_behind = sides.size() > 1 && sides[0]->frame.to_local(points[i]).z() < 0;
        look(*sides[is_behind ? 1 : 0], i);
      }
    });
    for (const auto& side : sides) side->consider_indexes();
  }
}

/// Throws Error(input) for a point that is not finite.
void check_finite(std::span<const Vec3> points);

}  // namespace vantage::internal::query
