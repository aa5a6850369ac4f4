#include <utility>

#include "solid/region_builder.h"

namespace vantage::internal::solid {
namespace {

Emptiness explain_mesh(const Region& region, const Remainder& left) {
  return {region.name + " does not meet " + left.text(), "check its place and its axes: the scene frame, metres, z up"};
}

}  // namespace

template <>
void add_regions<Limit::meshes>(const std::vector<KeepInMesh>& meshes, RegionBuilder& builder) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Mesh& mesh = builder.meshes()[i];
    const std::string& name = meshes[i].name;
    const std::string full_name = std::string("mesh ").append(name);
    const std::uint32_t label = builder.add_source({builder.add_cause(full_name)});
    std::vector<std::uint32_t> labels(mesh.triangles.size(), label);
    builder.keep({std::string("the ").append(full_name),
                  Solid(moved_to_origin(mesh, std::move(labels), builder.origin()), name), explain_mesh});
  }
}

}  // namespace vantage::internal::solid
