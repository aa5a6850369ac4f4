#include "core/volume_check.h"

#include <algorithm>
#include <string>
#include <vector>

#include "vantage/error.h"

namespace vantage::internal::core {

void check_labelled(const Mesh& mesh, const Labels& labels) {
  const auto refuse = [&](ErrorCode code, const std::string& problem, const std::string& where) {
    throw Error(code, problem, where, labels.fix);
  };
  if (labels.of.size() != mesh.triangles.size()) {
    refuse(ErrorCode::array_sizes_differ,
           std::string("the ").append(labels.owner) + " has " + std::to_string(mesh.triangles.size()) +
               " triangles but " + labels.name + "s of " + std::to_string(labels.of.size()),
           "");
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite())
      refuse(ErrorCode::coordinate_not_finite, "a coordinate is not finite", "vertex " + std::to_string(v));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const auto beyond = [&](std::uint32_t v) { return v >= mesh.vertices.size(); };
    if (std::any_of(triangle.begin(), triangle.end(), beyond)) {
      refuse(ErrorCode::index_out_of_range, "a vertex index is out of range", "triangle " + std::to_string(t));
    }
    if (labels.of[t] >= labels.count) {
      refuse(ErrorCode::index_out_of_range, std::string("its ").append(labels.name) + " index is out of range",
             "triangle " + std::to_string(t));
    }
  }
}

void check_volume(const Volume& volume) {
  check_labelled(volume.mesh, {volume.cause_of, volume.causes.size(), "volume", "cause",
                               "give a volume as computed, or mend what was changed in it"});
  if (!volume.polygon_of.empty() && volume.polygon_of.size() != volume.mesh.triangles.size()) {
    throw Error(ErrorCode::array_sizes_differ,
                "there are " + std::to_string(volume.polygon_of.size()) + " polygons for " +
                    std::to_string(volume.mesh.triangles.size()) + " triangles",
                "volume", "give a volume as computed, or leave polygon_of empty");
  }
}

MeshMeasures measure_sound(const Mesh& mesh) {
  MeshMeasures measures = measure(mesh);
  if (measures.closed && measures.oriented) return measures;
  throw Error(ErrorCode::internal_defect,
              measures.closed ? "the volume's facets do not all face outward" : "the volume is not closed",
              std::to_string(measures.facets) + " facets, Euler number " + std::to_string(measures.euler),
              "this is a defect of vantage: please report it together with the mission and its meshes; nothing was "
              "written");
}

}  // namespace vantage::internal::core
