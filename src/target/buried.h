// Whether a target seems to lie under the ground.
#pragma once

#include <optional>
#include <string>

#include "scene/prepared_data.h"
#include "target/lengths.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage::internal::target {

/// A sentence for people where nothing of the scene is below the target and what is above all of it is either all that
/// there is or spreads over most of the scene: it names that object, and the smallest offset that brings the target out
/// where there is one of a few metres. A scene may be anything, a canopy alone too: such a target is computed like any
/// other.
std::optional<Warning> buried_note(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                                   const Lengths& lengths);

}  // namespace vantage::internal::target
