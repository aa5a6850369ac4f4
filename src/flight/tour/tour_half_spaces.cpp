#include "flight/tour/tour_half_spaces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "flight/tour/tour_detour.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr double kSlack = 1e-12;    ///< of the sizes: what rounding may break a half-space by
constexpr double kParallel = 1e-9;  ///< sine of the angle between planes that have no line in common

}  // namespace

struct HalfSpaces::Best {
  const HalfSpaces& spaces;
  const Vec3 &a, &b;
  double smoothing, slack;
  double least = std::numeric_limits<double>::infinity();
  std::optional<Vec3> point = std::nullopt;

  void offer(const Vec3& x) {
    const double length = way_length(a, x, b, smoothing);
    if (!(length < least) || !spaces.hold(x, slack)) return;
    least = length;
    point = x;
  }

  void offer_plane(const Plane& p) {
    const double da = p.inward.dot(a) - p.offset, db = p.inward.dot(b) - p.offset;
    offer(shortest_on_flat(a - da * p.inward, std::hypot(da, smoothing), b - db * p.inward, std::hypot(db, smoothing)));
  }

  /// The line where two planes meet, and where the others cut it.
  void offer_line(std::size_t i, std::size_t j) {
    const Plane &p = spaces.planes_[i], &q = spaces.planes_[j];
    const Vec3 cross = p.inward.cross(q.inward);
    const double square = cross.squaredNorm();
    if (square < kParallel * kParallel) return;
    const Vec3 base = (p.offset * q.inward.cross(cross) + q.offset * cross.cross(p.inward)) / square;
    const Vec3 along = cross / std::sqrt(square);
    const double ta = along.dot(a - base), tb = along.dot(b - base);
    const Vec3 pa = base + ta * along, pb = base + tb * along;
    offer(shortest_on_flat(pa, std::hypot((a - pa).norm(), smoothing), pb, std::hypot((b - pb).norm(), smoothing)));
    for (std::size_t k = j + 1; k < spaces.count_; ++k) {
      const Plane& r = spaces.planes_[k];
      const double slope = r.inward.dot(along);
      if (std::abs(slope) > kParallel) offer(base + (r.offset - r.inward.dot(base)) / slope * along);
    }
  }
};

void HalfSpaces::add(const Vec3& inward, double offset) {
  if (count_ < kMost) {
    planes_[count_++] = {inward, offset};
    return;
  }
  planes_[oldest_] = {inward, offset};
  oldest_ = (oldest_ + 1) % kMost;
}

bool HalfSpaces::hold(const Vec3& point, double slack) const {
  return std::all_of(planes_.begin(), planes_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [&](const Plane& p) { return p.inward.dot(point) >= p.offset - slack; });
}

std::optional<Vec3> HalfSpaces::on_segment(const Vec3& a, const Vec3& b, double slack) const {
  double from = 0, to = 1;
  for (std::size_t i = 0; i < count_; ++i) {
    const Plane& p = planes_[i];
    const double da = p.inward.dot(a) - p.offset + slack, db = p.inward.dot(b) - p.offset + slack;
    if (da < 0 && db < 0) return std::nullopt;
    if (da < 0) from = std::max(from, da / (da - db));
    if (db < 0) to = std::min(to, da / (da - db));
  }
  if (from > to) return std::nullopt;
  return Vec3(a + std::clamp(0.5, from, to) * (b - a));
}

std::optional<Vec3> HalfSpaces::shortest_way(const Vec3& a, const Vec3& b, double smoothing) const {
  const double slack = kSlack * (1 + a.norm() + b.norm());
  if (std::optional<Vec3> point = on_segment(a, b, slack)) return point;
  Best best{*this, a, b, smoothing, slack};
  for (std::size_t i = 0; i < count_; ++i) {
    best.offer_plane(planes_[i]);
    for (std::size_t j = i + 1; j < count_; ++j) best.offer_line(i, j);
  }
  return best.point;
}

}  // namespace vantage::internal::flight::tour
