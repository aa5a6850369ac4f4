// What an embedder does with `core` alone: a scene from arrays and one from a mesh file, an exact volume, queries, a
// mesh.
#include <cmath>
#include <cstdio>
#include <string>

#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/scene.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace {

/// A box of the size of a house, closed.
vantage::Scene house() {
  vantage::Scene scene;
  for (const double x : {10.0, 18.0}) {
    for (const double y : {-6.0, 6.0}) {
      for (const double z : {0.0, 9.0}) scene.mesh.vertices.emplace_back(x, y, z);
    }
  }
  scene.mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                          {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  scene.object_of.assign(scene.mesh.triangles.size(), 0);
  scene.objects = {{"house"}};
  return scene;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) return 2;
  const auto square = vantage::Target::polygon({{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
  const vantage::PreparedScene prepared(house());
  const vantage::PreparedTarget target(prepared, square, {.max_range_m = 40});
  const vantage::Volume volume = vantage::compute_visibility(target);
  const vantage::MeshMeasures measures = vantage::measure(volume.mesh);
  const auto answers = vantage::query_points(target, {}, {{0, 0, 10}, {25, 0, 2}});
  vantage::write_volume(volume, argv[2]);

  const vantage::PreparedScene plaza(vantage::read_scene(argv[1]));
  const vantage::Volume seen = vantage::compute_visibility({plaza, square, {.max_range_m = 50}});
  std::printf("house: %zu facets, %.0f m3; plaza: %zu facets\n", measures.facets, measures.volume_m3,
              seen.mesh.triangles.size());
  const double half_ball = 2.0 / 3.0 * std::acos(-1.0) * 40 * 40 * 40;
  const bool is_right = measures.closed && measures.volume_m3 > 0.3 * half_ball && measures.volume_m3 < half_ball &&
                        answers[0].inside && !answers[1].inside && answers[1].blocked_by.front() == "house" &&
                        vantage::measure(seen.mesh).closed;
  return is_right ? 0 : 1;
} catch (const vantage::Error& error) {
  std::puts(error.what());
  return 2;
}
