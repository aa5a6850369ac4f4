// A mesh whose triangles say where they come from.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::core {

/// A mesh with one label per triangle.
struct LabelledMesh {
  Mesh mesh;
  std::vector<std::uint32_t> labels;  ///< parallel to mesh.triangles
};

}  // namespace vantage::internal::core
