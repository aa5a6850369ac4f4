// Random draws for tests: the seed is printed, and can be given again.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <random>

#include "vantage/geometry.h"

namespace vantage::testing {

/// Prints its seed. The environment variable VANTAGE_SEED replaces it.
class Random {
 public:
  explicit Random(std::uint64_t seed) {
    if (const char* given = std::getenv("VANTAGE_SEED")) seed = std::strtoull(given, nullptr, 10);
    std::cout << "seed " << seed << "\n";
    engine_.seed(seed);
  }

  double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<>(low, high)(engine_); }
  bool chance(double share) { return uniform(0, 1) < share; }
  Vec3 point(double low, double high) {
    const double x = uniform(low, high), y = uniform(low, high);
    return {x, y, uniform(low, high)};
  }
  Vec3 in_box(const Box& box) {
    const double x = uniform(box.min.x(), box.max.x()), y = uniform(box.min.y(), box.max.y());
    return {x, y, uniform(box.min.z(), box.max.z())};
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 d = point(-1, 1);
      if (d.norm() <= 1 && d.norm() > 0.01) return d.normalized();
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace vantage::testing
