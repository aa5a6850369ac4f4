// Whether the arrays of a volume fit together.
#pragma once

#include "vantage/volume.h"

namespace vantage::solid {

/// Throws Error(input) when triangles and their causes differ in number, an index is out of range or a coordinate is
/// not finite: a caller may have changed the volume.
void check_volume(const Volume& volume);

}  // namespace vantage::solid
