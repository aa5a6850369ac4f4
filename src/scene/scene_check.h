// What is wrong with the arrays of a scene.
#pragma once

#include "vantage/scene.h"

namespace vantage::internal::scene {

/// Throws Error(input) for an index out of range, an object_of of another length than the triangles (it may be empty),
/// and a coordinate that is not finite or beyond kMaxCoordinate. Cost: linear.
void check_scene(const Scene& scene);

}  // namespace vantage::internal::scene
