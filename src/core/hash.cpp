// docs/hashes.md
#include <span>

#include "core/sha256.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

void add_corners(const Mesh& mesh, std::size_t triangle, internal::core::Sha256& hash) {
  for (const std::uint32_t corner : mesh.triangles[triangle]) {
    if (corner >= mesh.vertices.size()) {
      throw Error(ErrorCode::index_out_of_range, "vertex index " + std::to_string(corner) + " is out of range",
                  "triangle " + std::to_string(triangle), "give indices of the mesh's own vertices");
    }
    hash.add(std::span(mesh.vertices[corner].data(), 3));
  }
}

}  // namespace

std::string scene_hash(const Scene& scene) {
  const std::vector<Triangle>& triangles = scene.mesh.triangles;
  if (!scene.object_of.empty() && scene.object_of.size() != triangles.size()) {
    throw Error(ErrorCode::array_sizes_differ, "the scene names objects for another number of triangles", "object_of",
                "give one object for each triangle, or none");
  }
  internal::core::Sha256 hash;
  hash.add("vantage scene 1\n");
  hash.add(static_cast<std::uint64_t>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    add_corners(scene.mesh, t, hash);
    hash.add(scene.object_of.empty() ? std::uint32_t{0} : scene.object_of[t]);
  }
  return hash.hex();
}

std::string volume_hash(const Mesh& mesh) {
  internal::core::Sha256 hash;
  hash.add("vantage volume 1\n");
  hash.add(static_cast<std::uint64_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) add_corners(mesh, t, hash);
  return hash.hex();
}

}  // namespace vantage
