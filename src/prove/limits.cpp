#include "prove/limits.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "prove/limits_distance.h"
#include "prove/limits_ground.h"
#include "prove/limits_mesh.h"
#include "prove/limits_sensor.h"
#include "prove/limits_zones.h"
#include "vantage/error.h"

namespace vantage::internal::prove {
namespace {

/// Cut faces are put into such planes exactly: what a file rounded is all that is allowed.
ClaimProof prove_within_box(const std::string& name, const LimitedVolume& volume, const Box& box) {
  Broken worst;
  for (const Triangle& triangle : volume.solid().triangles) {
    for (const std::uint32_t v : triangle) {
      const Vec3& at = volume.solid().vertices[v];
      worst.see((box.min - at).cwiseMax(at - box.max).maxCoeff(), at - volume.origin());
    }
  }
  if (worst.by_m > volume.rounding_m()) return volume.wrong(name, worst, "the limit");
  return proved(name, "it holds at every vertex, and what it allows is convex");
}

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
    const auto bounds_nothing = [](const Zone::Ring& ring) { return ring.size() < 3; };
    if (bounds_nothing(zone.outer) || std::any_of(zone.holes.begin(), zone.holes.end(), bounds_nothing)) {
      throw Error(ErrorCode::zone_not_simple, "a ring of the zone has fewer than 3 corners", where,
                  "give the corners in order");
    }
  }
}

void check_boxes_of(const std::vector<Box>& boxes, const std::string& name) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    require((boxes[i].min.array() < boxes[i].max.array()).all(), "the box is reversed or flat",
            name + " " + std::to_string(i), "give min smaller than max on every axis");
  }
}

}  // namespace

// All members are named: a limit that is added does not compile here before it is proved or named.
std::vector<ClaimProof> prove_limits(const LimitedVolume& volume, const LimitedVolume& seen,
                                     const std::vector<View>& parts, const Sensor& sensor, const Navigation& navigation,
                                     const core::ProgressReporter& progress) {
  const auto& [altitude, keep_in, keep_in_zones, keep_out, keep_out_zones, meshes, above_ground, clearance] =
      navigation;
  check_boxes_of(keep_in, "keep_in");
  check_zones(keep_in_zones, "keep_in zone");
  check_boxes_of(keep_out, "keep_out");
  check_zones(keep_out_zones, "keep_out zone");
  for (const KeepInMesh& mesh : meshes) check_mesh(mesh.mesh, "keep-in mesh '" + mesh.name + "'");
  if (above_ground) check_heights(*above_ground, "navigation altitude");
  if (clearance) check_clearance(*clearance);
  std::vector<ClaimProof> claims;
  if (altitude) {
    require(altitude->min_m < altitude->max_m, "the altitude band is reversed or empty", "navigation altitude",
            "give the lower altitude first");
    const double all = std::numeric_limits<double>::infinity();
    claims.push_back(
        prove_within_box("altitude", volume, {{-all, -all, altitude->min_m}, {all, all, altitude->max_m}}));
  }
  if (keep_in.size() == 1 && keep_in_zones.empty()) {
    claims.push_back(prove_within_box("keep_in", volume, keep_in[0]));
  } else if (!keep_in.empty() || !keep_in_zones.empty()) {
    claims.push_back(prove_keep_in(volume, navigation, progress.part(0, 0.2)));
  }
  if (!keep_out.empty() || !keep_out_zones.empty()) {
    claims.push_back(prove_keep_out(volume, navigation, progress.part(0.2, 0.4)));
  }
  if (!meshes.empty()) claims.push_back(prove_meshes(volume, meshes));
  if (above_ground) claims.push_back(prove_above_ground("agl", volume, *above_ground, progress.part(0.4, 0.5)));
  if (clearance) claims.push_back(prove_clearance(volume, *clearance, progress.part(0.5, 0.7)));
  const std::vector<ClaimProof> of_sensor = prove_sensor(seen, sensor, parts, progress.part(0.7, 1));
  claims.insert(claims.end(), of_sensor.begin(), of_sensor.end());
  return claims;
}

}  // namespace vantage::internal::prove
