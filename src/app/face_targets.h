// Targets that are roofs and facades of the scene's objects.
#pragma once

#include <optional>
#include <vector>

#include "geo/on_globe.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

struct FaceTargets {
  std::vector<Target> targets;
  std::optional<Warning> note = std::nullopt;  ///< how many faces are one target, where they are several
};

/// The faces that `wanted` means, in the scene frame, each a target: of the name that `target` has, or of the object's
/// and the part's, and with its offset. `together`: one target of all of them. `globe`: of the scene; needed for at_deg
/// only. Throws Error(input), with the place in the mission file, for an object that is not there and for one without
/// such a face.
FaceTargets face_targets(const Mission& mission, const FaceTarget& wanted, const Target& target,
                         const geo::OnGlobe* globe, bool together);

}  // namespace vantage::internal::app
