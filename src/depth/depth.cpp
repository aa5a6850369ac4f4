#include "depth/depth.h"

namespace vantage::internal::depth {

const std::array<CubeFace, 6>& cube_faces() {
  static const std::array<CubeFace, 6> kFaces = [] {
    const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
    return std::array<CubeFace, 6>{{{x, -y, z}, {-x, y, z}, {y, x, z}, {-y, -x, z}, {z, x, -y}, {-z, x, y}}};
  }();
  return kFaces;
}

}  // namespace vantage::internal::depth
