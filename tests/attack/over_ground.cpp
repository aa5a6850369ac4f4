#include "over_ground.h"

#include <algorithm>

namespace attack {

double distance_to_side(const Plan& p, const Plan& a, const Plan& b) {
  const Plan side = b - a;
  const double square = side.squaredNorm();
  const double share = square > 0 ? std::clamp((p - a).dot(side) / square, 0.0, 1.0) : 0.0;
  return (p - a - share * side).norm();
}

Pieces pieces_at(const vantage::Ground& ground, const Plan& p) {
  if (!ground.surface) return {ground.plane_z_m, ground.plane_z_m, 0};
  Pieces pieces;
  for (const vantage::Triangle& t : ground.surface->triangles) {
    Vec3 c[3];
    for (int k = 0; k < 3; ++k) c[k] = ground.surface->vertices[t[k]] - Vec3(p.x(), p.y(), 0);
    double weight[3], sum = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
      weight[k] = a.x() * b.y() - a.y() * b.x();
      sum += weight[k];
    }
    if (sum == 0) continue;
    const bool holds = std::all_of(weight, weight + 3, [&](double w) { return w * sum >= 0; });
    if (holds) {
      const double z = (weight[0] * c[0].z() + weight[1] * c[1].z() + weight[2] * c[2].z()) / sum;
      pieces.lowest = std::min(pieces.lowest, z);
      pieces.highest = std::max(pieces.highest, z);
      pieces.beside = 0;
    } else {
      for (int k = 0; k < 3; ++k) {
        pieces.beside =
            std::min(pieces.beside, distance_to_side(Plan::Zero(), c[k].head<2>(), Plan(c[(k + 1) % 3].head<2>())));
      }
    }
  }
  return pieces;
}

std::vector<Plan> near_places(const vantage::Ground& ground, const Vec3& p) {
  std::vector<Plan> places{p.head<2>()};
  if (!ground.surface) return places;
  double size = p.head<2>().cwiseAbs().maxCoeff();
  for (const Vec3& v : ground.surface->vertices) size = std::max(size, (v - p).head<2>().norm());
  const double step = 1e-9 * size;
  for (const Plan& aside :
       {Plan(step, 0.3 * step), Plan(-step, -0.3 * step), Plan(-0.3 * step, step), Plan(0.3 * step, -step)}) {
    places.push_back(places[0] + aside);
  }
  return places;
}

}  // namespace attack
