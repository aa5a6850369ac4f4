#include "query/link_query.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/bounds_distance.h"
#include "core/walk_bvh.h"
#include "target/fresnel_zone.h"

namespace vantage::internal::query {
namespace {

/// What enters the zone by less than this part of its radius touches it.
constexpr double kTouch = 1e-9;

/// The point of a convex polygon that is nearest to the origin.
Vec3 nearest_to_origin(const std::vector<Vec3>& corners) {
  Vec3 nearest = corners[0];
  const auto take = [&](const Vec3& point) {
    if (point.squaredNorm() < nearest.squaredNorm()) nearest = point;
  };
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &from = corners[i], &to = corners[(i + 1) % corners.size()];
    const Vec3 side = to - from;
    const double length = side.squaredNorm();
    take(length > 0 ? Vec3(from + std::clamp(-from.dot(side) / length, 0.0, 1.0) * side) : from);
    if (i > 0) normal += (from - corners[0]).cross(to - corners[0]);
  }
  if (!(normal.squaredNorm() > 0)) return nearest;
  const Vec3 foot = normal * (normal.dot(corners[0]) / normal.squaredNorm());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &from = corners[i], &to = corners[(i + 1) % corners.size()];
    if (normal.dot((to - from).cross(foot - from)) < 0) return nearest;
  }
  take(foot);
  return nearest;
}

/// The zone of one position; coordinates are about the antenna. The map makes a ball of radius 1 of it.
class LinkEllipsoid {
 public:
  LinkEllipsoid(const Vec3& direction, double distance, double excess)
      : direction_(direction),
        distance_(distance),
        excess_(excess),
        half_length_(0.5 * (distance + excess)),
        radius_(0.5 * std::sqrt(excess * (2 * distance + excess))) {}

  bool may_meet(const core::Bounds& bounds, const Vec3& antenna) const {
    const Vec3 vehicle = antenna + distance_ * direction_;
    const double sum = core::distance_to(bounds, antenna) + core::distance_to(bounds, vehicle);
    return sum < (distance_ + excess_) * (1 + 1e-12);
  }

  Vec3 mapped(const Vec3& point) const {
    const double along = direction_.dot(point);
    return (along - 0.5 * distance_) / half_length_ * direction_ + (point - along * direction_) / radius_;
  }
  Vec3 original(const Vec3& point) const {
    const double along = direction_.dot(point);
    return (along * half_length_ + 0.5 * distance_) * direction_ + (point - along * direction_) * radius_;
  }

  static LinkEllipsoid of(const Vec3& vehicle, double excess) {
    const double distance = vehicle.norm();
    return {distance > 0 ? Vec3(vehicle / distance) : Vec3(Vec3::UnitZ()), distance, excess};
  }

  static bool holds(const Vec3& mapped) { return mapped.squaredNorm() < 1 - 2 * kTouch; }

 private:
  Vec3 direction_;
  double distance_, excess_, half_length_, radius_;
};

class MappedPolygon {
 public:
  MappedPolygon(const PreparedScene::Data& scene, const Vec3& antenna) : scene_(scene), antenna_(antenna) {}

  /// The place on the map of the polygon's point that is deepest in the zone.
  Vec3 deepest(std::uint32_t polygon, const LinkEllipsoid& zone) {
    corners_.clear();
    for (const std::uint32_t vertex : scene_.corners_of(polygon)) {
      corners_.push_back(zone.mapped(scene_.vertices[vertex] - antenna_));
    }
    return nearest_to_origin(corners_);
  }

 private:
  const PreparedScene::Data& scene_;
  const Vec3& antenna_;
  std::vector<Vec3> corners_;
};

}  // namespace

LinkQuery::LinkQuery(const PreparedScene::Data& scene, const Vec3& antenna, const RadioLink& link)
    : scene_(scene), antenna_(antenna - scene.origin), excess_(target::zone_excess_m(link)) {}

