#include "target/range_region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/enclosing_circle.h"
#include "core/facet_polygon.h"
#include "core/portable_math.h"
#include "core/triangle_distance.h"

namespace vantage::internal::target {
namespace {

constexpr double kSphereRounding = 1e-15;  // of the distance from the origin
constexpr std::size_t kFew = 8;            // so many balls are tried faster than a search among them begins

}  // namespace

RangeRegion::RangeRegion(const std::vector<Eigen::Vector2d>& polygon, double max_range)
    : centres_(polygon), radius_(max_range) {
  for (const Eigen::Vector2d& c : centres_) power_.push_back(max_range * max_range - c.squaredNorm());
  find_neighbours();
  find_opposite();
}

// Cuts the cell of each centre out of a square that holds the region. Cuts of no more than rounding are left out: the
// cell is larger then, by nothing.
void RangeRegion::find_neighbours() {
  const double reach = 2.1 * radius_;
  core::FacetPolygon cell, scratch;
  neighbours_.resize(centres_.size());
  for (std::uint32_t ball = 0; ball < centres_.size(); ++ball) {
    cell.corners.assign({{-reach, -reach, 0}, {reach, -reach, 0}, {reach, reach, 0}, {-reach, reach, 0}});
    cell.makers.assign(4, core::FacetPolygon::kFar);
    for (std::uint32_t other = 0; other < centres_.size(); ++other) {
      if (other == ball) continue;
      const FartherSide side = farther_from(ball, other);
      core::clip_facet(cell, side.normal, side.height, kSphereRounding * reach * side.normal.lpNorm<1>(), other,
                       scratch);
    }
    for (std::uint32_t other = 0; other < centres_.size(); ++other) {
      // A ball that is met nowhere has no cell: it must not seem to be met everywhere.
      if (other == ball || !(cell.empty() || std::ranges::count(cell.makers, other))) continue;
      for (const auto& [from, to] : {std::pair{ball, other}, std::pair{other, ball}})
        if (!std::ranges::count(neighbours_[from], to)) neighbours_[from].push_back(to);
    }
  }
  for (auto& some : neighbours_) std::ranges::sort(some);
}

// Where to begin the search for the ball that is met first.
void RangeRegion::find_opposite() {
  for (std::size_t sector = 0; sector < opposite_.size(); ++sector) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(sector) + 0.5) / static_cast<double>(opposite_.size());
    const portable::SineCosine turn = portable::sine_cosine(angle);
    const Eigen::Vector2d along(turn.cosine, turn.sine);
    const auto farther = [&](const auto& a, const auto& b) { return a.dot(along) < b.dot(along); };
    opposite_[sector] = static_cast<std::uint32_t>(std::ranges::min_element(centres_, farther) - centres_.begin());
  }
}

// About equal in angle.
std::size_t RangeRegion::sector_of(const Vec3& direction) const {
  const double x = direction.x(), y = direction.y(), sum = std::abs(x) + std::abs(y);
  if (!(sum > 0)) return 0;
  const double turn = y >= 0 ? 1 - x / sum : 3 + x / sum;  // 0 to 4
  return std::min(static_cast<std::size_t>(turn * 0.25 * static_cast<double>(opposite_.size())), opposite_.size() - 1);
}

double RangeRegion::inner_radius() const {
  double farthest = 0;
  for (const Eigen::Vector2d& c : centres_) farthest = std::max(farthest, c.norm());
  return radius_ - farthest;
}

double RangeRegion::gauge(const Vec3& direction) const {
  if (centres_.size() > kFew) return gauge(nearest_ball(direction), direction);
  double greatest = 0;
  for (std::size_t ball = 0; ball < centres_.size(); ++ball) greatest = std::max(greatest, gauge(ball, direction));
  return greatest;
}

double RangeRegion::gauge(const Vec3& direction, std::size_t& ball) const {
  const double first = gauge(ball, direction);
  // On the sphere about a the point direction / first is inside the ball about b when 2 x . (b - a) >= b^2 - a^2.
  const Eigen::Vector2d& a = centres_[ball];
  bool inside = true;
  for (const std::uint32_t k : neighbours_[ball]) {
    const Eigen::Vector2d& b = centres_[k];
    const double along = direction.x() * (b.x() - a.x()) + direction.y() * (b.y() - a.y());
    inside = inside && 2 * along >= (power_[ball] - power_[k]) * first;
  }
  if (inside) return first;
  ball = nearest_ball(direction);
  return gauge(ball, direction);
}

// The centre that is farthest from direction / gauge, by way of centres that are farther and farther. The square of the
// distance, without what is the same for all centres: next to that a small target would vanish.
std::size_t RangeRegion::first_met(const Vec3& direction, double gauge, std::size_t ball) const {
  const auto nearness = [&](std::size_t k) {
    return 2 * (direction.x() * centres_[k].x() + direction.y() * centres_[k].y()) - gauge * centres_[k].squaredNorm();
  };
  double least = nearness(ball);
  for (std::size_t last = centres_.size(); last != ball;) {
    last = ball;
    for (const std::uint32_t k : neighbours_[last]) {
      if (const double other = nearness(k); other < least) {
        least = other;
        ball = k;
      }
    }
  }
  return ball;
}

// A point of one sphere that is outside another ball lies beyond the other's sphere, so each step comes nearer.
std::size_t RangeRegion::nearest_ball(const Vec3& direction) const {
  std::size_t best = first_met(direction, direction.norm() / radius_, opposite_[sector_of(direction)]);
  double greatest = gauge(best, direction);
  for (;;) {
    const std::size_t next = first_met(direction, greatest, best);
    if (next == best) return best;
    const double g = gauge(next, direction);
    if (!(g > greatest)) return best;
    greatest = g;
    best = next;
  }
}

core::Plane RangeRegion::supporting_plane(const Vec3& direction) const {
  const std::size_t ball = nearest_ball(direction);
  const Vec3 point = direction / gauge(ball, direction);
  const Vec3 normal = point - Vec3(centres_[ball].x(), centres_[ball].y(), 0);
  return normal / normal.dot(point);
}

// Nothing is deeper than under the ball whose sphere is nearest, and any ball bounds the depth: those of the middle and
// of the corners are good enough, and mostly the first of them tells.
bool RangeRegion::is_deeper_than(double depth, const std::array<Vec3, 3>& corners) const {
  std::size_t last = centres_.size(), start = opposite_[sector_of(corners[0])];
  for (const Vec3& point : {Vec3((corners[0] + corners[1] + corners[2]) / 3), corners[0], corners[1], corners[2]}) {
    start = first_met(point, 1, start);
    if (start == last) continue;
    last = start;
    const Vec3 centre(centres_[last].x(), centres_[last].y(), 0);
    const double nearest = std::sqrt(core::squared_distance_to_triangle(centre, corners[0], corners[1], corners[2]));
    if (radius_ - nearest <= depth) return false;
  }
  return true;
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
  const Eigen::Vector2d centre = core::smallest_enclosing_circle(frame.polygon).centre;
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
