// Closed meshes to stay in.
#pragma once

#include <vector>

#include "prove/limited_volume.h"
#include "vantage/navigation.h"

namespace vantage::internal::prove {

/// The worst of the proofs for each mesh.
ClaimProof prove_meshes(const LimitedVolume& volume, const std::vector<KeepInMesh>& meshes);

}  // namespace vantage::internal::prove
