#include "vantage/ground.h"

#include <algorithm>
#include <string>
#include <vector>

#include "scene/obstacles.h"
#include "scene/scene_check.h"
#include "vantage/error.h"
#include "vantage/navigation.h"

namespace vantage {
namespace {

/// A scene without objects has one, of no kind.
ObjectKind kind_of(const Scene& scene, std::uint32_t object) {
  return object < scene.objects.size() ? scene.objects[object].kind : ObjectKind::other;
}

/// The triangles of the objects for which `wanted` holds, with the vertices that they use; their objects too.
template <typename Wanted>
Mesh part_of(const Scene& scene, const Wanted& wanted, std::vector<std::uint32_t>* objects = nullptr) {
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
    if (objects) objects->push_back(scene.object_of[t]);
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

void add_overhead(const Scene& scene, std::uint32_t first_object, Mesh& mesh, std::vector<std::uint32_t>& object_of) {
  for (const OverheadLine& line : scene.overhead) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), line.mesh.vertices.begin(), line.mesh.vertices.end());
    for (const Triangle& t : line.mesh.triangles) {
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    object_of.resize(mesh.triangles.size(), first_object++);
  }
}

}  // namespace

namespace internal::scene {

Obstacles obstacles_in(const Scene& scene, const std::vector<std::uint32_t>& ground) {
  Obstacles result;
  const auto wanted = [&](std::uint32_t object) {
    return kind_of(scene, object) != ObjectKind::ground &&
           std::find(ground.begin(), ground.end(), object) == ground.end();
  };
  result.mesh = part_of(scene, wanted, &result.object_of);
  if (result.mesh.empty()) {
    result.mesh = scene.mesh;
    result.object_of = scene.object_of;
    result.object_of.resize(scene.mesh.triangles.size(), 0);
  }
  add_overhead(scene, static_cast<std::uint32_t>(scene.objects.size()), result.mesh, result.object_of);
  return result;
}

Scene overhead_alone(const Scene& scene) {
  Scene alone;
  add_overhead(scene, 0, alone.mesh, alone.object_of);
  for (const OverheadLine& line : scene.overhead) alone.objects.push_back(line.object);
  return alone;
}

}  // namespace internal::scene

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
  return std::make_shared<const Mesh>(std::move(internal::scene::obstacles_in(scene, ground).mesh));
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
