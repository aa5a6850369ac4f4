#include <array>
#include <cmath>
#include <string>

#include "core/solid_check.h"
#include "core/text.h"
#include "core/zone_check.h"
#include "solid/navigation.h"
#include "vantage/error.h"

namespace vantage::internal::solid {
namespace {

/// One pair of limits; `what` and `axis` are for the message: "the altitude band", "".
void check_pair(double min, double max, const std::string& what, const std::string& axis, const std::string& where) {
  const auto refuse = [&](ErrorCode code, const std::string& problem, const char* fix) {
    throw Error(code, std::string(what).append(" ").append(problem), where, fix);
  };
  const std::string of_axis = axis.empty() ? "" : std::string(" in ").append(axis);
  if (!std::isfinite(min) || !std::isfinite(max)) {
    refuse(ErrorCode::value_out_of_range, std::string("is not finite").append(of_axis),
           "give numbers; leave a limit out where there is none");
  }
  if (min > max) {
    refuse(ErrorCode::limits_reversed,
           std::string("is reversed")
               .append(of_axis)
               .append(": min ")
               .append(core::number_text(min))
               .append(" is above max ")
               .append(core::number_text(max)),
           "swap the two");
  }
  if (min == max) {
    refuse(ErrorCode::limits_empty,
           std::string("is empty").append(of_axis).append(": min and max are both ").append(core::number_text(min)),
           "give a max above the min");
  }
}

void check_boxes(const std::vector<Box>& boxes, const std::string& name, const std::string& key) {
  constexpr std::array kAxes = {"x", "y", "z"};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const std::string index = std::to_string(i);
    for (unsigned axis = 0; axis < 3; ++axis) {
      check_pair(boxes[i].min[axis], boxes[i].max[axis], std::string(name).append(" ").append(index), kAxes[axis],
                 std::string("navigation.").append(key).append("[").append(index).append("]"));
    }
  }
}

[[noreturn]] void refuse(const std::string& problem, const std::string& where, const char* fix) {
  throw Error(ErrorCode::value_out_of_range, problem, where, fix);
}

/// `what`, of the mesh, is for the message: "the ground".
void check_triangles(const Mesh& mesh, const std::string& what, const std::string& where) {
  for (const Vec3& vertex : mesh.vertices) {
    if (!vertex.allFinite()) refuse(what + ": a vertex is not finite", where, "mend the mesh");
  }
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= mesh.vertices.size()) refuse(what + ": an index is out of range", where, "mend the mesh");
    }
  }
}

void check_ground(const Ground& ground, const std::string& where) {
  if (!std::isfinite(ground.plane_z_m)) {
    refuse("the plane of the ground is not finite", where, "give its z in metres");
  }
  if (ground.surface) check_triangles(*ground.surface, "the ground", where);
}

void check_clearance(const Clearance& clearance) {
  const std::string where = "navigation.clearance";
  if (!(clearance.distance_m > 0) || !std::isfinite(clearance.distance_m)) {
    refuse("the clearance is not a positive, finite number of metres", where, "leave it out where there is none");
  }
  if (!clearance.obstacles) refuse("the clearance has no obstacles", where, "give those of the scene: obstacles_of");
  check_triangles(*clearance.obstacles, "the obstacles", where);
}

void check_zones(const std::vector<Zone>& zones, const char* key) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const std::string where = std::string("navigation.").append(key).append("[").append(std::to_string(i)).append("]");
    if (const auto fault = core::fault_of(zones[i])) {
      throw Error(fault->code, std::string("zone ").append(zones[i].name).append(": ").append(fault->problem), where,
                  fault->fix);
    }
    if (zones[i].above_ground) check_ground(zones[i].above_ground->ground, where);
  }
}

}  // namespace

void check_limits(const Navigation& navigation) {
  if (navigation.altitude) {
    check_pair(navigation.altitude->min_m, navigation.altitude->max_m, "the altitude band", "", "navigation.altitude");
  }
  if (const auto& limit = navigation.above_ground) {
    check_pair(limit->min_m, limit->max_m, "the band above the ground", "", "navigation.altitude.agl");
    check_ground(limit->ground, "navigation.ground");
  }
  if (navigation.clearance) check_clearance(*navigation.clearance);
  check_boxes(navigation.keep_in, "box", "boxes");
  check_boxes(navigation.keep_out, "keep_out", "keep_out");
  check_zones(navigation.keep_in_zones, "keep_in_zones");
  check_zones(navigation.keep_out_zones, "keep_out_zones");
}

std::vector<Mesh> check_navigation(const Navigation& navigation, const core::ProgressReporter& progress) {
  check_limits(navigation);
  std::vector<Mesh> meshes;
  const auto count = static_cast<double>(navigation.meshes.size());
  for (std::size_t i = 0; i < navigation.meshes.size(); ++i) {
    const KeepInMesh& keep_in = navigation.meshes[i];
    const auto done = static_cast<double>(i);
    meshes.push_back(core::checked_solid(keep_in.mesh, keep_in.name, progress.part(done / count, (done + 1) / count)));
  }
  return meshes;
}

}  // namespace vantage::internal::solid
