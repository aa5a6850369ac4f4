// Binary STL, scene frame. The format has single precision only: far from the origin (UTM coordinates) it is coarse.
#include <Eigen/Geometry>
#include <limits>

#include "io/writers.h"
#include "vantage/version.h"

namespace vantage::internal::io {

void write_stl_mesh(const Mesh& mesh, std::string_view content, AtomicFile& file) {
  const auto& [vertices, triangles] = mesh;
  check_count(triangles.size(), std::numeric_limits<std::uint32_t>::max(), "triangles", "STL");

  std::string header("vantage " VANTAGE_VERSION " ");
  header.append(content).append(", scene frame, metres, z up");
  header.resize(80, ' ');
  append_little_endian(header, static_cast<std::uint32_t>(triangles.size()));
  file.write(header);

  std::string facet;
  for (const Triangle& t : triangles) {
    const Vec3 &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
    const Vec3 normal = (b - a).cross(c - a).stableNormalized();
    facet.clear();
    for (const Vec3& v : {normal, a, b, c}) {
      for (const double coordinate : v) append_little_endian(facet, static_cast<float>(coordinate));
    }
    append_little_endian(facet, std::uint16_t{0});
    file.write(facet);
  }
}

void write_stl(const StoredMesh& stored, AtomicFile& file) { write_stl_mesh(stored.mesh, "visibility volume", file); }

}  // namespace vantage::internal::io
