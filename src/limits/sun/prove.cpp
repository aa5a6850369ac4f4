// What the limit takes away, the target less a cone, is convex and reaches to infinity, and no mesh winds round all of
// that: so it is enough that no facet meets it, whichever way it faces. A facet does not where a plane has the lines of
// sight from it on one side and the cone on the other. A plane's normal u, of unit length, has the cone about s behind
// it if u . s is at most minus the sine of the cone's half angle. docs/proof.md has the argument.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "prove/limit_proof.h"
#include "prove/triangle_distance.h"

namespace vantage::internal::prove {
namespace {

class SunCone {
 public:
  SunCone(const SunLimit& sun, const View& part, const Vec3& origin) : axis_(unit(sun.direction)) {
    const double angle = sun.exclude_deg * std::numbers::pi / 180;
    sine_ = std::sin(angle);
    cosine_ = sun.exclude_deg < 90 ? std::cos(angle) : 0;
    side_ = axis_.unitOrthogonal();
    up_ = axis_.cross(side_);
    for (const Vec3& corner : part.whole) target_.push_back(part.origin - origin + corner);
  }

  void look(const LimitedVolume::Corners& facet, double tolerance_m, FacetFinding& finding) const {
    if (is_clear({facet, tolerance_m})) return;
    finding.is_open = true;
    const Vec3 middle = (facet[0] + facet[1] + facet[2]) / 3;
    for (std::size_t k = 0; k < 3; ++k) {
      finding.broken.see(depth(facet[k]), facet[k]);
      const Vec3 between = (facet[k] + facet[(k + 1) % 3]) / 2;
      finding.broken.see(depth(between), between);
    }
    finding.broken.see(depth(middle), middle);
  }

 private:
  /// How far inside of the cone a line of sight ends, square to its surface; negative outside.
  double inside_by(const Vec3& sight) const {
    const double along = axis_.dot(sight);
    return along * sine_ - (sight - along * axis_).norm() * cosine_;
  }

  /// The depth of a position, by the deepest line of sight that is found.
  double depth(const Vec3& position) const {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < target_.size(); ++i) {
      // It is concave along an edge.
      Vec3 a = target_[i], b = target_[(i + 1) % target_.size()];
      for (int step = 0; step < 40; ++step) {
        const Vec3 first = a + (b - a) / 3, second = b - (b - a) / 3;
        (inside_by(first - position) < inside_by(second - position) ? a : b) =
            inside_by(first - position) < inside_by(second - position) ? first : second;
      }
      most = std::max({most, inside_by(a - position), inside_by(target_[i] - position)});
    }
    Vec3 middle = Vec3::Zero();
    for (const Vec3& corner : target_) middle += corner / static_cast<double>(target_.size());
    return std::max(most, inside_by(middle - position));
  }

  /// What is to be separated from the cone.
  struct Sights {
    const LimitedVolume::Corners& facet;
    double tolerance_m;
  };

  /// So far in front of the plane through the cone's top, at most, is a point of the cone at a distance of 1. That is 1
  /// if the normal itself is in the cone; else the cosine of what its angle to the axis is more than that of the cone,
  /// and 0, the top, if all of the cone is behind. Rounded up. `towards`: the cosine of the angle.
  double most_in_front(const Vec3& normal, double towards) const {
    constexpr double kRounding = 4e-15;  // of the sums, of the sine and of the cosine
    if (towards >= cosine_ - kRounding) return 1;
    const double across = (normal - towards * axis_).norm();
    return std::clamp(towards * cosine_ + across * sine_ + kRounding, 0.0, 1.0);
  }

  /// Whether the plane with this normal leaves all lines of sight out of the cone, less the tolerance: its top then
  /// lies farther along by the tolerance over the sine.
  bool separates(const Vec3& normal, const Sights& sights) const {
    const auto& [facet, tolerance_m] = sights;
    const double towards = normal.dot(axis_);
    double least = std::numeric_limits<double>::infinity(), farthest = -least, longest = 0;
    for (const Vec3& corner : target_) least = std::min(least, normal.dot(corner));
    for (const Vec3& corner : facet) {
      farthest = std::max(farthest, normal.dot(corner));
      for (const Vec3& end : target_) longest = std::max(longest, (end - corner).norm());
    }
    const double top = tolerance_m / sine_;
    return least - farthest >= towards * top + most_in_front(normal, towards) * (longest + top);
  }

