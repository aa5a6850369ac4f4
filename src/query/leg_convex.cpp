#include "query/leg_convex.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

namespace vantage::internal::query {
namespace {

constexpr double kLegRounding = std::numeric_limits<double>::epsilon();
constexpr double kMet = 1e-12;  // of the distance: nearer to the border than this is on it

/// Keeps what of the interval has a linear function >= 0. False where that is nothing.
bool keep_part(LegInterval& part, double at_begin, double at_end) {
  if (at_begin < 0 && at_end < 0) return false;
  if (at_begin >= 0 && at_end >= 0) return true;
  const double crossing = at_begin / (at_begin - at_end);
  if (at_begin < 0) {
    part.begin = std::max(part.begin, crossing - 2 * kLegRounding);
  } else {
    part.end = std::min(part.end, crossing + 2 * kLegRounding);
  }
  return part.begin <= part.end;
}

/// A point, and the way to what some half-spaces have in common: their normals with weights >= 0.
class Projection {
 public:
  /// Sharir and Welzl's problem of three dimensions ("A combinatorial bound for linear programming and related
  /// problems", 1992): the half-space that is missed most joins those that bound the nearest point so far, and the
  /// three or fewer that bound it then are found among these. The distance grows with each step.
  Projection(const Vec3& point, std::span<const HalfSpace> set, double tolerance)
      : point_(point), set_(set), tolerance_(tolerance) {
    constexpr int kMostSteps = 100;
    for (int step = 0; step < kMostSteps; ++step) {
      const std::size_t missed = most_missed();
      if (missed == set.size() || !add(missed)) return;
    }
  }

  double distance() const { return way_.norm(); }

  /// A half-space that holds the set, square to the way: its height, and what rounding may do to it.
  struct Tangent {
    Vec3 normal;
    double height, error;
  };
  Tangent tangent() const {
    Vec3 normal = Vec3::Zero();
    double height = 0, size = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const HalfSpace& side = set_[active_[i]];
      normal += weight_[i] * side.normal;
      height += weight_[i] * side.height;
      size += weight_[i] * (std::abs(side.height) + point_.norm() + way_.norm());
    }
    const double length = normal.norm();
    return {normal / length, height / length, 8 * kLegRounding * size / length};
  }

 private:
  std::size_t most_missed() const {
    std::size_t worst = set_.size();
    double least = -tolerance_;
    const Vec3 nearest = point_ + way_;
    for (std::size_t i = 0; i < set_.size(); ++i) {
      const double inside = set_[i].normal.dot(nearest) - set_[i].height;
      if (inside < least) {
        least = inside;
        worst = i;
      }
    }
    return worst;
  }

  /// The nearest point of what `added` and the active half-spaces have in common.
  bool add(std::size_t added) {
    std::array<std::size_t, 4> all{};
    std::copy_n(active_.begin(), count_, all.begin());
    const std::size_t before = count_;
    const double last = way_.norm();
    for (unsigned chosen = 0; chosen < (1u << before); ++chosen) {
      std::array<std::size_t, 3> basis{added};
      std::size_t size = 1;
      for (std::size_t i = 0; i < before && size < 4; ++i) {
        if (!(chosen >> i & 1u)) continue;
        if (size < 3) basis[size] = all[i];
        ++size;
      }
      std::array<double, 3> weight{};
      Vec3 way;
      if (size > 3 || !solve(basis, size, weight, way) || !(way.norm() > last)) continue;
      const bool is_in_all = std::all_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(before),
                                         [&](std::size_t i) { return gap(i) <= set_[i].normal.dot(way) + tolerance_; });
      if (!is_in_all) continue;
      active_ = basis;
      weight_ = weight;
      count_ = size;
      way_ = way;
      return true;
    }
    return false;
  }

  /// How far the point is from a half-space; negative inside.
  double gap(std::size_t i) const { return set_[i].height - set_[i].normal.dot(point_); }

