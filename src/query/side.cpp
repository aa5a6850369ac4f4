#include "query/side.h"

#include <cmath>
#include <string>

#include "target/lengths.h"
#include "vantage/error.h"

namespace vantage::internal::query {
namespace {

/// Squares of larger coordinates may overflow.
constexpr double kSquarable = 1e150;

target::LocalTarget local_target(const PreparedScene::Data& scene, const TargetFrame& frame, double max_range) {
  const target::Lengths lengths = target::lengths_of(scene, frame, max_range);
  return target::make_local_target(frame.polygon, lengths.slack, lengths.rounding);
}

/// The leaves of the hierarchy that overlap a box.
std::vector<std::uint32_t> leaves_in(const PreparedScene::Data& scene, const Box& box) {
  std::vector<std::uint32_t> leaves;
  const auto enter = [&](const core::BvhNode& node) {
    if (!overlap(node.bounds, box)) return false;
    if (node.leaf()) leaves.push_back(static_cast<std::uint32_t>(&node - scene.bvh.nodes.data()));
    return !node.leaf();
  };
  core::walk_bvh(scene.bvh, enter, [](std::uint32_t) {});
  return leaves;
}

}  // namespace

bool overlap(const core::Bounds& bounds, const Box& box) {
  bool apart = false;
  for (int a = 0; a < 3; ++a) apart = apart || bounds.min[a] > box.max[a] || bounds.max[a] < box.min[a];
  return !apart;
}

Side::Side(const PreparedScene::Data& scene_data, const Limits& navigation, const TargetFrame& target_frame,
           const target::RangeRegion& range_region, double max_range, bool reachable)
    : scene(scene_data),
      limits(navigation),
      frame(target_frame),
      target(local_target(scene_data, target_frame, max_range)),
      range(range_region),
      is_reachable(reachable) {
  // All that is in range is this near to the centre, which is a mean of the target's vertices.
  reaches[0].metres = range.radius() * (1 + 1e-9);
}

Bearing Side::bearing_of(const Vec3& scene_point) const {
  const double largest = scene_point.cwiseAbs().maxCoeff();
  if (largest < kSquarable) {
    const Vec3 point = frame.to_local(scene_point);
    const double distance = point.norm();
    return {distance > 0 ? Vec3(point / distance) : Vec3(Vec3::Zero()), distance, point.z() > 0,
            is_reachable && range.contains(point)};
  }
  // So far away the centre is where the origin is.
  const Vec3 unit = scene_point / largest;
  const Vec3 direction = Vec3(frame.axis_u.dot(unit), frame.axis_v.dot(unit), frame.normal.dot(unit)).normalized();
  return {direction, std::min(unit.norm() * largest, std::numeric_limits<double>::max()), direction.z() > 0, false};
}

Box Side::pyramid(const Vec3& direction, double farthest) const {
  Box box;
  box.extend(Vec3(frame.to_scene(direction * farthest) - scene.origin));
  for (const auto& t : target.vertices) box.extend(Vec3(frame.to_scene({t.x(), t.y(), 0}) - scene.origin));
  return box;
}

/// A box of all that may hide the target from points within reach. Relative to the scene's origin.
Box Side::box_within(double metres) const {
  Box box;
  for (const auto& t : target.vertices) box.extend(Vec3(frame.to_scene({t.x(), t.y(), 0}) - scene.origin));
  const double room = metres * (1 + 1e-6) + 1e-6 + 1e-12 * frame.origin.norm();
  box.extend(Vec3(frame.origin - scene.origin - Vec3::Constant(room)));
  box.extend(Vec3(frame.origin - scene.origin + Vec3::Constant(room)));
  return box;
}

void Side::find_leaves(Reach& reach) const {
  if (!reach.leaves.empty()) return;
  reach.leaves = leaves_in(scene, box_within(reach.metres));
  for (const std::uint32_t leaf : reach.leaves) reach.polygons += scene.bvh.nodes[leaf].count;
}

void Side::make_index(Reach& reach) const {
  reach.index = std::make_unique<BlockerIndex>(scene, frame, target, reach.leaves, reach.metres);
}

void Side::consider_index(Reach& reach) const {
  constexpr std::size_t kLittle = 1000;  // blockers, about a millisecond
  if (reach.index || reach.work < kLittle) return;
  find_leaves(reach);
  if (reach.work >= reach.polygons) make_index(reach);
}

const BlockerIndex& Side::index_for(double farthest) {
  Reach& reach = reach_for(farthest);
  if (!reach.index) {
    find_leaves(reach);
    make_index(reach);
  }
  return *reach.index;
}

void Side::consider_indexes() {
  for (Reach& reach : reaches) consider_index(reach);
}

Sides make_sides(const PreparedTarget::Data& target, const PreparedTarget::Data::Part& part, const Limits& limits) {
  const PreparedScene::Data& scene = target.scene.data();
  const double max_range = range_limit_m(target.sensor);
  Sides result;
  if (part.sides) {
    const target::PointSides& sides = *part.sides;
    const target::RangeRegion range(part.frame.polygon, max_range);  // of the point, not of the triangle for it
    result.push_back(std::make_unique<Side>(scene, limits, sides.front, range, max_range, true));
    if (sides.back) result.push_back(std::make_unique<Side>(scene, limits, *sides.back, range, max_range, true));
    if (target.sensor.link) {
      for (auto& side : result) side->link.emplace(scene, side->frame.origin, *target.sensor.link);
    }
    return result;
  }
  // Where no point at all is in range the centre may be out of range itself: look from the circle's centre, as the
  // engine does.
  const target::RangeRegion range(part.frame.polygon,
                                  part.is_reachable ? max_range : 2 * part.frame.enclosing_radius_m);
  result.push_back(std::make_unique<Side>(scene, limits, part.frame, range, max_range, part.is_reachable));
  return result;
}

void check_finite(std::span<const Vec3> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) continue;
    throw Error(ErrorCode::coordinate_not_finite, "a coordinate is not finite", "point " + std::to_string(i),
                "give three numbers");
  }
}

}  // namespace vantage::internal::query
