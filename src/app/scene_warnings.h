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

/// The first object that a point lies in: of its facets on the vertical line through the point an odd number is above,
/// and an even number in all, or else it is not closed there. Nothing where the point is in the open; nor, mostly,
/// where houses and their ground are one object, which as a whole is not closed.
std::optional<std::uint32_t> object_round(const LoadedScene& loaded, const Vec3& at);

/// Of these the one that tells that the scene seems to lie on its side, with what to do. Looked for once.
std::optional<Warning> on_its_side(const LoadedScene& loaded);

}  // namespace vantage::internal::app
