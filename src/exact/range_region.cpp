#include "exact/range_region.h"

namespace vantage::exact {

RangeRegion::RangeRegion(const LocalTarget& target, double max_range) : centres_(target.vertices), radius_(max_range) {
  for (const Eigen::Vector2d& c : centres_) power_.push_back(max_range * max_range - c.squaredNorm());
}

double RangeRegion::gauge(const Vec3& direction) const {
  double greatest = 0;
  for (std::size_t ball = 0; ball < centres_.size(); ++ball) greatest = std::max(greatest, gauge(ball, direction));
  return greatest;
}

std::size_t RangeRegion::nearest_ball(const Vec3& direction) const {
  std::size_t best = 0;
  double greatest = 0;
  for (std::size_t ball = 0; ball < centres_.size(); ++ball) {
    const double g = gauge(ball, direction);
    if (g > greatest) greatest = g, best = ball;
  }
  return best;
}

Plane RangeRegion::supporting_plane(const Vec3& direction) const {
  const std::size_t ball = nearest_ball(direction);
  const Vec3 point = direction / gauge(ball, direction);
  const Vec3 normal = point - Vec3(centres_[ball].x(), centres_[ball].y(), 0);
  return normal / normal.dot(point);
}

bool RangeRegion::contains(const Vec3& point) const {
  for (const Eigen::Vector2d& c : centres_)
    if ((point - Vec3(c.x(), c.y(), 0)).squaredNorm() > radius_ * radius_) return false;
  return true;
}

}  // namespace vantage::exact
