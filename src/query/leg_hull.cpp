#include "query/leg_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "target/numerics.h"

namespace vantage::internal::query {
namespace {

/// With more corners a target is taken for a rectangle that holds it.
constexpr std::size_t kMostCorners = 6;

std::vector<Eigen::Vector2d> outline_of(const target::LocalTarget& target) {
  if (target.vertices.size() <= kMostCorners) return target.vertices;
  Eigen::Vector2d low = target.vertices[0], high = low;
  for (const Eigen::Vector2d& vertex : target.vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

}  // namespace

LegHull::LegHull(const Side& side, const Leg& leg, double radius)
    : from_(leg.from - side.scene.origin), to_(leg.to - side.scene.origin), radius_(radius) {
  const Vec3 centre = side.frame.origin - side.scene.origin;
  const double farthest = std::max((from_ - centre).norm(), (to_ - centre).norm()) + radius + side.target.radius;
  // Blockers whose planes are eased hide more than the polygon does, by this part of the distance: so may one beside
  // the hull.
  const double room = 2 * numerics::kGrazing * farthest + 2 * side.target.slack +
                      32 * std::numeric_limits<double>::epsilon() * (leg.from.norm() + leg.to.norm());
  for (const Eigen::Vector2d& t : outline_of(side.target)) {
    target_.push_back(centre + side.frame.axis_u * t.x() + side.frame.axis_v * t.y());
  }
  for (int axis = 0; axis < 3; ++axis) add(Vec3::Unit(axis), room);
  add(side.frame.normal, room);
  Slab& in_front = slabs_.back();
  in_front.low = std::max(in_front.low, side.frame.normal.dot(centre) - room);
  for (std::size_t i = 0; i < target_.size(); ++i) {
    const Vec3 &corner = target_[i], edge = target_[(i + 1) % target_.size()] - corner;
    add(edge.cross(from_ - corner), room);
    add(edge.cross(to_ - corner), room);
    add((to_ - from_).cross(corner - from_), room);
  }
}

void LegHull::add(const Vec3& normal, double room) {
  const double length = normal.norm();
  if (!(length > 0)) return;
  const Vec3 unit = normal / length;
  const auto [low, high] = std::minmax({unit.dot(from_), unit.dot(to_)});
  Slab slab{unit, unit.cwiseAbs(), low - radius_, high + radius_};
  for (const Vec3& corner : target_) {
    slab.low = std::min(slab.low, unit.dot(corner));
    slab.high = std::max(slab.high, unit.dot(corner));
  }
  slab.low -= room;
  slab.high += room;
  slabs_.push_back(slab);
}

bool LegHull::may_meet(const core::Bounds& bounds) const {
  const Vec3 low(bounds.min[0], bounds.min[1], bounds.min[2]), high(bounds.max[0], bounds.max[1], bounds.max[2]);
  const Vec3 centre = 0.5 * (low + high), half = 0.5 * (high - low);
  return std::none_of(slabs_.begin(), slabs_.end(), [&](const Slab& slab) {
    const double at = slab.normal.dot(centre), reach = slab.size.dot(half);
    return at - reach > slab.high || at + reach < slab.low;
  });
}

bool LegHull::may_meet(std::span<const Vec3> corners) const {
  return std::none_of(slabs_.begin(), slabs_.end(), [&](const Slab& slab) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& corner : corners) {
      const double at = slab.normal.dot(corner);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    return low > slab.high || high < slab.low;
  });
}

}  // namespace vantage::internal::query
