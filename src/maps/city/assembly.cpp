#include "maps/city/assembly.h"

#include "maps/terrain/raster_ground.h"

namespace vantage::internal::city {
Scene assemble(const Site& site, const std::vector<Mesh>& solids, const Ground& ground, MissingPolicy missing) {
  Scene scene;
  std::size_t vertices = ground.mesh().vertices.size(), triangles = ground.mesh().triangles.size();
  for (const Mesh& solid : solids) {
    vertices += solid.vertices.size();
    triangles += solid.triangles.size();
  }
  scene.mesh.vertices.reserve(vertices);
  scene.mesh.triangles.reserve(triangles);
  scene.object_of.reserve(triangles);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    terrain::append_object(scene, solids[i], site.items[i].record.object);
  }
  ground.add_to(scene, missing);
  return scene;
}

}  // namespace vantage::internal::city
