#include "vantage/ground.h"

#include <algorithm>
#include <string>
#include <vector>

#include "scene/scene_check.h"
#include "vantage/error.h"
#include "vantage/navigation.h"

namespace vantage {
namespace {

/// A scene without objects has one, of no kind.
ObjectKind kind_of(const Scene& scene, std::uint32_t object) {
  return object < scene.objects.size() ? scene.objects[object].kind : ObjectKind::other;
}

/// The triangles of the objects for which `wanted` holds, with the vertices that they use.
template <typename Wanted>
Mesh part_of(const Scene& scene, const Wanted& wanted) {
  constexpr std::uint32_t kUnused = 0xffffffff;
  std::vector<std::uint32_t> number(scene.mesh.vertices.size(), kUnused);
  Mesh part;
  for (std::size_t t = 0; t < scene.object_of.size(); ++t) {
    if (!wanted(scene.object_of[t])) continue;
    Triangle triangle = scene.mesh.triangles[t];
    for (std::uint32_t& vertex : triangle) {
      if (number[vertex] == kUnused) {
        number[vertex] = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(scene.mesh.vertices[vertex]);
      }
      vertex = number[vertex];
    }
    part.triangles.push_back(triangle);
  }
  return part;
}

Mesh part_of_kind(const Scene& scene, ObjectKind kind) {
  return part_of(scene, [&](std::uint32_t object) { return kind_of(scene, object) == kind; });
}

bool is_level(const Mesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [&](const Vec3& vertex) { return vertex.z() == mesh.vertices.front().z(); });
}

}  // namespace

std::optional<Ground> ground_of(const Scene& scene) {
  internal::scene::check_scene(scene);
  Mesh mesh = part_of_kind(scene, ObjectKind::ground);
  if (mesh.empty()) {
    mesh = part_of_kind(scene, ObjectKind::surface);
  } else if (scene.georeference && scene.georeference->vertical == kFlatGround && is_level(mesh)) {
    return Ground{mesh.vertices.front().z()};
  }
  if (mesh.empty()) return std::nullopt;
  return Ground{0, std::make_shared<const Mesh>(std::move(mesh))};
}

std::shared_ptr<const Mesh> obstacles_of(const Scene& scene, const std::vector<std::uint32_t>& ground) {
  internal::scene::check_scene(scene);
  Mesh mesh = part_of(scene, [&](std::uint32_t object) {
    return kind_of(scene, object) != ObjectKind::ground &&
           std::find(ground.begin(), ground.end(), object) == ground.end();
  });
  if (mesh.empty()) mesh = scene.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), scene.overhead.vertices.begin(), scene.overhead.vertices.end());
  for (const Triangle& t : scene.overhead.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return std::make_shared<const Mesh>(std::move(mesh));
}

Ground ground_of(const Scene& scene, std::uint32_t object) {
  internal::scene::check_scene(scene);
  Mesh mesh = part_of(scene, [&](std::uint32_t other) { return other == object; });
  if (mesh.empty()) {
    throw Error(ErrorCode::value_out_of_range, "the scene has no object " + std::to_string(object) + " with triangles",
                "ground", "give the index of one of Scene::objects");
  }
  return Ground{0, std::make_shared<const Mesh>(std::move(mesh))};
}

}  // namespace vantage
