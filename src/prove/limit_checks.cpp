#include "prove/limit_checks.h"

#include <string>
#include <vector>

#include "prove/solid_mesh.h"
#include "prove/zone_rings.h"

namespace vantage::internal::prove {
namespace {

void check_zones(const std::vector<Zone>& zones, const std::string& name) {
  for (const Zone& zone : zones) check_rings(zone, name + " " + zone.name);
}

}  // namespace

void check_limits(const Navigation& navigation) {
  check_zones(navigation.keep_in_zones, "keep_in zone");
  check_zones(navigation.keep_out_zones, "keep_out zone");
  for (const KeepInMesh& mesh : navigation.meshes) solid_mesh(mesh.mesh, "keep-in mesh '" + mesh.name + "'");
}

}  // namespace vantage::internal::prove
