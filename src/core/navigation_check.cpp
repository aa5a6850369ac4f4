#include "core/navigation_check.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/limit_check.h"
#include "core/read_limits.h"
#include "core/solid_check.h"
#include "core/zone_check.h"
#include "vantage/error.h"

namespace vantage {
namespace internal::core {
namespace {

std::string member(const char* name) { return std::string("navigation.") + name; }

std::string member(const char* name, std::size_t index) { return member(name) + "[" + std::to_string(index) + "]"; }

/// `name`: of the limit, for the message.
void refuse(const std::optional<LimitFault>& fault, const std::string& name, const std::string& where) {
  if (fault) throw Error(fault->code, problem_of(name, *fault), where, fault->fix);
}

void check_triangles(const Mesh& mesh, const std::string& where) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite()) {
      throw Error(ErrorCode::coordinate_not_finite, "a coordinate is not finite",
                  where + ", vertex " + std::to_string(v), "give numbers");
    }
    if (mesh.vertices[v].cwiseAbs().maxCoeff() > kMaxCoordinate) {
      throw Error(ErrorCode::coordinate_too_large, "a coordinate is larger than 1,000,000 km",
                  where + ", vertex " + std::to_string(v), "give coordinates in metres");
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      if (vertex < mesh.vertices.size()) continue;
      throw Error(ErrorCode::index_out_of_range, "a vertex index is out of range",
                  where + ", triangle " + std::to_string(t), "mend the mesh");
    }
  }
}

void check_zones(const std::vector<Zone>& zones, const char* key) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    refuse(fault_of(zones[i]), zones[i].name.empty() ? member(key, i) : zone_name(zones, i), member(key, i));
    if (zones[i].above_ground) check_ground(zones[i].above_ground->ground, member(key, i));
  }
}

void check_clearance(const Clearance& clearance) {
  const std::string name = member("clearance");
  refuse(fault_of_clearance(clearance.distance_m), name, name);
  if (!clearance.obstacles) {
    throw Error(ErrorCode::nothing_given, "the clearance has no obstacles", name,
                "give those of the scene: obstacles_of");
  }
  check_triangles(*clearance.obstacles, name + ", obstacles");
}

}  // namespace

void check_ground(const Ground& ground, const std::string& where) {
  if (ground.surface) return check_triangles(*ground.surface, where + ", ground");
  if (!std::isfinite(ground.plane_z_m)) {
    throw Error(ErrorCode::value_out_of_range, "the plane of the ground is not finite", where + ", ground",
                "give its z in metres");
  }
}

// All members are named: a limit that is added does not compile here before it is checked.
std::vector<Mesh> checked_navigation(const Navigation& navigation, const ProgressReporter& progress) {
  const auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = navigation;
  if (altitude) refuse(fault_of_band(altitude->min_m, altitude->max_m), member("altitude"), member("altitude"));
  if (above_ground) {
    const std::string name = member("altitude.agl");
    refuse(fault_of_band(above_ground->min_m, above_ground->max_m), name, name);
    check_ground(above_ground->ground, name);
  }
  if (clearance) check_clearance(*clearance);
  refuse(fault_of_count(keep_in.size() + keep_out.size()), "navigation", "navigation");  // before their work
  check_zones(keep_in, "keep_in");
  check_zones(keep_out, "keep_out");
  std::vector<Mesh> checked;
  const auto count = static_cast<double>(meshes.size());
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto done = static_cast<double>(i);
    checked.push_back(checked_solid(meshes[i].mesh, meshes[i].name, progress.part(done / count, (done + 1) / count)));
  }
  return checked;
}

}  // namespace internal::core

void check_navigation(const Navigation& navigation, const Progress& callback) {
  const internal::core::ProgressReporter progress(callback);
  if (!navigation.meshes.empty()) progress.begin("navigation");  // all else takes no time
  internal::core::checked_navigation(navigation, progress);
  if (!navigation.meshes.empty()) progress.finish();
}

}  // namespace vantage
