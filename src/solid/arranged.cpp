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

/// So many meshes are in one arrangement: what it costs grows with the square of their number, where all of them meet.
constexpr std::size_t kMostAtOnce = 8;

Arranged intersection_at_once(std::span<const LabelledMesh> meshes, std::size_t& fallbacks,
                              const core::ProgressReporter& progress) {
  std::vector<Weighted> operands;
  for (const LabelledMesh& mesh : meshes) operands.push_back({&mesh});
  if (auto arranged = weighing_at_least(operands, operands.size(), progress)) return *arranged;
  ++fallbacks;
  std::vector<Solid> solids;
  for (const LabelledMesh& mesh : meshes) solids.push_back(mesh.mesh.empty() ? Solid() : Solid(mesh, "the volume"));
  const Solid solid = intersect(solids, progress);
  return {solid, solid.epsilon()};
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

Arranged intersection_of(std::vector<LabelledMesh> meshes, std::size_t& fallbacks,
                         const core::ProgressReporter& progress) {
  const auto all = static_cast<double>(meshes.size());
  double epsilon_m = 0;
  while (true) {
    const std::size_t count = meshes.size(), groups = (count + kMostAtOnce - 1) / kMostAtOnce;
    // The last round takes about as long for each mesh as the first one.
    const auto done = [&](std::size_t meshes_done) {
      return 1 - (static_cast<double>(count) - 0.5 * static_cast<double>(meshes_done)) / all;
    };
    double farthest_m = 0;
    std::vector<LabelledMesh> next;
    for (std::size_t g = 0; g < groups; ++g) {
      const std::size_t begin = count * g / groups, end = count * (g + 1) / groups;
      const Arranged group = intersection_at_once(std::span(meshes).subspan(begin, end - begin), fallbacks,
                                                  progress.part(done(begin), done(end)));
      farthest_m = std::max(farthest_m, group.epsilon_m);
      if (groups == 1 || group.solid.empty()) return {group.solid, epsilon_m + farthest_m};
      next.push_back(group.solid.to_mesh());
    }
    epsilon_m += farthest_m;
    meshes = std::move(next);
  }
}

}  // namespace vantage::internal::solid