// A point b at d from the antenna is on the border of the zone of the position at t where t = e (2 d - e) / (2 (b . u -
// d + e)). For the deepest point of a polygon that t is less than the one that it was found for; from step to step the
// excess at the deepest point goes to 0 as in Newton's method, from above.
double LinkQuery::reach(const Vec3& direction, double farthest) const {
  constexpr int kMostSteps = 60;
  double reach = farthest;
  MappedPolygon mapped(scene_, antenna_);
  const auto shorten = [&](std::uint32_t polygon) {
    for (int step = 0; step < kMostSteps && reach > 0; ++step) {
      const LinkEllipsoid zone(direction, reach, excess_);
      const Vec3 deepest = mapped.deepest(polygon, zone);
      if (!LinkEllipsoid::holds(deepest)) return;
      const Vec3 b = zone.original(deepest);
      const double d = b.norm(), rest = b.dot(direction) - d + excess_;
      if (2 * d <= excess_) {
        reach = 0;  // it enters the zone of every position
        return;
      }
      const double next = excess_ * (2 * d - excess_) / (2 * rest);
      if (!(rest > 0) || !(next < reach)) return;  // rounding
      reach = next;
    }
  };
  core::walk_nearer_first(
      scene_.bvh, [&](const core::Bounds& bounds) { return core::distance_to(bounds, antenna_); },
      [&](const core::BvhNode& node) {
        return reach > 0 && LinkEllipsoid(direction, reach, excess_).may_meet(node.bounds, antenna_);
      },
      shorten);
  return reach;
}

void LinkQuery::for_each_entering(const Vec3& direction, double distance,
                                  const std::function<void(std::uint32_t)>& visit) const {
  for_each_polygon_entering(distance * direction, 0,
                            [&](std::uint32_t polygon, const Vec3&) { visit(object_of(polygon)); });
}

void LinkQuery::for_each_polygon_entering(const Vec3& vehicle, double more,
                                          const std::function<void(std::uint32_t, const Vec3&)>& visit) const {
  const LinkEllipsoid zone = LinkEllipsoid::of(vehicle, excess_ + more);
  MappedPolygon mapped(scene_, antenna_);
  core::walk_bvh(
      scene_.bvh, [&](const core::BvhNode& node) { return zone.may_meet(node.bounds, antenna_); },
      [&](std::uint32_t polygon) {
        const Vec3 deepest = mapped.deepest(polygon, zone);
        if (LinkEllipsoid::holds(deepest)) visit(polygon, zone.original(deepest));
      });
}

bool LinkQuery::enters(std::uint32_t polygon, const Vec3& vehicle, double more) const {
  const LinkEllipsoid zone = LinkEllipsoid::of(vehicle, excess_ + more);
  return LinkEllipsoid::holds(MappedPolygon(scene_, antenna_).deepest(polygon, zone));
}

double LinkQuery::distance_m(std::uint32_t polygon, const Vec3& from) const {
  std::vector<Vec3> corners;
  for (const std::uint32_t vertex : scene_.corners_of(polygon)) {
    corners.push_back(scene_.vertices[vertex] - antenna_ - from);
  }
  return nearest_to_origin(corners).norm();
}

// The polygon is convex: the way crosses its plane, and passes all sides on the same hand.
bool LinkQuery::crosses(std::uint32_t polygon, const Vec3& vehicle) const {
  const auto vertices = scene_.corners_of(polygon);
  const auto corner = [&](std::size_t i) -> Vec3 { return scene_.vertices[vertices[i % vertices.size()]] - antenna_; };
  double least = std::numeric_limits<double>::infinity(), most = -least;
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const double hand = vehicle.dot(corner(i).cross(corner(i + 1)));
    least = std::min(least, hand);
    most = std::max(most, hand);
    if (i > 0) normal += (corner(i) - corner(0)).cross(corner(i + 1) - corner(0));
  }
  const double height = normal.dot(corner(0));
  return (least > 0 || most < 0) && height * (height - normal.dot(vehicle)) < 0;
}

}  // namespace vantage::internal::query
