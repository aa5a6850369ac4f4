#include "target/column.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/walk_bvh.h"

namespace vantage::internal::target {

Column::Column(const PreparedScene::Data& scene, const TargetFrame& frame, const Lengths& lengths, double floor)
    : scene_(scene),
      frame_(frame),
      lengths_(lengths),
      target_(make_local_target(frame.polygon, lengths.slack, lengths.rounding)),
      floor_(floor) {}

std::vector<Crossing> Column::crossings(double ceiling) {
  std::vector<Crossing> found;
  core::walk_bvh(
      scene_.bvh, [&](const core::BvhNode& node) { return meets(node.bounds, ceiling); },
      [&](std::uint32_t polygon) { add_crossing(polygon, ceiling, found); });
  return found;
}

bool Column::meets(const core::Bounds& bounds, double ceiling) const {
  const Vec3 centre = frame_.origin - scene_.origin;
  std::array<Vec3, 8> corners;
  double lowest = INFINITY, highest = -INFINITY;
  for (int i = 0; i < 8; ++i) {
    Vec3 corner;
    for (int a = 0; a < 3; ++a) corner[a] = (i >> a & 1 ? bounds.max[a] : bounds.min[a]) - centre[a];
    corners[i] = {frame_.axis_u.dot(corner), frame_.axis_v.dot(corner), frame_.normal.dot(corner)};
    lowest = std::min(lowest, corners[i].z());
    highest = std::max(highest, corners[i].z());
  }
  if (lowest > ceiling || highest <= floor_) return false;
  for (const LocalTarget::Edge& edge : target_.edges) {
    const bool outside = std::all_of(corners.begin(), corners.end(),
                                     [&](const Vec3& c) { return edge.outward.dot(c.head<2>()) >= edge.distance; });
    if (outside) return false;
  }
  return true;
}

void Column::add_crossing(std::uint32_t polygon, double ceiling, std::vector<Crossing>& found) {
  local_polygon(scene_, frame_, polygon, clipped_.corners);
  const bool stands =
      std::any_of(clipped_.corners.begin(), clipped_.corners.end(), [this](const Vec3& c) { return c.z() > floor_; });
  if (!stands) return;
  clipped_.makers.assign(clipped_.corners.size(), 0);
  for (const LocalTarget::Edge& edge : target_.edges) {
    core::clip_facet(clipped_, {-edge.outward.x(), -edge.outward.y(), 0}, lengths_.slack - edge.distance, 0, 0,
                     scratch_);
    if (clipped_.empty()) return;
  }
  Crossing crossing{INFINITY, -INFINITY, polygon, {}};
  for (const Vec3& c : clipped_.corners) {
    if (c.z() < crossing.low) {
      crossing.low = c.z();
      crossing.place = c;
    }
    crossing.high = std::max(crossing.high, c.z());
  }
  if (crossing.high > std::min(floor_, -lengths_.clear) && crossing.low <= ceiling) found.push_back(crossing);
}

Lift lift_at(const std::vector<Crossing>& crossings, double height, const Lengths& lengths) {
  Lift result;
  for (const Crossing& c : crossings) {
    if (c.high > height - lengths.clear && c.high <= height + lengths.lift) {
      result.lift = std::max(result.lift, c.high + lengths.clear - height);
    }
  }
  for (const Crossing& c : crossings) {
    if (!result.pierced_by && crosses(c, height + result.lift, lengths)) result.pierced_by = &c;
  }
  return result;
}

// A step is at most half of what the target may be raised: one that is short of clearing a surface then lies on it.
HeightStep::HeightStep(const Lengths& lengths)
    : decimals(std::max(3, static_cast<int>(std::ceil(-std::log10(lengths.lift / 2) - 1e-9)))) {}

double HeightStep::past(double height) const {
  const double steps = std::pow(10, decimals);
  return std::floor(height * steps + 1) / steps;
}

double clear_height(const std::vector<Crossing>& crossings, const Lengths& lengths, double from) {
  const HeightStep step(lengths);
  for (double height = from;;) {
    const Lift lift = lift_at(crossings, height, lengths);
    if (!lift.pierced_by) return height;
    height = step.past(lift.pierced_by->high);
  }
}

}  // namespace vantage::internal::target
