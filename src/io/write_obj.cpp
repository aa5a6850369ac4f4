// Wavefront OBJ: one group per cause, in the axes and the unit of the scene file.
#include <cmath>
#include <set>
#include <vector>

#include "common/input.h"
#include "io/axes_text.h"
#include "io/georeference_text.h"
#include "io/rounding_text.h"
#include "io/volume_statement.h"
#include "io/writers.h"
#include "vantage/error.h"
#include "vantage/version.h"

namespace vantage::internal::io {
namespace {

/// Group names end at white space, so that becomes "_"; a name that is taken gets the number of its cause.
std::vector<std::string> group_names(const std::vector<Cause>& causes) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const Cause& cause : causes) {
    std::string name = printable(cause.name);
    for (char& c : name) c = c == ' ' ? '_' : c;
    if (name.empty()) name = name_of(cause.kind);
    if (!taken.insert(name).second) {
      name.append("#").append(std::to_string(names.size()));
      taken.insert(name);
    }
    names.push_back(name);
  }
  return names;
}

/// The mesh with its facets in the order of the groups.
Mesh in_file_order(const StoredMesh& stored, const std::vector<std::vector<std::size_t>>& facets_of) {
  Mesh mesh{stored.mesh.vertices, {}};
  mesh.triangles.reserve(stored.mesh.triangles.size());
  for (const std::vector<std::size_t>& facets : facets_of) {
    for (const std::size_t t : facets) mesh.triangles.push_back(stored.mesh.triangles[t]);
  }
  return mesh;
}

}  // namespace

void check_obj_scale(const Volume& volume, double scale) {
  double largest = 0;
  for (const Vec3& vertex : volume.mesh.vertices) largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
  if (scale > 0 && std::isfinite(scale) && std::isfinite(largest / scale)) return;
  throw Error(ErrorCode::value_out_of_range, "the volume cannot be written in units of " + shortest(scale) + " m",
              "scale", "give the length of the scene file's unit in metres");
}

void write_obj(const Volume& volume, const StoredMesh& stored, UpAxis up, double scale, AtomicFile& file) {
  const auto& [vertices, triangles] = stored.mesh;
  std::vector<std::vector<std::size_t>> facets_of(volume.causes.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) facets_of[stored.cause_of[t]].push_back(t);
  file.write("# vantage " VANTAGE_VERSION " visibility volume: " + std::string(name_of(volume.outcome)) + "\n");
  file.write("# " + io::axes_text({up, scale}) + "\n");
  file.write(place_comment(volume.georeference, "# "));
  file.write("# " + io::rounding_text(stored.rounding_m) + "\n");
  file.write(statement_comments(volume, in_file_order(stored, facets_of), "# "));

  for (const Vec3& vertex : vertices) {
    std::string line("v");
    for (const double coordinate : up == UpAxis::y ? to_y_up(vertex) : vertex) {
      line.append(" ").append(shortest(coordinate / scale));
    }
    file.write(line.append("\n"));
  }

  const std::vector<std::string> names = group_names(volume.causes);
  for (std::size_t cause = 0; cause < facets_of.size(); ++cause) {
    if (facets_of[cause].empty()) continue;
    file.write("g " + names[cause] + "\n");
    for (const std::size_t t : facets_of[cause]) {
      std::string line("f");
      for (const std::uint32_t index : triangles[t]) line.append(" ").append(std::to_string(std::uint64_t{index} + 1));
      file.write(line.append("\n"));
    }
  }
}

}  // namespace vantage::internal::io
