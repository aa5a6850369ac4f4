#include "maps/city/assembly.h"

#include <string>

namespace vantage::internal::city {
namespace {

void append(Scene& scene, const Mesh& mesh, const SceneObject& named) {
  if (mesh.empty()) return;
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scene.mesh.vertices.insert(scene.mesh.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const Triangle& t : mesh.triangles) scene.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  scene.object_of.resize(scene.mesh.triangles.size(), object);
  scene.objects.push_back(named);
}

}  // namespace

Scene assemble(const Site& site, const std::vector<Mesh>& solids, const Mesh& ground) {
  Scene scene;
  std::size_t vertices = ground.vertices.size(), triangles = ground.triangles.size();
  for (const Mesh& solid : solids) {
    vertices += solid.vertices.size();
    triangles += solid.triangles.size();
  }
  scene.mesh.vertices.reserve(vertices);
  scene.mesh.triangles.reserve(triangles);
  scene.object_of.reserve(triangles);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    append(scene, solids[i], site.items[i].record.object);
  }
  append(scene, ground, {"ground", "", ObjectKind::ground});
  return scene;
}

}  // namespace vantage::internal::city
