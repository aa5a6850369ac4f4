#include "maps/terrain/tin_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace vantage::internal::terrain {

void grow(Tin& tin, double max_error_m, const core::ProgressReporter& progress) {
  double first = -1;
  tin.refine(max_error_m, [&](double error) {
    // The error falls about as a power of the number of insertions: its logarithm tells how far it is.
    if (first < 0) first = error;
    const double floor = std::max(max_error_m, 0.01), done = std::log(first / error), all = std::log(first / floor);
    const double part = all > 0 ? std::clamp(done / all, 0.0, 1.0) : 0;
    progress.report(static_cast<std::uint64_t>(1000 * part), 1000);
  });
}

Mesh mesh_of(const Tin& tin, const std::vector<bool>& wanted) {
  Mesh mesh;
  std::vector<std::uint32_t> index(tin.points().size(), Tin::kNone);
  for (std::size_t f = 0; f < tin.facets().size(); ++f) {
    if (!wanted[f]) continue;
    Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t corner = tin.facets()[f].corner[i];
      if (index[corner] == Tin::kNone) {
        index[corner] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(tin.points()[corner]);
      }
      triangle[i] = index[corner];
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

TriangulatedTerrain raised_over(TriangulatedTerrain surface,
                                std::initializer_list<std::reference_wrapper<const std::vector<Vec3>>> points,
                                const core::ProgressReporter& progress) {
  constexpr double kRounding_m = 1e-9;
  std::vector<double> raise(surface.mesh().vertices.size(), 0);
  bool is_raised = false;
  for (const std::vector<Vec3>& list : points) {
    for (const Vec3& point : list) {
      progress.tick();
      const auto below = surface.find(point.head<2>());
      if (!below) continue;
      const double height = point.z() - below->height;
      if (!(height > kRounding_m)) continue;
      is_raised = true;
      for (const std::uint32_t corner : surface.mesh().triangles[below->triangle]) {
        raise[corner] = std::max(raise[corner], height);
      }
    }
  }
  if (!is_raised) return surface;
  Mesh mesh = surface.mesh();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i].z() += raise[i];
  return TriangulatedTerrain(std::move(mesh), progress);
}

double largest_error(const TriangulatedTerrain& surface, const std::vector<Vec3>& points,
                     const core::ProgressReporter& progress) {
  double largest = 0;
  for (const Vec3& point : points) {
    progress.tick();
    const std::optional<double> height = surface.height(point.head<2>());
    if (!height) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(*height - point.z()));
  }
  return largest;
}

}  // namespace vantage::internal::terrain