  bool solve(const std::array<std::size_t, 3>& basis, std::size_t size, std::array<double, 3>& weight,
             Vec3& way) const {
    constexpr double kParallel = 1e-12;
    const Vec3& a = set_[basis[0]].normal;
    const double gap_a = gap(basis[0]);
    if (size == 1) {
      weight[0] = gap_a;
    } else if (size == 2) {
      const Vec3& b = set_[basis[1]].normal;
      const double gap_b = gap(basis[1]), cosine = a.dot(b), square = a.cross(b).squaredNorm();
      if (!(square > kParallel * kParallel)) return false;
      weight[0] = (gap_a - cosine * gap_b) / square;
      weight[1] = (gap_b - cosine * gap_a) / square;
    } else {
      const Vec3 &b = set_[basis[1]].normal, &c = set_[basis[2]].normal;
      const Vec3 bc = b.cross(c), ca = c.cross(a), ab = a.cross(b);
      const double volume = a.dot(bc);
      if (!(std::abs(volume) > kParallel * kParallel)) return false;
      const Vec3 corner = (gap_a * bc + gap(basis[1]) * ca + gap(basis[2]) * ab) / volume;
      weight = {corner.dot(bc) / volume, corner.dot(ca) / volume, corner.dot(ab) / volume};
    }
    way = Vec3::Zero();
    for (std::size_t i = 0; i < size; ++i) {
      if (!(weight[i] >= 0) || !std::isfinite(weight[i])) return false;
      way += weight[i] * set_[basis[i]].normal;
    }
    return true;
  }

  Vec3 point_, way_ = Vec3::Zero();
  std::span<const HalfSpace> set_;
  double tolerance_;
  std::array<std::size_t, 3> active_{};
  std::array<double, 3> weight_{};
  std::size_t count_ = 0;
};

}  // namespace

std::optional<LegInterval> near_part(const Vec3& from, const Vec3& to, std::span<const HalfSpace> set, double radius) {
  LegInterval part{0, 1};
  for (const HalfSpace& side : set) {
    const double grown = side.height - radius;
    if (!keep_part(part, side.normal.dot(from) - grown, side.normal.dot(to) - grown)) return std::nullopt;
  }
  const auto clamped = [&] { return LegInterval{std::clamp(part.begin, 0.0, 1.0), std::clamp(part.end, 0.0, 1.0)}; };
  if (!(radius > 0)) return clamped();
  const double scale = std::max(from.norm(), to.norm()) + radius;
  constexpr int kMostSteps = 40;
  for (double LegInterval::*end : {&LegInterval::begin, &LegInterval::end}) {
    for (int step = 0; step < kMostSteps; ++step) {
      const double place = part.*end;
      const Projection nearest(from + place * (to - from), set, kMet * scale);
      if (!(nearest.distance() > radius + kMet * scale)) break;
      const auto [normal, height, error] = nearest.tangent();
      const double grown = height - radius - error;
      if (!keep_part(part, normal.dot(from) - grown, normal.dot(to) - grown)) return std::nullopt;
      if (part.*end == place) break;
    }
  }
  return clamped();
}

std::optional<LegInterval> ball_part(const Vec3& from, const Vec3& to, const Vec3& centre, double radius) {
  const Vec3 along = to - from, start = centre - from;
  const double length = along.norm();
  if (!(length > 0)) return start.norm() <= radius ? std::optional(LegInterval{0, 1}) : std::nullopt;
  const Vec3 direction = along / length;
  const double foot = direction.dot(start);
  const double aside = (start - foot * direction).norm();
  if (!(aside <= radius)) return std::nullopt;
  const double half = std::sqrt((radius - aside) * (radius + aside));
  const double begin = std::max(0.0, (foot - half) / length), end = std::min(1.0, (foot + half) / length);
  if (begin > end) return std::nullopt;
  return LegInterval{begin, end};
}

}  // namespace vantage::internal::query
