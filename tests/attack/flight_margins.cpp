#include "flight_margins.h"

#include <algorithm>

namespace attack {

NavigationMargins::NavigationMargins(const vantage::Navigation& navigation) {
  each_limit(navigation, [&](auto limit, const auto& value) { limits_.push_back(margins_of<limit>(value, nobody_)); });
}

std::vector<Margin> NavigationMargins::at(const Vec3& p) const {
  std::vector<Margin> margins;
  for (const AddMargins& add : limits_) add(p, margins);
  return margins;
}

// The frame is last, so that seeds judge what they judged before.
SensorMargins::SensorMargins(const vantage::Sensor& sensor, const std::vector<SeenTarget>& parts)
    : by_{sensor, parts}, range_m_(range_limit_m(sensor)) {
  every_sensor_limit<Limit::min_range, Limit::incidence, Limit::pixel, Limit::sun>([&](auto limit) {
    const auto* value = given<limit>({}, by_.sensor);
    if (value != nullptr) limits_.push_back(margins_of<limit>(*value, by_));
  });
}

std::vector<Margin> SensorMargins::at(const Vec3& p) const {
  std::vector<Margin> margins;
  for (const SeenTarget& part : by_.parts) {
    double farthest = 0;
    for (const Vec3& corner : part.corners) farthest = std::max(farthest, (corner - p).norm());
    add_margin(margins, {"max_range", range_m_ - farthest, range_m_ - farthest});
    if (!part.all_sides) add_margin(margins, {"behind", part.height(p), part.height(p)});
  }
  for (const Margin& margin : of_limits(p)) add_margin(margins, margin);
  return margins;
}

std::vector<Margin> SensorMargins::of_limits(const Vec3& p) const {
  std::vector<Margin> margins;
  for (const AddMargins& add : limits_) add(p, margins);
  return margins;
}

std::string broken_among(const std::vector<Margin>& margins) {
  for (const Margin& margin : margins) {
    if (margin.high < 0) return margin.limit;
  }
  return {};
}

}  // namespace attack
