#include "cli/plain_volume.h"

#include <utility>

namespace vantage::cli {

Volume plain_volume(Mesh mesh, const std::string& cause) {
  Volume volume;
  volume.causes = {{CauseKind::scene, cause, surface_area(mesh)}};
  volume.cause_of.assign(mesh.triangles.size(), 0);
  volume.mesh = std::move(mesh);
  return volume;
}

}  // namespace vantage::cli
