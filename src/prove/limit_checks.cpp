#include "prove/limit_checks.h"

#include <string>
#include <vector>

#include "prove/solid_mesh.h"
#include "prove/zone_rings.h"

namespace vantage::internal::prove {
namespace {

void check_zones(const std::vector<Zone>& zones, const std::string& name) {
  for (std::size_t i = 0; i < zones.size(); ++i) check_rings(zones[i], name + " " + zone_name(zones, i));
}

}  // namespace

void check_limits(const Navigation& navigation) {
  check_zones(navigation.keep_in, "keep_in");
  check_zones(navigation.keep_out, "keep_out");
  for (const KeepInMesh& mesh : navigation.meshes) solid_mesh(mesh.mesh, "keep-in mesh '" + mesh.name + "'");
}

}  // namespace vantage::internal::prove
