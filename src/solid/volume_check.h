// Whether a volume is what it should be.
#pragma once

#include "vantage/volume.h"

namespace vantage::solid {

/// Throws Error(input) when triangles and their causes differ in number, an index is out of range or a coordinate is
/// not finite: a caller may have changed the volume.
void check_volume(const Volume& volume);

/// Measures what the engine or a cut made. Throws Error(internal) unless it is closed and oriented: it must not be
/// written then.
MeshMeasures measure_sound(const Mesh& mesh);

}  // namespace vantage::solid
