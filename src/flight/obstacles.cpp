#include "flight/obstacles.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "vantage/scene.h"

namespace vantage::internal::flight {
namespace {

bool is_ground(const SceneObject& object, const std::string& named) {
  if (object.kind == ObjectKind::ground) return true;
  return !named.empty() && (object.name == named || object.source_id == named || display_name(object) == named);
}

/// The triangles that count, moved by -origin, and their objects.
std::pair<Mesh, std::vector<std::uint32_t>> obstacles_in(const Mission& mission, const Vec3& origin) {
  const Scene& scene = mission.scene();
  const std::string named = mission.as_written.ground ? mission.as_written.ground->object : "";
  std::vector<bool> counts(scene.objects.size());
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = !is_ground(scene.objects[i], named);
  const auto is_counted = [&](std::uint32_t object) { return counts[object]; };
  const bool has_any = std::any_of(scene.object_of.begin(), scene.object_of.end(), is_counted);

  std::pair<Mesh, std::vector<std::uint32_t>> result;
  result.first.vertices.reserve(scene.mesh.vertices.size());
  for (const Vec3& vertex : scene.mesh.vertices) result.first.vertices.push_back(vertex - origin);
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (has_any && !is_counted(scene.object_of[t])) continue;
    result.first.triangles.push_back(scene.mesh.triangles[t]);
    result.second.push_back(scene.object_of[t]);
  }
  return result;
}

Vec3 middle_of(const Mesh& mesh) {
  if (mesh.empty()) return Vec3::Zero();
  const Box box = bounding_box(mesh);
  return (box.min + box.max) / 2;
}

std::vector<std::string> names_in(const Scene& scene) {
  std::vector<std::string> names;
  for (const SceneObject& object : scene.objects) names.push_back(display_name(object));
  return names;
}

}  // namespace

Obstacles::Obstacles(const Mission& mission)
    : origin_(middle_of(mission.scene().mesh)),
      names_(names_in(mission.scene())),
      mesh_([&] {
        auto [mesh, objects] = obstacles_in(mission, origin_);
        object_of_ = std::move(objects);
        return std::move(mesh);
      }()),
      tree_(mesh_) {}

Obstacles::Nearest Obstacles::nearest(const Vec3& point) const {
  const core::TriangleTree::Nearest found = tree_.nearest(point - origin_);
  return {found.distance, names_[object_of_[found.triangle]]};
}

}  // namespace vantage::internal::flight
