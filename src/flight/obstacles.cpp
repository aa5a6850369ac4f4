#include "flight/obstacles.h"

#include <utility>

#include "scene/obstacles.h"
#include "vantage/error.h"

namespace vantage::internal::flight {

std::vector<std::uint32_t> named_ground(const Mission& mission) {
  std::vector<std::uint32_t> ground;
  if (!mission.as_written.ground || mission.as_written.ground->object.empty()) return ground;
  const std::string& name = mission.as_written.ground->object;
  const std::vector<SceneObject>& objects = mission.scene().objects;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const SceneObject& object = objects[i];
    if (object.name == name || object.source_id == name || display_name(object) == name) ground.push_back(i);
  }
  return ground;
}

std::optional<Ground> ground_if_known(const Mission& mission) {
  try {
    return ground_of(mission);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::ground_missing) throw;
    return std::nullopt;
  }
}

Obstacles::Obstacles(const Mission& mission) : Obstacles(mission.scene(), named_ground(mission)) {}

Obstacles::Obstacles(const Scene& scene, const std::vector<std::uint32_t>& ground)
    : mesh_([&] {
        scene::Obstacles found = scene::obstacles_in(scene, ground);
        object_of_ = std::move(found.object_of);
        if (scene.mesh.empty()) return std::move(found.mesh);
        const Box box = bounding_box(scene.mesh);
        origin_ = (box.min + box.max) / 2;
        for (Vec3& vertex : found.mesh.vertices) vertex -= origin_;
        return std::move(found.mesh);
      }()),
      tree_(mesh_) {
  for (const SceneObject& object : scene.objects) names_.push_back(display_name(object));
  for (const OverheadLine& line : scene.overhead) names_.push_back(display_name(line.object));
}

Obstacles::Nearest Obstacles::nearest(const Vec3& point) const {
  const core::TriangleTree::Nearest found = tree_.nearest(point - origin_);
  return {found.distance, names_[object_of_[found.triangle]]};
}

}  // namespace vantage::internal::flight
