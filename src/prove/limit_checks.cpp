#include "prove/limit_checks.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "prove/solid_mesh.h"
#include "prove/zone_rings.h"
#include "vantage/error.h"

namespace vantage::internal::prove {
namespace {

void require(bool is_right, const char* problem, const std::string& where, const char* fix) {
  if (!is_right) throw Error(ErrorCode::limits_reversed, problem, where, fix);
}

void check_mesh(const Mesh& mesh, const std::string& where) {
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (v < mesh.vertices.size() && mesh.vertices[v].allFinite()) continue;
      throw Error(ErrorCode::index_out_of_range, "a triangle names a vertex that is missing or not finite", where,
                  "mend the mesh");
    }
  }
}

void check_heights(const AboveGround& heights, const std::string& where) {
  if (!heights.ground.surface && !std::isfinite(heights.ground.plane_z_m)) {
    throw Error(ErrorCode::value_out_of_range, "the ground has no finite height", where, "give its z");
  }
  require(heights.min_m < heights.max_m, "the band above the ground is reversed or empty", where,
          "give the lower height first");
  if (heights.ground.surface) check_mesh(*heights.ground.surface, where);
}

void check_clearance(const Clearance& clearance) {
  if (!(clearance.distance_m > 0) || !std::isfinite(clearance.distance_m) || !clearance.obstacles) {
    throw Error(ErrorCode::value_out_of_range, "the clearance has no positive distance or no obstacles",
                "navigation clearance", "give both, or leave it out");
  }
  check_mesh(*clearance.obstacles, "navigation clearance");
}

void check_zones(const std::vector<Zone>& zones, const std::string& name) {
  for (const Zone& zone : zones) {
    const std::string where = name + " " + zone.name;
    require(zone.min_z_m < zone.max_z_m, "the zone is reversed or flat", where, "give the lower z first");
    if (zone.above_ground) check_heights(*zone.above_ground, where);
    check_rings(zone, where);
  }
}

void check_boxes_of(const std::vector<Box>& boxes, const std::string& name) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    require((boxes[i].min.array() < boxes[i].max.array()).all(), "the box is reversed or flat",
            name + " " + std::to_string(i), "give min smaller than max on every axis");
  }
}

}  // namespace

void check_limits(const Navigation& navigation) {
  if (const auto& altitude = navigation.altitude) {
    require(altitude->min_m < altitude->max_m, "the altitude band is reversed or empty", "navigation altitude",
            "give the lower altitude first");
  }
  check_boxes_of(navigation.keep_in, "keep_in");
  check_zones(navigation.keep_in_zones, "keep_in zone");
  check_boxes_of(navigation.keep_out, "keep_out");
  check_zones(navigation.keep_out_zones, "keep_out zone");
  for (const KeepInMesh& mesh : navigation.meshes) solid_mesh(mesh.mesh, "keep-in mesh '" + mesh.name + "'");
  if (navigation.above_ground) check_heights(*navigation.above_ground, "navigation altitude");
  if (navigation.clearance) check_clearance(*navigation.clearance);
}

}  // namespace vantage::internal::prove
