// How wide a radio link's zone can be at a point of the scene: docs/theory.md, "Radio links".
#pragma once

#include <algorithm>
#include <cmath>

namespace vantage::internal::exact {

/// A point b of the scene, d = |b - A| from the antenna A, enters the zone of a vehicle at p, t <= D from it, where
/// d + |b - p| < t + e. Then the straight line from A to p passes b at no more than
///
///     R(d) = sqrt(2 e d (D - d + e / 2) / D),   or e where that is more, and d <= D + e / 2.
///
/// Proof. Square |b - p| < t + e - d: with the angle a between the two directions, 1 - cos a < e (2 (t - d) + e) / (2 t
/// d). If the foot of b on the line lies between A and p, the distance is d sin a, and its square at most
/// 2 d^2 (1 - cos a) < e d (2 (t - d) + e) / t. For d >= e / 2 that grows with t: t = D gives R(d). If the foot is
/// behind A, 1 - cos a >= 1, and the distance is d: d^2 <= d^2 (1 - cos a) is half of that. If it is beyond p,
/// |b - p| <= t + e - |b|, and with h for the distance from the line h + sqrt(t^2 + h^2) <= t + e: |b - p| <= e. For
/// d < e / 2 the distance is d at most, and R(d)^2 >= 2 e d > d^2.
class ZoneRadius {
 public:
  /// All of a piece of the scene counts with its largest radius, which is by no more than this part too large anywhere.
  static constexpr double kMostTooWide = 0.25;

  /// In parts of the range: beyond it the radius falls steeply to 0, and pieces may count with that at this distance.
  static constexpr double kLastDistance = 0.9;

  /// `excess`: zone_excess_m; `range`: of the vehicle, > 0. Metres.
  ZoneRadius(double excess, double range)
      : excess_(excess), range_(range), least_(std::max(excess, kLeastRadius * std::min(1.0, range / kFullRange))) {}

  double excess() const { return excess_; }

  /// Nothing that is farther from the antenna enters any zone.
  double reach() const { return range_ + excess_ / 2; }

  /// The most for any point between two distances from the antenna. R^2 is a parabola.
  double largest(double from, double to) const {
    return std::max(least_, at(std::clamp(reach() / 2, from, std::max(from, to))));
  }

  /// What a point at this distance may count with although it is more than needed.
  double allowed(double distance) const {
    return std::max(least_, at(std::min(distance, std::max(kLastDistance * range_, reach() / 2))));
  }

  /// Whether the largest radius of a piece between the two distances is hardly more than that of any of its points.
  bool is_even(double from, double to) const {
    const double least = std::min(allowed(from), allowed(std::min(to, reach())));
    return largest(from, to) <= (1 + kMostTooWide) * least;
  }

 private:
  // A thousand times what rounding moves scenes at map coordinates by; in worlds shorter than 20 m less in proportion.
  static constexpr double kLeastRadius = 1e-6, kFullRange = 20;

  double at(double distance) const {
    return std::sqrt(std::max(0.0, 2 * excess_ * distance * (reach() - distance) / range_));
  }

  double excess_, range_, least_;
};

}  // namespace vantage::internal::exact
