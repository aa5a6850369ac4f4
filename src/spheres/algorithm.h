// Algorithm 1 of Willis, Hague, Wolek and Brink (2024): the intersection of the visibility spheres of a polygon's
// vertices, with edges halved while the intersection of the spheres of their ends is not a topological sphere.
// docs/spheres.md says what each step means where the paper leaves it open.
#pragma once

#include <array>
#include <optional>

#include "core/progress_reporter.h"
#include "solid/csg.h"
#include "spheres/sphere_maker.h"
#include "vantage/spheres.h"
#include "vantage/target.h"

namespace vantage::internal::spheres {

struct Intersection {
  solid::LabelledMesh mesh;      ///< target's frame; labels are SphereLabel; closed; may be empty
  std::optional<Vec3> blocked;   ///< the point that sees nothing: the run ended there
  std::array<Vec3, 2> unseen{};  ///< where the mesh is empty: the two points whose spheres do not meet, or the same
                                 ///< twice where that of this point does not meet those before it
};

/// Runs the algorithm over the corners of `frame.polygon`; a single one is a sphere. Fills all of the report but the
/// device. Stage meshes are in the scene frame. Points are numbered: the polygon's corners, then midpoints as they
/// come.
Intersection intersect_spheres(const TargetFrame& frame, const SphereMaker& maker, const SpheresOptions& options,
                               SpheresReport& report, const StageSink& stages, const core::ProgressReporter& progress);

}  // namespace vantage::internal::spheres
