// From what booleans leave to a volume.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <utility>
#include <vector>

#include "solid/csg.h"
#include "vantage/volume.h"

namespace vantage::solid {

/// Makes `labelled`, in the scene frame, the result's mesh: each facet with the cause that `cause_of_label` says, an
/// index into `causes`; of these the ones that still bound something, with their areas.
template <typename CauseOfLabel>
void take_over(LabelledMesh labelled, const std::vector<Cause>& causes, const CauseOfLabel& cause_of_label,
               Volume& result) {
  std::vector<double> area(causes.size(), 0);
  std::vector<bool> used(causes.size(), false);
  std::vector<std::uint32_t> cause_of;
  const Mesh& mesh = labelled.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t cause = cause_of_label(labelled.labels[t]);
    const Vec3& a = mesh.vertices[mesh.triangles[t][0]];
    area[cause] += (mesh.vertices[mesh.triangles[t][1]] - a).cross(mesh.vertices[mesh.triangles[t][2]] - a).norm() / 2;
    used[cause] = true;
    cause_of.push_back(cause);
  }
  std::vector<std::uint32_t> new_index(causes.size(), 0);
  result.causes.clear();
  for (std::size_t cause = 0; cause < area.size(); ++cause) {
    if (!used[cause]) continue;
    new_index[cause] = static_cast<std::uint32_t>(result.causes.size());
    result.causes.push_back({causes[cause].kind, causes[cause].name, area[cause]});
  }
  for (std::uint32_t& cause : cause_of) cause = new_index[cause];
  result.cause_of = std::move(cause_of);
  result.mesh = std::move(labelled.mesh);
}

}  // namespace vantage::solid
