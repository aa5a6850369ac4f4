#include "prove/winding.h"

#include <algorithm>

#include "prove/distance.h"
#include "prove/orientation.h"

namespace vantage::internal::prove {

std::optional<int> passage(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const std::array<int, 3> sides = {orientation(from, to, a, b), orientation(from, to, b, c),
                                    orientation(from, to, c, a)};
  const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
  if (*least < 0 && *most > 0) return 0;
  const int at_from = orientation(a, b, c, from), at_to = orientation(a, b, c, to);
  if (at_from * at_to > 0) return 0;
  if (at_from * at_to == 0 || *least * *most == 0) {
    return are_on_a_line(a, b, c) ? std::optional(0) : std::nullopt;
  }
  return at_from;
}

const std::array<Vec3, Winding::kRays>& Winding::ways() {
  static const std::array<Vec3, kRays> ways = {Vec3(0.0013, 0.0007, 1), Vec3(-0.0011, 0.0017, 1),
                                               Vec3(0.0005, -0.0019, 1), Vec3(-0.0007, -0.0023, -1)};
  return ways;
}

Winding::Winding(const Vec3& point, const Box& box) : point_(point) {
  // Longer than needed: what lies beside the box is outside as well.
  const double length = 2 * (std::max(box.max.z(), point.z()) - std::min(box.min.z(), point.z())) + 1;
  for (std::size_t i = 0; i < kRays; ++i) {
    rays_[i].end = point + length * ways()[i];
    rays_[i].low = point.cwiseMin(rays_[i].end);
    rays_[i].high = point.cwiseMax(rays_[i].end);
  }
}

void Winding::add(const std::array<Vec3, 3>& corners) {
  const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  for (Ray& ray : rays_) {
    if (!ray.is_known || (low.array() > ray.high.array()).any() || (high.array() < ray.low.array()).any()) continue;
    const std::optional<int> passes = passage(point_, ray.end, corners);
    ray.is_known = passes.has_value();
    ray.turns += passes.value_or(0);
  }
  if ((point_ - high).cwiseMax(low - point_).maxCoeff() < nearest_m_) {
    nearest_m_ = std::min(nearest_m_, distance_from(point_, corners));
  }
}

std::optional<int> Winding::turns(double unsure_m) const {
  if (!(nearest_m_ > unsure_m)) return std::nullopt;
  for (const Ray& ray : rays_) {
    if (ray.is_known) return ray.turns;
  }
  return std::nullopt;
}

}  // namespace vantage::internal::prove