  Vec3 slanted(double turn) const { return cosine_ * (std::cos(turn) * side_ + std::sin(turn) * up_) - sine_ * axis_; }
  double turn_of(const Vec3& sight) const { return std::atan2(up_.dot(sight), side_.dot(sight)); }

  bool is_clear(const Sights& sights) const {
    if (separates(-axis_, sights)) return true;
    Vec3 sum = Vec3::Zero();
    for (const Vec3& corner : target_) sum += corner / static_cast<double>(target_.size());
    for (const Vec3& corner : sights.facet) sum -= corner / 3;
    if (separates(slanted(turn_of(sum)), sights)) return true;
    if (const auto normal = from_top(sights); normal && separates(*normal, sights)) return true;
    return is_clear_beside(sights) || is_clear_along_a_side(sights);
  }

  /// From the cone's top to the nearest line of sight.
  std::optional<Vec3> from_top(const Sights& sights) const {
    LimitedVolume::Corners moved = sights.facet;
    for (Vec3& corner : moved) corner += sights.tolerance_m / sine_ * axis_;
    std::optional<NearestPoints> nearest;
    const std::size_t last = std::max<std::size_t>(target_.size(), 3);
    for (std::size_t k = 2; k < last; ++k) {
      const NearestPoints one =
          nearest_points(moved, {target_[0], target_[(k - 1) % target_.size()], target_[k % target_.size()]});
      if (!nearest || one.distance < nearest->distance) nearest = one;
    }
    if (!(nearest->distance > 0)) return std::nullopt;
    return (nearest->on_b - nearest->on_a) / nearest->distance;
  }

  /// Each line of sight allows an arc of turns; where all arcs have one in common, it is the end of one of them. With
  /// half of the tolerance, so that the end of an arc is inside of it.
  bool is_clear_beside(const Sights& sights) const {
    for (const Vec3& corner : target_) {
      for (const Vec3& position : sights.facet) {
        const Vec3 sight = corner - position;
        const double along = axis_.dot(sight), beside = (sight - along * axis_).norm();
        const double needed = (sine_ * along - sights.tolerance_m / 2) / (cosine_ * beside);
        if (!(needed >= -1)) continue;  // any turn will do
        if (needed > 1) return false;
        for (const double sign : {-1.0, 1.0}) {
          if (separates(slanted(turn_of(sight) + sign * std::acos(needed)), sights)) return true;
        }
      }
    }
    return false;
  }

  /// The lines of sight from a facet that touches the target, or all but does, begin at the cone's top. Where numbers
  /// do not tell the way to the nearest one, one of the sides of what all of them are may do: normals of the facet, of
  /// the target, and of two edges.
  bool is_clear_along_a_side(const Sights& sights) const {
    const LimitedVolume::Corners& facet = sights.facet;
    const std::size_t n = target_.size();
    const auto is_clear_along = [&](const Vec3& normal) {
      const Vec3 way = normal.stableNormalized();
      return way.norm() > 0 && (separates(way, sights) || separates(-way, sights));
    };
    if (is_clear_along((facet[1] - facet[0]).cross(facet[2] - facet[0]))) return true;
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 2; i < n; ++i) area += (target_[i - 1] - target_[0]).cross(target_[i] - target_[0]);
    if (is_clear_along(area)) return true;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 edge = target_[(i + 1) % n] - target_[i];
      for (std::size_t k = 0; k < 3; ++k) {
        if (is_clear_along(edge.cross(facet[(k + 1) % 3] - facet[k]))) return true;
      }
    }
    return false;
  }

  Vec3 axis_, side_, up_;
  double sine_ = 0, cosine_ = 0;
  std::vector<Vec3> target_;
};

}  // namespace

template <>
ClaimProof prove_limit<Limit::sun>(const SunLimit& sun, const Claimant& of, const core::ProgressReporter& progress) {
  const LimitedVolume& volume = of.volume;
  std::optional<ClaimProof> all;
  for (const View& part : of.parts) {
    const SunCone cone(sun, part, volume.origin());
    const auto findings =
        volume.look_at_facets([&](const LimitedVolume::Corners& facet,
                                  FacetFinding& finding) { cone.look(facet, volume.tolerance_of(facet), finding); },
                              progress);
    const ClaimProof one = volume.judged("sun", findings,
                                         "a plane has the sun's cone on one side, and on the other one "
                                         "all lines of sight from a facet",
                                         "the angle to the sun");
    all = all ? worse(*all, one) : one;
  }
  return *all;
}

}  // namespace vantage::internal::prove
