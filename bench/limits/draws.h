// Random targets and limits of the sensor in real cities.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "support/cities.h"
#include "vantage/sensor.h"
#include "vantage/target.h"

namespace vantage::bench {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  bool chance(double share) { return uniform(0, 1) < share; }
  Vec3 direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 2 * std::numbers::pi), across = std::sqrt(1 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
  }

 private:
  std::mt19937_64 engine_;
};

struct Limit {
  const char* name;
  std::function<void(Sensor&, Draw&)> add;
  std::function<void(Sensor&)> loosen;  ///< by 1 %
};
const std::vector<Limit>& limits();

/// Some of the limits together, as allowed. `among`: which may be drawn; empty: all. `names`: of those drawn.
Sensor draw_sensor(Draw& draw, const std::vector<std::string>& among, std::string& names);

/// A target that can be seen as it lies; draws until there is one.
PreparedTarget draw_prepared(const PreparedCity& city, const Sensor& sensor, Draw& draw);

}  // namespace vantage::bench
