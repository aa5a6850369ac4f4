// Targets that are roofs and facades of the scene's objects.
#pragma once

#include "geo/local_frame.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// Makes `mission.target` of the faces that `wanted` means: in the scene frame, a part for each convex piece. A target
/// without a name gets the object's and that of the part. `frame`: of the scene; needed for at_deg only. Throws
/// Error(input), with the place in the mission file, for an object that is not there and for one without such a face.
void take_faces(Mission& mission, const FaceTarget& wanted, const geo::LocalFrame* frame);

}  // namespace vantage::internal::app
