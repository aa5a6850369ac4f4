// Random numbers that depend on the seed and the number of the viewpoint only, never on threads or order.
// SplitMix64: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
#pragma once

#include <cstdint>

namespace vantage::internal::verify {

class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t index) : state_(mixed(mixed(seed) + index)) {}

  std::uint64_t next() { return mixed(state_ += 0x9e3779b97f4a7c15u); }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace vantage::internal::verify
