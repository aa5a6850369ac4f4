// Convex outlines whose corners are hard to see.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/random.h"

namespace vantage::testing {

inline double log_uniform(Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

/// From `a` to `b`, both left out: `count` vertices that bulge to the right by `rise` of the distance.
inline std::vector<Eigen::Vector2d> bulge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, int count, double rise) {
  std::vector<Eigen::Vector2d> points;
  const Eigen::Vector2d along = b - a, right(along.y(), -along.x());
  for (int k = 1; k <= count; ++k) {
    const double t = static_cast<double>(k) / (count + 1);
    points.emplace_back(a + t * along + 4 * t * (1 - t) * rise * right);
  }
  return points;
}

/// Draws convex outlines of about radius 1, counter-clockwise. Something was done to most of the 3 to 6 corners or to
/// the side after them, on any scale down to 1e-9, often so that each vertex is near the line of its neighbours.
class OutlineDraw {
 public:
  /// `most_vertices`: at least 30.
  explicit OutlineDraw(Random& random, int most_vertices = 64)
      : random_(random), corner_count_(random.integer(3, 6)), most_(most_vertices / corner_count_ - 2) {
    std::vector<int> kinds;
    for (int k = 0; k < corner_count_; ++k) {
      const double angle = 2 * std::numbers::pi * (k + random.uniform(-0.25, 0.25)) / corner_count_;
      corners_.emplace_back(std::cos(angle), std::sin(angle));
      kinds.push_back(random.integer(plain, crowded_side));
    }
    for (int k = 0; k < corner_count_; ++k) {
      const int next = kinds[(k + 1) % corner_count_];
      const bool has_no_side = kinds[k] >= bulging_side && (next == chamfer || next == fillet);
      add_corner(k, has_no_side ? plain : kinds[k]);
    }
  }

  const std::vector<Eigen::Vector2d>& outline() const { return outline_; }

  /// The corners at which something was done, as they were before.
  const std::vector<Eigen::Vector2d>& places() const { return places_; }

 private:
  enum Kind { plain, chamfer, fillet, bulging_side, crowded_side };

  void add_corner(int k, int kind) {
    const Eigen::Vector2d here = corners_[k], next = corners_[(k + 1) % corner_count_];
    if (kind != plain) places_.push_back(here);
    if (kind == chamfer || kind == fillet) {
      cut_corner(corners_[(k + corner_count_ - 1) % corner_count_], here, next,
                 kind == chamfer ? 0 : random_.integer(1, most_ - 2));
      return;
    }
    outline_.push_back(here);
    if (kind == bulging_side) append(bulge(here, next, random_.integer(1, most_), log_uniform(random_, 1e-12, 1e-3)));
    if (kind == crowded_side) crowd(here, next);
  }

  void cut_corner(const Eigen::Vector2d& before, const Eigen::Vector2d& here, const Eigen::Vector2d& after,
                  int between) {
    const double size = log_uniform(random_, (between + 1) * 3e-9, random_.chance(0.5) ? 1e-6 : 0.1);
    const Eigen::Vector2d back = (before - here).normalized(), on = (after - here).normalized();
    const double base_angle = std::numbers::pi / 2 - 0.5 * std::acos(std::clamp(back.dot(on), -1.0, 1.0));
    outline_.push_back(here + size * back);
    append(bulge(here + size * back, here + size * on, between, 0.22 * std::tan(0.5 * base_angle)));  // no farther out
    outline_.push_back(here + size * on);
  }

  // On the line to the next corner, most of them near this one.
  void crowd(const Eigen::Vector2d& here, const Eigen::Vector2d& next) {
    std::vector<double> shares;
    for (int i = random_.integer(1, most_); i > 0; --i) shares.push_back(log_uniform(random_, 1e-8, 0.9));
    std::sort(shares.begin(), shares.end());
    for (const double share : shares) {
      const Eigen::Vector2d p = here + share * (next - here);
      if ((p - outline_.back()).norm() > 4e-9) outline_.push_back(p);
    }
  }

  void append(const std::vector<Eigen::Vector2d>& points) {
    outline_.insert(outline_.end(), points.begin(), points.end());
  }

  Random& random_;
  int corner_count_, most_;
  std::vector<Eigen::Vector2d> corners_, outline_, places_;
};

}  // namespace vantage::testing
