// What a program that uses vantage looks like: a target on the ground between two walls.
#include <cmath>
#include <cstdio>

#include "vantage/scene.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace {

/// Adds the upright rectangle over the segment from a to b, `height` metres tall, as an object of its own.
void add_wall(vantage::Scene& scene, const vantage::Vec3& a, const vantage::Vec3& b, double height, const char* name) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  const vantage::Vec3 up(0, 0, height);
  scene.mesh.vertices.insert(scene.mesh.vertices.end(), {a, b, b + up, a + up});
  scene.mesh.triangles.push_back({first, first + 1, first + 2});
  scene.mesh.triangles.push_back({first, first + 2, first + 3});
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scene.object_of.insert(scene.object_of.end(), 2, object);
  scene.objects.emplace_back(name);
}

}  // namespace

int main() {
  vantage::Scene scene;
  add_wall(scene, {-20, 10, 0}, {20, 10, 0}, 15, "north wall");
  add_wall(scene, {-20, -10, 0}, {20, -10, 0}, 15, "south wall");

  vantage::Target target;
  target.vertices = {{-5, -5, 0}, {5, -5, 0}, {0, 5, 0}};
  const double range = 50;
  const vantage::Volume volume =
      vantage::compute_visibility(vantage::PreparedScene(scene), target, vantage::Sensor{range});

  const vantage::MeshMeasures measures = vantage::measure(volume.mesh);
  std::printf("volume %.1f m3, %zu facets, %zu causes\n", measures.volume_m3, measures.facets, volume.causes.size());
  // Two walls take something away from the half ball, but not all of it.
  const double half_ball = 2.0 / 3.0 * std::acos(-1.0) * range * range * range;
  const bool plausible = measures.closed && measures.euler == 2 && measures.volume_m3 > 0.1 * half_ball &&
                         measures.volume_m3 < 0.9 * half_ball;
  if (!plausible) std::puts("this is not the volume of a target between two walls");
  return plausible ? 0 : 1;
}
