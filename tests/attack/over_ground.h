// Heights above ground, which may lie in pieces over each other.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "limit_attack.h"
#include "vantage/ground.h"

namespace attack {

/// A place seen from above.
using Plan = Eigen::Vector2d;

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double distance_to_side(const Plan& p, const Plan& a, const Plan& b);

/// z of the pieces of ground at a place.
struct Pieces {
  double lowest = kNoLimit, highest = -kNoLimit;
  double beside = kNoLimit;  ///< how far the nearest triangle is, in plan; 0 on one

  bool is_there() const { return lowest <= highest; }
};
Pieces pieces_at(const vantage::Ground& ground, const Plan& p);

/// The place and four beside it, so near that only rounding tells them apart.
std::vector<Plan> near_places(const vantage::Ground& ground, const Vec3& p);

/// The least and the greatest value over places.
template <typename Value>
Margin between(const std::string& limit, const std::vector<Plan>& places, const Value& value) {
  Margin margin{limit, kNoLimit, -kNoLimit, false};
  for (const Plan& place : places) {
    const double at = value(place);
    margin.low = std::min(margin.low, at);
    margin.high = std::max(margin.high, at);
  }
  return margin;
}

}  // namespace attack
