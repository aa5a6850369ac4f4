// Where the copies of an i3dm stand (3D Tiles 1.0, section "Instanced 3D Model").
#pragma once

#include <cstdint>
#include <vector>

#include "tiles/tables.h"

namespace vantage::internal::tiles {

struct Instance {
  Transform transform;  ///< of the model, z up, into the tile's coordinates
  std::uint64_t batch = 0;
};

/// How many there are. Throws std::string where the table does not say.
std::size_t instance_count(const Table& features);

/// Throws std::string, what is wrong. `into_world`: of the tile, for instances that stand upright on the earth.
std::vector<Instance> instances_of(const Table& features, const Transform& into_world);

}  // namespace vantage::internal::tiles
