// The obvious airspace for tests: boxes to keep away from, and one to stay in.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "vantage/tour.h"

namespace vantage::testing {

struct NamedBox {
  std::string name;
  Box box;
};

/// The distance of a point from a box; 0 inside.
inline double distance_to(const Box& box, const Vec3& point) {
  return (point - point.cwiseMax(box.min).cwiseMin(box.max)).norm();
}

/// Of a segment: convex along it, so thirds close in on the least one. Not below the true one by construction, and
/// above it by 1e-9 of the length at most.
inline double distance_to(const Box& box, const Leg& leg) {
  double low = 0, high = 1;
  const auto at = [&](double t) { return distance_to(box, Vec3(leg.from + t * (leg.to - leg.from))); };
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (at(a) == 0 || at(b) == 0) return 0;
    (at(a) < at(b) ? high : low) = at(a) < at(b) ? b : a;
  }
  return std::min({at(low), at(high), at(0), at(1)});
}

class BoxAirspace : public Airspace {
 public:
  BoxAirspace(std::vector<NamedBox> obstacles, double clearance_m, const Box& inside)
      : obstacles_(std::move(obstacles)), clearance_(clearance_m), inside_(inside) {}

  bool allows(const Leg& leg, double deviation_m) const override { return obstacle(leg, deviation_m).empty(); }

  std::string obstacle(const Leg& leg, double deviation_m) const override {
    for (const Vec3& p : {leg.from, leg.to}) {
      const bool is_in = (p.array() - deviation_m >= inside_.min.array()).all() &&
                         (p.array() + deviation_m <= inside_.max.array()).all();
      if (!is_in) return "border";
    }
    for (const NamedBox& obstacle : obstacles_) {
      if (distance_to(obstacle.box, leg) < clearance_ + deviation_m + 1e-6) return obstacle.name;
    }
    return {};
  }

  Box bounds() const override { return inside_; }

  const std::vector<NamedBox>& obstacles() const { return obstacles_; }
  double clearance() const { return clearance_; }

 private:
  std::vector<NamedBox> obstacles_;
  double clearance_;
  Box inside_;
};

}  // namespace vantage::testing
