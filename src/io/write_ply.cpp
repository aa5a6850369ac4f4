// PLY 1.0, binary, little-endian; scene frame.
#include <limits>

#include "common/input.h"
#include "io/georeference_text.h"
#include "io/rounding_text.h"
#include "io/volume_statement.h"
#include "io/writers.h"
#include "vantage/version.h"

namespace vantage::internal::io {

void write_ply(const Volume& volume, const StoredMesh& stored, AtomicFile& file) {
  const auto& [vertices, triangles] = stored.mesh;
  check_count(vertices.size(), std::numeric_limits<std::int32_t>::max(), "vertices", "PLY");

  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += "comment vantage " VANTAGE_VERSION " visibility volume: " + std::string(name_of(volume.outcome)) + "\n";
  header += "comment vantage frame: scene, metres, z up\n";
  header += place_comment(volume.georeference, "comment ");
  header += "comment vantage tolerance_m " + shortest(volume.tolerance_m) + "\n";
  header += "comment " + io::rounding_text(stored.rounding_m) + "\n";
  header += statement_comments(volume, stored.mesh, "comment ");
  for (std::size_t i = 0; i < volume.causes.size(); ++i) {
    const Cause& cause = volume.causes[i];
    header +=
        "comment vantage cause " + std::to_string(i) + " " + name_of(cause.kind) + " " + printable(cause.name) + "\n";
  }
  header += "element vertex " + std::to_string(vertices.size()) + "\n";
  header += "property double x\nproperty double y\nproperty double z\n";
  header += "element face " + std::to_string(triangles.size()) + "\n";
  header += "property list uchar int vertex_indices\nproperty uint cause\nend_header\n";
  file.write(header);

  std::string row;
  for (const Vec3& vertex : vertices) {
    row.clear();
    for (const double coordinate : vertex) append_little_endian(row, coordinate);
    file.write(row);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    row.clear();
    append_little_endian(row, std::uint8_t{3});
    for (const std::uint32_t index : triangles[t]) append_little_endian(row, index);
    append_little_endian(row, stored.cause_of[t]);
    file.write(row);
  }
}

}  // namespace vantage::internal::io
