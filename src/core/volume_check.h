// Whether a volume is what it should be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vantage/volume.h"

namespace vantage::internal::core {

/// What each triangle of a mesh belongs to.
struct Labels {
  const std::vector<std::uint32_t>& of;  ///< per triangle: below `count`
  std::size_t count;
  const char* owner;  ///< for messages: "volume"
  const char* name;   ///< "cause"
  const char* fix;
};

/// Throws Error(input) when triangles and labels differ in number, an index is out of range or a coordinate is not
/// finite: a caller may have changed the mesh.
void check_labelled(const Mesh& mesh, const Labels& labels);

/// The same of a volume and its causes.
void check_volume(const Volume& volume);

/// Measures what the engine or a cut made. Throws Error(internal) unless it is closed and oriented: it must not be
/// written then.
VANTAGE_INTERNAL_API MeshMeasures measure_sound(const Mesh& mesh);

}  // namespace vantage::internal::core
