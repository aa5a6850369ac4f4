#include "target/range_region.h"

#include "target/enclosing_circle.h"

namespace vantage::internal::target {

RangeRegion::RangeRegion(const std::vector<Eigen::Vector2d>& polygon, double max_range)
    : centres_(polygon), radius_(max_range) {
  for (const Eigen::Vector2d& c : centres_) power_.push_back(max_range * max_range - c.squaredNorm());
}

double RangeRegion::inner_radius() const {
  double farthest = 0;
  for (const Eigen::Vector2d& c : centres_) farthest = std::max(farthest, c.norm());
  return radius_ - farthest;
}

double RangeRegion::gauge(const Vec3& direction) const {
  double greatest = 0;
  for (std::size_t ball = 0; ball < centres_.size(); ++ball) greatest = std::max(greatest, gauge(ball, direction));
  return greatest;
}

double RangeRegion::gauge(const Vec3& direction, std::size_t& ball) const {
  const double first = gauge(ball, direction);
  // On the sphere about a the point direction / first is inside the ball about b when 2 x . (b - a) >= b^2 - a^2.
  const Eigen::Vector2d& a = centres_[ball];
  bool inside = true;
  for (std::size_t k = 0; k < centres_.size(); ++k) {
    const Eigen::Vector2d& b = centres_[k];
    const double along = direction.x() * (b.x() - a.x()) + direction.y() * (b.y() - a.y());
    inside = inside && 2 * along >= (power_[ball] - power_[k]) * first;
  }
  if (inside) return first;
  ball = nearest_ball(direction);
  return gauge(ball, direction);
}

std::size_t RangeRegion::nearest_ball(const Vec3& direction) const {
  std::size_t best = 0;
  double greatest = 0;
  for (std::size_t ball = 0; ball < centres_.size(); ++ball) {
    const double g = gauge(ball, direction);
    if (g > greatest) {
      greatest = g;
      best = ball;
    }
  }
  return best;
}

core::Plane RangeRegion::supporting_plane(const Vec3& direction) const {
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

void move_into_range(TargetFrame& frame, double max_range) {
  const auto farthest = [&](const Eigen::Vector2d& p) {
    double d = 0;
    for (const auto& v : frame.polygon) d = std::max(d, (v - p).norm());
    return d;
  };
  const double allowed = 0.5 * (frame.enclosing_radius_m + max_range);
  if (farthest(Eigen::Vector2d::Zero()) <= allowed) return;
  const Eigen::Vector2d centre = smallest_enclosing_circle(frame.polygon).centre;
  double low = 0, high = 1;  // the distance to the farthest vertex is convex along the way
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (farthest(middle * centre) <= allowed ? high : low) = middle;
  }
  const Eigen::Vector2d shift = high * centre;
  frame.origin += frame.axis_u * shift.x() + frame.axis_v * shift.y();
  for (auto& v : frame.polygon) v -= shift;
}

}  // namespace vantage::internal::target
