#include "support/claimed_points.h"

#include <algorithm>
#include <cmath>

#include "support/clip_oracle.h"
#include "support/mesh_probe.h"

namespace vantage::testing {
namespace {

Vec3 on_surface(const Mesh& mesh, Random& random) {
  const auto& t =
      mesh.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.triangles.size()) - 1))];
  double a = random.uniform(0, 1), b = random.uniform(0, 1);
  if (a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  const Vec3& corner = mesh.vertices[t[0]];
  return corner + a * (mesh.vertices[t[1]] - corner) + b * (mesh.vertices[t[2]] - corner);
}

}  // namespace

Verdict judge(const Volume& volume, const Mesh& scene, std::vector<Vec3> polygon, int count, double margin,
              Random& random) {
  for (Vec3& vertex : polygon) vertex += volume.lift_m.at(0) * volume.frame.normal;
  const ClipOracle oracle(scene, polygon);
  const MeshProbe probe(volume);
  const Vec3& centre = volume.frame.origin;
  Verdict verdict;
  for (int k = 0; k < count; ++k) {
    Vec3 point;
    if (k % 5 == 0) {
      point = probe.draw(random);
    } else {
      point = on_surface(volume.mesh, random);
      point += 2e-6 * std::pow(5e3, random.uniform(0, 1)) * (centre - point);
    }
    const double distance = (point - centre).norm(), depth = probe.depth(point);
    if (depth < 1e-6 * distance) continue;
    ++verdict.looked;
    if (!oracle.is_hidden_from(point, margin)) continue;
    ++verdict.hidden;
    verdict.deepest = std::max(verdict.deepest, depth / distance);
  }
  return verdict;
}

}  // namespace vantage::testing
