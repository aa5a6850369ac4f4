#include "solid/arranged.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "arrangement/arrangement.h"
#include "core/parallel.h"
#include "vantage/error.h"

namespace vantage::internal::solid {
namespace {

using arrangement::Part;
using arrangement::Surface;

/// As seen along the axis that a normal is nearest to, from its end.
Eigen::Vector2d flat(const Vec3& point, const Vec3& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const Eigen::Vector2d seen(point[(axis + 1) % 3], point[(axis + 2) % 3]);
  return normal[axis] > 0 ? seen : Eigen::Vector2d(seen.y(), seen.x());
}

std::vector<Triangle> triangles_of(const Surface& surface, const Part& part) {
  const std::vector<std::uint32_t>& first = surface.rings[part.first_ring];
  if (part.rings == 1 && first.size() == 3) return {{first[0], first[1], first[2]}};
  std::vector<std::vector<NumberedPoint>> rings;
  for (std::uint32_t r = part.first_ring; r < part.first_ring + part.rings; ++r) {
    std::vector<NumberedPoint>& ring = rings.emplace_back();
    for (const std::uint32_t p : surface.rings[r]) ring.push_back({flat(surface.points[p], part.normal), p});
  }
  return triangulate(rings, surface.epsilon_m);
}

}  // namespace

std::optional<Arranged> weighing_at_least(std::span<const Weighted> operands, std::uint64_t least,
                                          const core::ProgressReporter& progress) {
  std::vector<arrangement::Operand> meshes;
  for (const Weighted& operand : operands) {
    meshes.push_back({&operand.labelled->mesh, operand.weight, operand.is_complement});
  }
  auto surface = arrangement::weighing_at_least(meshes, least, progress);
  if (!surface) return std::nullopt;
  std::vector<std::vector<Triangle>> triangles(surface->parts.size());
  constexpr std::size_t kGrain = 256;
  parallel::for_ranges(triangles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) triangles[i] = triangles_of(*surface, surface->parts[i]);
  });
  LabelledMesh labelled;
  labelled.mesh.vertices = std::move(surface->points);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Part& part = surface->parts[i];
    std::vector<Triangle>& all = labelled.mesh.triangles;
    all.insert(all.end(), triangles[i].begin(), triangles[i].end());
    labelled.labels.resize(all.size(), operands[part.operand].labelled->labels[part.triangle]);
  }
  if (labelled.mesh.triangles.empty()) return Arranged{{}, surface->epsilon_m};
  // Two facets may both have been cut along one line that is none of their borders: such an edge has four facets.
  try {
    const Solid solid(labelled, "an arrangement");
    return Arranged{simplified(solid), std::max(surface->epsilon_m, solid.epsilon())};
  } catch (const Error& error) {
    if (error.code() != ErrorCode::mesh_not_closed) throw;
    return std::nullopt;
  }
}

}  // namespace vantage::internal::solid
