// Gives bytes to a mesh reader. It may refuse them with an input error; what it reads must keep what it promises.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "fuzz/bytes.h"
#include "io/mesh_readers.h"
#include "support/internals.h"
#include "vantage/error.h"

namespace vantage::fuzzing {

inline void check(const io::RawMesh& mesh) {
  require(!mesh.triangles.empty(), "there is a triangle");
  require(mesh.object_of.size() == mesh.triangles.size(), "every triangle has an object");
  for (const Vec3& vertex : mesh.vertices) require(vertex.allFinite(), "coordinates are finite");
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) require(corner < mesh.vertices.size(), "corners are in range");
  }
  std::vector<bool> used(mesh.objects.size(), false);
  for (const std::uint32_t object : mesh.object_of) {
    require(object < mesh.objects.size(), "objects are in range");
    used[object] = true;
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    require(used[i], "every object has a triangle");
    require(!display_name(mesh.objects[i]).empty(), "every object has a name");
  }
}

template <class Reader>
void read(const Reader& reader, const std::string& name, const std::uint8_t* data, std::size_t size) {
  core::ReadLimits limits;
  limits.repeated_triangles = 10'000;
  try {
    check(reader(io::MeshSource(name, std::string(reinterpret_cast<const char*>(data), size)), {}, limits));
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::input, "what cannot be read is an input error");
    require(error.problem().find('\n') == std::string::npos, "a problem is one line");
  }
}

}  // namespace vantage::fuzzing
