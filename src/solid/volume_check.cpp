#include "solid/volume_check.h"

#include <algorithm>
#include <string>
#include <vector>

#include "vantage/error.h"

namespace vantage::solid {
namespace {

[[noreturn]] void refuse(const std::string& problem, const std::string& where) {
  throw Error(ErrorKind::input, problem, where, "give a volume as computed, or mend what was changed in it");
}

}  // namespace

void check_volume(const Volume& volume) {
  const std::vector<Vec3>& vertices = volume.mesh.vertices;
  const std::vector<Triangle>& triangles = volume.mesh.triangles;
  if (volume.cause_of.size() != triangles.size()) {
    refuse("the volume has " + std::to_string(triangles.size()) + " triangles but causes of " +
               std::to_string(volume.cause_of.size()),
           "");
  }
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (!vertices[v].allFinite()) refuse("a coordinate is not finite", "vertex " + std::to_string(v));
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto beyond = [&](std::uint32_t v) { return v >= vertices.size(); };
    if (std::any_of(triangles[t].begin(), triangles[t].end(), beyond)) {
      refuse("a vertex index is out of range", "triangle " + std::to_string(t));
    }
    if (volume.cause_of[t] >= volume.causes.size()) {
      refuse("a cause index is out of range", "triangle " + std::to_string(t));
    }
  }
}

MeshMeasures measure_sound(const Mesh& mesh) {
  MeshMeasures measures = measure(mesh);
  if (measures.closed && measures.oriented) return measures;
  throw Error(ErrorKind::internal,
              measures.closed ? "the volume's facets do not all face outward" : "the volume is not closed",
              std::to_string(measures.facets) + " facets, Euler number " + std::to_string(measures.euler),
              "this is a defect of vantage: please report it together with the mission and its meshes; nothing was "
              "written");
}

}  // namespace vantage::solid
