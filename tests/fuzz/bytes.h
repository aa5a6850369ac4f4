// Numbers and closed meshes out of any bytes; after the last byte all is zero.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "support/solids.h"
#include "vantage/error.h"
#include "vantage/geometry.h"

namespace vantage::fuzzing {

inline void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : std::uint8_t{0}; }
  std::uint32_t below(std::uint32_t count) { return byte() % count; }
  /// On a grid, so that things touch and lie in one plane; a few roundings beside it; or any number.
  double number() {
    const std::uint8_t how = byte();
    double value = (static_cast<int>(byte()) - 128) / 16.0;
    if (how < 200) return value;
    if (how < 240) return value * (1 + std::ldexp(static_cast<int>(how) - 220, -52));
    std::uint64_t bits = 0;
    for (int i = 0; i < 8; ++i) bits = bits << 8U | byte();
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  Vec3 point() {
    const double x = number(), y = number();
    return {x, y, number()};
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

/// Closed and outward at first, as a dome or as boxes; then moved about, and now and then broken.
inline Mesh draw_solid(Bytes& bytes) {
  Mesh mesh;
  if (bytes.below(2) == 0) {
    const int sectors = 3 + static_cast<int>(bytes.below(5)), rings = 1 + static_cast<int>(bytes.below(4));
    mesh = testing::make_dome(Vec3::Zero(), sectors, rings, [&](double, double) {
             return 1 + bytes.below(32) / 4.0;
           }).mesh;
  } else {
    for (std::uint32_t boxes = 1 + bytes.below(3); boxes > 0; --boxes) {
      const Vec3 low = bytes.point();
      testing::append(mesh, testing::make_box_mesh(low, low + Vec3(1, 2, 3) * (1 + bytes.below(4))));
    }
  }
  for (std::uint32_t moved = bytes.below(8); moved > 0; --moved) {
    mesh.vertices[bytes.byte() % mesh.vertices.size()] = bytes.point();
  }
  for (std::uint32_t broken = bytes.below(16); broken > 14; --broken) {
    mesh.triangles[bytes.byte() % mesh.triangles.size()][bytes.below(3)] = bytes.byte();
  }
  return mesh;
}

/// What is refused must be the fault of the input, and said in one line.
inline void check_refusal(const Error& error) {
  require(error.kind() == ErrorKind::input, "what cannot be done is an input error");
  require(error.problem().find('\n') == std::string::npos, "a problem is one line");
}

}  // namespace vantage::fuzzing
