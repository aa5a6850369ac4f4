// What makes a mission's result nonsense though nothing in it is wrong by itself: a target far off the scene, a scene
// that lies on its side, a volume under the ground.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vantage/mission.h"

namespace vantage::internal::app {

/// None where all is as usual. `volume` may be null or empty. Cost: linear in the scene's
/// triangles.
std::vector<Warning> scene_warnings(const Mission& mission, const Volume* volume);

/// The first object that a point lies in: one that has, straight above the point, a facet more that faces up than that
/// faces down, and a floor below, which faces down, also if it is one object with the ground. Nothing where the point
/// is in the open, under a roof without a floor, or in an object whose facets face inward.
std::optional<std::uint32_t> object_round(const LoadedScene& loaded, const Vec3& at);

/// Throws Error(target_inside_solid) where the middle or a corner of a target lies in what only stands in for something
/// that is not built, or under what fills a void of a raster: nobody knows what is seen from there.
void refuse_in_stand_ins(const LoadedScene& loaded, const Target& target);
/// The same for all targets of a mission.
void refuse_in_stand_ins(const Mission& mission);

/// Of these the one that tells that the scene seems to lie on its side, with what to do. Looked for once.
std::optional<Warning> on_its_side(const LoadedScene& loaded);

}  // namespace vantage::internal::app
