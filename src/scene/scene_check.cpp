#include "scene/scene_check.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/read_limits.h"
#include "vantage/error.h"

namespace vantage::internal::scene {

void check_scene(const Scene& scene) {
  const auto refuse = [](ErrorCode code, std::string problem,
                         const char* fix = "give each triangle three vertices and an object") {
    throw Error(code, std::move(problem), "scene made in memory", fix);
  };
  const std::size_t objects = std::max<std::size_t>(1, scene.objects.size());
  if (!scene.object_of.empty() && scene.object_of.size() != scene.mesh.triangles.size()) {
    refuse(ErrorCode::array_sizes_differ, "object_of has " + std::to_string(scene.object_of.size()) + " entries for " +
                                              std::to_string(scene.mesh.triangles.size()) + " triangles");
  }
  for (std::uint32_t object : scene.object_of) {
    if (object >= objects)
      refuse(ErrorCode::index_out_of_range, "object index " + std::to_string(object) + " is out of range");
  }
  for (const Triangle& t : scene.mesh.triangles) {
    for (std::uint32_t corner : t) {
      if (corner >= scene.mesh.vertices.size())
        refuse(ErrorCode::index_out_of_range, "vertex index " + std::to_string(corner) + " is out of range");
    }
  }
  for (std::size_t i = 0; i < scene.mesh.vertices.size(); ++i) {
    const Vec3& v = scene.mesh.vertices[i];
    if (!v.allFinite())
      refuse(ErrorCode::coordinate_not_finite, "vertex " + std::to_string(i) + " is not finite", "give three numbers");
    if (v.cwiseAbs().maxCoeff() > core::kMaxCoordinate) {
      refuse(ErrorCode::coordinate_too_large,
             "vertex " + std::to_string(i) + " is more than " +
                 std::to_string(static_cast<long>(core::kMaxCoordinate / 1000)) + " km from the origin",
             "give coordinates in metres");
    }
  }
}

}  // namespace vantage::internal::scene
